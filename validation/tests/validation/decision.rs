//! The decision itself: on synthetic pictures whose bias is known, and on a claim with and
//! without faults.

use crate::claims::claims;
use etalon_film::{BoxFilter, ExactFilm, FilmSettings, Filter, RenderFacts, RenderedImage};
use etalon_images::Image;
use etalon_render::judge::{ExactImage, ImageComparison, Tolerances, judge, judge_known};
use etalon_statistics::Verdict;
use etalon_validation::claim::{Budget, Claim};
use etalon_validation::fault::PlantedFault;
use etalon_validation::folders;
use etalon_validation::outcome::{self, Conclusion, Outcome};
use etalon_validation::run::{self, Options};
use etalon_validation::tier::Tier;

const WIDTH: usize = 40;
const HEIGHT: usize = 24;

/// What a pixel is expected to be.
fn truth(x: usize, y: usize) -> f64 {
    0.2 + 0.01 * x as f64 + 0.02 * y as f64
}

/// Replicates with noise of 5 % per pixel, and a relative bias that depends on the place.
fn picture(seed: u64, bias: impl Fn(usize, usize) -> f64) -> RenderedImage {
    let settings = FilmSettings::new(WIDTH as u32, HEIGHT as u32, Filter::Box(BoxFilter));
    let mut film = ExactFilm::new(settings, &[]).expect("a small film");
    let mut state = seed;
    let mut noise = || {
        // Sums of uniform numbers of a linear congruential generator (Knuth's MMIX).
        let mut sum = 0.0;
        for _ in 0..12 {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            sum += (state >> 11) as f64 / (1u64 << 53) as f64;
        }
        sum - 6.0
    };
    for _ in 0..16 {
        let mut image = Image::new(WIDTH, HEIGHT);
        for name in ["R", "G", "B"] {
            let pixels = (0..WIDTH * HEIGHT)
                .map(|i| {
                    let (x, y) = (i % WIDTH, i / WIDTH);
                    (truth(x, y) * (1.0 + bias(x, y) + 0.05 * noise())) as f32
                })
                .collect();
            image.push(name, pixels);
        }
        film.add_replicate(&image, 1).expect("it fits");
    }
    film.develop(RenderFacts::default())
}

fn known() -> ExactImage {
    let pixels: Vec<f64> = (0..WIDTH * HEIGHT)
        .map(|i| truth(i % WIDTH, i / WIDTH))
        .collect();
    ExactImage {
        size: [WIDTH as u32, HEIGHT as u32],
        channels: ["R", "G", "B"]
            .map(|name| (name.to_owned(), pixels.clone()))
            .into(),
    }
}

/// Against the truth, and against another sound picture.
fn both(image: &RenderedImage) -> [ImageComparison; 2] {
    let rules = Tolerances::default();
    [
        judge_known(image, &known(), rules).expect("comparable"),
        judge(image, &picture(99, |_, _| 0.0), rules).expect("comparable"),
    ]
}

#[test]
fn a_sound_picture_agrees() {
    // α = 10⁻³ per judgement; the seed is fixed. Mutant rejected: a bias of 2 % (below).
    for judgement in both(&picture(1, |_, _| 0.0)) {
        assert_eq!(judgement.verdict, Verdict::Agrees);
        assert!(judgement.p_exact > 1e-3);
        for row in &judgement.images {
            assert!(row.interval[0] < 0.0 && row.interval[1] > 0.0 || row.bias.abs() < 0.005);
            assert!(row.smallest_detectable < 0.01);
        }
    }
}

#[test]
fn a_bias_of_the_whole_picture_differs() {
    for judgement in both(&picture(2, |_, _| 0.02)) {
        assert_eq!(judgement.verdict, Verdict::Differs);
        assert!(judgement.p_exact < 1e-3);
        assert!((judgement.images[0].bias - 0.02).abs() < 0.005);
    }
}

