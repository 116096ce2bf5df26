//! What `etalon estimators` makes of synthetic pictures, whose bias and variance are known.
//!
//! The truth is 1 in every pixel; pictures have independent noise of standard deviation σ and a bias
//! b; the reference is the mean of noisy replicates. So relMSE is (b² + σ²)/1.01, variance σ²/1.01 and
//! squared bias b²/1.01.

use etalon_film::{ExactFilm, FilmSettings, Filter, RenderFacts};
use etalon_images::Image;
use etalon_math::float64;
use etalon_render::estimators::cell::{Cell, Rendered};
use etalon_render::estimators::schedule::{Share, Size};
use etalon_render::estimators::{Failure, Findings, Options, Reference, Schedule, Trial, table};
use etalon_render::pipeline::LoadOptions;
use etalon_statistics::{Estimate, Summary};

const SIDE: u32 = 32;
const VALUES: usize = (SIDE * SIDE * 3) as usize;

/// Uniform numbers (Steele, Lea, Flood 2014, "Fast splittable pseudorandom number generators").
struct Noise(u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 * f64::EPSILON / 2.0 + f64::EPSILON / 4.0
    }

    /// Mean `mean`, standard deviation `deviation`, skewed to the right, as renders are.
    fn around(&mut self, mean: f64, deviation: f64) -> f32 {
        (mean - deviation * (1.0 + float64::ln(self.uniform()))) as f32
    }
}

/// A reference of 16 replicates with this noise each, by way of a file.
fn reference(noise: &mut Noise, deviation: f64) -> Reference {
    let settings = FilmSettings::new(SIDE, SIDE, Filter::default());
    let mut film = ExactFilm::new(settings, &[]).expect("a small film");
    for _ in 0..16 {
        let mut image = Image::new(SIDE as usize, SIDE as usize);
        for name in ["R", "G", "B"] {
            let plane = (0..VALUES / 3).map(|_| noise.around(1.0, deviation));
            image.push(name, plane.collect());
        }
        film.add_replicate(&image, 1).expect("it fits");
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("reference.exr");
    let developed = film.develop(RenderFacts::default());
    developed.write_exr(&path).expect("written");
    Reference::read(&path, [SIDE as usize; 2]).expect("what was written")
}

/// Pictures measured against a reference.
fn measured(noise: &mut Noise, reference: &Reference, bias: f64, deviation: f64) -> Cell {
    let mut cell = Cell::new(Size {
        samples: 1,
        replicates: 40,
    });
    for _ in 0..40 {
        let rendered = Rendered {
            pixels: (0..VALUES)
                .map(|_| noise.around(1.0 + bias, deviation))
                .collect(),
            seconds: 1.0,
            faults: 0,
        };
        cell.add(rendered, reference, true).expect("finite");
    }
    cell
}

/// The mean of numbers.
fn mean(values: impl IntoIterator<Item = f64>) -> f64 {
    let values: Vec<f64> = values.into_iter().collect();
    values.iter().sum::<f64>() / values.len() as f64
}

/// relMSE, MSE, relative variance and squared relative bias found with each of twelve references (whose
/// noise all pictures share, so that each makes one number), less the truth.
fn excesses(bias: f64, deviation: f64, of_reference: f64) -> [Estimate; 4] {
    let mut noise = Noise(1 << 40);
    let (b, v) = (bias * bias, deviation * deviation);
    let truth = [(b + v) / 1.01, b + v, v / 1.01, b / 1.01];
    let mut found = [const { Vec::new() }; 4];
    for _ in 0..12 {
        let reference = reference(&mut noise, of_reference);
        let cell = measured(&mut noise, &reference, bias, deviation);
        let numbers = [
            mean(cell.of(|p| p.error)),
            mean(cell.of(|p| p.squared)),
            mean(cell.pairs.iter().map(|pair| pair.variance)),
            mean(cell.pairs.iter().map(|pair| pair.bias_squared)),
        ];
        for (found, (number, truth)) in found.iter_mut().zip(numbers.into_iter().zip(truth)) {
            found.push(number - truth);
        }
    }
    found.map(|found| Estimate::mean(&Summary::of(&found).expect("twelve")))
}

/// α = 10⁻⁴ for each number. Mutants rejected: ½ forgotten in the variance, a picture paired with
/// itself (either moves a number by 0.09, the standard errors are below 10⁻³).
#[test]
fn bias_and_variance_are_told_apart() {
    // The reference's variance is 10⁻⁴/16: what it makes of the bias, 4bs², is 2.5·10⁻⁶.
    for excess in excesses(0.1, 0.3, 0.01) {
        assert!(excess.p_differs(5e-6) > 1e-4, "{excess:?}");
        assert!(excess.interval(0.9999).bound() < 2e-3, "{excess:?}");
    }
}

/// α = 10⁻⁴ for each number. Mutants rejected: the reference's noise, 2.5·10⁻³, not subtracted or
/// subtracted twice, its standard errors not squared.
#[test]
fn the_reference_s_noise_is_taken_off() {
    let [error, squared, variance, bias] = excesses(0.0, 0.3, 0.2);
    for excess in [squared, bias] {
        // The weights' noise: terms of order s⁴ = 6·10⁻⁶.
        assert!(excess.p_differs(5e-5) > 1e-4, "{excess:?}");
        assert!(excess.interval(0.9999).bound() < 1.25e-3, "{excess:?}");
    }
    // Weights are too great by 3s² on average, 0.75 % of the variance of 0.09.
    for excess in [error, variance] {
        assert!(excess.p_differs(0.0075 * 0.09) > 1e-4, "{excess:?}");
    }
}

#[test]
fn a_reference_without_colour_or_of_another_size_is_refused() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("grey.exr");
    let settings = FilmSettings {
        pixel_format: etalon_film::PixelFormat::Luminance,
        ..FilmSettings::new(8, 8, Filter::default())
    };
    let mut film = ExactFilm::new(settings, &[]).expect("a small film");
    let image = Image::new(8, 8).with("Y", vec![1.0; 64]);
    film.add_replicate(&image, 1).expect("it fits");
    let developed = film.develop(RenderFacts::default());
    developed.write_exr(&path).expect("written");
    let refusal = Reference::read(&path, [8, 8]).expect_err("no colour");
    assert!(refusal.contains("no channels R, G and B"), "{refusal}");
    let refusal = Reference::read(&path, [9, 8]).expect_err("another size");
    assert!(refusal.contains("8 × 8 pixels"), "{refusal}");
}

