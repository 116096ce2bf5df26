//! What lies under a slab.

use crate::interface::fresnel;
use crate::interface::refraction::reflect;
use crate::lane_bsdf_at_point::LaneBxdf;
use crate::layers::interface::{ggx, is_smooth};
use crate::models::diffuse::Diffuse;
use crate::models::roughconductor::RoughConductor;
use core::fmt::Debug;
use etalon_sampling::warps::square_to_cosine_hemisphere;
use glam::{Vec2, Vec3, Vec4};

/// A direction that light was scattered into.
#[derive(Clone, Copy, Debug)]
pub struct Scattered {
    /// The direction.
    pub wi: Vec3,
    /// f·|cos θi| over the density, per lane.
    pub weight: Vec4,
    /// Per steradian; `None` of a discrete direction.
    pub density: Option<f32>,
}

/// What lies under a slab, in the frame of the surface; directions leave it.
pub trait Base: Copy + Debug {
    /// f(wo, wi)·|cos θi| per lane, and the density of `wi` (sr⁻¹): zero of a mirror.
    fn eval(&self, wo: Vec3, wi: Vec3) -> (Vec4, f32);

    /// Samples a direction.
    fn sample(&self, wo: Vec3, u: Vec2) -> Option<Scattered>;

    /// What a mirror reflects at the cosine `cos`, per lane; `None` if it is rough.
    fn mirrored(&self, cos: f32) -> Option<Vec4>;

    /// Its roughness, if it scatters about the mirror direction.
    fn alpha(&self) -> Option<Vec2>;

    /// What it reflects, by itself.
    fn albedo(&self) -> Vec4;
}

impl Base for Diffuse {
    #[inline]
    fn eval(&self, wo: Vec3, wi: Vec3) -> (Vec4, f32) {
        let (value, density) = self.eval_lanes(wo, wi);
        (value, density.x)
    }

    #[inline]
    fn sample(&self, _: Vec3, u: Vec2) -> Option<Scattered> {
        let wi = square_to_cosine_hemisphere(u);
        Some(Scattered {
            wi,
            weight: self.reflectance,
            density: Some(wi.z * core::f32::consts::FRAC_1_PI),
        })
    }

    #[inline]
    fn mirrored(&self, _: f32) -> Option<Vec4> {
        None
    }

    #[inline]
    fn alpha(&self) -> Option<Vec2> {
        None
    }

    fn albedo(&self) -> Vec4 {
        self.reflectance
    }
}

/// A smooth or rough conductor.
#[derive(Clone, Copy, Debug)]
pub struct MetalBase {
    /// Real part of the index relative to the slab, per lane.
    pub eta: Vec4,
    /// Imaginary part, per lane.
    pub k: Vec4,
    /// Roughness along x and y.
    pub alpha: Vec2,
}

impl MetalBase {
    #[inline]
    fn rough(&self) -> RoughConductor {
        RoughConductor {
            eta: self.eta,
            k: self.k,
            reflectance: Vec4::ONE,
            microfacet: ggx(self.alpha),
        }
    }

    #[inline]
    fn fresnel(&self, cos: f32) -> Vec4 {
        fresnel::conductor(cos.min(1.0), self.eta, self.k)
    }
}

impl Base for MetalBase {
    #[inline]
    fn eval(&self, wo: Vec3, wi: Vec3) -> (Vec4, f32) {
        if is_smooth(self.alpha) {
            return (Vec4::ZERO, 0.0);
        }
        let (value, density) = self.rough().eval_lanes(wo, wi);
        (value, density.x)
    }

    #[inline]
    fn sample(&self, wo: Vec3, u: Vec2) -> Option<Scattered> {
        if is_smooth(self.alpha) {
            return Some(Scattered {
                wi: reflect(wo, Vec3::Z),
                weight: self.fresnel(wo.z),
                density: None,
            });
        }
        let sample = self.rough().sample_lanes(wo, 0.0, u.to_array());
        let density = sample.chance.x;
        (sample.found && density > 0.0).then(|| Scattered {
            wi: sample.wi,
            weight: sample.value / density,
            density: Some(density),
        })
    }

    #[inline]
    fn mirrored(&self, cos: f32) -> Option<Vec4> {
        is_smooth(self.alpha).then(|| self.fresnel(cos))
    }

    #[inline]
    fn alpha(&self) -> Option<Vec2> {
        Some(self.alpha)
    }

    fn albedo(&self) -> Vec4 {
        self.fresnel(1.0)
    }
}
