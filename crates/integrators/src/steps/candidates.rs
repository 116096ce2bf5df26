//! Several light samples that compete for one shadow ray.
//!
//! A vertex draws M light samples x₁ … x_M; the choice of the light is stratified over them, and one pair of
//! numbers is turned for each. With gᵢ the estimate that one light sample xᵢ would bring beside scattering, and ĝᵢ
//! the same if nothing is in the way, one is chosen with the probability Σ ĝᵢ / Σⱼ Σ ĝⱼ (the inner sums over the
//! wavelengths), gets the only shadow ray, and counts gᵢ/M over that probability. Whatever the samples, the mean
//! over the choice is Σᵢ gᵢ/M, the mean of what M shadow rays would bring: the choice needs no density of its own,
//! and may depend on all wavelengths (J. Talbot, D. Cline, P. Egbert, Importance resampling for global
//! illumination, 2005, with the balance heuristic in the target).
//!
//! Against scattering they count as one light sample, not as M. The balance heuristic for M would trust them
//! as far as M shadow rays, which they are not: where visibility decides, or which of two lights, that was measured to
//! double the variance. For the same reason one sample is drawn of a lone light whose samples are all alike.

use crate::steps::dimensions::BounceSamples;
use crate::steps::light_connection::LightConnection;
use crate::steps::settings::LightCandidates;
use etalon_math::float::ONE_MINUS_EPSILON;
use etalon_sampling::Sampler;
use etalon_spectrum::Wavelengths;
use etalon_transport::{LightSample, LightSampleContext, LightVariety, World};
use glam::Vec2;

/// Multiples of this spread evenly over a square, modulo one: powers of the inverse of the plastic
/// number (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences").
pub(crate) const TURN: Vec2 = Vec2::new(0.754_877_7, 0.569_840_3);

/// How many there are of several lights unless a scene says so.
const AUTOMATIC: u32 = 2;

/// How many light samples a vertex draws for its shadow ray; not zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Candidates(u32);

impl Candidates {
    /// One light sample.
    pub(crate) const ONE: Self = Self(1);

    /// As many as `wanted` says at a receiver with such lights.
    #[inline]
    pub(crate) fn at<W: World>(
        wanted: LightCandidates,
        world: &W,
        from: &LightSampleContext,
    ) -> Self {
        let count = match wanted {
            LightCandidates(Some(count)) if count.get() == 1 => return Self::ONE,
            LightCandidates(count) => match (count, world.light_variety(from)) {
                (_, LightVariety::Even) | (None, LightVariety::Single) => return Self::ONE,
                (None, LightVariety::Several) => AUTOMATIC,
                (Some(count), _) => count.get(),
            },
        };
        Self(count)
    }

    /// How many.
    #[inline]
    pub(crate) fn count(self) -> u32 {
        self.0
    }

    /// Draws them, and chooses one; `connect` says what a light sample brings. Draws one more number of `sampler`
    /// than the event has, if there is a choice.
    #[inline]
    pub(crate) fn draw<W: World>(
        self,
        world: &W,
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        event: &BounceSamples,
        sampler: &mut impl Sampler,
        connect: impl Fn(&LightSample) -> Option<LightConnection>,
    ) -> Option<LightConnection> {
        if self == Self::ONE {
            let (choice, u) = (event.light_choice, event.light);
            return connect(&world.sample_light(from, wavelengths, choice, u)?);
        }
        // The better number decides which candidate counts, and so which light: the candidates' lights
        // are nearly the same for all samples.
        let (mut number, shift) = (event.light_choice, sampler.next_1d());
        let (mut chosen, mut sum) = (None, 0.0);
        for i in 0..self.0 {
            let choice = ((shift + i as f32) / self.0 as f32).min(ONE_MINUS_EPSILON);
            let u = (event.light + TURN * i as f32)
                .fract()
                .min(Vec2::splat(ONE_MINUS_EPSILON));
            let light = world.sample_light(from, wavelengths, choice, u);
            let Some(candidate) = light.as_ref().and_then(&connect) else {
                continue;
            };
            let expected = candidate.path.unoccluded().element_sum();
            if !expected.is_finite() {
                // Not for the choice to hide.
                return Some(candidate);
            }
            if expected > 0.0 {
                sum += expected;
                let p = expected / sum;
                if number < p {
                    number = (number / p).min(ONE_MINUS_EPSILON);
                    chosen = Some((candidate, expected));
                } else {
                    number = ((number - p) / (1.0 - p)).min(ONE_MINUS_EPSILON);
                }
            }
        }
        let (mut connection, expected) = chosen?;
        connection.path.throughput.beta *= sum / (expected * self.0 as f32);
        Some(connection)
    }
}
