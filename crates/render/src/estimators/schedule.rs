//! How much each estimator renders: fixed by a pilot before anything is measured.
//!
//! Of the time, a stated share goes to the reference (none if it is a file). The rest is divided
//! equally among the estimators, and each one's part in two:
//!
//! - *equal time*, a share of [`EQUAL_TIME`]: about [`TARGET`] pictures, or as many as there is time for if their length is asked
//!   for, that take the same time by every estimator, as nearly as a sampler's sizes allow; the remainder of rounding down goes into
//!   more pictures, up to [`MOST`];
//! - *ladder*, the rest: [`LADDER`] pictures at each of 1, b, b², … samples per pixel, as far as that
//!   allows. b is 2, or 4 if a stratified sampler takes part, whose sizes are squares.

use etalon_sampling::SamplerKind;

/// The share of an estimator's time that goes into pictures at equal time.
pub const EQUAL_TIME: f64 = 0.4;

/// The pictures at equal time that are aimed at.
pub const TARGET: u32 = 24;

/// The most of them.
pub const MOST: u32 = 64;

/// The fewest of them: fewer are not resampled ([`etalon_statistics::bootstrap::FEWEST`]).
pub const FEWEST: u32 = 8;

/// The pictures at each size of the ladder.
pub const LADDER: u32 = 8;

/// The replicates of a rendered reference that are aimed at, and the fewest.
const REFERENCE: u32 = 16;

/// The largest size of a ladder (samples per pixel).
const TOP: u32 = 1 << 14;

/// The largest picture of all (samples per pixel).
const LARGEST: f64 = (1 << 20) as f64;

/// So many independent pictures of so many samples per pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Samples per pixel of one picture.
    pub samples: u32,
    /// Pictures.
    pub replicates: u32,
}

impl Size {
    /// Samples per pixel over all pictures.
    pub fn total(self) -> u64 {
        u64::from(self.samples) * u64::from(self.replicates)
    }
}

/// What one estimator renders.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Share {
    /// Pictures that take as long as the others'.
    pub equal_time: Size,
    /// Pictures of every size, the smallest first; never empty.
    pub ladder: Vec<Size>,
}

/// What is rendered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Schedule {
    /// The reference, if it is rendered.
    pub reference: Option<Size>,
    /// The estimators.
    pub shares: Vec<Share>,
    /// The step of all ladders that every estimator reaches: where samples are equal.
    pub equal_samples: usize,
}

/// An estimator as the pilot saw it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    /// Seconds for one sample in every pixel.
    pub seconds: f64,
    /// The sampler, whose sizes are not all alike good.
    pub sampler: SamplerKind,
}

impl Schedule {
    /// Divides `seconds` among estimators of these paces, and `share` of it for a reference by the
    /// first, if there is to be one. A picture at equal time takes `picture` seconds, if they are given.
    ///
    /// # Errors
    /// The seconds that would be enough, if these are not.
    pub fn fix(
        paces: &[Pace],
        seconds: f64,
        share: Option<f64>,
        picture: Option<f64>,
    ) -> Result<Self, f64> {
        let slowest = paces.iter().map(|pace| pace.seconds).fold(0.0, f64::max);
        let (first, fewest) = (paces.first().map_or(0.0, |p| p.seconds), f64::from(FEWEST));
        let for_reference = |share: f64| f64::from(REFERENCE) * first / share;
        // One estimator's part of the time after the reference.
        let part = (1.0 - share.unwrap_or(0.0)) / paces.len() as f64;
        let smaller = part * EQUAL_TIME.min(1.0 - EQUAL_TIME);
        let pictures = fewest * picture.unwrap_or(0.0) / (part * EQUAL_TIME);
        let needed = (fewest * slowest / smaller).max(share.map_or(0.0, for_reference));
        let needed = needed.max(pictures);
        if !(needed <= seconds) {
            return Err(needed);
        }
        let timed = part * EQUAL_TIME * seconds;
        let climbed = part * (1.0 - EQUAL_TIME) * seconds;
        let squares = (paces.iter()).any(|p| matches!(p.sampler, SamplerKind::Stratified { .. }));
        let base = if squares { 4 } else { 2 };
        let each = picture.unwrap_or(timed / f64::from(TARGET));
        let shares: Vec<Share> = paces
            .iter()
            .map(|pace| Share {
                equal_time: at_most(pace, each, timed, MOST),
                ladder: ladder(pace, climbed, base),
            })
            .collect();
        let shortest = shares.iter().map(|share| share.ladder.len()).min();
        let reference = share.zip(paces.first()).map(|(share, pace)| {
            let time = share * seconds;
            at_most(pace, time / f64::from(REFERENCE), time, 2 * REFERENCE - 1)
        });
        Ok(Self {
            reference,
            equal_samples: shortest.unwrap_or(1) - 1,
            shares,
        })
    }

    /// Samples per pixel, over everything that is rendered.
    pub fn samples(&self) -> u64 {
        let shares = self.shares.iter();
        let sizes = shares.flat_map(|share| share.ladder.iter().chain([&share.equal_time]));
        sizes.chain(&self.reference).map(|size| size.total()).sum()
    }
}

