//! A base under a slab with a dielectric interface, by random walk.
//!
//! ```text
//! f(wo, wi) = f_interface(wo, wi) + Σₙ ∫ … ∫ T(wo → ω₁) [events inside] T(ωₙ → wi) dω₁ … dωₙ,   n ≤ `max_depth`
//! ```
//!
//! Guo, Hašan and Zhao (2018), *Position-Free Monte Carlo Simulation for Arbitrary Layered BSDFs*; the choice of layers, their
//! parameters and their defaults are those of `LayeredBxDF` in Pharr, Jakob and Humphreys (2023), *Physically Based Rendering*,
//! section 14.3. The slab's extinction is 1 per unit of `thickness`.
//!
//! No closed form exists, so what this has of f is one walk's estimate of it (`walk`):
//!
//! - *A value* is the mean of `samples` walks from one of the two directions to the other, with random numbers from a stream
//!   that is keyed by both of them, the place and the wavelengths. It is a pure function, and symmetric: the walk starts from the
//!   same of the two whichever is `wo`.
//! - *A sample* is where a walk leaves. With its throughput W and the density q that this model states, its value is
//!   W q: an estimator that divides by q has W, unbiased whatever q is. q weighs strategies, and is everywhere above zero.
//! - *Mixtures and tilted normals* need samples that follow q ([`Bxdf::sample_by_density`]).
//!
//! A smooth interface has a discrete reflection, which is no part of this. Over a mirror, so has the base: both
//! leave in one direction, with all the light that goes to and fro between them, Σₖ T² ρ (F ρ)ᵏ.

mod base;
mod interface;
mod numbers;
mod slab;
mod walk;

pub use base::{Base, MetalBase, Scattered};
pub(crate) use slab::{Slab, SlabDescription};

use crate::Bxdf;
use crate::interface::fresnel;
use crate::interface::refraction::{half_way, reflect};
use core::f32::consts::FRAC_1_PI;
use etalon_math::{DeltaProbability, float};
use etalon_sampling::warps::square_to_cosine_hemisphere;
use etalon_transport::{BsdfSample, SamplePdf, TransportMode};
use glam::{Vec2, Vec3, Vec4};
use interface::ggx;
use numbers::Numbers;
use walk::{Walk, series};

/// The part of a rough base's light that its lobe in q is thought to have; the rest is spread by the cosine.
const LOBE_SHARE: f32 = 0.75;

/// A slab over a base, at a point.
#[derive(Clone, Copy, Debug)]
pub struct Layered<B> {
    pub(crate) slab: Slab,
    pub(crate) base: B,
}

/// The parts of q, each with its probability.
struct Shares {
    /// About the mirror direction, as the interface reflects.
    top: f32,
    /// About the mirror direction, as the base is seen to reflect with the roughness `alpha`.
    lobe: f32,
    alpha: Vec2,
    /// By the cosine.
    spread: f32,
}

impl<B: Base> Layered<B> {
    /// Whether light that meets nothing but interface and base leaves in the mirror direction.
    #[inline]
    fn is_mirror(&self) -> bool {
        self.slab.interface.is_smooth() && self.base.mirrored(1.0).is_some()
    }

    /// What the interface's normal reflects at the cosine `cos`, and the refracted cosine.
    #[inline]
    fn fresnel(&self, cos: f32) -> (f32, f32) {
        fresnel::dielectric(cos.min(1.0), self.slab.interface.eta)
    }

    /// The discrete reflection: its energy per lane and its probability.
    fn atom(&self, cos: f32) -> (Vec4, f32) {
        if !self.slab.interface.is_smooth() {
            return (Vec4::ZERO, 0.0);
        }
        let (reflectance, cos_t) = self.fresnel(cos);
        let top = Vec4::splat(reflectance);
        let Some(mirrored) = self.base.mirrored(cos_t) else {
            return (top, reflectance);
        };
        let let_in = (1.0 - reflectance) * (1.0 - reflectance);
        let way = -2.0 * self.slab.thickness / cos_t.max(f32::MIN_POSITIVE);
        let once = mirrored * float::exp(way);
        // A walk to and fro k times more has 2k + 1 events.
        let again = series(once * reflectance, self.slab.max_depth.div_ceil(2));
        let energy = top + once * again * let_in;
        let probability = match self.slab.scatters() {
            true => (0.25 * energy.element_sum()).clamp(0.1, 0.9),
            false => 1.0,
        };
        (energy, probability)
    }

    fn discrete_sample(wo: Vec3, (value, probability): (Vec4, f32)) -> BsdfSample {
        BsdfSample {
            wi: reflect(wo, Vec3::Z),
            value,
            chance: SamplePdf::Discrete(DeltaProbability::uniform(probability)),
            eta: 1.0,
            is_null: false,
        }
    }

    fn shares(&self, cos: f32, discrete: f32) -> Shares {
        let is_smooth = self.slab.interface.is_smooth();
        let top = if is_smooth { 0.0 } else { self.fresnel(cos).0 };
        let below = 1.0 - discrete - top;
        // What a mirror shows through a smooth interface is discrete.
        let alpha = self.base.alpha().filter(|_| !self.is_mirror());
        let lobe = alpha.map_or(0.0, |_| LOBE_SHARE * below);
        Shares {
            top,
            lobe,
            alpha: alpha.map_or(Vec2::ONE, |alpha| self.slab.seen_alpha(alpha)),
            spread: below - lobe,
        }
    }