/// The Cornell box by `path` and `direct`, with a schedule that no machine has a say in.
fn scheduled(seed: u64) -> Findings {
    let scenes = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let define = |key: &str| (key.to_owned(), "16".to_owned());
    let options = Options {
        load: LoadOptions {
            defines: vec![define("resx"), define("resy")],
            ..LoadOptions::default()
        },
        integrators: vec!["path".to_owned(), "direct".to_owned()],
        seconds: 20.0,
        seed,
        ..Options::default()
    };
    let size = |samples, replicates| Size {
        samples,
        replicates,
    };
    let share = Share {
        equal_time: size(16, 24),
        ladder: [1, 4, 16].map(|samples| size(samples, 8)).to_vec(),
    };
    let schedule = Schedule {
        reference: Some(size(64, 16)),
        shares: vec![share.clone(), share],
        equal_samples: 2,
    };
    let trial = Trial::prepare(&scenes.join("cornell-box/scene.xml"), &options);
    let trial = trial.expect("the scene is there");
    let trial = trial.with_schedule(schedule).expect("it fits");
    assert_eq!(
        trial.samples(),
        16 * 16 * (64 * 16 + 2 * (16 * 24 + 21 * 8))
    );
    trial.run(&()).expect("memory for it")
}

#[test]
fn a_biased_estimator_is_found_out_by_intervals() {
    let found = scheduled(1);
    let [path, direct] = found.estimators.as_slice() else {
        panic!("two estimators");
    };
    assert!(!path.reaches_one_percent || path.seconds_to_one_percent.value.is_some());
    assert!(!direct.reaches_one_percent, "{:?}", direct.equal_time);
    assert!(path.reaches_one_percent, "{:?}", path.equal_time);
    let red = direct.differences[0].interval.expect("light tails");
    assert!(red[1] < -0.2, "{red:?}");
    let exponent = path.convergence.exponent.interval.expect("three sizes");
    assert!(exponent[0] < -1.0 && -1.0 < exponent[1], "{exponent:?}");
    let gains = direct.gains.as_ref().expect("of the second");
    let ratio = gains.error_at_equal_samples;
    assert!(ratio.interval.expect("stable")[1] < 0.5, "{ratio:?}");
    for words in ["do not estimate the same picture", "of `direct` is bias"] {
        let said = found.remarks.iter().filter(|remark| remark.contains(words));
        assert_eq!(said.count(), 1, "{words}: {:?}", found.remarks);
    }
    let text = table::text(&found);
    assert!(text.contains("never"), "{text}");
}

#[test]
fn the_seed_decides_every_picture() {
    let numbers = |found: &Findings| -> Vec<f64> {
        let rows = found.estimators.iter();
        let noise = found.reference.rel_mse;
        rows.flat_map(|row| [row.equal_time.rel_mse.value, Some(row.means[0]), noise])
            .flatten()
            .collect()
    };
    let first = numbers(&scheduled(1));
    assert_eq!(first.len(), 6);
    assert_eq!(first, numbers(&scheduled(1)));
    let second = numbers(&scheduled(2));
    assert!(first.iter().zip(second).all(|(a, b)| *a != b));
}

#[test]
fn a_schedule_of_another_comparison_is_refused() {
    let scenes = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let options = Options {
        integrators: vec!["path".to_owned(), "direct".to_owned()],
        load: LoadOptions {
            defines: vec![("resx".to_owned(), "8".to_owned())],
            ..LoadOptions::default()
        },
        seconds: 20.0,
        ..Options::default()
    };
    let trial = || {
        let path = scenes.join("cornell-box/scene.xml");
        Trial::prepare(&path, &options).expect("the scene is there")
    };
    let good = trial().schedule().clone();
    let changes: [fn(&mut Schedule); 4] = [
        |schedule| schedule.reference = None,
        |schedule| schedule.shares.truncate(1),
        |schedule| schedule.equal_samples = 99,
        |schedule| schedule.shares[0].equal_time.replicates = 1,
    ];
    for change in changes {
        let mut schedule = good.clone();
        change(&mut schedule);
        let refused = trial().with_schedule(schedule);
        assert!(matches!(refused, Err(Failure::Impossible(_))));
    }
    assert!(trial().with_schedule(good).is_ok());
}
