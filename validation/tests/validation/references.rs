//! References that cannot be used: each gives a clear error, never a pass.

use crate::claims::claims;
use etalon_film::{
    BoxFilter, ExactFilm, FilmSettings, Filter, Metadata, RenderFacts, RenderedImage,
    read_developed,
};
use etalon_images::Image;
use etalon_render::decide::judged::{self, Against, Asked};
use etalon_render::judge::{Tolerances, judge};
use etalon_validation::claim::{Claim, Oracle};
use etalon_validation::folders;
use etalon_validation::outcome::{self, Conclusion, Outcome};
use etalon_validation::reference::{self, Expected};
use etalon_validation::run::{self, Options};
use etalon_validation::tier::Tier;
use std::path::PathBuf;

fn claim() -> Claim {
    let claim = Claim::read(&folders::claims().join("cornell-box.toml"));
    claim.expect("a claim")
}

/// A folder of its own for a test, removed at its end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("etalon-{name}-{}", std::process::id()));
        std::fs::create_dir_all(&path).expect("a temporary folder");
        Self(path)
    }

    /// The cornell box's reference, copied; and what its claim expects.
    fn with_reference(name: &str) -> (Self, Expected) {
        let folder = Self::new(name);
        for extension in ["json", "exr"] {
            let file = format!("cornell-box.{extension}");
            std::fs::copy(folders::references().join(&file), folder.0.join(&file)).expect("copied");
        }
        let expected = reference::expected(&claim()).expect("a scene");
        (folder, expected)
    }

    fn read(&self, expected: &Expected) -> Result<etalon_film::RenderedImage, String> {
        reference::read_in(&self.0, "cornell-box", expected)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

#[test]
fn a_whole_reference_is_read() {
    let (folder, hash) = Folder::with_reference("whole");
    folder.read(&hash).expect("a reference");
}

#[test]
fn a_missing_reference_is_an_error() {
    let mut other = claim();
    other.name = "no-such-claim".to_owned();
    let message = reference::read(&other).expect_err("there is none");
    assert!(message.contains("cargo xtask references --only no-such-claim"));
    let (folder, hash) = Folder::with_reference("missing");
    std::fs::remove_file(folder.0.join("cornell-box.exr")).expect("removed");
    let message = folder.read(&hash).expect_err("the picture is gone");
    assert!(message.contains("cornell-box.exr"), "{message}");
}

#[test]
fn a_reference_of_another_state_of_the_scene_is_an_error() {
    let (folder, mut expected) = Folder::with_reference("scene");
    expected.scene_hash = "0".to_owned();
    let message = folder.read(&expected).expect_err("another scene's hash");
    assert!(message.contains("another state of the scene"), "{message}");
}

#[test]
fn a_reference_of_other_numbers_than_the_claim_states_is_an_error() {
    // Mutants rejected: only the one or the other is compared.
    for (spp, seeds) in [(100_000, 32), (256, 999)] {
        let mut claim = claim();
        claim.oracle = Oracle::Reference {
            spp,
            seeds,
            integrator: None,
        };
        let message = reference::read(&claim).expect_err("other numbers");
        let stated = format!(
            "256 samples per pixel of 32 seeds, the claim's `oracle` states {spp} of {seeds}"
        );
        assert!(message.contains(&stated), "{message}");
        assert!(
            message.contains("cargo xtask references --only cornell-box"),
            "{message}"
        );
    }
    // Nor does it help to amend the description alone.
    let (folder, mut expected) = Folder::with_reference("numbers");
    expected.spp = 512;
    let path = folder.0.join("cornell-box.json");
    let text = std::fs::read_to_string(&path).expect("a description");
    std::fs::write(&path, text.replace("\"spp\": 256", "\"spp\": 512")).expect("written");
    let message = folder.read(&expected).expect_err("fewer samples");
    assert!(message.contains("not as many samples"), "{message}");
}

#[test]
fn a_reference_of_another_integrator_is_an_error() {
    let (folder, mut expected) = Folder::with_reference("integrator");
    expected.integrator = Some("volpath".to_owned());
    let message = folder.read(&expected).expect_err("another integrator");
    let stated = "made by the scene's integrator, the claim's `oracle` states Mitsuba's `volpath`";
    assert!(message.contains(stated), "{message}");
}

/// What is said of the cornell box's reference after a change of it.
fn said_of(name: &str, change: impl FnOnce(&mut RenderedImage)) -> String {
    let (folder, expected) = Folder::with_reference(name);
    let path = folder.0.join("cornell-box.exr");
    let mut picture = read_developed(&path).expect("a picture");
    change(&mut picture);
    picture.write_exr(&path).expect("written");
    folder.read(&expected).expect_err("not whole")
}

fn facts(picture: &mut RenderedImage) -> &mut Metadata {
    picture.metadata.as_mut().expect("statistics")
}

#[test]
fn a_reference_without_a_channel_or_a_size_of_tiles_is_an_error() {
    // Mutants rejected: a reference is compared by what it happens to have.
    for (index, name) in ["R", "G", "B"].into_iter().enumerate() {
        let message = said_of(&format!("channel-{name}"), |picture| {
            // The plane stays, under a name that is no colour's.
            let other = format!("lost.{name}");
            let mut image = Image::new(picture.image.width(), picture.image.height());
            for channel in ["R", "G", "B"] {
                let plane = picture.image.channel(channel).expect("a channel").to_vec();
                let kept = if channel == name { &other } else { channel };
                image.push(kept, plane);
            }
            picture.image = image;
            facts(picture).channels[index] = other;
        });
        let expected = format!("it has no channel `{name}`");
        assert!(message.contains(&expected), "{message}");
    }
    for (side, expected) in [
        (None, "it has no means of the whole image"),
        (Some(16), "it has no means of tiles of 16² pixels"),
        (Some(64), "it has no means of tiles of 64² pixels"),
    ] {
        let message = said_of("sides", |picture| {
            facts(picture)
                .tile_means
                .retain(|means| means.side() != side);
        });
        assert!(message.contains(expected), "{message}");
        assert!(message.contains("cargo xtask references"), "{message}");
    }
}

#[test]
fn a_picture_of_our_own_is_no_reference() {
    // It has the numbers that are asked for. Mutants rejected: nobody asks who made it, or with
    // which variant.
    for version in [etalon_render::VERSION, "Mitsuba 3.9.1 scalar_spectral"] {
        let message = said_of("own", |picture| {
            facts(picture).version = version.to_owned();
        });
        let expected = format!(
            "it was made by `{version}`, its description names `Mitsuba 3.9.1 llvm_ad_spectral`"
        );
        assert!(message.contains(&expected), "{message}");
    }
}

#[test]
fn pictures_without_a_mean_of_the_whole_are_not_compared() {
    // Mutant rejected: no mean differs where there is none.
    let path = reference::picture_path("cornell-box");
    let whole = read_developed(&path).expect("a picture");
    let mut tiles = whole.clone();
    facts(&mut tiles).tile_means.retain(|m| m.side().is_some());
    let judged = judge(&whole, &tiles, Tolerances::default());
    let message = judged.expect_err("refused");
    assert!(message.contains("means of the whole image"), "{message}");
}

#[test]
fn a_reference_is_read_before_anything_is_rendered() {
    // The estimator cannot be rendered either, so that who is asked first is told. Mutant rejected:
    // the picture before the reference.
    let mut claim = claim();
    claim.name = "no-such-claim".to_owned();
    claim.estimators.truncate(1);
    claim.estimators[0].light_chooser = Some("no such chooser".to_owned());
    claim.estimators[0].mutants.clear();
    let claims = [claim];
    let options = Options {
        only: None,
        tier: Tier::Default,
        seed: 1,
        part: None,
    };
    let rows = outcome::run(run::tasks(&claims, &options), &options, None, |_, _| ());
    let rows = rows.expect("a plan");
    let message = rows[0].compared.as_ref().err().expect("broken");
    assert!(message.contains("cargo xtask references"), "{message}");
}

#[test]
fn a_truncated_reference_is_an_error() {
    let (folder, hash) = Folder::with_reference("truncated");
    let path = folder.0.join("cornell-box.exr");
    let bytes = std::fs::read(&path).expect("a file");
    for length in [0, 100, bytes.len() / 2, bytes.len() - 1] {
        std::fs::write(&path, &bytes[..length]).expect("written");
        let message = folder.read(&hash).expect_err("truncated");
        assert!(message.contains("cornell-box.exr"), "{length}: {message}");
    }
}

#[test]
fn a_reference_with_a_nan_pixel_is_an_error() {
    let (folder, hash) = Folder::with_reference("nan");
    let path = folder.0.join("cornell-box.exr");
    let mut picture = read_developed(&path).expect("a picture");
    let mut image = Image::new(picture.image.width(), picture.image.height());
    for name in ["R", "G", "B"] {
        let mut plane = picture.image.channel(name).expect("a channel").to_vec();
        if name == "G" {
            plane[17] = f32::NAN;
        }
        image.push(name, plane);
    }
    picture.image = image;
    picture.write_exr(&path).expect("written");
    let message = folder.read(&hash).expect_err("a NaN pixel");
    assert!(message.contains("NaN"), "{message}");
}

#[test]
fn a_reference_of_another_size_is_an_error() {
    let (folder, mut expected) = Folder::with_reference("size");
    expected.size[1] += 1;
    let message = folder.read(&expected).expect_err("another size");
    assert!(
        message.contains("it has 96 × 96 pixels, the film 96 × 97"),
        "{message}"
    );
}

#[test]
fn pictures_of_another_size_are_not_compared() {
    let picture = |width: u32| {
        let settings = FilmSettings::new(width, 8, Filter::Box(BoxFilter));
        let mut film = ExactFilm::new(settings, &[]).expect("a small film");
        for value in [0.5, 0.6, 0.7] {
            let mut image = Image::new(width as usize, 8);
            for name in ["R", "G", "B"] {
                image.push(name, vec![value; width as usize * 8]);
            }
            film.add_replicate(&image, 1).expect("it fits");
        }
        film.develop(RenderFacts::default())
    };
    let against = picture(9);
    let against = Against::Picture(&against);
    let asked = Asked {
        exact: false,
        alarm: 1e-3,
    };
    let judged = judged::judge(&picture(8), against, Default::default(), asked);
    let message = judged.err().expect("refused");
    assert!(message.contains("differ in size"), "{message}");
}

#[test]
fn a_claim_without_its_reference_breaks_the_run() {
    let claims = claims();
    let mut claims: Vec<Claim> = (claims.into_iter())
        .filter(|claim| claim.name == "foliage" || claim.name == "irradiance-disk")
        .collect();
    for claim in &mut claims {
        if claim.name == "foliage" {
            claim.name = "no-such-claim".to_owned();
        }
    }
    let options = Options {
        only: None,
        tier: Tier::Default,
        seed: 1,
        part: None,
    };
    let tasks = run::tasks(&claims, &options);
    let rows = outcome::run(tasks, &options, None, |_, _| ()).expect("a plan");
    let broken = rows.iter().find(|row| row.outcome == Outcome::Broken);
    let broken = broken.expect("it cannot be compared");
    assert_eq!(broken.task.claim.name, "no-such-claim");
    assert!(broken.decision.p_corrected.is_none());
    assert_eq!(Conclusion::of(&rows).exit_code(), 2);
}
