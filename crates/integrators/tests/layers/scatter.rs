//! A plane's scattering: lobes that differ from wavelength to wavelength.

use crate::world::Fault;
use etalon_math::{DeltaProbability, Density, Frame, SolidAngle, float};
use etalon_transport::*;
use glam::{Vec2, Vec3, Vec4};
use std::f32::consts::PI;

/// A plane at four wavelengths, seen from one side.
#[derive(Clone, Copy)]
pub(crate) struct Scatter {
    pub(crate) passing: Vec4,
    /// Fraction of light in the lobe and in the discrete direction.
    pub(crate) lobe: Vec4,
    pub(crate) atom: Vec4,
    pub(crate) exponent: Vec4,
    pub(crate) share: f32,
    pub(crate) normal: Vec3,
    pub(crate) tilt: Vec4,
    pub(crate) fault: Fault,
    /// Whether it says that it scatters to one side only.
    pub(crate) one_sided: bool,
}

impl Scatter {
    fn lobe_density(&self, cos: f32) -> Vec4 {
        if cos <= 0.0 {
            return Vec4::ZERO;
        }
        let n = self.exponent;
        let lobe = n
            .to_array()
            .map(|n| (n + 1.0) / (2.0 * PI) * float::pow(cos, n));
        Vec4::from_array(lobe)
    }

    fn direction(&self, cos: f32, turn: f32) -> Vec3 {
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        let (y, x) = float::sin_cos(2.0 * PI * turn);
        Frame::from_normal(self.normal).to_world(Vec3::new(x * sin, y * sin, cos))
    }
}

impl Bsdf for Scatter {
    fn eval(&self, _: Vec3, wi: Vec3, _: TransportMode) -> Vec4 {
        self.lobe * self.lobe_density(self.normal.dot(wi))
    }
    fn density(&self, _: Vec3, wi: Vec3) -> Density<SolidAngle> {
        let mut density = self.lobe_density(self.normal.dot(wi));
        if self.fault == Fault::OtherLanes {
            density *= Vec4::new(1.0, 0.5, 0.5, 0.5);
        }
        Density::per_lane(density * (1.0 - self.passing) * (1.0 - self.share))
    }
    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        let sample = |wi, value, chance, passes| BsdfSample {
            wi,
            value,
            chance,
            eta: 1.0,
            is_null: passes,
        };
        let pass = self.passing.x;
        if u_lobe < pass {
            return self.discrete(wo, 0, mode);
        }
        if (u_lobe - pass) / (1.0 - pass) < self.share {
            return self.discrete(wo, 1, mode);
        }
        let cos = float::pow(1.0 - u.x, 1.0 / (self.exponent.x + 1.0));
        let wi = self.direction(cos, u.y);
        let density = self.density(wo, wi);
        (density.hero() > 0.0).then(|| {
            sample(
                wi,
                self.eval(wo, wi, mode),
                SamplePdf::Continuous(density),
                false,
            )
        })
    }
    fn discrete(&self, wo: Vec3, index: u32, _: TransportMode) -> Option<BsdfSample> {
        // Another lane takes the atom's direction only if it is its own.
        let same = self.tilt.cmpeq(Vec4::splat(self.tilt.x));
        let same = Vec4::select(same, Vec4::ONE, Vec4::ZERO);
        let shared = if self.fault == Fault::AtomForAll {
            Vec4::ONE
        } else {
            same
        };
        let (wi, value, atom) = match index {
            0 => (-wo, self.passing, self.passing),
            1 => (
                self.direction(self.tilt.x, 0.3),
                self.atom * same,
                shared * (1.0 - self.passing) * self.share,
            ),
            _ => return None,
        };
        Some(BsdfSample {
            wi,
            value,
            chance: SamplePdf::Discrete(DeltaProbability(atom)),
            eta: 1.0,
            is_null: index == 0,
        })
    }
    fn has_continuous(&self) -> bool {
        self.share < 1.0
    }
    fn has_discrete(&self) -> bool {
        self.share > 0.0
    }
    fn hemisphere(&self) -> Option<Frame> {
        self.one_sided.then(|| Frame::from_normal(self.normal))
    }
    fn null_transmittance(&self) -> Vec4 {
        self.passing
    }
    fn null_probability(&self) -> Vec4 {
        self.passing
    }
    fn albedo(&self, _: Vec3) -> Vec4 {
        self.lobe
    }
    fn eval_and_density(
        &self,
        wo: Vec3,
        wi: Vec3,
        mode: TransportMode,
    ) -> (Vec4, Density<SolidAngle>) {
        (self.eval(wo, wi, mode), self.density(wo, wi))
    }
    fn projected_area(&self, _: Vec3) -> f32 {
        1.0
    }
}

/// Cosine of the discrete direction's angle with the normal, for a wavelength.
pub(crate) fn tilt(lambda: f32) -> f32 {
    0.3 + 0.6 * (lambda - 360.0) / 470.0
}
