//! Simulated sound programs: what the decision says of them shows whether its error rates are kept.
//!
//! Of each question a program answers with pictures of 4 × 4 tiles whose true mean is 1, or off by what is allowed. Noise is drawn
//! from σ = 10⁻⁴ to 0.1 of a picture's mean, evenly in its logarithm and anew for each question, of a kind that each program has:
//! even, common to all tiles, skewed, flashes, rare flashes, or a tail without variance. Programs of the last two kinds find lights
//! by chance, and say so.

use crate::judge::{self, Verdict};
use crate::replicate::Replicate;
use crate::rules::{BRIGHTEST, Rules};
use crate::tile::TILES;
use crate::truth::Picture;
use etalon_math::float64::{ln, pow};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Samples per pixel of the pictures.
const SAMPLES: u32 = 1024;

/// How the noise of a program is distributed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Noise {
    /// Normal, independent in each tile.
    Normal,
    /// Normal, half of its variance common to all tiles.
    Common,
    /// A tile is the sum of a few exponential numbers: as few as the noise asks for, one at least.
    Skewed,
    /// A thousandth to a twentieth of the light comes in flashes as bright as a sample may be.
    Flashes,
    /// A thousandth to a half of the light comes in flashes, each in one tile, one in 0.3 to 300 pictures.
    RareFlashes,
    /// Pareto's distribution, of an index from 1.1 to 2: the variance does not exist.
    NoVariance,
}

impl Noise {
    /// All kinds.
    pub const ALL: [Self; 6] = [
        Self::Normal,
        Self::Common,
        Self::Skewed,
        Self::Flashes,
        Self::RareFlashes,
        Self::NoVariance,
    ];

    /// Whether a program of this kind may miss bright samples in all pictures.
    pub fn finds_lights_by_chance(self) -> bool {
        matches!(self, Self::RareFlashes | Self::NoVariance)
    }
}

/// How many questions of a program came to which verdict.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Answers {
    /// Within the bound.
    pub agrees: u32,
    /// Accused, falsely.
    pub differs: u32,
    /// Neither.
    pub undecided: u32,
}

/// A program with its noise and the share of δ by which all its means are off, from −1 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NullProgram {
    /// How its noise is distributed.
    pub noise: Noise,
    /// Its error over δ.
    pub error: f64,
}

impl NullProgram {
    /// Asks it questions by these rules, with the looks of a run: more pictures where it is undecided.
    pub fn ask(&self, questions: u32, looks: &[u32], rules: &Rules, seed: u64) -> Answers {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let rules = Rules {
            samples: SAMPLES,
            brightest: match self.noise.finds_lights_by_chance() {
                true => 1e9,
                false => BRIGHTEST,
            },
            ..*rules
        };
        let truth = Picture::even(TILES, 1.0);
        let mut answers = Answers::default();
        let mut pictures = Vec::new();
        for _ in 0..questions {
            pictures.clear();
            let source = Source::of(self.noise, 1.0 + self.error * rules.bound, &mut random);
            let mut verdict = Verdict::Undecided(String::new());
            for look in looks {
                while pictures.len() < *look as usize {
                    let index = pictures.len() as u32;
                    pictures.push(Replicate {
                        pose: index % 2,
                        seed: index + 1,
                        luminance: source.picture(&mut random),
                    });
                }
                verdict = judge::decide(&truth, &pictures, &rules);
                if !matches!(verdict, Verdict::Undecided(_)) {
                    break;
                }
            }
            match verdict {
                Verdict::Agrees => answers.agrees += 1,
                Verdict::Undecided(_) => answers.undecided += 1,
                _ => answers.differs += 1,
            }
        }
        answers
    }
}

/// Where the pictures of a question come from.
struct Source {
    noise: Noise,
    mean: f64,
    /// The noise of a tile relative to its mean, as if it were independent of the others.
    sigma: f64,
    /// Of flashes how much of the light they carry and how many there are in a picture; of Pareto's distribution its index.
    shape: [f64; 2],
}

impl Source {
    fn of(noise: Noise, mean: f64, random: &mut Pcg64Mcg) -> Self {
        let mut between = |a: f64, b: f64| a * pow(b / a, random.random::<f64>());
        let tiles = f64::from(TILES);
        Self {
            noise,
            mean,
            sigma: tiles * between(1e-4, 0.1),
            shape: match noise {
                Noise::Flashes => {
                    let share = between(1e-3, 0.05);
                    let samples = f64::from(SAMPLES * TILES * TILES);
                    [share, share * samples / BRIGHTEST]
                }
                Noise::RareFlashes => [between(1e-3, 0.5), between(1.0 / 300.0, 3.0)],
                _ => [between(1.1, 2.0), 0.0],
            },
        }
    }

