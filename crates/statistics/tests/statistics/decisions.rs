//! Estimates, families, counts, lines and shares against published or 40-digit values.

// Reference values keep the digits they were computed to.
#![allow(clippy::excessive_precision)]

use crate::checks::near;
use etalon_statistics::chi_squared::{CountsError, goodness_of_fit};
use etalon_statistics::family::holm;
use etalon_statistics::{Estimate, Family, Interval, Line, Summary, Verdict, proportion};

/// The example of Wikipedia's article on Welch's t-test (t = −2.46, ν = 25.0, p = 0.021), here
/// with 20 digits from mpmath.
const A: [f64; 15] = [
    27.5, 21.0, 19.0, 23.6, 17.0, 17.9, 16.9, 20.1, 21.9, 22.6, 23.1, 19.6, 19.0, 21.7, 21.4,
];
const B: [f64; 15] = [
    27.1, 22.0, 20.8, 23.4, 23.4, 23.5, 25.8, 22.0, 24.8, 20.2, 21.9, 22.1, 22.9, 20.5, 24.4,
];

fn summary(sample: &[f64]) -> Summary {
    Summary::of(sample).expect("at least two finite numbers")
}

#[test]
fn welch() {
    let difference = Estimate::welch(&summary(&A), &summary(&B));
    near(difference.value(), -2.166_666_666_666_666_7, 1e-14);
    near(
        difference.standard_error(),
        0.882_424_510_013_755_155_68,
        1e-14,
    );
    near(
        difference.degrees_of_freedom(),
        24.988_529_290_231_414_357,
        1e-14,
    );
    near(
        difference.p_differs(0.0),
        0.021_378_001_462_867_032_492,
        1e-12,
    );
    near(
        difference.p_differs(1.0),
        0.099_759_380_928_005_059_266,
        1e-12,
    );
    near(
        difference.p_agrees(4.0),
        0.024_087_171_581_722_664_551,
        1e-12,
    );
    near(
        difference.smallest_detectable(0.05, 0.9),
        2.977_067_741_393_136_492_2,
        1e-10,
    );
    let interval = difference.interval(0.95);
    near(interval.low, -3.984_096_267_140_928_103_9, 1e-12);
    near(interval.high, -0.349_237_066_192_405_229_39, 1e-12);
    near(interval.bound(), 3.984_096_267_140_928_103_9, 1e-12);
    near(interval.width(), 2.0 * 1.817_429_600_474_261_4, 1e-12);
    assert!(interval.contains(-1.0) && !interval.contains(0.0));

    assert_eq!(difference.verdict(4.0, 0.95), Verdict::Agrees);
    assert_eq!(difference.verdict(0.1, 0.95), Verdict::Differs);
    assert_eq!(difference.verdict(2.0, 0.95), Verdict::Undecided);
    let relative = difference.scaled(-0.5).expect("finite");
    near(relative.value(), 1.083_333_333_333_333_3, 1e-14);
    near(relative.p_differs(0.5), difference.p_differs(1.0), 1e-12);
}

#[test]
fn paired_and_one_sample() {
    let paired = Estimate::paired(&A, &B).expect("pairs");
    near(paired.standard_error(), 0.806_737_501_809_229_657_8, 1e-13);
    near(paired.p_differs(0.0), 0.017_746_021_669_480_717_972, 1e-12);
    assert_eq!(Estimate::paired(&A, &B[1..]), None);
    assert_eq!(Estimate::paired(&[1.0], &[2.0]), None);
    assert_eq!(Estimate::paired(&[1.0, f64::NAN], &[2.0, 1.0]), None);

    let excess = Estimate::excess(&summary(&[1.0, 2.0, 3.0]), 2.0);
    assert_eq!((excess.value(), excess.degrees_of_freedom()), (0.0, 2.0));
    near(excess.p_differs(0.0), 1.0, 1e-14);
    near(
        Estimate::with_known_error(1.96, 1.0)
            .expect("finite")
            .p_differs(0.0),
        2.0 * 0.024_997_895_148_220_436,
        1e-13,
    );
}

