//! A point of primary sample space that takes the steps of a Markov chain.
//!
//! A path is a function of uniform numbers u₀, u₁, …, its *primary sample* (Kelemen, Szirmay-Kalos,
//! Antal, Csonka 2002, "A Simple and Robust Mutation Strategy for the Metropolis Light Transport
//! Algorithm"). A *large step* draws all of them again. A *small step* moves each around the circle
//! [0, 1) by
//!
//! ```text
//! ±s₂·exp(−u·ln(s₂/s₁)),    u uniform in [0, 1)
//! ```
//!
//! so that distances between s₁ and s₂ are equally likely on a logarithmic scale (ibid., section
//! 3).
//!
//! Numbers are 32-bit integers with wrapping arithmetic: a step and its reverse are equally likely to
//! the last bit. They are created and moved lazily: a number that several accepted steps did not use
//! catches up with all of them when it is used.

use crate::steps::dimensions as dim;
use etalon_math::float;
use etalon_sampling::Sampler;
use etalon_sampling::hash::{GOLDEN, derived_key, mix64, random_float};
use glam::Vec2;

/// The distribution of a small step.
pub(crate) trait SmallStep {
    /// The distance around the circle of 2³² places that the number with this index moves, from 64
    /// random bits. A distance and its opposite must be equally likely.
    fn offset(&self, index: u32, bits: u64) -> u32;
}

/// The sizes of steps.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Sizes {
    /// s₂ in 2⁻³².
    largest: f32,
    /// ln(s₂/s₁)
    range: f32,
}

impl Sizes {
    fn new(smallest: f32, largest: f32) -> Self {
        const PLACES: f32 = 4_294_967_296.0;
        Self {
            largest: largest * PLACES,
            range: float::ln(largest / smallest),
        }
    }
}

/// Steps of all sizes between two, equally likely on a logarithmic scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LogarithmicStep {
    smallest: f32,
    largest: f32,
    usual: Sizes,
    /// For the film position.
    film: Sizes,
    /// For the wavelengths.
    wavelengths: Sizes,
}

impl LogarithmicStep {
    /// Steps between `smallest` and `largest`, both in (0, ½].
    pub(crate) fn new(smallest: f32, largest: f32) -> Self {
        let usual = Sizes::new(smallest, largest);
        Self {
            smallest,
            largest,
            usual,
            film: usual,
            wavelengths: usual,
        }
    }

    /// The same, but up to an eighth of the film (Veach 1997, section 11.4.3.2, has up to 5 % of
    /// its area), and to all wavelengths: neither changes much else of a path.
    pub(crate) fn reaching_far(self) -> Self {
        let up_to = |largest: f32| Sizes::new(self.smallest, self.largest.max(largest));
        Self {
            film: up_to(0.125),
            wavelengths: up_to(0.5),
            ..self
        }
    }
}

impl SmallStep for LogarithmicStep {
    #[inline]
    fn offset(&self, index: u32, bits: u64) -> u32 {
        let sizes = match index {
            0..dim::LENS => &self.film,
            dim::WAVELENGTHS => &self.wavelengths,
            _ => &self.usual,
        };
        let u = random_float((bits >> 32) as u32);
        let distance = (sizes.largest * float::exp(-u * sizes.range)) as u32;
        if bits & 1 == 0 {
            distance
        } else {
            distance.wrapping_neg()
        }
    }
}

/// One number, and its value before the current step.
#[derive(Clone, Copy, Debug)]
struct Number {
    bits: u32,
    /// The last step that it took.
    time: u32,
    /// `bits` and `time` before.
    before: (u32, u32),
}

/// A primary sample, with the step that is being tried.
#[derive(Clone, Debug)]
pub(crate) struct PrimarySample<M> {
    step: M,
    /// The probability of a large step.
    large_step: f32,
    numbers: Vec<Number>,
    /// Accepted steps, and the one that is being tried.
    time: u32,
    /// The last accepted large step, and the key of the numbers that it drew.
    drawn: (u32, u64),
    /// The key of the large step that is being tried, if it is one.
    fresh: Option<u64>,
    /// Numbers from this index on have not been used in the current step.
    reach: usize,
    dimension: u32,
    /// The state of the stream that decides the chain's course.
    stream: u64,
}

