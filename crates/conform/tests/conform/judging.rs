//! The decision on simulated programs: sound ones are not accused, and faults that drivers and renderers have are found.

use etalon_conform::judge::{Finding, Verdict, judge};
use etalon_conform::replicate::Replicate;
use etalon_conform::rules::{BRIGHTEST, Rules};
use etalon_conform::truth::Picture;
use etalon_math::float64::pow;
use etalon_statistics::normal::upper_quantile;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

const PIXELS: u32 = 16;
const SAMPLES: u32 = 64;

/// A picture that looks different from every side.
fn truth() -> Picture {
    Picture::of(PIXELS, |x, y| 1.0 + 0.4 * x + 0.3 * y * y + 0.2 * x * y)
}

/// Pictures of a sound program, whose pixels have this relative noise.
fn sound(count: u32, noise: f64, seed: u64) -> Vec<Replicate> {
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let truth = truth();
    let mut pixel =
        |known: &f64| known * (1.0 + noise * upper_quantile(1.0 - random.random::<f64>()));
    (0..count)
        .map(|index| Replicate {
            pose: index % 2,
            seed: index + 1,
            luminance: truth.means.iter().map(&mut pixel).collect(),
        })
        .collect()
}

fn rules(questions: usize, looks: u32) -> Rules {
    Rules::new(questions, looks, SAMPLES, BRIGHTEST * truth().brightest())
}

fn judged(replicates: &[Replicate]) -> Finding {
    judge(&truth(), replicates, &rules(40, 2))
}

fn changed(change: impl Fn(usize, usize, &dyn Fn(usize, usize) -> f64) -> f64) -> Vec<Replicate> {
    let side = PIXELS as usize;
    let of = |replicate: Replicate| {
        let at = |x: usize, y: usize| replicate.luminance[(y % side) * side + x % side];
        let pixels = (0..side * side).map(|i| change(i % side, i / side, &at));
        Replicate {
            luminance: pixels.collect(),
            ..replicate
        }
    };
    sound(32, 0.02, 5).into_iter().map(of).collect()
}

#[test]
fn a_sound_program_agrees() {
    let finding = judged(&sound(32, 0.02, 1));
    assert_eq!(finding.verdict, Verdict::Agrees, "{finding:?}");
    assert_eq!(finding.suspicion, None);
    // With too much noise nothing is shown, either way.
    let finding = judged(&sound(32, 2.0, 2));
    assert!(
        matches!(finding.verdict, Verdict::Undecided(_)),
        "{finding:?}"
    );
    assert!(matches!(judged(&[]).verdict, Verdict::Undecided(_)));
}

/// Each fault with what is suspected, as far as anything is.
#[test]
fn planted_faults_are_found() {
    type Change = fn(usize, usize, &dyn Fn(usize, usize) -> f64) -> f64;
    let faults: [(Change, Option<&str>); 15] = [
        (|x, y, at| 1.01 * at(x, y), None),
        (|x, y, at| 0.985 * at(x, y), None),
        (|x, y, at| std::f64::consts::PI * at(x, y), Some("π")),
        (|x, y, at| 2.0 * at(x, y), Some("2:")),
        (|x, y, at| 683.0 * at(x, y), Some("683")),
        (|_, _, _| 0.0, Some("nothing at all")),
        (|x, y, at| at(15 - x, y), Some("mirrored")),
        (|x, y, at| at(x, 15 - y), Some("upside down")),
        (|x, y, at| at(y, x), Some("rows for columns")),
        (|x, y, at| at(x + 15, y), Some("too far right")),
        // A tile that is black in all pictures, and one that is half as dark, for which the others make up.
        (|x, y, at| if x < 4 && y < 4 { 0.0 } else { at(x, y) }, None),
        (
            |x, y, at| match (x < 4 && y < 4, x >= 12 && y >= 12) {
                (true, _) => 0.5 * at(x, y),
                (_, true) => at(x, y) + 0.5 * at(x - 12, y - 12),
                _ => at(x, y),
            },
            None,
        ),
        // Eight bits, sRGB's curve, roughly, and a vignette.
        (
            |x, y, at| (255.0 * at(x, y)).round().min(255.0) / 255.0,
            None,
        ),
        (|x, y, at| pow(at(x, y), 1.0 / 2.2), None),
        (
            |x, y, at| {
                let square = (x as f64 - 7.5).powi(2) + (y as f64 - 7.5).powi(2);
                at(x, y) / (1.0 + 0.132 * square / 64.0).powi(2)
            },
            None,
        ),
    ];
    for (index, (fault, suspected)) in faults.iter().enumerate() {
        let finding = judged(&changed(fault));
        assert_eq!(
            finding.verdict,
            Verdict::Differs,
            "fault {index}: {finding:?}"
        );
        let suspicion = finding.suspicion.clone();
        match suspected {
            None => assert_eq!(suspicion, None, "fault {index}"),
            Some(word) => {
                let suspicion = suspicion.unwrap_or_default();
                assert!(suspicion.contains(word), "fault {index}: {suspicion}");
            }
        }
    }
}