#[test]
fn no_variance_is_certainty_not_a_panic() {
    let constant = summary(&[0.5; 8]);
    let same = Estimate::welch(&constant, &constant);
    assert_eq!((same.p_differs(0.0), same.p_agrees(1e-9)), (1.0, 0.0));
    assert_eq!(same.verdict(0.0, 0.99), Verdict::Agrees);
    let other = Estimate::excess(&constant, 0.25);
    assert_eq!((other.p_differs(0.0), other.p_agrees(0.1)), (0.0, 1.0));
    assert_eq!((other.p_differs(0.3), other.p_agrees(0.3)), (1.0, 0.0));
    assert_eq!(other.verdict(0.1, 0.99), Verdict::Differs);
    // Only one side varies: Welch's degrees of freedom are that side's.
    let mixed = Estimate::welch(&summary(&[1.0, 2.0, 3.0, 4.0]), &constant);
    near(mixed.degrees_of_freedom(), 3.0, 1e-14);

    assert_eq!(Summary::of(&[1.0]), None);
    assert_eq!(Summary::of(&[1.0, f64::INFINITY]), None);
    assert_eq!(Estimate::new(0.0, f64::NAN, 3.0), None);
    assert_eq!(Estimate::new(0.0, 1.0, 0.0), None);
}

#[test]
fn holm_by_hand() {
    // Wikipedia, Holm–Bonferroni method.
    let adjusted = holm(&[0.01, 0.04, 0.03, 0.005]);
    for (actual, expected) in adjusted.iter().zip([0.03, 0.06, 0.06, 0.02]) {
        near(*actual, expected, 1e-14);
    }
    let mut family = Family::new(0.05).expect("a level");
    for (name, p) in [("a", 0.01), ("b", 0.04), ("c", 0.03), ("d", 0.005)] {
        family.push(name, p).expect("a probability");
    }
    assert_eq!(family.len(), 4);
    assert_eq!(family.level_of_each(), 0.0125);
    let rejected: Vec<_> = family.decide().into_iter().map(|d| d.rejected).collect();
    assert_eq!(rejected, [true, false, false, true]);
    assert!(family.push("e", f64::NAN).is_err());
    assert!(family.push("e", -0.1).is_err());
    assert_eq!(family.len(), 4);
    assert!(Family::new(0.0).is_none() && Family::new(f64::NAN).is_none());
    assert!(holm(&[]).is_empty());
}

#[test]
fn declared_hypotheses_count() {
    let mut family = Family::new(0.05).expect("a level");
    let first = family.declare("tested");
    let broken = family.declare("never ran");
    family.record(first, 0.03).expect("a probability");
    let decided = family.decide();
    // 0.03 would be rejected alone; two were declared, so 0.06 is not.
    near(decided[first].adjusted, 0.06, 1e-14);
    assert!(!decided[first].rejected && !decided[broken].rejected);
    assert!(family.record(broken, 1.5).is_err());
    family.record(first, 0.02).expect("a probability");
    assert!(family.decide()[first].rejected);
}

#[test]
fn a_die() {
    // Sixty rolls; mpmath.
    let fit = goodness_of_fit(&[5, 8, 9, 8, 10, 20], &[10.0; 6]).expect("testable");
    near(fit.statistic, 13.4, 1e-14);
    near(fit.p_value, 0.019_905_220_334_774_381_023, 1e-12);
    assert_eq!((fit.cells, fit.degrees_of_freedom), (6, 5.0));
}

#[test]
fn small_cells_are_pooled_by_expectation() {
    // 1 + 2 + 3 make the first pooled cell; 5 and 39 stay.
    let fit = goodness_of_fit(&[0, 7, 1, 4, 38], &[1.0, 3.0, 2.0, 5.0, 39.0]).expect("testable");
    assert_eq!(fit.cells, 3);
    near(fit.statistic, 4.0 / 6.0 + 1.0 / 5.0 + 1.0 / 39.0, 1e-13);
    // 1 alone is too small, so it takes 6 with it.
    let fit = goodness_of_fit(&[2, 5, 43], &[1.0, 6.0, 43.0]).expect("testable");
    assert_eq!((fit.cells, fit.statistic), (2, 0.0));
}