/// Pictures of at most `each` seconds and at least one sample, as many as fit into `all` seconds.
fn at_most(pace: &Pace, each: f64, all: f64, most: u32) -> Size {
    let samples = round_down(pace.sampler, (each / pace.seconds).min(LARGEST) as u32);
    let fit = (all / (pace.seconds * f64::from(samples))).min(f64::from(most)) as u32;
    // An even number: pictures are also looked at in pairs.
    Size {
        samples,
        replicates: fit.max(FEWEST) & !1,
    }
}

fn ladder(pace: &Pace, seconds: f64, base: u32) -> Vec<Size> {
    let mut left = seconds;
    let mut sizes = Vec::new();
    let mut samples = 1;
    while samples <= TOP {
        left -= pace.seconds * f64::from(samples * LADDER);
        if left < 0.0 && !sizes.is_empty() {
            break;
        }
        sizes.push(Size {
            samples,
            replicates: LADDER,
        });
        samples *= base;
    }
    sizes
}

/// The greatest size of at most `samples`, and at least one, that the sampler stratifies fully.
fn round_down(sampler: SamplerKind, samples: u32) -> u32 {
    let samples = samples.max(1);
    match sampler {
        SamplerKind::Independent => samples,
        SamplerKind::Stratified { .. } => samples.isqrt().pow(2),
        SamplerKind::Sobol => 1 << samples.ilog2(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paces() -> Vec<Pace> {
        let pace = |seconds, sampler| Pace { seconds, sampler };
        vec![
            pace(0.01, SamplerKind::Independent),
            pace(0.013, SamplerKind::Sobol),
            pace(0.05, SamplerKind::Stratified { jitter: true }),
        ]
    }

    fn seconds(pace: &Pace, size: Size) -> f64 {
        pace.seconds * size.total() as f64
    }

    #[test]
    fn time_is_kept_and_shared() {
        let schedule = Schedule::fix(&paces(), 60.0, Some(0.25), None).expect("enough");
        let reference = schedule.reference.expect("rendered");
        let spent = seconds(&paces()[0], reference);
        assert!(spent <= 15.0 && spent > 10.0, "{reference:?}");
        for (share, pace) in schedule.shares.iter().zip(paces()) {
            let part = 15.0;
            let spent = seconds(&pace, share.equal_time);
            let timed = EQUAL_TIME * part;
            assert!(spent <= timed && spent > 0.7 * timed, "{share:?}");
            let each = pace.seconds * f64::from(share.equal_time.samples);
            assert!(each <= timed / 24.0, "{share:?}");
            let climbed: f64 = share.ladder.iter().map(|size| seconds(&pace, *size)).sum();
            assert!(climbed <= part - timed, "{share:?}");
            assert!(share.equal_time.replicates.is_multiple_of(2));
            // Every size suits the sampler.
            for size in share.ladder.iter().chain([&share.equal_time]) {
                assert_eq!(pace.sampler.round_up(size.samples), size.samples);
            }
        }
        // All ladders have the step where samples are equal.
        let equal: Vec<u32> = (schedule.shares.iter())
            .map(|share| share.ladder[schedule.equal_samples].samples)
            .collect();
        assert!(
            equal.iter().all(|n| *n == equal[0]) && equal[0] >= 4,
            "{equal:?}"
        );
    }

    #[test]
    fn too_little_time_is_refused_with_what_would_do() {
        for share in [None, Some(0.2)] {
            let needed = Schedule::fix(&paces(), 0.3, share, None).expect_err("too little");
            assert!(needed > 0.3);
            let schedule = Schedule::fix(&paces(), 1.001 * needed, share, None).expect("enough");
            assert!((schedule.shares.iter()).all(|share| share.equal_time.replicates >= FEWEST));
            assert!(Schedule::fix(&paces(), 0.99 * needed, share, None).is_err());
        }
        assert!(Schedule::fix(&paces(), 0.0, None, None).is_err());
    }

    #[test]
    fn pictures_are_as_long_as_asked() {
        let fix = |seconds, picture| Schedule::fix(&paces(), seconds, Some(0.25), Some(picture));
        let schedule = fix(200.0, 2.0).expect("enough");
        for (share, pace) in schedule.shares.iter().zip(paces()) {
            let each = pace.seconds * f64::from(share.equal_time.samples);
            assert!(each <= 2.0 && each > 0.5, "{share:?}");
            assert!(share.equal_time.replicates >= FEWEST, "{share:?}");
        }
        // Eight pictures of 2 s each for three estimators: 16 s of a part, of which 40 % are for them.
        let needed = fix(100.0, 2.0).expect_err("too little");
        assert!((needed - 160.0).abs() < 1e-9, "{needed}");
    }

    #[test]
    fn sizes_are_rounded_down() {
        let sizes = |kind: SamplerKind| [0, 1, 3, 10, 70].map(|n| round_down(kind, n));
        assert_eq!(sizes(SamplerKind::Independent), [1, 1, 3, 10, 70]);
        assert_eq!(sizes(SamplerKind::Sobol), [1, 1, 2, 8, 64]);
        let stratified = SamplerKind::Stratified { jitter: true };
        assert_eq!(sizes(stratified), [1, 1, 1, 9, 64]);
    }
}
