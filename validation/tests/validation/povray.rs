//! Twins by POV-Ray: their colours, references that cannot be used, and what the pixelwise
//! comparison finds and forgives.

use crate::claims;
use etalon_film::{BoxFilter, ExactFilm, FilmSettings, Filter, RenderFacts, RenderedImage};
use etalon_images::{Frame, Image, exr};
use etalon_integrators::signature;
use etalon_render::decide::measure::Measure;
use etalon_render::decide::pixelwise::{self, PixelwiseLimits};
use etalon_statistics::Verdict;
use etalon_validation::claim::{Claim, Oracle};
use etalon_validation::outcome::{self, Conclusion, Outcome};
use etalon_validation::povray::{self, ScenePair};
use etalon_validation::run::{self, Options};
use etalon_validation::tier::Tier;
use etalon_validation::{edges, folders, rendering};
use std::path::PathBuf;

const NAME: &str = "povray-signature-perspective";

fn claims() -> Vec<Claim> {
    let claims = claims::claims();
    let twins = |claim: &Claim| matches!(claim.oracle, Oracle::Povray { .. });
    claims.into_iter().filter(twins).collect()
}

fn claim(name: &str) -> Claim {
    let mut claims = claims().into_iter();
    claims.find(|claim| claim.name == name).expect("a claim")
}

fn default() -> Options {
    Options {
        only: None,
        tier: Tier::Default,
        seed: 1,
        part: None,
    }
}

/// The number of an object named as in `#declare Colour3 = …` or `#declare Instance1 = …`.
fn object(name: &str) -> Option<u32> {
    if let Some(number) = name.strip_prefix("Colour") {
        return number.parse().ok();
    }
    let number: u32 = name.strip_prefix("Instance")?.parse().ok()?;
    Some((1 << 31) | number)
}

#[test]
fn colours_of_twins_are_those_of_the_integrator() {
    let mut compared = 0;
    for claim in claims() {
        let integrator = claim.estimators[0].integrator.as_deref();
        if integrator != Some("signature") {
            continue;
        }
        let path = folders::scenes().join(povray::twin(&claim.scene));
        let text = std::fs::read_to_string(&path).expect("a twin");
        for line in text.lines() {
            let Some((name, colour)) = (line.strip_prefix("#declare "))
                .and_then(|rest| rest.split_once(" = rgb <"))
                .and_then(|(name, rest)| Some((name, rest.strip_suffix(">;")?)))
            else {
                continue;
            };
            let number = object(name).unwrap_or_else(|| panic!("{}: {name}", path.display()));
            let expected = signature::colour(number);
            let found: Vec<f32> = (colour.split(", "))
                .map(|component| component.parse().expect("a number"))
                .collect();
            assert_eq!(found.len(), 3, "{}: {line}", path.display());
            for (found, expected) in found.iter().zip(expected) {
                assert!(
                    (found - expected).abs() < 1e-6,
                    "{}: {line}",
                    path.display()
                );
            }
            compared += 1;
        }
    }
    assert_eq!(compared, 7 + 6 + 7);
}

#[test]
fn the_quickest_twins_agree_and_their_mutants_are_found() {
    // Without noise nothing is left to chance. The slower twins are part of `validate`.
    let claims: Vec<Claim> = (claims().into_iter())
        .filter(|claim| claim.name.contains("signature") || claim.name == "povray-spheres")
        .collect();
    let rows =
        outcome::run(run::tasks(&claims, &default()), &default(), None, |_, _| ()).expect("a plan");
    assert_eq!(rows.len(), 3 * 4 + 2);
    for row in &rows {
        assert_eq!(row.outcome, Outcome::Passed, "{}", row.task.label());
        assert_eq!(row.decision.looks, 1, "{}", row.task.label());
        if row.task.fault.is_none() {
            let compared = row.compared.as_ref().expect("compared");
            let shown = compared.shown.as_ref().expect("two pictures");
            assert_eq!(shown[0].image.width(), shown[1].image.width());
            assert_eq!(compared.measures()[0].value, 0.0);
        }
    }
}

/// A reference of its own for a test, in a folder that is removed at its end.
struct Copy {
    folder: PathBuf,
    twins: ScenePair,
}

impl Copy {
    fn new(test: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("etalon-{test}-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a temporary folder");
        for extension in ["json", "exr"] {
            let file = format!("{NAME}.{extension}");
            std::fs::copy(folders::references().join(&file), folder.join(&file)).expect("copied");
        }
        let twins = povray::twins(&claim(NAME)).expect("twins");
        Self { folder, twins }
    }

    fn path(&self, extension: &str) -> PathBuf {
        self.folder.join(format!("{NAME}.{extension}"))
    }

