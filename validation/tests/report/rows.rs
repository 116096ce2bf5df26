//! Rows of every kind and outcome, made of numbers instead of renders.

use etalon_film::{BoxFilter, ExactFilm, FilmSettings, Filter, RenderFacts, RenderedImage};
use etalon_images::{Frame, Image};
use etalon_render::decide::convergence::Fall;
use etalon_render::decide::decision::Decision;
use etalon_render::decide::judged::{self, Against, Asked, Judged};
use etalon_render::decide::measure::Measure;
use etalon_render::judge::{ExactImage, ImageRow, Tolerances};
use etalon_statistics::Verdict;
use etalon_validation::claim::Claim;
use etalon_validation::fault::PlantedFault;
use etalon_validation::folders;
use etalon_validation::look::Look;
use etalon_validation::outcome::{Outcome, Row};
use etalon_validation::run::{Compared, Evidence, Task};

const WIDTH: usize = 48;
const HEIGHT: usize = 32;

/// What every pixel is expected to be; sRGB code 137.
const TRUTH: f64 = 0.25;

/// How strict the synthetic comparisons are.
pub(crate) const RULES: Tolerances = Tolerances {
    image_bound: 0.005,
    tile_bound: 0.03,
    alpha: 1e-4,
    rounding: 1e-6,
};

/// Equality, at one level.
pub(crate) const ASKED: Asked = Asked {
    exact: true,
    alarm: 1e-4,
};

/// 32 replicates with noise of 5 % per pixel, off by ∓`bias` left and right of the middle.
pub(crate) fn picture(seed: u64, bias: f64, seconds: f64) -> RenderedImage {
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
    for _ in 0..32 {
        let mut image = Image::new(WIDTH, HEIGHT);
        for name in ["R", "G", "B"] {
            let pixel = |i: usize| {
                let side = if i % WIDTH < WIDTH / 2 { -1.0 } else { 1.0 };
                (TRUTH * (1.0 + side * bias + 0.05 * noise())) as f32
            };
            image.push(name, (0..WIDTH * HEIGHT).map(pixel).collect());
        }
        film.add_replicate(&image, 4).expect("it fits");
    }
    film.develop(RenderFacts {
        seconds: Some(seconds),
        ..RenderFacts::default()
    })
}

/// The truth, as numbers and as a picture without statistics.
pub(crate) fn truth() -> (ExactImage, RenderedImage) {
    let size = WIDTH * HEIGHT;
    let mut image = Image::new(WIDTH, HEIGHT);
    for name in ["R", "G", "B"] {
        image.push(name, vec![TRUTH as f32; size]);
    }
    let known = ExactImage {
        size: [WIDTH as u32, HEIGHT as u32],
        channels: ["R", "G", "B"]
            .map(|name| (name.to_owned(), vec![TRUTH; size]))
            .into(),
    };
    let frame = Frame::whole(&image);
    let metadata = None;
    (
        known,
        RenderedImage {
            image,
            frame,
            metadata,
        },
    )
}

/// The claims that the rows are about.
pub(crate) fn claims() -> Vec<Claim> {
    let names = [
        "irradiance-sphere",
        "samplers",
        "cornell-box",
        "convergence-sobol",
        "noise-irradiance",
    ];
    let all = Claim::read_all(&folders::claims()).expect("claims can be read");
    let find = |name: &str| all.iter().find(|claim| claim.name == name).cloned();
    names.map(|name| find(name).expect("a claim")).into()
}

