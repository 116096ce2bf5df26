//! A scattering model that also looks where light was learned to come from.
//!
//! ```text
//! p(ω) = α·p_f(ω) + (1 − α)·(1 − p₀)·p_g(ω)
//! ```
//!
//! with p_f the model's own density (in which its choice among lobes is contained), p_g the learned one, and
//! p₀ the probability of passing straight on, which is left as it is. Discrete directions are found by the
//! model alone, with probability α·P. p₀, p_f and P may differ from lane to lane, α and p_g do not.

use super::sd_tree;
use etalon_math::float::ONE_MINUS_EPSILON;
use etalon_math::{DeltaProbability, Density, Frame, SolidAngle};
use etalon_sampling::discrete::Quadtree;
use etalon_transport::{Bsdf, BsdfSample, SamplePdf, TransportMode};
use glam::{Vec2, Vec3, Vec4};

/// A scattering model, and where light comes from.
#[derive(Clone, Copy)]
pub(crate) struct GuidedBsdf<'f, B> {
    pub(crate) bsdf: B,
    /// Where light comes from, and α, the probability of following the model's own choice; `None` leaves
    /// the model as it is.
    pub(crate) lobe: Option<(&'f Quadtree, f32)>,
}

impl<B: Bsdf> GuidedBsdf<'_, B> {
    /// The learned density where light does not pass straight on: (1 − p₀)·p_g.
    #[inline]
    fn on_scatter(&self, learned: Density<SolidAngle>) -> Density<SolidAngle> {
        let scattered = Vec4::ONE - self.bsdf.null_probability();
        Density::per_lane(learned.lanes() * scattered)
    }

    /// The mixture's density, from the two that are mixed, the model's with this share.
    #[inline]
    fn mix(
        &self,
        share: f32,
        own: Density<SolidAngle>,
        learned: Density<SolidAngle>,
    ) -> Density<SolidAngle> {
        let scattered = self.on_scatter(learned).lanes();
        Density::per_lane(own.lanes() * share + scattered * (1.0 - share))
    }

    /// The probability of a discrete direction: only the model samples it, with the probability `share`.
    #[inline]
    fn by_model(own: DeltaProbability, share: f32) -> SamplePdf {
        SamplePdf::Discrete(DeltaProbability(own.0 * share))
    }

    /// A direction of the learned density.
    #[inline]
    fn sample_learned(
        &self,
        (lobe, share): (&Quadtree, f32),
        wo: Vec3,
        u: Vec2,
        mode: TransportMode,
    ) -> Option<BsdfSample> {
        let (wi, learned) = sd_tree::sample(lobe, u);
        let (value, own) = self.bsdf.eval_and_density(wo, wi, mode);
        (value != Vec4::ZERO).then(|| BsdfSample {
            wi,
            value,
            chance: SamplePdf::Continuous(self.mix(share, own, learned)),
            // Whichever side it is on; this only sways Russian roulette.
            eta: 1.0,
            is_null: false,
        })
    }
}

impl<B: Bsdf> Bsdf for GuidedBsdf<'_, B> {
    #[inline]
    fn eval(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> Vec4 {
        self.bsdf.eval(wo, wi, mode)
    }

    #[inline]
    fn density(&self, wo: Vec3, wi: Vec3) -> Density<SolidAngle> {
        let own = self.bsdf.density(wo, wi);
        match self.lobe {
            Some((lobe, share)) => self.mix(share, own, sd_tree::density(lobe, wi)),
            None => own,
        }
    }

    #[inline]
    fn eval_and_density(
        &self,
        wo: Vec3,
        wi: Vec3,
        mode: TransportMode,
    ) -> (Vec4, Density<SolidAngle>) {
        let (value, own) = self.bsdf.eval_and_density(wo, wi, mode);
        match self.lobe {
            // Without scattering there is no density.
            Some((lobe, share)) if value != Vec4::ZERO => {
                let learned = sd_tree::density(lobe, wi);
                (value, self.mix(share, own, learned))
            }
            _ => (value, own),
        }
    }

    #[inline]
    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        let Some((lobe, share)) = self.lobe else {
            return self.bsdf.sample(wo, u_lobe, u, mode);
        };
        // The lowest numbers are the null interaction; the rest are divided between model and guiding.
        let passing = self.bsdf.null_probability().x;
        if u_lobe < passing {
            return self.bsdf.sample(wo, u_lobe, u, mode);
        }
        let rest = (u_lobe - passing) / (1.0 - passing);
        if rest >= share {
            return self.sample_learned((lobe, share), wo, u, mode);
        }
        let u_lobe = passing + rest / share * (1.0 - passing);
        let mut sample = self
            .bsdf
            .sample(wo, u_lobe.min(ONE_MINUS_EPSILON), u, mode)?;
        sample.chance = match sample.chance {
            SamplePdf::Continuous(own) => {
                SamplePdf::Continuous(self.mix(share, own, sd_tree::density(lobe, sample.wi)))
            }
            SamplePdf::Discrete(own) => Self::by_model(own, share),
        };
        Some(sample)
    }

    fn discrete(&self, wo: Vec3, index: u32, mode: TransportMode) -> Option<BsdfSample> {
        let mut sample = self.bsdf.discrete(wo, index, mode)?;
        if let (Some((_, share)), false) = (self.lobe, sample.is_null) {
            sample.chance = match sample.chance {
                SamplePdf::Discrete(own) => Self::by_model(own, share),
                continuous @ SamplePdf::Continuous(_) => continuous,
            };
        }
        Some(sample)
    }

    #[inline]
    fn has_continuous(&self) -> bool {
        self.bsdf.has_continuous()
    }

    fn has_discrete(&self) -> bool {
        self.bsdf.has_discrete()
    }

    #[inline]
    fn hemisphere(&self) -> Option<Frame> {
        self.bsdf.hemisphere()
    }

    #[inline]
    fn null_transmittance(&self) -> Vec4 {
        self.bsdf.null_transmittance()
    }

    #[inline]
    fn null_probability(&self) -> Vec4 {
        self.bsdf.null_probability()
    }

    #[inline]
    fn albedo(&self, wo: Vec3) -> Vec4 {
        self.bsdf.albedo(wo)
    }

    #[inline]
    fn projected_area(&self, direction: Vec3) -> f32 {
        self.bsdf.projected_area(direction)
    }
}