    fn read(&self) -> Result<RenderedImage, String> {
        povray::read_in(&self.folder, NAME, &self.twins)
    }

    /// Why it cannot be used.
    fn refusal(&self) -> String {
        let Err(message) = self.read() else {
            panic!("it was read");
        };
        let again = format!("cargo xtask references --only {NAME}");
        assert!(message.contains(&again), "{message}");
        message
    }

    fn replace_picture(&self, image: &Image) {
        exr::write(&self.path("exr"), image, Frame::whole(image), "").expect("written");
    }
}

impl Drop for Copy {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.folder);
    }
}

fn grey(width: usize, height: usize) -> Image {
    let plane = || vec![0.5; width * height];
    Image::new(width, height)
        .with("R", plane())
        .with("G", plane())
        .with("B", plane())
}

#[test]
fn a_whole_reference_is_read() {
    let picture = Copy::new("twin-whole").read().expect("a reference");
    assert_eq!([picture.image.width(), picture.image.height()], [160, 120]);
}

#[test]
fn a_missing_reference_is_an_error() {
    for extension in ["exr", "json"] {
        let copy = Copy::new(&format!("twin-missing-{extension}"));
        std::fs::remove_file(copy.path(extension)).expect("removed");
        assert!(copy.refusal().contains(extension));
    }
}

#[test]
fn a_truncated_reference_is_an_error() {
    let copy = Copy::new("twin-truncated");
    let bytes = std::fs::read(copy.path("exr")).expect("a file");
    for length in [0, 100, bytes.len() / 2, bytes.len() - 1] {
        std::fs::write(copy.path("exr"), &bytes[..length]).expect("written");
        assert!(copy.refusal().contains(".exr"), "{length}");
    }
}

#[test]
fn a_reference_of_another_size_or_without_colours_is_an_error() {
    let copy = Copy::new("twin-size");
    copy.replace_picture(&grey(120, 160));
    assert!(copy.refusal().contains("120 × 160 pixels"));
    copy.replace_picture(&Image::new(160, 120).with("Y", vec![0.5; 160 * 120]));
    assert!(copy.refusal().contains("no channels R, G and B"));
}

#[test]
fn a_reference_with_a_nan_pixel_is_an_error() {
    let copy = Copy::new("twin-nan");
    let mut image = grey(160, 120);
    image.channel_mut("B").expect("a channel")[17] = f32::NAN;
    copy.replace_picture(&image);
    assert!(copy.refusal().contains("not finite"));
}

#[test]
fn a_reference_of_another_state_of_either_twin_is_an_error() {
    let mut copy = Copy::new("twin-stale");
    copy.twins.twin_hash = "0".to_owned();
    assert!(copy.refusal().contains("another state of POV-Ray's twin"));
    copy.twins.scene_hash = "0".to_owned();
    assert!(copy.refusal().contains("another state of the scene"));
}

#[test]
fn a_twin_without_its_reference_breaks_the_run() {
    let mut claim = claim(NAME);
    claim.name = "no-such-claim".to_owned();
    let claims = [claim];
    let rows =
        outcome::run(run::tasks(&claims, &default()), &default(), None, |_, _| ()).expect("a plan");
    // Not even a mutant counts as found.
    assert!(rows.iter().all(|row| row.outcome == Outcome::Broken));
    assert_eq!(Conclusion::of(&rows).exit_code(), 2);
}

const SIDE: usize = 40;

const LIMITS: PixelwiseLimits = PixelwiseLimits {
    edges: 0.11,
    excused: 0.002,
};

/// A picture whose left half is dark, or what `change` makes of it in two replicates.
fn two_halves(change: impl Fn(usize, usize, usize) -> f32) -> RenderedImage {
    let settings = FilmSettings::new(SIDE as u32, SIDE as u32, Filter::Box(BoxFilter));
    let mut film = ExactFilm::new(settings, &[]).expect("a small film");
    for replicate in 0..2 {
        let pixels = (0..SIDE * SIDE).map(|i| change(i % SIDE, i / SIDE, replicate));
        let plane: Vec<f32> = pixels.collect();
        let image = Image::new(SIDE, SIDE)
            .with("R", plane.clone())
            .with("G", plane.clone())
            .with("B", plane);
        film.add_replicate(&image, 1).expect("it fits");
    }
    film.develop(RenderFacts::default())
}

fn truth(x: usize) -> f32 {
    if x < SIDE / 2 { 0.25 } else { 0.75 }
}

