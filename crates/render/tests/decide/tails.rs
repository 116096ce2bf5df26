//! Means whose replicates are too far from normal for t: tiles that it calls off, and whole images.

use etalon_film::{BoxFilter, ExactFilm, FilmSettings, Filter, RenderFacts, RenderedImage};
use etalon_images::Image;
use etalon_render::decide::judged::{Against, Asked, judge, stated};
use etalon_render::judge::{ExactImage, Tolerances};
use etalon_statistics::Verdict;

/// A picture of two tiles of 16², of which `left` and `right` are the replicates, and what it ought
/// to be: ½.
fn picture(left: &[f64], right: &[f64]) -> (RenderedImage, ExactImage) {
    let settings = FilmSettings::new(32, 16, Filter::Box(BoxFilter));
    let mut film = ExactFilm::new(settings, &[]).expect("a small film");
    for (left, right) in left.iter().zip(right) {
        let pixel = |i: usize| (if i % 32 < 16 { *left } else { *right }) as f32;
        let plane: Vec<f32> = (0..32 * 16).map(pixel).collect();
        let names = ["R", "G", "B"];
        let image = (names.iter()).fold(Image::new(32, 16), |i, n| i.with(*n, plane.clone()));
        film.add_replicate(&image, 1).expect("it fits");
    }
    let picture = film.develop(RenderFacts::default());
    let channels = ["R", "G", "B"].map(|name| (name.to_owned(), vec![0.5; 32 * 16]));
    let known = ExactImage {
        size: [32, 16],
        channels: channels.into(),
    };
    (picture, known)
}

/// Failures are shown at the level `alarm`.
fn asked(exact: bool, alarm: f64) -> Asked {
    Asked { exact, alarm }
}

/// The verdict on the tiles of such a picture, within 3 % and half a per cent.
fn tiles(left: &[f64], right: &[f64]) -> Verdict {
    let (picture, known) = picture(left, right);
    let judged = judge(
        &picture,
        Against::ExactImage(&known),
        Tolerances::default(),
        asked(false, 1e-3),
    );
    let tiles = judged.expect("comparable").judgement.tiles;
    let row = tiles.iter().find(|row| row.side == 16);
    row.expect("tiles of 16²").verdict
}

/// Replicates about `mean`, spread evenly, with a last one of its own.
fn replicates(count: usize, mean: f64, last: f64) -> Vec<f64> {
    let spread = |i: usize| mean + 0.002 * (i as f64 / (count - 1) as f64 - 0.5);
    let mut all: Vec<f64> = (0..count).map(spread).collect();
    all[count - 1] = last;
    all
}

#[test]
fn a_tile_within_its_tolerance_confirms_no_other() {
    // Left, one of 16 replicates makes the variance: nobody can tell, whatever t says. Mutant
    // rejected: p-values of equality, by which the right tile, 2 % off, would confirm it.
    let wild = replicates(16, 0.8, 0.9);
    let off = |mean: f64| replicates(16, mean, mean);
    assert_eq!(tiles(&wild, &off(0.51)), Verdict::Undecided);
    assert_eq!(tiles(&wild, &off(0.55)), Verdict::Differs);
}

#[test]
fn a_bootstrap_confirms_what_t_has_said() {
    // One of 32 replicates is far below the others. Mutant rejected: an interval that excludes
    // no bias at all, in place of one beyond the tolerance.
    let sound = replicates(32, 0.5, 0.5);
    let off = |mean, last| tiles(&replicates(32, mean, last), &sound);
    assert_eq!(off(0.521, 0.51), Verdict::Undecided);
    assert_eq!(off(0.53, 0.52), Verdict::Differs);
}

#[test]
fn equality_that_nobody_could_ask_is_asked_where_it_can_be() {
    // One of 32 replicates is far off, and the level is a whole run's: t is refused, and no bootstrap
    // reaches it. With 99 % confidence the bias is below half a per cent, and in one of the two
    // pictures it is not nothing. Mutant rejected: half a per cent is all that is asked, so that a bias
    // of 0.1 % agrees with a formula whose equality nobody has looked at. (By t it is not far enough for
    // this level, so that tiles, which are as large as the image in effect, are silent.)
    let rules = Tolerances {
        alpha: 1e-6,
        rounding: 2e-5,
        ..Tolerances::default()
    };
    let verdict = |mean: f64, last: f64, exact: bool| {
        let all = replicates(32, mean, last);
        let (picture, known) = picture(&all, &all);
        let against = Against::ExactImage(&known);
        let judged = judge(&picture, against, rules, asked(exact, 1e-8)).expect("comparable");
        let images = &judged.judgement.images;
        assert!(images.iter().all(|row| row.interval[1].is_infinite()));
        assert_eq!(judged.judgement.verdict, Verdict::Undecided);
        let stated = stated(&picture, against, &judged.judgement, exact, 0.01);
        let stated = stated.expect("comparable");
        assert!(stated.bias < 0.005, "{}", stated.bias);
        stated.verdict(&judged.judgement)
    };
    assert_eq!(verdict(0.5006, 0.505, true), Verdict::Undecided);
    assert_eq!(verdict(0.5, 0.505, true), Verdict::Agrees);
    // Of a reference equality is not claimed.
    assert_eq!(verdict(0.5006, 0.505, false), Verdict::Agrees);
}

#[test]
fn a_failure_is_not_shown_by_an_interval_that_only_a_higher_level_has() {
    // Replicates with a skewness of 1.9, 32 of them: at a level of 1 % a bootstrap excludes that the
    // mean is ½, and at 10⁻⁹ nobody can tell. Mutants rejected: t's own p-value, which is below 10⁻⁹ in
    // the image's mean and in tiles; and the p-value of the interval at 1 % taken for one at 10⁻⁹.
    let skewed = |mean: f64| -> Vec<f64> {
        // Sixth powers of uniform numbers.
        let third = |i: usize| ((i as f64 + 0.5) / 32.0).powi(3);
        (0..32).map(|i| mean + 0.01 * third(i) * third(i)).collect()
    };
    let p = |mean: f64, alarm: f64| {
        let all = skewed(mean);
        let (picture, known) = picture(&all, &all);
        let rules = Tolerances {
            alpha: 0.01,
            rounding: 2e-5,
            ..Tolerances::default()
        };
        let judged = judge(
            &picture,
            Against::ExactImage(&known),
            rules,
            asked(true, alarm),
        );
        judged.expect("comparable").p
    };
    assert!(
        p(0.503, 1e-9) > 0.009 && p(0.503, 1e-9) <= 0.01,
        "in doubt, and no more"
    );
    assert!(
        p(0.503, 1e-3) <= 1e-3,
        "shown where a bootstrap reaches the level"
    );
    assert!(p(0.4986, 1e-9) > 0.01, "no doubt about what is true");
}