/// 1.5 % too dark: of a sample in each pixel a few bright ones could make up for it, of many they could not.
#[test]
fn darkness_needs_samples() {
    let dark = changed(|x, y, at| 0.985 * at(x, y));
    let with = |samples| {
        let rules = Rules {
            samples,
            ..rules(40, 2)
        };
        judge(&truth(), &dark, &rules).verdict
    };
    let few = with(1);
    assert!(
        matches!(&few, Verdict::Undecided(why) if why.contains("make up for it")),
        "{few:?}"
    );
    assert_eq!(with(64), Verdict::Differs);
}

/// A few pictures may be near each other by chance, and off; many may not, even if no test of their mean reaches the level.
#[test]
fn a_few_pictures_that_are_alike_show_little() {
    let pictures = |count: u32| -> Vec<Replicate> {
        let mut pictures = sound(count, 1e-3, 12);
        for (index, picture) in pictures.iter_mut().enumerate() {
            // One in fifteen is less bright than the others, which forbids a test by their deviation.
            let factor = if index == 3 { 1.049 } else { 1.05 };
            picture
                .luminance
                .iter_mut()
                .for_each(|pixel| *pixel *= factor);
        }
        pictures
    };
    let few = judged(&pictures(4)).verdict;
    assert!(matches!(few, Verdict::Undecided(_)), "{few:?}");
    assert_eq!(judged(&pictures(32)).verdict, Verdict::Differs);
}

/// Half floats are no fault.
#[test]
fn eleven_bits_are_enough() {
    let half = |x: f64| (x * 1024.0).round() / 1024.0;
    assert_eq!(
        judged(&changed(|x, y, at| half(at(x, y)))).verdict,
        Verdict::Agrees
    );
}

/// An interval that reaches too far says how many pictures would tell: their number is within a factor of two of what is needed.
#[test]
fn undecided_says_what_it_would_take() {
    let Verdict::Undecided(why) = judged(&sound(32, 0.12, 2)).verdict else {
        panic!("decided");
    };
    let number = why
        .split_once("about ")
        .and_then(|(_, rest)| rest.split_once(" pictures"));
    let number: u32 = number
        .and_then(|(number, _)| number.parse().ok())
        .expect(&why);
    assert!(number > 32, "{why}");
    assert_eq!(judged(&sound(2 * number, 0.12, 2)).verdict, Verdict::Agrees);
}

#[test]
fn copies_are_no_replicates() {
    let one = sound(1, 0.02, 3).remove(0);
    let other = sound(1, 0.02, 8).remove(0);
    let copies: Vec<Replicate> = (0..32)
        .map(|index| Replicate {
            pose: index % 2,
            seed: index + 1,
            luminance: [&one, &other][index as usize % 2].luminance.clone(),
        })
        .collect();
    assert!(matches!(judged(&copies).verdict, Verdict::Broken(_)));
    let mut some = sound(32, 0.02, 3);
    some[6].luminance = some[2].luminance.clone();
    assert!(matches!(judged(&some).verdict, Verdict::Broken(_)));
    // A picture without noise is the same for all seeds.
    let exact = |factor: f64| -> Vec<Replicate> {
        let luminance: Vec<f64> = truth().means.iter().map(|mean| factor * mean).collect();
        (copies.iter())
            .map(|copy| Replicate {
                luminance: luminance.clone(),
                ..*copy
            })
            .collect()
    };
    assert_eq!(judged(&exact(1.0)).verdict, Verdict::Agrees);
    assert_eq!(judged(&exact(0.9)).verdict, Verdict::Differs);
    // Of pictures that differ by rounding, some are the same by chance.
    let mut rounded = exact(1.0);
    for (index, replicate) in rounded.iter_mut().enumerate() {
        replicate.luminance[0] *= 1.0 + 1e-7 * (index % 5) as f64;
    }
    assert_eq!(judged(&rounded).verdict, Verdict::Agrees);
    // A shape that is wrong without noise is told as that: one tile is dark, and others make up for it.
    let mut spotted = exact(1.0);
    for replicate in &mut spotted {
        replicate.luminance[0] -= 0.8;
        replicate.luminance[255] += 0.8;
    }
    let finding = judged(&spotted);
    assert_eq!(finding.verdict, Verdict::Differs);
    assert!(finding.tile.is_some() && finding.suspicion.is_none());
}

