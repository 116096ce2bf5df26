//! Light sampling at several vertices at once.
//!
//! What [`Candidates::draw`](crate::steps::candidates::Candidates::draw) and
//! [`LightConnection`](crate::steps::light_connection::LightConnection) do for one vertex.

use crate::steps::candidates::TURN;
use crate::steps::dimensions::BounceSamples;
use crate::steps::light_connection::UnoccludedPath;
use crate::steps::path_throughput::PathThroughput;
use etalon_math::float::ONE_MINUS_EPSILON;
use etalon_math::lane::{Lane, Mask, Select, Spectral};
use etalon_spectrum::Wavelengths;
use etalon_transport::{LaneBsdf, LaneLightSample, LaneReceiver, LaneShading};

/// Connections of several vertices to lights, as [`crate::steps::light_connection::LightConnection`] describes them.
pub(super) struct LaneConnection<F: Lane> {
    /// The light samples; found where there is a connection.
    pub(super) light: LaneLightSample<F>,
    pub(super) path: UnoccludedPath<F>,
}

impl<F: Lane> LaneConnection<F> {
    /// `yes` in the lanes where `mask` says yes, `no` in the others.
    #[inline(always)]
    fn choose(mask: F::Mask, yes: Self, no: Self) -> Self {
        Self {
            light: LaneLightSample::choose(mask, yes.light, no.light),
            path: UnoccludedPath::choose(mask, yes.path, no.path),
        }
    }
}

/// Several vertices of one kind, at which light is sampled.
pub(super) struct LaneVertex<'v, F: Lane, L, B> {
    pub(super) lanes: &'v L,
    pub(super) bsdf: &'v B,
    pub(super) wavelengths: &'v [Wavelengths],
    pub(super) wo: F::Vector,
    pub(super) from: LaneReceiver<F>,
    /// The paths that led there.
    pub(super) before: PathThroughput<F>,
}

impl<F: Lane, L: LaneShading, B: LaneBsdf<F>> LaneVertex<'_, F, L, B> {
    /// The connection to a light sample.
    #[inline(always)]
    pub(super) fn connect(&self, wanted: F::Mask, u_light: F, u: [F; 2]) -> LaneConnection<F> {
        let mut light = (self.lanes).sample_light(&self.from, self.wavelengths, wanted, u_light, u);
        let (value, density) = self.bsdf.eval_and_density(self.wo, light.direction);
        let contribution = value * light.radiance;
        light.found = light.found & !contribution.is_zero();
        LaneConnection {
            light,
            path: UnoccludedPath::new(
                &self.before,
                contribution,
                (F::Spectrum::uniform(light.chance), light.is_delta),
                self.before.r_u * density,
                [1.0; 2],
            ),
        }
    }

    /// Resamples up to `most` light samples for one shadow ray, `counts` of them in each lane: what [`Candidates::draw`] does.
    #[inline(always)]
    pub(super) fn resample(
        &self,
        events: &BounceSamples<F, [F; 2]>,
        shift: F,
        counts: F,
        most: u32,
    ) -> LaneConnection<F> {
        let below_one = F::splat(ONE_MINUS_EPSILON);
        let one = Lane::eq(counts, F::ONE);
        let mut number = events.light_choice;
        let mut sum = F::ZERO;
        let mut ended = F::Mask::splat(false);
        let mut chosen: Option<(LaneConnection<F>, F)> = None;
        for i in 0..most {
            let i = i as f32;
            let choice = ((shift + i) / counts).min(below_one);
            let [u, v] = [events.light[0] + TURN.x * i, events.light[1] + TURN.y * i]
                .map(|u| (u - u.floor()).min(below_one));
            let wanted = F::splat(i).lt(counts) & !ended;
            let candidate = self.connect(
                wanted,
                one.select(events.light_choice, choice),
                [
                    one.select(events.light[0], u),
                    one.select(events.light[1], v),
                ],
            );
            let active = wanted & candidate.light.found;
            let expected = candidate.path.unoccluded().sum();
            let infinite = !expected.abs().lt(F::splat(f32::INFINITY));
            let counted = active & !infinite & expected.gt(F::ZERO);
            sum = counted.select(sum + expected, sum);
            let p = expected / sum;
            let taken = number.lt(p);
            let rest = taken
                .select(number / p, (number - p) / (F::ONE - p))
                .min(below_one);
            number = counted.select(rest, number);
            // What is not finite is not for the choice to hide.
            let take = active & (one | infinite | (counted & taken));
            ended = ended | (active & infinite);
            let certain = one | infinite;
            let kept = certain.select(F::ZERO, expected);
            chosen = Some(match chosen {
                None => {
                    let mut candidate = candidate;
                    candidate.light.found = take;
                    (candidate, kept)
                }
                Some((before, expected)) => (
                    LaneConnection::choose(take, candidate, before),
                    take.select(kept, expected),
                ),
            });
        }
        let (mut connection, expected) = chosen.expect("at least one candidate");
        let weighed = expected.gt(F::ZERO);
        let factor = weighed.select(sum / (expected * counts), F::ONE);
        let beta = &mut connection.path.throughput.beta;
        *beta = *beta * factor;
        connection
    }
}
