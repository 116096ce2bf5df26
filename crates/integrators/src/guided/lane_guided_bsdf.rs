//! [`GuidedBsdf`](super::guided_bsdf::GuidedBsdf) at several vertices, in lanes. None of them lets light pass straight on: p₀ is 0.

use super::sd_tree;
use etalon_math::float::ONE_MINUS_EPSILON;
use etalon_math::lane::{Lane, MOST_LANES, Mask, Select, Spectral};
use etalon_sampling::discrete::Quadtree;
use etalon_transport::{LaneBsdf, LaneBsdfSample};
use glam::Vec2;

/// Scattering models, and where light comes from.
#[derive(Clone, Copy)]
pub(crate) struct LaneGuidedBsdf<'f, F: Lane, B> {
    bsdf: B,
    /// Where light comes from, if that was learned.
    lobes: [Option<&'f Quadtree>; MOST_LANES],
    /// The lanes where it was.
    guided: F::Mask,
    /// α, the probability of following the model's own choice; 1 where nothing was learned.
    share: F,
}

impl<'f, F: Lane, B: LaneBsdf<F>> LaneGuidedBsdf<'f, F, B> {
    /// The lobe and the share of lane i are `lobe(i)`.
    #[inline(always)]
    pub(crate) fn new(bsdf: B, lobe: impl Fn(usize) -> Option<(&'f Quadtree, f32)>) -> Self {
        let mut lobes = [None; MOST_LANES];
        let share = F::from_fn(|i| {
            let (lobe, share) = lobe(i).unzip();
            lobes[i] = lobe;
            share.unwrap_or(1.0)
        });
        Self {
            bsdf,
            lobes,
            guided: F::Mask::from_fn(|i| lobes[i].is_some()),
            share,
        }
    }

    /// The densities with which the lobes find directions, in the lanes of `mask`.
    #[inline(always)]
    fn learned(&self, mask: F::Mask, wi: F::Vector) -> F {
        let [x, y] = sd_tree::places::<F>(wi);
        F::from_fn(|i| match self.lobes[i] {
            Some(lobe) if mask.lane(i) => {
                sd_tree::density_at(lobe, Vec2::new(x.lane(i), y.lane(i)))
            }
            _ => 0.0,
        })
    }

    /// The mixture's density where `mask` says so, from the two that are mixed; the model's elsewhere.
    #[inline(always)]
    fn mix(&self, mask: F::Mask, own: F::Spectrum, learned: F) -> F::Spectrum {
        let scattered = F::Spectrum::uniform(learned * (F::ONE - self.share));
        F::Spectrum::choose(mask, own * self.share + scattered, own)
    }

    /// Directions of the learned densities, in the lanes of `mask`.
    #[inline(always)]
    fn sample_learned(&self, mask: F::Mask, wo: F::Vector, u: [F; 2]) -> LaneBsdfSample<F> {
        let drawn = F::array(|i| match self.lobes[i] {
            Some(lobe) if mask.lane(i) => {
                let u = Vec2::new(u[0].lane(i), u[1].lane(i));
                let (place, density) = sd_tree::sample_place(lobe, u);
                [place.x, place.y, density]
            }
            _ => [0.0; 3],
        });
        let drawn = drawn.as_ref();
        let [x, y, learned] = [0, 1, 2].map(|column| F::from_fn(|i| drawn[i][column]));
        let wi = sd_tree::directions::<F>([x, y]);
        let (value, own) = self.bsdf.eval_and_density(wo, wi);
        LaneBsdfSample {
            found: !value.is_zero(),
            wi,
            value,
            chance: self.mix(mask, own, learned),
            is_delta: F::Mask::splat(false),
            // Whichever side it is on; this only sways Russian roulette.
            eta: F::ONE,
        }
    }
}

impl<F: Lane, B: LaneBsdf<F>> LaneBsdf<F> for LaneGuidedBsdf<'_, F, B> {
    #[inline(always)]
    fn hemisphere(&self, wo: F::Vector) -> Option<F::Vector> {
        self.bsdf.hemisphere(wo)
    }

    #[inline(always)]
    fn has_continuous(&self) -> bool {
        self.bsdf.has_continuous()
    }

    #[inline(always)]
    fn eval_and_density(&self, wo: F::Vector, wi: F::Vector) -> (F::Spectrum, F::Spectrum) {
        let (value, own) = self.bsdf.eval_and_density(wo, wi);
        // Without scattering there is no density.
        let mixed = self.guided & !value.is_zero();
        (value, self.mix(mixed, own, self.learned(mixed, wi)))
    }

    #[inline(always)]
    fn sample(&self, wo: F::Vector, u_lobe: F, u: [F; 2]) -> LaneBsdfSample<F> {
        let by_model = !self.guided | u_lobe.lt(self.share);
        let rest = (u_lobe / self.share).min(F::splat(ONE_MINUS_EPSILON));
        let rest = self.guided.select(rest, u_lobe);
        let mut sample = self.bsdf.sample(wo, rest, u);
        let continuous = self.guided & by_model & !sample.is_delta;
        let discrete = F::Spectrum::choose(
            self.guided & sample.is_delta,
            sample.chance * self.share,
            sample.chance,
        );
        sample.chance = match continuous.any() {
            true => self.mix(continuous, discrete, self.learned(continuous, sample.wi)),
            false => discrete,
        };
        match by_model.all() {
            true => sample,
            false => {
                let learned = self.sample_learned(!by_model, wo, u);
                LaneBsdfSample::choose(by_model, sample, learned)
            }
        }
    }

    #[inline(always)]
    fn albedo(&self, wo: F::Vector) -> F::Spectrum {
        self.bsdf.albedo(wo)
    }
}