#[test]
fn a_bias_in_a_tile_is_found_where_it_is() {
    // The faint tile (2, 1) is 20 % off, and the rest makes up for it in the mean.
    let inside = |x: usize, y: usize| x >= 32 && y >= 16;
    let (mut tile, mut rest) = (0.0, 0.0);
    for i in 0..WIDTH * HEIGHT {
        let (x, y) = (i % WIDTH, i / WIDTH);
        *(if inside(x, y) { &mut tile } else { &mut rest }) += truth(x, y);
    }
    let image = picture(3, |x, y| {
        if inside(x, y) {
            0.2
        } else {
            -0.2 * tile / rest
        }
    });
    for judgement in both(&image) {
        assert_eq!(judgement.verdict, Verdict::Differs);
        for row in &judgement.images {
            assert_eq!(row.verdict, Verdict::Agrees);
        }
        let small = judgement.tiles.iter().find(|row| row.side == 16);
        assert_eq!(small.expect("tiles of 16²").worst, [2, 1]);
    }
}

#[test]
fn pictures_of_different_size_are_refused() {
    let mut other = known();
    other.size = [HEIGHT as u32, WIDTH as u32];
    let message = judge_known(&picture(4, |_, _| 0.0), &other, Tolerances::default());
    assert!(message.expect_err("refused").contains("differ in size"));
}

#[test]
fn the_furnace_holds_and_its_mutants_are_found() {
    // α = 10⁻³ over the three comparisons; rejected: wrong light density, energy × 1.02.
    let claims = claims();
    let options = Options {
        only: Some("furnace".to_owned()),
        tier: Tier::Default,
        seed: 3,
        part: None,
    };
    let claims: Vec<Claim> = claims.into_iter().filter(|c| c.name == "furnace").collect();
    let tasks = run::tasks(&claims, &options);
    assert_eq!(tasks.len(), 3);
    let rows = outcome::run(tasks, &options, None, |_, _| ()).expect("a plan");
    for row in &rows {
        assert_eq!(row.outcome, Outcome::Passed, "{:?}", row.task.fault);
    }
    assert_eq!(Conclusion::of(&rows).exit_code(), 0);
}

#[test]
fn the_stated_bound_is_exceeded_no_more_often_than_it_says() {
    use etalon_render::decide::judged::{Against, stated};
    // 200 pictures that are off by 1 %, judged at α = 0.2: a bound below 1 % is wrong, and with
    // three channels of which the farthest counts it is rarer than α. More than 40 + 3.1 standard
    // deviations would happen once in a thousand runs. Mutant rejected: bounds 10 % too low.
    let known = known();
    let wrong = |factor: f64| {
        (0..200_u64)
            .filter(|seed| {
                let image = picture(1000 + seed, |_, _| 0.01);
                let judgement =
                    judge_known(&image, &known, Tolerances::default()).expect("comparable");
                let stated = stated(&image, Against::ExactImage(&known), &judgement, true, 0.2);
                factor * stated.expect("comparable").bias < 0.01
            })
            .count()
    };
    assert!(wrong(1.0) < 58);
    assert!(wrong(0.9) > 58);
}

/// One estimator of a closed form with few samples, whose claim has the bound `image` of its own.
pub(crate) fn poor(image: f64) -> Vec<Claim> {
    let mut claims = claims();
    claims.retain(|claim| claim.name == "irradiance-disk");
    for claim in &mut claims {
        claim.bounds.image = image;
        claim.estimators.truncate(1);
        for estimator in &mut claim.estimators {
            estimator.mutants.clear();
            estimator.thorough.spp = 32;
            estimator.default = Some(estimator.thorough);
        }
    }
    claims
}

/// The only row's looks, and the bound of its bias.
fn passed(claims: &[Claim], tier: Tier) -> (usize, f64) {
    let options = Options {
        only: None,
        tier,
        seed: 1,
        part: None,
    };
    let rows = outcome::run(run::tasks(claims, &options), &options, None, |_, _| ());
    let row = &rows.expect("a plan")[0];
    assert_eq!(row.outcome, Outcome::Passed, "{tier:?}");
    let compared = row.compared.as_ref().expect("made");
    (row.decision.looks, compared.bias_bound.expect("asked for"))
}