/// Compares such a picture with the truth: the middle two columns of 40 and their two neighbours
/// are next to the edge.
fn compared(change: impl Fn(usize, usize, usize) -> f32, edges: usize) -> (Verdict, Vec<Measure>) {
    let edge = |x: usize| (SIDE / 2 - edges..SIDE / 2 + edges).contains(&x);
    let mask: Vec<bool> = (0..SIDE * SIDE).map(|i| edge(i % SIDE)).collect();
    let theirs = two_halves(|x, _, _| truth(x));
    let ours = two_halves(change);
    let measures = pixelwise::measure(&ours, &theirs, &mask, LIMITS, 1e-4).expect("comparable");
    (Measure::together(&measures).0, measures)
}

#[test]
fn a_difference_beyond_the_tolerance_is_found_anywhere_but_at_edges() {
    let off = |by: f32, column: usize| {
        move |x: usize, y: usize, _| truth(x) + if (x, y) == (column, 7) { by } else { 0.0 }
    };
    let verdict = |by: f32, column: usize| compared(off(by, column), 2).0;
    assert_eq!(verdict(0.0, 3), Verdict::Agrees);
    assert_eq!(verdict(0.0019, 3), Verdict::Agrees);
    assert_eq!(verdict(0.0021, 3), Verdict::Differs);
    assert_eq!(verdict(-0.0021, 3), Verdict::Differs);
    // At an edge, three pixels of 1600 are excused, four are not.
    assert_eq!(verdict(0.5, SIDE / 2 - 1), Verdict::Agrees);
    let wrong = |rows: usize| {
        move |x: usize, y: usize, _| {
            truth(if x + 1 == SIDE / 2 && y < rows {
                x + 1
            } else {
                x
            })
        }
    };
    assert_eq!(compared(wrong(3), 2).0, Verdict::Agrees);
    assert_eq!(compared(wrong(4), 2).0, Verdict::Differs);
}

#[test]
fn bright_pixels_are_judged_relative_to_their_value() {
    let factor = |by: f32| {
        let ours = two_halves(|_, _, _| 16.0 * by);
        let theirs = two_halves(|_, _, _| 16.0);
        let mask = vec![false; SIDE * SIDE];
        let measures = pixelwise::measure(&ours, &theirs, &mask, LIMITS, 1e-4);
        Measure::together(&measures.expect("comparable")).0
    };
    assert_eq!(factor(1.0 + 0.9 / 1024.0), Verdict::Agrees);
    assert_eq!(factor(1.0 - 1.1 / 1024.0), Verdict::Differs);
}

#[test]
fn a_picture_shifted_by_a_pixel_is_found_although_every_edge_has_its_colours() {
    let (verdict, measures) = compared(|x, _, _| truth(x.saturating_sub(1)), 2);
    assert_eq!(measures[0].value, 0.0, "all wrong pixels are edge pixels");
    assert_eq!(measures[3].value, 1.0 / SIDE as f64);
    assert_eq!(verdict, Verdict::Differs);
}

#[test]
fn too_many_edges_are_no_excuse() {
    let (verdict, measures) = compared(|x, _, _| truth(x), 3);
    assert_eq!(measures[2].value, 6.0 / SIDE as f64);
    assert_eq!(verdict, Verdict::Differs);
}

#[test]
fn noise_leaves_undecided_what_may_differ() {
    // One pixel whose two replicates differ: with one degree of freedom its interval is wide.
    let noisy = |x: usize, y: usize, replicate: usize| {
        let swing = if (x, y) == (3, 7) { 1e-4 } else { 0.0 };
        truth(x) + swing * (replicate as f32 - 0.5)
    };
    let (verdict, measures) = compared(noisy, 2);
    assert_eq!(measures[0].interval, [0.0, 1.0]);
    assert_eq!(verdict, Verdict::Undecided);
}

#[test]
fn edges_are_seen_where_objects_colours_and_shadows_end() {
    let mask = |name: &str| {
        let claim = claim(name);
        let loaded = rendering::load(&claim, &[], None).expect("a scene");
        let size = loaded.compiled.film.size;
        (edges::edges(&loaded.compiled.scene, size), size.x as usize)
    };
    // Nothing but background in the corners, nothing but floor at the lower border's middle.
    let (objects, width) = mask(NAME);
    assert!(!objects[0] && !objects[width - 1] && !objects[width * 119 + width / 2]);
    // A floor of squares alone: its only edges are those between colours.
    let (colours, width) = mask("povray-checkerboard");
    let row = &colours[90 * width..91 * width];
    let edges = row.iter().filter(|edge| **edge).count();
    assert!((4..width / 2).contains(&edges), "{edges}");
    // Walls and a floor, but more edges than silhouettes alone would make.
    let (shadows, _) = mask("povray-hard-shadows");
    let share = shadows.iter().filter(|edge| **edge).count() as f64 / shadows.len() as f64;
    assert!((0.15..0.22).contains(&share), "{share}");
}