impl<M: SmallStep> PrimarySample<M> {
    /// The sample with the key `start`; `course` selects the steps that it takes.
    pub(crate) fn new(step: M, large_step: f32, start: u64, course: u64) -> Self {
        Self {
            step,
            large_step,
            numbers: Vec::new(),
            time: 0,
            drawn: (0, start),
            fresh: None,
            reach: 0,
            dimension: 0,
            stream: course,
        }
    }

    /// Becomes another sample, at its beginning.
    pub(crate) fn restart(&mut self, start: u64) {
        self.numbers.clear();
        self.time = 0;
        self.drawn = (0, start);
        self.fresh = None;
        self.dimension = 0;
    }

    /// The next 64 bits of the chain's course (SplitMix64: Steele, Lea, Flood 2014).
    #[inline]
    fn next_bits(&mut self) -> u64 {
        self.stream = self.stream.wrapping_add(GOLDEN);
        mix64(self.stream)
    }

    /// A number in [0, 1) that decides something about the chain itself.
    #[inline]
    pub(crate) fn decide(&mut self) -> f32 {
        random_float((self.next_bits() >> 32) as u32)
    }

    /// Begins a step; whether it is a large one.
    pub(crate) fn propose(&mut self) -> bool {
        self.time += 1;
        self.reach = 0;
        self.dimension = 0;
        let large = self.decide() < self.large_step;
        self.fresh = large.then(|| self.next_bits());
        large
    }

    /// Stays where the step led.
    pub(crate) fn accept(&mut self) {
        if let Some(key) = self.fresh.take() {
            self.drawn = (self.time, key);
        }
    }

    /// Goes back to where it was.
    pub(crate) fn reject(&mut self) {
        for number in &mut self.numbers[..self.reach] {
            if number.time == self.time {
                (number.bits, number.time) = number.before;
            }
        }
        self.fresh = None;
        self.time -= 1;
    }

    /// The number with this index after the step at hand.
    #[inline]
    fn number(&mut self, index: u32) -> f32 {
        let place = index as usize;
        let (drawn, key) = self.drawn;
        while self.numbers.len() <= place {
            let bits = uniform(key, self.numbers.len() as u32);
            self.numbers.push(Number {
                bits,
                time: drawn,
                before: (bits, drawn),
            });
        }
        let mut number = self.numbers[place];
        if number.time < drawn {
            number.bits = uniform(key, index);
            number.time = drawn;
        }
        if number.time < self.time {
            number.before = (number.bits, number.time);
            if let Some(fresh) = self.fresh {
                number.bits = uniform(fresh, index);
            } else {
                for _ in number.time..self.time {
                    let bits = self.next_bits();
                    number.bits = number.bits.wrapping_add(self.step.offset(index, bits));
                }
            }
            number.time = self.time;
            self.numbers[place] = number;
            self.reach = self.reach.max(place + 1);
        }
        random_float(number.bits)
    }
}

/// 32 uniform bits: the number with this index of the sample with this key.
#[inline]
fn uniform(key: u64, index: u32) -> u32 {
    (derived_key(key, index) >> 32) as u32
}

impl<M: SmallStep> Sampler for PrimarySample<M> {
    #[inline]
    fn next_1d(&mut self) -> f32 {
        let index = self.dimension;
        self.dimension = index.wrapping_add(1);
        self.number(index)
    }

    #[inline]
    fn next_2d(&mut self) -> Vec2 {
        self.dimension = self.dimension.next_multiple_of(2);
        let x = self.next_1d();
        Vec2::new(x, self.next_1d())
    }

    #[inline]
    fn dimension(&self) -> u32 {
        self.dimension
    }

    #[inline]
    fn skip_to(&mut self, dimension: u32) {
        self.dimension = dimension;
    }
}