#[test]
fn a_full_run_goes_on_until_half_a_per_cent_is_excluded() {
    // A claim whose own bound is 5 %, with few samples: the default run is content with its first
    // look, the full one with nothing above 0.5 %. Mutant rejected: a full run that asks nothing
    // more than the claim does.
    let claims = poor(0.05);
    let ((first, wide), (full, narrow)) =
        (passed(&claims, Tier::Default), passed(&claims, Tier::Full));
    assert!(first == 1 && wide > 0.005, "{first} {wide}");
    assert!(full > 1 && narrow < 0.005, "{full} {narrow}");
}

#[test]
fn a_full_run_asks_a_claims_own_bound_where_that_is_tighter() {
    // Mutant rejected: half a per cent for every row.
    let (looks, bias) = passed(&poor(0.05), Tier::Full);
    assert!(bias > 0.0025, "{bias}");
    let (more, narrow) = passed(&poor(0.0025), Tier::Full);
    assert!(more > looks && narrow < 0.0025, "{more} {narrow}");
}

#[test]
fn a_fault_that_is_missed_for_lack_of_samples_is_undecided() {
    // Mutants rejected: what is missed is a failure, which would kill faults that no claim has seen;
    // or it passes.
    let claims = poor(0.05);
    for (verdict, fault, outcome) in [
        (None, Some(PlantedFault::Energy), Outcome::Broken),
        (
            Some(Verdict::Undecided),
            Some(PlantedFault::Energy),
            Outcome::Undecided,
        ),
        (
            Some(Verdict::Agrees),
            Some(PlantedFault::Energy),
            Outcome::Failed,
        ),
        (
            Some(Verdict::Differs),
            Some(PlantedFault::Energy),
            Outcome::Passed,
        ),
        (Some(Verdict::Undecided), None, Outcome::Undecided),
        (Some(Verdict::Agrees), None, Outcome::Passed),
        (Some(Verdict::Differs), None, Outcome::Failed),
    ] {
        let options = Options {
            only: None,
            tier: Tier::Default,
            seed: 1,
            part: None,
        };
        let mut task = run::tasks(&claims, &options)[0];
        task.fault = fault;
        assert_eq!(
            Outcome::of(&task, verdict),
            outcome,
            "{fault:?} {verdict:?}"
        );
    }
}

#[test]
fn batches_together_are_as_if_rendered_at_once() {
    use etalon_validation::accumulate::merge;
    let (a, b) = (picture(5, |_, _| 0.0), picture(6, |_, _| 0.0));
    let both = merge(&a, &b).expect("batches of one estimator");
    let facts = both.metadata.as_ref().expect("statistics");
    assert_eq!(facts.replicates, 32);
    for channel in ["R", "G", "B"] {
        // The whole image's mean is a tile, and a mean of pixels.
        let (means, _) = etalon_render::judge::replicates(facts, channel, None).expect("means");
        assert_eq!(means.len(), 32);
        let mean = means.iter().sum::<f64>() / 32.0;
        let pixels = both.image.channel(channel).expect("a channel");
        let other = pixels.iter().map(|x| f64::from(*x)).sum::<f64>() / pixels.len() as f64;
        assert!((mean - other).abs() < 1e-6 * mean, "{mean} {other}");
        // The noise is 5 % of the truth, over the root of 32 replicates; mutant rejected: standard
        // errors averaged, which would be √2 times as great.
        let errors = both.standard_error(channel).expect("standard errors");
        let relative = (0..WIDTH * HEIGHT)
            .map(|i| f64::from(errors[i]) / truth(i % WIDTH, i / WIDTH))
            .sum::<f64>()
            / (WIDTH * HEIGHT) as f64;
        let expected = 0.05 / 32.0_f64.sqrt();
        assert!(
            (relative / expected - 1.0).abs() < 0.05,
            "{relative} {expected}"
        );
    }
    let one = merge(&both, &a).err();
    assert_eq!(one, None, "more batches may follow");
}

