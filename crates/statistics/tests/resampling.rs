//! Resampling tests and intervals against enumerations and other programs, and their error rates.

// Reference values keep the digits they were computed to.
#![allow(clippy::excessive_precision)]

use etalon_statistics::bootstrap::{self, Plan};
use etalon_statistics::ratio::{self, Known};
use etalon_statistics::robust::{Method, Symmetry, judge};
use etalon_statistics::sign_flip::{self, Side};
use etalon_statistics::tails::{self, Limits, Refusal, Tails};
use etalon_statistics::{
    Estimate, Interval, Summary, Verdict, normal, permutation, proportion, student_t,
};
use proptest::prelude::*;

#[track_caller]
fn near(actual: f64, expected: f64, relative: f64) {
    assert!(
        (actual / expected - 1.0).abs() <= relative,
        "{actual:e} is not {expected:e}"
    );
}

struct Random(u64);

impl Random {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (((z ^ (z >> 31)) >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        normal::upper_quantile(self.uniform())
    }

    fn exponential(&mut self) -> f64 {
        -libm::log(self.uniform())
    }
}

#[test]
fn shapes() {
    // SciPy 1.17: `skew(bias=False)`, `kurtosis(bias=False)`.
    let sample = [2.1, 2.4, 1.9, 2.2, 2.05, 9.7, 2.3, 2.15, 1.8, 2.6];
    let shape = Tails::of(&sample).expect("finite");
    near(shape.skewness(), 3.106_929_352_689_833, 1e-13);
    near(shape.excess_kurtosis(), 9.742_374_072_891_355, 1e-12);
    near(shape.energy_share(), 9.7 / 29.2, 1e-14);
    assert_eq!(shape.hill(), None);
    assert!(matches!(
        shape.refusal(0.01, &Limits::DECLARED),
        Some(Refusal::Skewness { .. })
    ));
    // Distortion at α = 0.025, by hand: G₁ (2 z² + 1) φ(z) / (6 √10 α), z = 1.959 964.
    near(
        shape.distortion(0.025),
        3.106_929_352_689_833 * 8.682_917_641_388_251_916_7 * 0.058_445_069_805_035_361
            / (6.0 * 10.0_f64.sqrt())
            / 0.025,
        1e-8,
    );

    let same = Tails::of(&[0.5; 9]).expect("finite");
    assert_eq!((same.skewness(), same.excess_kurtosis()), (0.0, 0.0));
    assert_eq!(same.refusal(1e-6, &Limits::DECLARED), None);
    // The scale does not matter, even at the ends of the doubles.
    let huge = sample.map(|x| x * 1e300);
    near(
        Tails::of(&huge).expect("finite").skewness(),
        shape.skewness(),
        1e-12,
    );
    assert_eq!(Tails::of(&[1.0, 2.0]), None);
    assert_eq!(Tails::of(&[1.0, 2.0, f64::NAN]), None);

    // ln(8/2) + ln(4/2) = 3 ln 2.
    near(
        tails::hill_index(&[8.0, 1.0, 4.0, 2.0], 2).expect("a tail"),
        0.961_796_693_925_975_6,
        1e-14,
    );
    assert_eq!(tails::hill_index(&[1.0, 2.0], 2), None);
    assert_eq!(tails::hill_index(&[1.0, 0.0], 1), None);
    assert_eq!(tails::energy_share(&[1.0, -3.0, 2.0], 2), Some(5.0 / 6.0));
    assert_eq!(tails::energy_share(&[0.0; 3], 1), Some(0.0));
    assert_eq!(tails::energy_share(&[], 1), None);
}

#[test]
fn limits_of_normal_samples() {
    // Grubbs' table: G = 2.126 for n = 8 and two-sided 5 %, 2.956 for n = 20 and 1 % (two-sided
    // 3.001); share = G²/(n − 1).
    let grubbs =
        |n: usize, level: f64| (tails::normal_variance_share(n, level) * (n as f64 - 1.0)).sqrt();
    assert!((grubbs(8, 0.05) - 2.126).abs() < 1e-3);
    assert!((grubbs(20, 0.01) - 3.001).abs() < 1e-3);
    // SciPy's t quantiles.
    near(
        tails::normal_variance_share(16, 1e-3),
        0.650_008_148_180_857_8,
        1e-10,
    );
    // 99.9 % points of |G₁| of 400,000 (n = 256: 100,000) normal samples by NumPy, seed 3.
    for (n, simulated, error) in [
        (8, 2.421, 0.07),
        (16, 2.120, 0.03),
        (32, 1.569, 0.03),
        (64, 1.107, 0.03),
        (256, 0.527, 0.03),
    ] {
        near(tails::normal_skewness(n, 1e-3), simulated, error);
    }
}

/// Normal samples are refused as rarely as declared: with 8, 16 and 64 replicates, at α = 10⁻³, in
/// at most 2.1 · 10⁻³ of 5,000 runs (exact 99.9 % intervals); samples
/// whose t-test would mislead (exponential, and Pareto of index 1.5, where it has no variance) in
/// most.
#[test]
fn refusals_are_rare_for_normal_samples() {
    let mut random = Random(9);
    let mut refused = |n: usize, runs: u32, draw: fn(&mut Random) -> f64| {
        (0..runs)
            .filter(|_| {
                let sample: Vec<f64> = (0..n).map(|_| draw(&mut random)).collect();
                let shape = Tails::of(&sample).expect("finite");
                shape.refusal(1e-3, &Limits::DECLARED).is_some()
            })
            .count() as u64
    };
    for n in [8, 16, 64] {
        let share = proportion::interval(refused(n, 5000, |r| 10.0 + r.normal()), 5000, 0.999);
        assert!(share.expect("trials").low <= 2.1e-3, "{n} {share:?}");
    }
    assert!(refused(64, 200, Random::exponential) > 150);
    let pareto = |r: &mut Random| libm::pow(r.uniform(), -1.0 / 1.5);
    assert!(refused(64, 200, pareto) > 190);
}

#[test]
fn sign_flips() {
    // 12 of 256 by enumeration (Python's itertools), and SciPy's `permutation_test`.
    let sample = [-0.3, 0.5, 0.9, 1.4, -0.2, 0.7, 1.1, 0.4];
    let both = sign_flip::test(&sample, Side::Both, 1, 0).expect("finite");
    assert!(both.exact);
    near(both.p_value, 12.0 / 256.0, 1e-14);
    near(both.least, 2.0 / 256.0, 1e-14);
    let greater = sign_flip::test(&sample, Side::Greater, 1, 0).expect("finite");
    near(greater.p_value, 6.0 / 256.0, 1e-14);
    let less = sign_flip::test(&sample, Side::Less, 1, 0).expect("finite");
    assert!(less.p_value > 0.97);
    // Twenty-one numbers are too many to enumerate; 2⁻²⁰ of the choices are as extreme.
    let long = [1.0; 21];
    let drawn = sign_flip::test(&long, Side::Both, 999, 7).expect("finite");
    assert!(!drawn.exact);
    near(drawn.p_value, 1e-3, 1e-12);
    assert_eq!(
        drawn,
        sign_flip::test(&long, Side::Both, 999, 7).expect("finite")
    );
    let exact = sign_flip::test(&long[..20], Side::Both, 1, 7).expect("finite");
    near(exact.p_value, 2.0 / 1_048_576.0, 1e-14);
    assert_eq!(
        sign_flip::test(&[0.0; 4], Side::Both, 1, 0)
            .expect("finite")
            .p_value,
        1.0
    );
    assert_eq!(sign_flip::test(&[], Side::Both, 9, 0), None);
    assert_eq!(sign_flip::test(&[f64::NAN], Side::Both, 9, 0), None);
}

#[test]
fn permutations() {
    // 150 of 462 by enumeration of |t| (Python's itertools over SciPy's `ttest_ind`).
    let a = [27.5, 21.0, 19.0, 23.6, 17.0];
    let b = [27.1, 22.0, 20.8, 23.4, 23.5, 25.8];
    let exact = permutation::test(&a, &b, 1, 0).expect("finite");
    assert!(exact.exact);
    near(exact.p_value, 150.0 / 462.0, 1e-14);
    near(exact.least, 1.0 / 462.0, 1e-14);
    // Twelve and twelve are drawn: 2.7 million divisions. Quite different: as small as can be.
    let low: Vec<f64> = (0..12).map(f64::from).collect();
    let high: Vec<f64> = low.iter().map(|x| x + 100.0).collect();
    let drawn = permutation::test(&low, &high, 499, 3).expect("finite");
    assert!(!drawn.exact);
    near(drawn.p_value, 1.0 / 500.0, 1e-12);
    let same = permutation::test(&[1.0; 4], &[1.0; 4], 9, 3).expect("finite");
    assert_eq!(same.p_value, 1.0);
    assert_eq!(permutation::test(&[1.0], &b, 9, 3), None);
    assert_eq!(permutation::test(&[1.0, f64::NAN], &b, 9, 3), None);
}

/// Efron & Tibshirani's (1993) law school data: entrance test and grades, correlation 0.776.
const LAW: [(f64, f64); 15] = [
    (576.0, 3.39),
    (635.0, 3.30),
    (558.0, 2.81),
    (578.0, 3.03),
    (666.0, 3.44),
    (580.0, 3.07),
    (555.0, 3.00),
    (661.0, 3.43),
    (651.0, 3.36),
    (605.0, 3.13),
    (653.0, 3.12),
    (575.0, 2.74),
    (545.0, 2.76),
    (572.0, 2.88),
    (594.0, 2.96),
];

fn correlation(indices: &[usize]) -> f64 {
    let n = indices.len() as f64;
    let mean = |part: fn((f64, f64)) -> f64| indices.iter().map(|&i| part(LAW[i])).sum::<f64>() / n;
    let (mx, my) = (mean(|p| p.0), mean(|p| p.1));
    let sum = |term: &dyn Fn(f64, f64) -> f64| {
        indices
            .iter()
            .map(|&i| term(LAW[i].0 - mx, LAW[i].1 - my))
            .sum::<f64>()
    };
    sum(&|x, y| x * y) / (sum(&|x, _| x * x) * sum(&|_, y| y * y)).sqrt()
}

/// SciPy 1.17's `bootstrap`, 400,000 resamples: BCa (0.4266, 0.9267; Efron & Tibshirani print 0.43, 0.92) and percentiles (0.5221, 0.9475) at 90 %;
/// here 20,000, whose ends have standard errors of 0.003 and 0.0006.
#[test]
fn intervals_of_a_correlation() {
    let plan = Plan::independent(20_000, 1);
    let corrected = bootstrap::bca(15, &plan, 0.9, correlation).expect("resolved");
    assert!((corrected.low - 0.4266).abs() < 0.012, "{corrected:?}");
    assert!((corrected.high - 0.9267).abs() < 0.003, "{corrected:?}");
    let plain = bootstrap::percentile(15, &plan, 0.9, correlation).expect("resolved");
    assert!((plain.low - 0.5221).abs() < 0.012, "{plain:?}");
    assert!((plain.high - 0.9475).abs() < 0.003, "{plain:?}");

    // Too few resamples for the confidence, too few blocks, a constant, a NaN.
    assert_eq!(bootstrap::bca(15, &plan, 0.9999, correlation), None);
    assert_eq!(bootstrap::bca(7, &plan, 0.9, |_| 0.0), None);
    assert_eq!(
        bootstrap::bca(15, &plan, 0.9, |_| 0.5),
        Some(Interval {
            low: 0.5,
            high: 0.5
        })
    );
    assert_eq!(bootstrap::bca(15, &plan, 0.9, |_| f64::NAN), None);
}

/// NumPy, a million resamples: (0.65258, 1.54672) at 95 % for 24 exponential quantiles.
#[test]
fn studentised_interval() {
    let sample: Vec<f64> = (0..24)
        .map(|i| -libm::log((f64::from(i) + 0.5) / 24.0))
        .collect();
    let plan = Plan::independent(40_000, 2);
    let interval = bootstrap::studentised(&sample, &plan, 0.95).expect("resolved");
    assert!((interval.low - 0.65258).abs() < 0.01, "{interval:?}");
    assert!((interval.high - 1.54672).abs() < 0.03, "{interval:?}");
    assert_eq!(bootstrap::studentised(&sample[..19], &plan, 0.95), None);
    assert_eq!(
        bootstrap::studentised(&[1.0; 30], &plan, 0.95).map(|i| i.width()),
        Some(0.0)
    );
}

/// Means of exponential samples of 30 at 95 %, 600 runs: the studentised bootstrap covers at its
/// rate (exact 99.9 % interval) and misses on both sides; mutant: Student's interval misses above
/// at least four times as often as below.
#[test]
fn skewed_means_are_covered() {
    let mut random = Random(4);
    let (mut covered, mut student) = (0, [0, 0]);
    for run in 0..600 {
        let sample: Vec<f64> = (0..30).map(|_| random.exponential()).collect();
        let plan = Plan::independent(999, run);
        let interval = bootstrap::studentised(&sample, &plan, 0.95).expect("resolved");
        covered += u64::from(interval.contains(1.0));
        let plain = Estimate::mean(&Summary::of(&sample).expect("finite")).interval(0.95);
        student[0] += u32::from(plain.low > 1.0);
        student[1] += u32::from(plain.high < 1.0);
    }
    let share = proportion::interval(covered, 600, 0.999).expect("trials");
    assert!(share.contains(0.95), "{share:?}");
    assert!(student[1] > 4 * student[0], "{student:?}");
}

/// Circular blocks of three of twelve numbers: the variance of the resampled mean is that of the
/// twelve block means over four, 1.046_296_296_296_296 (NumPy); single numbers would give 0.472_222_222_222_222.
#[test]
fn blocks_keep_dependence() {
    let series = [1.0, 2.0, 4.0, 3.0, 5.0, 7.0, 6.0, 8.0, 9.0, 7.0, 5.0, 3.0];
    let variance = |block| {
        let plan = Plan {
            resamples: 40_000,
            block,
            seed: 8,
        };
        let means = bootstrap::resampled(12, &plan, |indices| {
            indices.iter().map(|&i| series[i]).sum::<f64>() / 12.0
        });
        Summary::of(&means.expect("a plan"))
            .expect("finite")
            .variance()
    };
    near(variance(3), 1.046_296_296_296_296, 0.04);
    near(variance(1), 0.472_222_222_222_222, 0.04);
    assert_eq!(bootstrap::block_length(1), 1);
    assert_eq!(bootstrap::block_length(27), 3);
    assert_eq!(bootstrap::block_length(28), 4);
    let broken = Plan {
        resamples: 9,
        block: 13,
        seed: 0,
    };
    assert_eq!(bootstrap::resampled(12, &broken, |_| 0.0), None);
}

#[test]
fn ratios() {
    let mean = |sample: &[f64]| sample.iter().sum::<f64>() / sample.len() as f64;
    let mut random = Random(12);
    let a: Vec<f64> = (0..40).map(|_| 6.0 + random.normal()).collect();
    let b: Vec<f64> = (0..40).map(|_| 2.0 + 0.2 * random.normal()).collect();
    let plan = Plan::independent(4000, 5);
    let ratio = ratio::of(&a, &b, &plan, 0.95, mean).expect("positive");
    let Known::Between(interval) = ratio.known else {
        panic!("a stable denominator");
    };
    // Fieller's interval is nearly the same for such samples.
    let estimate = |s: &[f64]| Estimate::mean(&Summary::of(s).expect("finite"));
    let exact = ratio::fieller(&estimate(&a), &estimate(&b), 0.95).expect("clear of zero");
    assert!(
        (interval.low - exact.low).abs() < 0.03,
        "{interval:?} {exact:?}"
    );
    assert!(
        (interval.high - exact.high).abs() < 0.03,
        "{interval:?} {exact:?}"
    );

    // One firefly makes the denominator: only a bound is left, and it is below the ratio.
    let mut spiky = b.clone();
    spiky[0] = 1000.0;
    let bounded = ratio::of(&a, &spiky, &plan, 0.95, mean).expect("positive");
    assert!(
        matches!(bounded.known, Known::AtLeast(low) if low < bounded.value),
        "{bounded:?}"
    );
    // A numerator with a firefly is no obstacle to an interval.
    assert!(matches!(
        ratio::of(&spiky, &b, &plan, 0.95, mean)
            .expect("positive")
            .known,
        Known::Between(_)
    ));

    let pairs: Vec<(f64, f64)> = b.iter().map(|&x| (3.0 * x, x)).collect();
    let shared = ratio::paired(&pairs, &plan, 0.95, |drawn| {
        let sum = |part: fn(&(f64, f64)) -> f64| drawn.iter().map(part).sum::<f64>();
        (sum(|p| p.0), sum(|p| p.1))
    })
    .expect("positive");
    assert!(
        matches!(shared.known, Known::Between(i) if i.width() < 1e-12 && i.contains(shared.value))
    );

    assert_eq!(ratio::of(&a[..7], &b, &plan, 0.95, mean), None);
    assert_eq!(ratio::of(&a, &[0.0; 9], &plan, 0.95, mean), None);
    assert_eq!(ratio::of(&a, &b, &plan, 0.9999, mean), None);
    let near_zero = Estimate::new(0.1, 0.1, 9.0).expect("finite");
    assert_eq!(ratio::fieller(&estimate(&a), &near_zero, 0.95), None);
}

/// Judged at α = 0.05 in 1,500 runs of 16 differences of exchangeable heavy-tailed numbers
/// (exponentials to the third): false differences stay at or below α (exact 99.9 % interval), by
/// Student's t and sign flips together. Mutant: a shift by 3 is found in nine tenths of 50.
#[test]
fn verdicts_on_heavy_tails() {
    let mut random = Random(21);
    let plan = Plan::independent(1999, 6);
    let mut draw = |shift: f64, n: usize| -> Vec<f64> {
        let mut heavy = || {
            let x = random.exponential();
            x * x * x
        };
        (0..n).map(|_| heavy() - heavy() + shift).collect()
    };
    let judged = |sample: &[f64], margin: f64, alpha: f64| {
        judge(
            sample,
            margin,
            alpha,
            Symmetry::Exchangeable,
            &Limits::DECLARED,
            &plan,
        )
        .expect("finite")
    };
    let (mut alarms, mut flips) = (0, 0);
    for _ in 0..1500 {
        let judgement = judged(&draw(0.0, 16), 0.0, 0.05);
        alarms += u64::from(judgement.verdict == Verdict::Differs);
        flips += u32::from(judgement.method == Method::SignFlip);
    }
    let share = proportion::interval(alarms, 1500, 0.999).expect("trials");
    assert!(share.low <= 0.05 && flips > 300, "{alarms} {flips}");
    let found = (0..50)
        .filter(|_| judged(&draw(30.0, 16), 0.0, 0.05).verdict == Verdict::Differs)
        .count();
    assert!(found >= 45, "{found}");
    // Eight replicates have 256 signs: a level of 10⁻³ is out of reach, and it is said.
    let mut few = [0.0, 0.1, -0.1, 0.05, -0.05, 0.02, 0.01, 50.0];
    let judgement = judged(&few, 1.0, 1e-3);
    assert_eq!(judgement.verdict, Verdict::Undecided);
    assert_eq!(judgement.method, Method::None);
    assert!(judgement.refusal.is_some());
    few[7] = 0.03;
    let judgement = judged(&few, 1.0, 1e-3);
    assert_eq!(
        (judgement.verdict, judgement.method),
        (Verdict::Agrees, Method::Student)
    );
}

/// Skewed samples against a known mean: the bootstrap takes over, and certifies or denies; where
/// the variance may not exist nothing is said.
#[test]
fn verdicts_without_symmetry() {
    let mut random = Random(33);
    let plan = Plan::independent(1999, 6);
    let mut draw = || {
        let x = random.exponential();
        x * x - 2.0
    };
    let sample: Vec<f64> = (0..60).map(|_| draw()).collect();
    let judged = |sample: &[f64], margin: f64| {
        judge(
            sample,
            margin,
            0.02,
            Symmetry::Unknown,
            &Limits::DECLARED,
            &plan,
        )
        .expect("finite")
    };
    let small = judged(&sample, 6.0);
    assert_eq!(
        (small.verdict, small.method),
        (Verdict::Agrees, Method::Bootstrap)
    );
    let shifted: Vec<f64> = sample.iter().map(|x| x + 10.0).collect();
    assert_eq!(judged(&shifted, 0.5).verdict, Verdict::Differs);
    let cauchy: Vec<f64> = (1..120)
        .map(|i| {
            let angle = std::f64::consts::PI * (f64::from(i) / 120.0 - 0.5);
            libm::tan(angle)
        })
        .collect();
    let nothing = judged(&cauchy, 100.0);
    assert_eq!(
        (nothing.verdict, nothing.method),
        (Verdict::Undecided, Method::None)
    );
    assert!(nothing.refusal.is_some());
    assert_eq!(
        judge(
            &[1.0],
            1.0,
            0.1,
            Symmetry::Unknown,
            &Limits::DECLARED,
            &plan
        ),
        None
    );
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 64,
        rng_seed: proptest::test_runner::RngSeed::Fixed(2),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// At the ends of Fieller's interval a − ρb is exactly t standard errors from zero.
    #[test]
    fn fieller_by_its_definition(
        a in -5.0..5.0_f64, b in 1.0..5.0_f64, sa in 0.01..1.0_f64, sb in 0.01..0.2_f64,
    ) {
        let numerator = Estimate::new(a, sa, 20.0).expect("finite");
        let denominator = Estimate::new(b, sb, 12.0).expect("finite");
        let interval = ratio::fieller(&numerator, &denominator, 0.95).expect("clear of zero");
        let t = student_t::upper_quantile(0.025, 12.0);
        for rho in [interval.low, interval.high] {
            let distance = (a - rho * b) / (sa * sa + rho * rho * sb * sb).sqrt();
            prop_assert!((distance.abs() - t).abs() < 1e-8);
        }
        prop_assert!(interval.contains(a / b));
    }

    /// The two one-sided p-values of an exact sign-flip test add up to one plus the ties'.
    #[test]
    fn sides_of_a_sign_flip(sample in prop::collection::vec(-3.0..3.0_f64, 1..10)) {
        let p = |side| sign_flip::test(&sample, side, 1, 0).expect("finite").p_value;
        prop_assert!(p(Side::Greater) + p(Side::Less) >= 1.0);
        let negated: Vec<f64> = sample.iter().map(|x| -x).collect();
        let mirrored = sign_flip::test(&negated, Side::Less, 1, 0).expect("finite").p_value;
        prop_assert_eq!(p(Side::Greater), mirrored);
        let both = p(Side::Both);
        prop_assert!((both - (2.0 * p(Side::Greater).min(p(Side::Less))).min(1.0)).abs() < 1e-12);
    }
}
