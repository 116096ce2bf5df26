//! The upper boundary of a slab: a smooth or rough interface between two dielectrics.
//!
//! As [`crate::models::roughdielectric`] with the normals of GGX, but reflection and transmission can be had one by one, as
//! walks need them. Light is followed as importance, so that a way in and out again has no factor of η².

use crate::interface::fresnel;
use crate::interface::refraction::{reflect, refract};
use crate::layers::numbers::Numbers;
use crate::microfacet::{Kind, Microfacet};
use crate::models::roughdielectric::RoughDielectric;
use etalon_transport::TransportMode;
use glam::{Vec2, Vec3, Vec4};

/// Below this α along both axes a surface is smooth.
const SMOOTH: f32 = 1e-3;

/// Whether a surface of roughness `alpha` is smooth.
#[inline]
pub(crate) fn is_smooth(alpha: Vec2) -> bool {
    alpha.max_element() < SMOOTH
}

/// An interface at a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Interface {
    /// Index inside over index outside.
    pub(crate) eta: f32,
    /// Roughness along x and y.
    pub(crate) alpha: Vec2,
}

/// A facet that light has met.
pub(crate) struct Facet {
    microfacet: Option<Microfacet>,
    /// The direction to where the light comes from, and the normal, on the upper side.
    up: Vec3,
    normal: Vec3,
    /// The factor of z that brings directions to the upper side.
    side: f32,
    /// Index of the medium beyond over the one before.
    eta: f32,
    cos_t: f32,
    /// The share of the light that is reflected.
    pub(crate) reflectance: f32,
}

impl Interface {
    /// Whether it has one normal only. One between equal indices does nothing, however rough it is.
    #[inline]
    pub(crate) fn is_smooth(&self) -> bool {
        self.eta == 1.0 || is_smooth(self.alpha)
    }

    /// The facet that light from the direction `w` (leaving the interface) meets; `None` where it only grazes.
    #[inline]
    pub(crate) fn facet(&self, w: Vec3, numbers: &mut Numbers) -> Option<Facet> {
        let (eta, side) = match w.z > 0.0 {
            true => (self.eta, 1.0),
            false => (1.0 / self.eta, -1.0),
        };
        let up = Vec3::new(w.x, w.y, w.z * side);
        let microfacet = (!self.is_smooth()).then(|| ggx(self.alpha));
        let normal = match &microfacet {
            Some(facets) => facets.sample(up, numbers.pair().to_array()),
            None => Vec3::Z,
        };
        let cos = up.dot(normal).min(1.0);
        let (reflectance, cos_t) = fresnel::dielectric(cos, eta);
        (up.z > 0.0 && cos > 0.0).then_some(Facet {
            microfacet,
            up,
            normal,
            side,
            eta,
            cos_t,
            reflectance,
        })
    }

    /// f(wo, wi)·|cos θi| of a rough interface, for importance, and the density (sr⁻¹) of `wi` where a facet chooses between
    /// reflection and transmission by its reflectance.
    #[inline]
    pub(crate) fn eval(&self, wo: Vec3, wi: Vec3) -> (f32, f32) {
        let rough = RoughDielectric {
            eta: Vec4::splat(self.eta),
            reflectance: Vec4::ONE,
            transmittance: Vec4::ONE,
            microfacet: ggx(self.alpha),
        };
        let (value, density) = rough.eval_in(wo, wi, TransportMode::Importance);
        (value.x, density.x)
    }
}

/// Facets with the roughness `alpha`, sampled as they are seen, masked as in pbrt-v4: by their height.
#[inline]
pub(crate) fn ggx(alpha: Vec2) -> Microfacet {
    Microfacet::new(Kind::Ggx, alpha, true).with_correlated(|_| true)
}

impl Facet {
    /// The mirror direction, and its weight (f·|cos θi| over its density) if reflection was chosen by its share.
    #[inline]
    pub(crate) fn reflected(&self) -> Option<(Vec3, f32)> {
        let wi = reflect(self.up, self.normal);
        (wi.z > 0.0).then(|| self.leaving(wi))
    }

    /// The same of the refracted direction; `None` under total reflection.
    #[inline]
    pub(crate) fn transmitted(&self) -> Option<(Vec3, f32)> {
        let wi = refract(self.up, self.normal, self.eta, self.cos_t);
        (self.reflectance < 1.0 && wi.z < 0.0).then(|| self.leaving(wi))
    }

    /// What is shadowed of the visible is all that visible normals leave of the weight (Heitz & d'Eon 2014, eq. 19).
    #[inline]
    fn leaving(&self, wi: Vec3) -> (Vec3, f32) {
        let shown = self.microfacet.map_or(1.0, |facets| {
            let visible = facets.g1(self.up, self.normal);
            let both = facets.g(self.up, wi, self.normal);
            if visible > 0.0 { both / visible } else { 0.0 }
        });
        (Vec3::new(wi.x, wi.y, wi.z * self.side), shown)
    }
}
