//! `blendphase`: two phase functions, the second with a share that may vary in space,
//!
//! ```text
//! p = (1 − w(x)) p₀ + w(x) p₁
//! ```

use crate::phases::{PhaseFunction, PhaseModel, PhasePoint};
use etalon_math::{Density, SolidAngle};
use etalon_params::{Class, Params};
use etalon_transport::{Build, PhaseSample, SpectrumKind, TextureId, TexturePoint, Textures};
use glam::{Vec2, Vec3, Vec4};

/// A mixture of two phase functions.
#[derive(Clone, Debug, PartialEq)]
pub struct Blend {
    weight: TextureId,
    parts: Box<[PhaseFunction; 2]>,
}

impl Blend {
    /// Reads `weight` and the two phase functions.
    pub(crate) fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let weight = build.volume(params, "weight", Some(0.5), SpectrumKind::Reflectance);
        let children = params.children(Class::Phase);
        let parts = children.iter().filter_map(|(_, node)| {
            PhaseFunction::from_params(&Params::new(node, params.diagnostics), build)
        });
        let parts: Vec<_> = parts.collect();
        if children.len() != 2 {
            params.error(format!(
                "`blendphase` has two phase functions, not {}",
                children.len()
            ));
            return None;
        }
        if parts
            .iter()
            .any(|part| matches!(part, PhaseFunction::Sggx(_)))
        {
            params.error("`sggx` cannot be blended: the density of a medium of flakes depends on where light goes");
            return None;
        }
        Some(Self {
            weight,
            parts: Box::new(parts.try_into().ok()?),
        })
    }

    #[inline]
    fn weight(&self, at: &PhasePoint<'_, impl Textures>) -> f32 {
        let place = TexturePoint::in_space(at.position);
        at.textures.number(self.weight, &place).clamp(0.0, 1.0)
    }
}

impl PhaseModel for Blend {
    fn eval(&self, at: &PhasePoint<'_, impl Textures>, wo: Vec3, wi: Vec3) -> Vec4 {
        let [a, b] = self.parts.each_ref().map(|part| part.eval(at, wo, wi));
        a.lerp(b, self.weight(at))
    }

    fn density(
        &self,
        at: &PhasePoint<'_, impl Textures>,
        wo: Vec3,
        wi: Vec3,
    ) -> Density<SolidAngle> {
        let [a, b] = self
            .parts
            .each_ref()
            .map(|part| part.density(at, wo, wi).lanes());
        Density::per_lane(a.lerp(b, self.weight(at)))
    }

    fn sample(&self, at: &PhasePoint<'_, impl Textures>, wo: Vec3, u: Vec2) -> PhaseSample {
        let weight = self.weight(at);
        let [a, b] = &*self.parts;
        let sample = if u.x < weight {
            b.sample(at, wo, Vec2::new(u.x / weight, u.y))
        } else {
            a.sample(at, wo, Vec2::new((u.x - weight) / (1.0 - weight), u.y))
        };
        PhaseSample {
            wi: sample.wi,
            value: self.eval(at, wo, sample.wi),
            density: self.density(at, wo, sample.wi),
        }
    }
}