/// Seven rows: passed with two looks, a mutant that was found, undecided, failed, broken, a
/// convergence, and coverages of which one is off.
pub(crate) fn rows(claims: &[Claim]) -> Vec<Row<'_>> {
    let [sphere, samplers, cornell, sobol, noise] = claims else {
        panic!("five claims");
    };
    let (known, drawn) = truth();
    let against = |picture: RenderedImage| {
        let judged = judged::judge(&picture, Against::ExactImage(&known), RULES, ASKED);
        of_pictures(picture, drawn.clone(), judged.expect("comparable"))
    };
    let own = picture(1, 0.0, 2.0);
    let mut passed = row(task(sphere, 0, None), Ok(against(own)), Outcome::Passed);
    let earlier = Look {
        spp: 64,
        replicates: 16,
        value: 0.001,
        interval: [-0.009, 0.011],
        verdict: Verdict::Undecided,
        ..passed.history[0].clone()
    };
    passed.history.insert(0, earlier);
    passed.decision.looks = 2;
    let fault = sphere.estimators[0].mutants.first().copied();
    let mutant = against(picture(2, 0.2, 1.0));
    let mutant = row(task(sphere, 0, fault), Ok(mutant), Outcome::Passed);
    let [undecided, failed] = [
        (0, 3, 0.0, Outcome::Undecided),
        (1, 4, 0.03, Outcome::Failed),
    ]
    .map(|(place, seed, bias, outcome)| {
        let mut compared = against(picture(seed, bias, 0.5 * seed as f64));
        if let Evidence::Pictures { refusals, .. } = &mut compared.evidence {
            refusals.push("G: skewness 4.1 beyond 2 (bootstrap)".to_owned());
        }
        row(task(samplers, place, None), Ok(compared), outcome)
    });
    let reason = Err("there is no <reference> of this scene".to_owned());
    let broken = row(task(cornell, 0, None), reason, Outcome::Broken);
    let exponent = measure("exponent of sobol points", -2.1, 0.2, [-4.0, -1.3]);
    let mut converged = of_measures(vec![exponent]);
    converged.fall = Some(Fall {
        over: "samples per replicate".to_owned(),
        points: vec![[4.0, 1e-2, 1e-3], [16.0, 6e-4, 1e-4], [64.0, 3e-5, 4e-6]],
        exponent: -2.1,
        factor: 0.19,
    });
    let converged = row(task(sobol, 0, None), Ok(converged), Outcome::Passed);
    let coverages = vec![
        measure("coverage of 68 % intervals", 0.681, 0.01, [0.65, 0.71]),
        measure("coverage of 95 % intervals", 0.91, 0.01, [0.935, 0.965]),
    ];
    let coverages = row(
        task(noise, 0, None),
        Ok(of_measures(coverages)),
        Outcome::Failed,
    );
    vec![
        passed, mutant, undecided, failed, broken, converged, coverages,
    ]
}

/// The row of a claim whose scene could not be rendered.
pub(crate) fn broken(claim: &Claim) -> Row<'_> {
    let reason = Err("it could not be rendered".to_owned());
    row(task(claim, 0, None), reason, Outcome::Broken)
}

fn task(claim: &Claim, place: usize, fault: Option<PlantedFault>) -> Task<'_> {
    let estimator = &claim.estimators[place];
    Task {
        elsewhere: false,
        claim,
        estimator,
        place,
        fault,
    }
}

fn measure(name: &str, value: f64, reach: f64, accepted: [f64; 2]) -> Measure {
    let interval = [value - reach, value + reach];
    Measure {
        name: name.to_owned(),
        value,
        interval,
        accepted,
        p: if accepted[0] < value && value < accepted[1] {
            1.0
        } else {
            1e-7
        },
        verdict: etalon_render::decide::measure::verdict(interval, accepted),
    }
}

fn of_measures(measures: Vec<Measure>) -> Compared {
    let (verdict, p) = Measure::together(&measures);
    Compared {
        evidence: Evidence::Measures(measures),
        verdict,
        p,
        spp: 512,
        replicates: 8,
        scene_hash: "0123456789abcdef".to_owned(),
        fall: None,
        shown: None,
        bias_bound: None,
    }
}

fn of_pictures(picture: RenderedImage, oracle: RenderedImage, judged: Judged) -> Compared {
    let reach = |row: &ImageRow| row.interval[0].abs().max(row.interval[1].abs());
    Compared {
        bias_bound: judged.judgement.widest().map(reach),
        verdict: judged.judgement.verdict,
        p: judged.p,
        evidence: Evidence::Pictures {
            picture: Box::new(picture),
            oracle: Box::new(oracle),
            judgement: judged.judgement,
            refusals: judged.refusals,
        },
        spp: 128,
        replicates: 32,
        scene_hash: "0123456789abcdef".to_owned(),
        fall: None,
        shown: None,
    }
}

fn row(task: Task<'_>, compared: Result<Compared, String>, outcome: Outcome) -> Row<'_> {
    let seconds = 1.0 + task.claim.name.len() as f64 / 7.0 + f64::from(task.place as u32);
    let seen = compared.as_ref().ok();
    Row {
        task,
        decision: Decision {
            verdict: seen.map(|compared| compared.verdict),
            in_doubt: false,
            p_corrected: seen.map(|compared| compared.p),
            looks: 1,
            level: 1e-5,
            seconds,
        },
        outcome,
        history: seen
            .and_then(|compared| Look::of(compared, 1e-5, seconds))
            .into_iter()
            .collect(),
        compared,
    }
}
