//! Every question's picture by its closed form is that of a second computation, which knows the scene alone and none of the
//! formulas: grids of rays, of directions, of points of lights, and sums of bounces. The scenes are posed, so that the
//! pose is checked with them.

mod camera;
mod diffuse;
mod geometry;
mod posing;
mod rough;
mod specular;

use diffuse::{by_directions, by_lights, by_sky, room};
use etalon_conform::question::Question;
use etalon_conform::questions::{ALL, by_name};
use etalon_conform::scene::Scene;
use rough::by_facets;
use specular::{covered, through_lens, traced};

/// The name of a question, how its picture is found again, and how far the mean of all pixels and any one of them may be off, as
/// shares of the truth's mean.
type Row = (&'static str, fn(&Scene) -> Vec<f64>, f64, f64);

const TABLE: &[Row] = &[
    ("wall", |s| traced(s, 1), 1e-12, 1e-12),
    ("point-light-unit", |s| by_lights(s, 4, 1), 1e-5, 1e-4),
    ("sun-unit", |s| by_lights(s, 4, 1), 1e-12, 1e-12),
    ("sphere-light-large", |s| by_lights(s, 2, 250), 1e-4, 1e-3),
    ("sphere-light-small", |s| by_lights(s, 2, 150), 1e-4, 1e-3),
    ("sphere-light-1e-4", |s| by_lights(s, 2, 150), 1e-4, 1e-3),
    ("sphere-light-1e-6", |s| by_lights(s, 2, 150), 1e-4, 1e-3),
    ("sphere-light-far", |s| by_lights(s, 2, 150), 1e-4, 1e-3),
    ("sphere-light-cut", |s| by_lights(s, 3, 250), 2e-4, 1e-3),
    ("rectangle-light", |s| by_lights(s, 4, 80), 1e-4, 1e-3),
    (
        "rectangle-light-tilted",
        |s| by_lights(s, 4, 80),
        1e-4,
        1e-3,
    ),
    ("triangle-light", |s| by_lights(s, 4, 80), 1e-4, 1e-3),
    ("octahedron-light", |s| by_lights(s, 4, 80), 1e-4, 1e-3),
    ("two-lights", |s| by_lights(s, 2, 150), 1e-4, 1e-3),
    ("point-light", |s| by_lights(s, 4, 1), 1e-5, 1e-4),
    ("spot-light", |s| by_lights(s, 4, 1), 1e-5, 1e-4),
    ("spot-light-off-axis", |s| by_lights(s, 4, 1), 1e-5, 1e-4),
    ("spot-falloff-linear", |s| by_lights(s, 4, 1), 1e-5, 1e-4),
    ("spot-falloff-smooth", |s| by_lights(s, 4, 1), 1e-5, 1e-4),
    ("spot-falloff-quartic", |s| by_lights(s, 4, 1), 1e-5, 1e-4),
    ("sun", |s| by_lights(s, 4, 1), 1e-12, 1e-12),
    ("form-factor-parallel", |s| by_lights(s, 6, 80), 1e-4, 1e-3),
    (
        "form-factor-perpendicular",
        |s| by_directions(s, 4, 15_000),
        1e-4,
        3e-3,
    ),
    ("sky-block", |s| by_sky(s, 8), 1e-4, 1e-4),
    ("sky-block-linear", |s| by_sky(s, 30), 1e-4, 1e-4),
    ("sky-block-to-poles", |s| by_sky(s, 30), 1e-4, 1e-4),
    ("sky-beside-wall", |s| by_directions(s, 4, 4000), 1e-4, 3e-3),
    ("furnace", |s| by_directions(s, 1, 100), 1e-12, 1e-12),
    ("white-furnace", |s| by_directions(s, 1, 100), 1e-12, 1e-12),
    ("glowing-room-0.2", |s| room(s, 1000), 1e-12, 1e-12),
    ("glowing-room-0.5", |s| room(s, 1000), 1e-12, 1e-12),
    ("glowing-room-sizes", |s| room(s, 1000), 1e-12, 1e-12),
    ("glowing-room-0.8", |s| room(s, 1000), 1e-12, 1e-12),
    ("glowing-cube", |s| room(s, 1000), 1e-12, 1e-12),
    ("glowing-cube-0.8", |s| room(s, 1000), 1e-12, 1e-12),
    ("integrating-sphere-point", |s| room(s, 200_000), 1e-4, 1e-3),
    ("integrating-sphere-ball", |s| room(s, 200_000), 1e-4, 1e-4),
    ("pane-0", |s| traced(s, 1), 1e-6, 1e-6),
    ("pane-45", |s| traced(s, 1), 1e-6, 1e-6),
    ("pane-70", |s| traced(s, 1), 1e-6, 1e-6),
    ("pile-of-panes", |s| traced(s, 1), 1e-6, 1e-6),
    ("glass-ball", |s| traced(s, 4), 1e-6, 1e-6),
    ("mirror", |s| traced(s, 1), 1e-12, 1e-12),
    ("conductor-45", |s| traced(s, 1), 1e-12, 1e-12),
    ("conductor-75", |s| traced(s, 1), 1e-12, 1e-12),
    ("conductor-weak", |s| traced(s, 1), 1e-12, 1e-12),
    ("mirror-corridor", |s| covered(s, 1000), 1e-4, 1e-3),
    ("mirror-room", |s| traced(s, 1), 1e-7, 1e-7),
    ("rough-metal-highlight", |s| by_facets(s, 8, 1), 1e-4, 1e-3),
    (
        "rough-metal-highlight-correlated",
        |s| by_facets(s, 8, 1),
        1e-4,
        1e-3,
    ),
    ("rough-metal-sky", |s| by_facets(s, 1, 60), 1e-4, 1e-4),
    (
        "rough-metal-sky-correlated",
        |s| by_facets(s, 1, 60),
        1e-4,
        1e-4,
    ),
    ("absorber", |s| traced(s, 1), 1e-6, 1e-6),
    ("absorber-slanted", |s| traced(s, 1), 1e-6, 1e-6),
    ("absorbing-ball", |s| traced(s, 8), 1e-4, 1e-4),
    ("scattering-box", |s| traced(s, 4), 1e-12, 1e-12),
    ("registration", |s| covered(s, 10_000), 1e-4, 3e-3),
    ("perspective", |s| covered(s, 10_000), 1e-4, 3e-3),
    ("perspective-wide", |s| covered(s, 10_000), 1e-4, 3e-3),
    ("defocus", |s| through_lens(s, 1, 10_000), 1e-4, 5e-3),
    ("defocus-edge", |s| through_lens(s, 4, 2000), 1e-4, 2e-3),
];

#[test]
fn closed_forms_are_what_the_scenes_show() {
    let wrong: Vec<&str> = std::thread::scope(|scope| {
        let rows: Vec<_> = TABLE
            .iter()
            .map(|row| (row.0, scope.spawn(|| agrees(row))))
            .collect();
        let wrong = rows
            .into_iter()
            .filter_map(|(name, row)| (!row.join().unwrap_or(false)).then_some(name));
        wrong.collect()
    });
    assert!(wrong.is_empty(), "{wrong:?}");
}

fn agrees((name, found, of_mean, of_pixel): &Row) -> bool {
    let question = by_name(name).expect("a question of this name");
    let (scene, truth) = question.posed(7, 3);
    let found = found(&scene);
    let mean = found.iter().sum::<f64>() / found.len() as f64;
    let expected = truth.mean();
    let off_mean = (mean / expected - 1.0).abs();
    let off_pixels = found.iter().zip(&truth.means);
    let off_pixels = off_pixels.map(|(a, b)| (a - b).abs() / expected);
    let off_pixel = off_pixels.fold(0.0, f64::max);
    println!("{name:28} {expected:.9} {mean:.9} {off_mean:.1e} {off_pixel:.1e}");
    off_mean <= *of_mean && off_pixel <= *of_pixel
}

#[test]
fn every_question_is_computed_again() {
    let names = |questions: &mut dyn Iterator<Item = &'static str>| {
        let mut names: Vec<&str> = questions.collect();
        names.sort_unstable();
        names
    };
    // References were computed twice when they were made.
    let has_closed_form = |question: &&Question| (question.ask)().1.error == 0.0;
    let asked = names(
        &mut ALL
            .iter()
            .filter(has_closed_form)
            .map(|question| question.name),
    );
    let computed = names(&mut TABLE.iter().map(|row| row.0));
    assert_eq!(asked, computed);
    assert!(asked.is_sorted_by(|a, b| a < b), "a name stands twice");
}