/// Rare bright pixels: a sound program is not accused of being too dark, and one that is too bright by far is.
#[test]
fn heavy_tails_accuse_nobody_of_darkness() {
    let spotted = |level: f64| -> Vec<Replicate> {
        let mut random = Pcg64Mcg::seed_from_u64(11);
        let mut replicates = sound(32, 0.001, 4);
        for replicate in &mut replicates {
            let rare: f64 = random.random();
            for pixel in &mut replicate.luminance {
                *pixel *= level * 0.5;
            }
            // Half of the light comes once in forty pictures.
            if rare < 1.0 / 40.0 {
                let mean: f64 = truth().mean();
                replicate.luminance[100] += level * 20.0 * mean * 256.0;
            }
        }
        replicates
    };
    let finding = judged(&spotted(1.0));
    assert!(
        matches!(finding.verdict, Verdict::Undecided(_)),
        "{finding:?}"
    );
    assert_eq!(judged(&spotted(8.0)).verdict, Verdict::Differs);
}

/// One pose is 1.2 % too bright, the other right: that is said. Seeds of a sound program make no such difference.
#[test]
fn poses_that_differ_are_told() {
    let mut replicates = sound(32, 0.02, 6);
    for replicate in replicates
        .iter_mut()
        .filter(|replicate| replicate.pose == 1)
    {
        replicate
            .luminance
            .iter_mut()
            .for_each(|pixel| *pixel *= 1.012);
    }
    let suspicion = judged(&replicates).suspicion.unwrap_or_default();
    assert!(suspicion.contains("its poses differ"), "{suspicion}");
    assert_eq!(judged(&sound(32, 2.0, 2)).suspicion, None);
}

/// A program that finds lights by chance alone may have missed a bright one, but not an even wall.
#[test]
fn who_finds_lights_by_chance_may_have_missed_them() {
    let verdict = |factor: f64, brightest: f64| {
        let rules = Rules {
            brightest,
            ..rules(40, 2)
        };
        let pictures = changed(|x, y, at| factor * at(x, y));
        judge(&truth(), &pictures, &rules).verdict
    };
    for (factor, brightest, differs) in [
        (0.0, 1e7, false),
        (0.5, 1e7, false),
        (1.5, 1e7, true),
        (0.0, 20.0, true),
        (0.5, 20.0, true),
    ] {
        let verdict = verdict(factor, brightest);
        assert_eq!(
            verdict == Verdict::Differs,
            differs,
            "{factor}: {verdict:?}"
        );
        assert!(verdict != Verdict::Agrees, "{factor}");
    }
}

/// 500 sound programs at an alarm of 0.01 for one question: 5 are expected to be accused at most; more than 19 would be seen with
/// a probability below 10⁻⁶. Mutant rejected: an alarm shared by fewer statistics than there are.
#[test]
fn the_rate_of_false_alarms_is_kept() {
    let rules = Rules {
        alarm: 0.01,
        miss: 0.01,
        ..rules(1, 1)
    };
    // Bounds of nothing, so that any shown difference counts.
    let rules = Rules {
        bound: 0.0,
        tile_bound: 1e-12,
        ..rules
    };
    let accused = (0..500)
        .filter(|seed| {
            let replicates = sound(32, 0.05, 1000 + seed);
            judge(&truth(), &replicates, &rules).verdict == Verdict::Differs
        })
        .count();
    assert!((1..=19).contains(&accused), "{accused}");
}

/// A reference that may be off itself narrows what agrees and widens what may differ. Mutant rejected: its error is left out.
#[test]
fn a_truth_that_is_uncertain_decides_less() {
    let exact = truth();
    let uncertain = Picture {
        error: 5e-4,
        ..truth()
    };
    let verdicts = |factor: f64| {
        let mut pictures = sound(32, 0.002, 3);
        let values = pictures.iter_mut().flat_map(|p| &mut p.luminance);
        values.for_each(|value| *value *= factor);
        [&exact, &uncertain].map(|truth| judge(truth, &pictures, &rules(40, 2)).verdict)
    };
    let [known, unknown] = verdicts(1.004);
    assert!(
        known == Verdict::Agrees && matches!(unknown, Verdict::Undecided(_)),
        "{unknown:?}"
    );
    let [known, unknown] = verdicts(1.0065);
    assert!(
        known == Verdict::Differs && matches!(unknown, Verdict::Undecided(_)),
        "{unknown:?}"
    );
    assert_eq!(verdicts(1.02), [Verdict::Differs, Verdict::Differs]);
}