#[test]
fn impossible_and_missing_counts() {
    let impossible = goodness_of_fit(&[1, 99], &[0.0, 100.0]).expect("testable");
    assert_eq!(
        (impossible.p_value, impossible.statistic),
        (0.0, f64::INFINITY)
    );
    // A density that lacks a tenth: the missing cell expects 100 and sees none.
    let lacking = goodness_of_fit(&[500, 500], &[450.0, 450.0]).expect("testable");
    assert_eq!(lacking.cells, 3);
    near(lacking.statistic, 100.0 + 2.0 * 2500.0 / 450.0, 1e-13);
    assert!(lacking.p_value < 1e-20);
    assert!(matches!(
        goodness_of_fit(&[500, 500], &[550.0, 550.0]),
        Err(CountsError::TooMuchExpected { .. })
    ));
    assert_eq!(
        goodness_of_fit(&[3, 3], &[3.0, 3.0]),
        Err(CountsError::TooFewCells)
    );
    assert!(goodness_of_fit(&[3], &[1.0, 2.0]).is_err());
    assert!(goodness_of_fit(&[3, 3], &[f64::NAN, 3.0]).is_err());
}

#[test]
fn anscombe() {
    // The first of Anscombe's (1973) sets: y = 3.0 + 0.5 x, standard error of the slope 0.118.
    let x = [10.0, 8.0, 13.0, 9.0, 11.0, 14.0, 6.0, 4.0, 12.0, 7.0, 5.0];
    let y = [
        8.04, 6.95, 7.58, 8.81, 8.33, 9.96, 7.24, 4.26, 10.84, 4.82, 5.68,
    ];
    let line = Line::fit(&x, &y).expect("a line");
    near(line.slope.value(), 0.500_090_909_090_909_090_91, 1e-13);
    near(
        line.slope.standard_error(),
        0.117_905_500_595_634_089_81,
        1e-13,
    );
    near(line.intercept.value(), 3.000_090_909_090_909_090_9, 1e-13);
    near(
        line.intercept.standard_error(),
        1.124_746_790_808_643_932_1,
        1e-13,
    );
    near(line.scatter, 1.236_603_322_726_321_068_9, 1e-13);
    assert_eq!(line.slope.degrees_of_freedom(), 9.0);

    // A weight of two is the point twice, but for the degrees of freedom.
    let twice = Line::fit_weighted(&x, &y, &[2.0; 11]).expect("a line");
    near(
        twice.slope.standard_error(),
        line.slope.standard_error(),
        1e-13,
    );
    assert_eq!(Line::fit(&[1.0, 1.0, 1.0], &[1.0, 2.0, 3.0]), None);
    assert_eq!(Line::fit(&[1.0, 2.0], &[1.0, 2.0]), None);
    assert_eq!(Line::fit(&[1.0, 2.0, f64::NAN], &[1.0, 2.0, 3.0]), None);
}

#[test]
fn a_power_law() {
    let x = [1.0, 4.0, 16.0, 64.0];
    let y = [3.0, 0.75, 0.1875, 0.046_875];
    let line = Line::fit_power_law(&x, &y).expect("positive numbers");
    near(line.slope.value(), -1.0, 1e-14);
    near(line.intercept.value(), 1.098_612_288_668_109_8, 1e-14);
    assert_eq!(Line::fit_power_law(&[1.0, 2.0, 0.0], &[1.0; 3]), None);
}

#[test]
fn clopper_and_pearson() {
    // SciPy's beta quantiles.
    for (successes, trials, confidence, low, high) in [
        (0, 20, 0.95, 0.0, 0.168_433_470_983_085_3),
        (
            3,
            20,
            0.95,
            0.032_070_937_185_463_715,
            0.378_926_826_545_313_96,
        ),
        (
            10,
            1000,
            0.99,
            0.003_726_782_924_252_682_3,
            0.021_276_058_753_616_5,
        ),
        (20, 20, 0.95, 0.831_566_529_016_914_7, 1.0),
    ] {
        let Interval { low: l, high: h } =
            proportion::interval(successes, trials, confidence).expect("trials");
        assert!(
            (l - low).abs() <= 1e-12 && (h - high).abs() <= 1e-12,
            "{l} {h}"
        );
    }
    assert_eq!(proportion::interval(1, 0, 0.9), None);
    assert_eq!(proportion::interval(2, 1, 0.9), None);
}

#[test]
fn verdicts_combine() {
    use Verdict::{Agrees, Differs, Undecided};
    assert_eq!(Agrees.and(Agrees), Agrees);
    assert_eq!(Agrees.and(Undecided), Undecided);
    assert_eq!(Undecided.and(Differs), Differs);
}