    fn picture(&self, random: &mut Pcg64Mcg) -> Vec<f64> {
        let count = (TILES * TILES) as usize;
        let Self {
            mean,
            sigma,
            shape: [a, b],
            ..
        } = *self;
        let normal = |random: &mut Pcg64Mcg| 1.0 + sigma * normal(random);
        let mut tiles: Vec<f64> = match self.noise {
            Noise::Normal | Noise::Flashes | Noise::RareFlashes => {
                (0..count).map(|_| normal(random)).collect()
            }
            Noise::Common => {
                let half = std::f64::consts::FRAC_1_SQRT_2;
                // The mean of independent tiles has a quarter of their deviation.
                let common = 0.25 * (normal(random) - 1.0);
                let own = (0..count).map(|_| 1.0 + half * (normal(random) - 1.0 + common));
                own.collect()
            }
            Noise::Skewed => {
                let terms = (1.0 / (sigma * sigma)).ceil().clamp(1.0, 16.0) as u32;
                // Of more, 16 of the same noise are taken, which are skewed more.
                let scale = (sigma * f64::from(terms).sqrt()).min(1.0);
                let exponential = |random: &mut Pcg64Mcg| -ln(1.0 - random.random::<f64>());
                let sum =
                    |random: &mut Pcg64Mcg| (0..terms).map(|_| exponential(random)).sum::<f64>();
                (0..count)
                    .map(|_| 1.0 + scale * (sum(random) / f64::from(terms) - 1.0))
                    .collect()
            }
            Noise::NoVariance => {
                // (1 − u)^(−1/a) has the mean a/(a − 1).
                let pareto = |random: &mut Pcg64Mcg| {
                    pow(1.0 - random.random::<f64>(), -1.0 / a) * (a - 1.0) / a
                };
                let scale = sigma.min(1.0);
                (0..count)
                    .map(|_| 1.0 + scale * (pareto(random) - 1.0))
                    .collect()
            }
        };
        if matches!(self.noise, Noise::Flashes | Noise::RareFlashes) {
            tiles.iter_mut().for_each(|tile| *tile *= 1.0 - a);
            // Of `b` flashes a picture in the mean each carries as much of its light; Knuth's way to draw how many.
            let (least, mut left) = (pow(std::f64::consts::E, -b), random.random::<f64>());
            while left > least {
                tiles[random.random_range(0..count)] += a / b * count as f64;
                left *= random.random::<f64>();
            }
        }
        tiles.iter_mut().for_each(|tile| *tile *= mean);
        tiles
    }
}

/// A standard normal number (Marsaglia and Bray 1964, by rejection from a square).
fn normal(random: &mut Pcg64Mcg) -> f64 {
    loop {
        let [x, y] = [
            2.0 * random.random::<f64>() - 1.0,
            2.0 * random.random::<f64>() - 1.0,
        ];
        let square = x * x + y * y;
        if square > 0.0 && square < 1.0 {
            return x * (-2.0 * ln(square) / square).sqrt();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each kind has the mean that it says, within five standard errors of what was drawn, or where there is no variance
    /// within a tenth.
    #[test]
    fn means_are_as_said() {
        for noise in Noise::ALL {
            let mut random = Pcg64Mcg::seed_from_u64(8);
            let source = Source {
                shape: match noise {
                    Noise::Flashes | Noise::RareFlashes => [0.4, 0.5],
                    _ => [1.9, 0.0],
                },
                ..Source::of(noise, 1.5, &mut random)
            };
            let means: Vec<f64> = (0..20_000)
                .map(|_| source.picture(&mut random).iter().sum::<f64>() / 16.0)
                .collect();
            let summary = etalon_statistics::Summary::of(&means).expect("many");
            let far = match noise {
                Noise::NoVariance => 0.15,
                _ => 5.0 * summary.standard_error(),
            };
            assert!((summary.mean() - 1.5).abs() < far, "{noise:?}: {summary:?}");
        }
    }

    /// Ten programs of each kind with 50 questions each, at the bounds and between, are not accused, and are not all undecided.
    #[test]
    fn sound_programs_are_not_accused() {
        let rules = Rules::new(50, 2, SAMPLES, BRIGHTEST);
        for (kind, noise) in Noise::ALL.into_iter().enumerate() {
            let mut total = Answers::default();
            for index in 0..10 {
                let error = [0.0, 1.0, -1.0][index % 3];
                let program = NullProgram { noise, error };
                let answers = program.ask(50, &[32, 128], &rules, (100 * kind + index) as u64);
                total.differs += answers.differs;
                total.agrees += answers.agrees;
            }
            assert_eq!(total.differs, 0, "{noise:?}");
            assert!(total.agrees > 0, "{noise:?}");
        }
        // Mutant rejected: programs that are off by three times the bound are accused.
        for error in [3.0, -3.0] {
            let program = NullProgram {
                noise: Noise::Normal,
                error,
            };
            let answers = program.ask(50, &[32, 128], &rules, 7);
            assert!(answers.differs > 10 && answers.agrees == 0, "{answers:?}");
        }
    }
}
