//! The steps of primary samples: do chains stay where they should?

use super::super::primary::{LogarithmicStep, PrimarySample, SmallStep};
use etalon_sampling::Sampler;
use etalon_statistics::chi_squared::goodness_of_fit;

/// Cells into which [0, 1) is cut.
const CELLS: usize = 20;

/// I, and the number that is looked at, if it was asked for.
type Observation = (f64, Option<f32>);

/// A scalar on primary samples of up to three numbers, and how often its chain should be seen in
/// each cell of the number at hand.
struct Landscape {
    name: &'static str,
    /// What is seen of a sample whose numbers the argument gives.
    at: fn(&mut dyn FnMut() -> f32) -> Observation,
    /// ∫ I over a cell, times anything.
    share: fn(usize) -> f64,
}

/// Middle of a cell.
fn middle(cell: usize) -> f64 {
    (cell as f64 + 0.5) / CELLS as f64
}

/// A saw tooth, steep at the seam of the circle; the same on the second number; and one that asks
/// for a third number on one side only, so that it lags behind and catches up.
const LANDSCAPES: [Landscape; 3] = [
    Landscape {
        name: "saw tooth",
        at: |next| {
            let x = next();
            (0.05 + f64::from(x), Some(x))
        },
        share: |cell| 0.05 + middle(cell),
    },
    Landscape {
        name: "second number",
        at: |next| {
            let (x, y) = (f64::from(next()), next());
            ((1.0 + x) * (0.05 + f64::from(y)), Some(y))
        },
        share: |cell| 0.05 + middle(cell),
    },
    Landscape {
        name: "number that comes and goes",
        at: |next| {
            if next() < 0.7 {
                return (1.0, None);
            }
            let x = next();
            (0.1 + 2.0 * f64::from(x), Some(x))
        },
        share: |cell| 0.1 + 2.0 * middle(cell),
    },
];

/// The p-value of a chain's visits against what they should be. Only every 60th state is looked at:
/// small steps of up to a quarter of the circle, and six large ones, lie between.
fn p_value<M: SmallStep>(step: M, landscape: &Landscape, course: u64) -> f64 {
    let mut sample = PrimarySample::new(step, 0.1, 1, course);
    let look = |sample: &mut PrimarySample<M>| {
        sample.skip_to(0);
        (landscape.at)(&mut || sample.next_1d())
    };
    let (mut here, mut cell) = look(&mut sample);
    let mut observed = [0_u64; CELLS];
    for turn in 0..1_200_000 {
        sample.propose();
        let (there, other) = look(&mut sample);
        if f64::from(sample.decide()) < there / here {
            sample.accept();
            (here, cell) = (there, other);
        } else {
            sample.reject();
        }
        if let Some(x) = cell
            && turn % 60 == 59
        {
            observed[(x * CELLS as f32) as usize] += 1;
        }
    }
    let total: u64 = observed.iter().sum();
    let shares: Vec<f64> = (0..CELLS).map(landscape.share).collect();
    let sum: f64 = shares.iter().sum();
    let expected: Vec<f64> = shares.iter().map(|s| s / sum * total as f64).collect();
    goodness_of_fit(&observed, &expected)
        .expect("twenty cells")
        .p_value
}

/// Kelemen's steps, but larger, so that chains get around.
fn steps() -> LogarithmicStep {
    LogarithmicStep::new(1.0 / 64.0, 0.25)
}

/// α = 10⁻³ over the three landscapes.
const ALPHA: f64 = 1e-3 / 3.0;

#[test]
fn chains_stay_where_they_should() {
    for landscape in &LANDSCAPES {
        let p = p_value(steps(), landscape, 11);
        assert!(p > ALPHA, "{}: p = {p:e}", landscape.name);
    }
}

/// Mutant: a step that goes forward only, so that its reverse is never taken.
struct Forward(LogarithmicStep);

impl SmallStep for Forward {
    fn offset(&self, index: u32, bits: u64) -> u32 {
        self.0.offset(index, bits & !1)
    }
}

#[test]
fn asymmetric_steps_are_noticed() {
    for landscape in &LANDSCAPES {
        let p = p_value(Forward(steps()), landscape, 11);
        assert!(p < ALPHA, "{}: p = {p:e}", landscape.name);
    }
}

#[test]
fn small_steps_have_the_sizes_that_they_should() {
    let (smallest, largest) = (1.0 / 1024.0, 1.0 / 64.0);
    let step = LogarithmicStep::new(smallest, largest);
    let mut sizes = [0_u64; 4];
    let mut forward = 0;
    let turns = 40_000_u64;
    for turn in 0..turns {
        let offset = step.offset(9, etalon_sampling::hash::mix64(turn)) as i32;
        forward += u64::from(offset > 0);
        let size = f64::from(offset.unsigned_abs()) / f64::from(2.0_f32.powi(32));
        // Each factor of two between 1/1024 and 1/64 is as likely as the others.
        let octave = (0..4).find(|i| size <= f64::from(smallest) * f64::from(2 << i) * 1.000_001);
        sizes[octave.expect("no larger than the largest")] += 1;
        assert!(size > f64::from(smallest) * 0.999_999, "{size}");
    }
    let quarter = [turns as f64 / 4.0; 4];
    let p = goodness_of_fit(&sizes, &quarter)
        .expect("four cells")
        .p_value;
    assert!(p > 1e-3, "octaves {sizes:?}: p = {p:e}");
    let halves = [forward, turns - forward];
    let half = [turns as f64 / 2.0; 2];
    let p = goodness_of_fit(&halves, &half).expect("two cells").p_value;
    assert!(p > 1e-3, "forward and back {halves:?}: p = {p:e}");
}

/// All numbers of a sample, in order.
fn numbers(sample: &mut PrimarySample<LogarithmicStep>, count: u32) -> Vec<f32> {
    sample.skip_to(0);
    (0..count).map(|_| sample.next_1d()).collect()
}

#[test]
fn a_rejected_step_leaves_no_trace() {
    let mut sample = PrimarySample::new(steps(), 0.5, 3, 4);
    for turn in 0..200 {
        let before = numbers(&mut sample, 6);
        let large = sample.propose();
        // A few numbers only, or all.
        let after = numbers(&mut sample, 1 + turn % 6);
        assert_ne!(before[..after.len()], after[..], "large: {large}");
        if turn % 3 == 0 {
            sample.accept();
        } else {
            sample.reject();
            assert_eq!(numbers(&mut sample, 6), before);
        }
    }
}

#[test]
fn a_sample_is_its_key_whatever_was_asked_first() {
    let mut forward = PrimarySample::new(steps(), 0.5, 9, 1);
    let mut backward = PrimarySample::new(steps(), 0.5, 9, 2);
    let expected = numbers(&mut forward, 20);
    for index in (0..20).rev() {
        backward.skip_to(index);
        assert_eq!(backward.next_1d(), expected[index as usize]);
    }
    backward.restart(10);
    assert_ne!(numbers(&mut backward, 20), expected);
}

#[test]
fn pairs_begin_at_even_numbers() {
    let mut sample = PrimarySample::new(steps(), 0.5, 9, 1);
    let all = numbers(&mut sample, 4);
    sample.skip_to(1);
    let pair = sample.next_2d();
    assert_eq!([pair.x, pair.y], [all[2], all[3]]);
    assert_eq!(sample.dimension(), 4);
}