#[test]
fn an_undecided_comparison_gets_more_replicates_and_is_never_passed() {
    // Far too few samples for a bound of 0.01 %: every look is undecided. α = 10⁻³.
    let mut claims = claims();
    claims.retain(|claim| claim.name == "irradiance-disk");
    for claim in &mut claims {
        claim.bounds.image = 1e-4;
        claim.bounds.rounding = 0.0;
        for estimator in &mut claim.estimators {
            estimator.mutants.clear();
            // Rows of the matrix have none.
            if let Some(budget) = &mut estimator.default {
                (budget.spp, budget.replicates) = (64, 32);
            }
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
    assert_eq!(rows.len(), 1);
    assert_eq!(rows[0].outcome, Outcome::Undecided);
    assert_eq!(rows[0].decision.looks, Tier::Default.looks().len());
    let compared = rows[0].compared.as_ref().expect("it can be compared");
    assert_eq!((compared.spp, compared.replicates), (512, 256));
    assert_eq!(Conclusion::of(&rows).exit_code(), 3);
}

#[test]
fn the_json_is_the_one_that_is_described() {
    use etalon_validation::json::{self, Provenance};
    let page = std::fs::read_to_string(folders::root().join("docs/validation-json.md"));
    let page = page.expect("the page can be read");
    let claims = claims();
    let claims: Vec<Claim> = (claims.into_iter())
        .filter(|c| c.name == "furnace" || c.name == "invariance-bits")
        .collect();
    let options = Options {
        only: None,
        tier: Tier::Default,
        seed: 4,
        part: None,
    };
    let tasks = run::tasks(&claims, &options);
    let plan = run::RunPlan::of(&tasks, &options);
    let rows = outcome::run(tasks, &options, None, |_, _| ()).expect("a plan");
    let value = json::of(&rows, &Provenance::of(&options, plan, 1.0));
    assert_eq!(value["exit_code"], 0);
    let object = |value: &serde_json::Value| -> Vec<String> {
        let object = value.as_object().expect("an object");
        object.keys().cloned().collect()
    };
    let row = &value["rows"][0];
    for field in [object(&value), object(row), object(&value["provenance"])].concat() {
        assert!(page.contains(&format!("`{field}`")), "{field}");
    }
    let command = row["command"].as_str().expect("a command");
    assert_eq!(command, "cargo xtask validate --only furnace --seed 4");
}

#[test]
fn parts_are_decided_as_parts_of_the_whole() {
    // The levels are those of all comparisons together. Mutants rejected: a family of what the
    // part makes, which would grant each larger shares; a comparison that no part, or two, make.
    let claims = claims();
    let mut claims: Vec<Claim> = (claims.into_iter())
        .filter(|claim| {
            ["furnace", "irradiance-point", "mirror-room"].contains(&claim.name.as_str())
        })
        .collect();
    for estimator in claims.iter_mut().flat_map(|claim| &mut claim.estimators) {
        estimator.default = Some(Budget {
            spp: 16,
            replicates: 8,
            bound: None,
        });
    }
    let rows_of = |part: Option<&str>| {
        let options = Options {
            only: None,
            tier: Tier::Default,
            seed: 3,
            part: part.map(|part| part.parse().expect("a part")),
        };
        let tasks = run::tasks(&claims, &options);
        let rows = outcome::run(tasks, &options, None, |_, _| ()).expect("a plan");
        let rows = rows.into_iter().map(|row| {
            let task = row.task;
            let name = format!("{} {}", task.claim.name, task.label());
            (name, row.history[0].level, row.history[0].value)
        });
        rows.collect::<Vec<_>>()
    };
    let whole = rows_of(None);
    let [mut first, second] = ["1/2", "2/2"].map(|part| rows_of(Some(part)));
    assert!(!first.is_empty() && !second.is_empty());
    first.extend(second);
    let sorted = |mut rows: Vec<(String, f64, f64)>| {
        rows.sort_by(|a, b| a.0.cmp(&b.0));
        rows
    };
    assert_eq!(sorted(first), sorted(whole));
}