    /// q.
    fn density(&self, wo: Vec3, wi: Vec3) -> f32 {
        let shares = self.shares(wo.z, self.atom(wo.z).1);
        let about_mirror = |alpha: Vec2, share: f32| match half_way(wo, wi) {
            Some((m, cos)) if share > 0.0 => {
                let facets = ggx(alpha);
                share * facets.density(wo, m, facets.d(m)) / (4.0 * cos)
            }
            _ => 0.0,
        };
        about_mirror(self.slab.interface.alpha, shares.top)
            + about_mirror(shares.alpha, shares.lobe)
            + shares.spread * FRAC_1_PI * wi.z
    }

    /// The estimate of f(wo, wi)·|cos θi|.
    fn estimate(&self, wo: Vec3, wi: Vec3) -> Vec4 {
        let Slab {
            interface,
            samples,
            key,
            ..
        } = self.slab;
        let top = match interface.is_smooth() {
            true => 0.0,
            false => interface.eval(wo, wi).0,
        };
        let height = |w: Vec3| [w.z, w.x, w.y];
        let (a, b) = match height(wo) < height(wi) {
            true => (wi, wo),
            false => (wo, wi),
        };
        let directions = a.to_array().into_iter().chain(b.to_array());
        let mut numbers = Numbers::keyed(key, directions, None);
        let sum: Vec4 = (0..samples).map(|_| self.connect(a, b, &mut numbers)).sum();
        Vec4::splat(top) + sum * (wi.z / f32::from(samples))
    }
}

impl<B: Base> Bxdf for Layered<B> {
    /// The same in either mode.
    fn eval_and_density(&self, wo: Vec3, wi: Vec3, _: TransportMode) -> (Vec4, Vec4) {
        if !(wo.z > 0.0 && wi.z > 0.0 && self.has_continuous()) {
            return (Vec4::ZERO, Vec4::ZERO);
        }
        let density = self.density(wo, wi);
        if !(density > 0.0) {
            return (Vec4::ZERO, Vec4::ZERO);
        }
        (self.estimate(wo, wi), Vec4::splat(density))
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, _: TransportMode) -> Option<BsdfSample> {
        if !(wo.z > 0.0) {
            return None;
        }
        let atom = self.atom(wo.z);
        if u_lobe < atom.1 {
            return Some(Self::discrete_sample(wo, atom));
        }
        let key = wo.to_array().into_iter().chain([u_lobe]);
        let mut numbers = Numbers::keyed(self.slab.key, key, Some(u));
        let facet = self.slab.interface.facet(wo, &mut numbers)?;
        let is_smooth = self.slab.interface.is_smooth();
        let (wi, weight) = if !is_smooth && u_lobe < facet.reflectance {
            let (wi, weight) = facet.reflected()?;
            (wi, Vec4::splat(weight))
        } else {
            let (direction, weight) = facet.transmitted()?;
            let chosen = match is_smooth {
                true => (1.0 - facet.reflectance) / (1.0 - atom.1),
                false => 1.0,
            };
            let walk = Walk {
                direction,
                depth: 0.0,
                throughput: Vec4::splat(weight * chosen),
            };
            self.escape(walk, &mut numbers)?
        };
        let density = self.density(wo, wi);
        (density > 0.0).then(|| BsdfSample {
            wi,
            value: weight * density,
            chance: SamplePdf::Continuous(etalon_math::Density::uniform(density)),
            eta: 1.0,
            is_null: false,
        })
    }

    fn sample_by_density(
        &self,
        wo: Vec3,
        u_lobe: f32,
        u: Vec2,
        mode: TransportMode,
    ) -> Option<BsdfSample> {
        if !(wo.z > 0.0) {
            return None;
        }
        let atom = self.atom(wo.z);
        if u_lobe < atom.1 {
            return Some(Self::discrete_sample(wo, atom));
        }
        let shares = self.shares(wo.z, atom.1);
        let about_mirror = |alpha| reflect(wo, ggx(alpha).sample(wo, u.to_array()));
        let chosen = u_lobe - atom.1;
        let wi = if chosen < shares.top {
            about_mirror(self.slab.interface.alpha)
        } else if chosen < shares.top + shares.lobe {
            about_mirror(shares.alpha)
        } else {
            square_to_cosine_hemisphere(u)
        };
        self.continuous(wo, wi, 1.0, mode)
    }

    fn samples_by_walk(&self) -> bool {
        true
    }

    fn discrete(&self, wo: Vec3, index: u32, _: TransportMode) -> Option<BsdfSample> {
        let atom = self.atom(wo.z);
        (index == 0 && wo.z > 0.0 && atom.1 > 0.0).then(|| Self::discrete_sample(wo, atom))
    }

    fn has_continuous(&self) -> bool {
        !self.is_mirror() || self.slab.scatters()
    }

    fn has_discrete(&self) -> bool {
        self.slab.interface.is_smooth() && (self.slab.interface.eta != 1.0 || self.is_mirror())
    }

    fn transmits(&self) -> bool {
        false
    }

    fn albedo(&self, _: Vec3) -> Vec4 {
        self.base.albedo()
    }
}
