//! The scattering of `principled`, whose equations are in [`super`].

use crate::Bxdf;
use crate::interface::fresnel;
use crate::interface::refraction::{half_vector, reflect, refract};
use crate::lane_bsdf_at_point::{LaneBxdf, nothing};
use crate::microfacet::{Kind, Microfacet};
use crate::models::disney::{self, DisneyBase, schlick_entering};
use crate::models::roughdielectric::RoughDielectric;
use core::f32::consts::FRAC_1_PI;
use etalon_math::lane::{Lane, Mask, Select, Spectral, Vector, branch, exp, ln, sin_cos_turns};
use etalon_sampling::warps::cosine_hemisphere;
use etalon_transport::{BsdfSample, LaneBsdfSample, TransportMode};
use glam::{Vec2, Vec3, Vec4};

/// The material at a point.
#[derive(Clone, Copy, Debug)]
pub struct Principled<F: Lane = f32> {
    /// The base's colour, per wavelength.
    pub(super) colour: F::Spectrum,
    /// The same with luminance one.
    pub(super) tint: F::Spectrum,
    /// α along x and y.
    pub(super) alpha: [F; 2],
    pub(super) eta: F,
    /// m.
    pub(super) metallic: F,
    /// b.
    pub(super) through: F,
    /// (1 − m) spec_tint.
    pub(super) tinted: F,
    pub(super) roughness: F,
    pub(super) flatness: F,
    /// 1 for Lambert's diffuse base, 0 for Burley's.
    pub(super) lambert: F,
    /// (1 − m) sheen.
    pub(super) sheen: F,
    pub(super) sheen_tint: F,
    pub(super) clearcoat: F,
    pub(super) coat_alpha: F,
    pub(super) base_probability: F,
    pub(super) coat_probability: F,
}

impl<F: Lane> Principled<F> {
    #[inline(always)]
    fn microfacet(&self) -> Microfacet<F> {
        Microfacet::in_lanes(|_| Kind::Ggx, self.alpha, |_| true)
    }

    /// The base; of a fully transmitting material only its sheen remains.
    #[inline(always)]
    fn base(&self) -> DisneyBase<F> {
        DisneyBase {
            colour: self.colour * (F::ONE - self.metallic - self.through).max(F::ZERO),
            sheen: DisneyBase::<F>::sheen_colour(self.sheen, self.sheen_tint, self.tint),
            roughness: self.roughness,
            flatness: self.flatness,
        }
    }

    /// The base by Lambert's rule, below an interface that reflects `fresnel`, for a cosine to the half-way normal.
    #[inline(always)]
    fn lambert_base(&self, wi: F::Vector, cos: F, fresnel: F) -> F::Spectrum {
        let DisneyBase { colour, sheen, .. } = self.base();
        (colour * ((F::ONE - fresnel) * FRAC_1_PI) + sheen * disney::schlick(cos)) * wi.z()
    }

    /// F_p, for a cosine to the half-way normal and the dielectric's reflectance.
    #[inline(always)]
    fn fresnel(&self, cos: F, dielectric: F) -> F::Spectrum {
        // Σ w S(R) = Σ wR + (Σ w − Σ wR)(1 − cos θ)⁵.
        let normal = self.colour * self.metallic
            + self.tint * (self.tinted * disney::normal_reflectance(self.eta));
        let weight = self.metallic + self.tinted;
        let grazing = F::Spectrum::uniform(weight) - normal;
        let schlick = normal + grazing * schlick_entering(cos, self.eta);
        schlick + (F::ONE - weight) * dielectric
    }

    /// The interface from the side of `wo`.
    #[inline(always)]
    fn rough(&self) -> RoughDielectric<F> {
        RoughDielectric {
            eta: F::Spectrum::uniform(self.eta),
            reflectance: F::Spectrum::uniform(F::ONE),
            transmittance: self.colour.at_least(F::ZERO).square_roots() * self.through,
            microfacet: self.microfacet(),
        }
    }

    /// The probability that the main interface is sampled, in front.
    #[inline(always)]
    fn interface_probability(&self) -> F {
        (F::ONE - self.base_probability - self.coat_probability).max(F::ZERO)
    }

    /// D₁.
    #[inline(always)]
    fn coat_d(&self, m: F::Vector) -> F {
        let a2 = self.coat_alpha * self.coat_alpha;
        let area = (a2 - 1.0) * m.z() * m.z() + 1.0;
        (a2 - 1.0) * FRAC_1_PI / (ln(a2) * area)
    }

    /// A normal of the clear coat, with the density D₁ cos θ.
    #[inline(always)]
    fn coat_normal(&self, [u, v]: [F; 2]) -> F::Vector {
        let a2 = self.coat_alpha * self.coat_alpha;
        let cos2 = (F::ONE - exp(ln(a2) * (F::ONE - v))) / (F::ONE - a2);
        let (sin, cos) = sin_cos_turns(u);
        let radius = (F::ONE - cos2).safe_sqrt();
        F::Vector::from_xyz(cos * radius, sin * radius, cos2.safe_sqrt())
    }

    /// The value and the density of the clear coat for two directions in front, and the normal half-way.
    #[inline(always)]
    fn coat(&self, wo: F::Vector, wi: F::Vector, (m, cos): (F::Vector, F)) -> (F, F) {
        let d = self.coat_d(m);
        let coat = Microfacet::<F>::in_lanes(|_| Kind::Ggx, [F::splat(0.25); 2], |_| true);
        let fresnel = schlick_entering(cos, self.eta) * 0.96 + 0.04;
        let shadowing = coat.g1(wo, m) * coat.g1(wi, m);
        (
            self.clearcoat * 0.25 * fresnel * d * shadowing * wi.z(),
            self.coat_probability * d * m.z() / (cos * 4.0),
        )
    }

    /// Two directions in front.
    #[inline(always)]
    fn front(&self, wo: F::Vector, wi: F::Vector) -> (F::Spectrum, F::Spectrum) {
        let (has_normal, m, cos) = half_vector::<F>(wo, wi);
        let fresnel = fresnel::dielectric(cos, self.eta).0;
        let base = branch!(
            self.lambert.gt(F::ZERO),
            // Where there is no normal half-way, it is at right angles to both.
            self.lambert_base(
                wi,
                has_normal.select(cos, F::ZERO),
                has_normal.select(fresnel, F::ONE)
            ),
            self.base().eval(wo, wi)
        );
        let microfacet = self.microfacet();
        let d = microfacet.d(m);
        let shadowing = microfacet.g1(wo, m) * microfacet.g1(wi, m);
        let value = base + self.fresnel(cos, fresnel) * (d * shadowing / (wo.z() * 4.0));
        let reflects = F::ONE - self.through * (F::ONE - fresnel);
        let normals = self.interface_probability() * reflects * microfacet.density(wo, m, d);
        let (coat, coat_density) = branch!(
            self.clearcoat.gt(F::ZERO),
            self.coat(wo, wi, (m, cos)),
            (F::ZERO, F::ZERO)
        );
        let density = normals / (cos * 4.0) + coat_density;
        let (value, density) = has_normal.select((value + coat, density), (base, F::ZERO));
        let diffuse = self.base_probability * wi.z() * FRAC_1_PI;
        (value, F::Spectrum::uniform(diffuse + density))
    }

    /// Two directions of which one at least is behind.
    #[inline(always)]
    fn behind(
        &self,
        wo: F::Vector,
        wi: F::Vector,
        mode: TransportMode,
    ) -> (F::Spectrum, F::Spectrum) {
        let passes = self.through.gt(F::ZERO);
        if !passes.any() {
            return nothing::<F>();
        }
        let (value, density) = self.rough().eval_in(wo, wi, mode);
        let from_below = wo.z().lt(F::ZERO);
        let mirrored = from_below & wi.z().lt(F::ZERO);
        let entered = self.interface_probability() * self.through;
        let value = value * mirrored.select(self.through, F::ONE);
        let density = density * from_below.select(F::ONE, entered);
        passes.select((value, density), nothing::<F>())
    }

    /// [`Bxdf::eval_and_density`] in lanes.
    #[inline(always)]
    fn eval_in(
        &self,
        wo: F::Vector,
        wi: F::Vector,
        mode: TransportMode,
    ) -> (F::Spectrum, F::Spectrum) {
        let in_front = wo.z().gt(F::ZERO) & wi.z().gt(F::ZERO);
        branch!(in_front, self.front(wo, wi), self.behind(wo, wi, mode))
    }

    /// A direction for `wo` in front, found through a normal of the coat or of the interface, and the relative index passed.
    /// Where light is lost, since it would leave on the wrong side, the direction is 0.
    #[inline(always)]
    fn through_normal(&self, wo: F::Vector, u_lobe: F, u: [F; 2]) -> (F::Vector, F) {
        let before = self.base_probability + self.coat_probability;
        let of_coat = u_lobe.lt(before);
        let m = branch!(
            of_coat,
            self.coat_normal(u),
            self.microfacet().sample(wo, u)
        );
        let cos = wo.dot_product(m);
        let visible = cos.gt(F::ZERO);
        let lost = F::Vector::broadcast(Vec3::ZERO);
        let reflected = reflect(wo, m);
        let leaves = (of_coat | visible) & reflected.z().gt(F::ZERO);
        let reflected = (leaves.select(reflected, lost), F::ONE);
        if !self.through.gt(F::ZERO).any() {
            return reflected;
        }
        let (fresnel, cos_t) = fresnel::dielectric(cos, self.eta);
        let u_lobe = (u_lobe - before) / (F::ONE - before);
        let refracts = !of_coat & u_lobe.ge(F::ONE - self.through * (F::ONE - fresnel));
        let refracted = refract(wo, m, self.eta, cos_t);
        let enters = visible & refracted.z().lt(F::ZERO);
        refracts.select((enters.select(refracted, lost), self.eta), reflected)
    }

    /// A direction for `wo` behind, and the relative index passed; 0 where there is none.
    #[inline(always)]
    fn seen_from_behind(
        &self,
        wo: F::Vector,
        u_lobe: F,
        u: [F; 2],
        mode: TransportMode,
    ) -> (F::Vector, F) {
        let none = F::Vector::broadcast(Vec3::ZERO);
        if !self.through.gt(F::ZERO).any() {
            return (none, F::ONE);
        }
        let sample = self.rough().sample_in(wo, u_lobe, u, mode);
        (sample.found.select(sample.wi, none), sample.eta)
    }

    /// [`Bxdf::sample`] in lanes.
    #[inline(always)]
    fn sample_in(
        &self,
        wo: F::Vector,
        u_lobe: F,
        u: [F; 2],
        mode: TransportMode,
    ) -> LaneBsdfSample<F> {
        let (wi, eta) = branch!(
            wo.z().gt(F::ZERO),
            branch!(
                u_lobe.lt(self.base_probability),
                (cosine_hemisphere::<F>(u), F::ONE),
                self.through_normal(wo, u_lobe, u)
            ),
            self.seen_from_behind(wo, u_lobe, u, mode)
        );
        LaneBsdfSample::continuous(wi, self.eval_in(wo, wi, mode), eta)
    }
}

impl<F: Lane> LaneBxdf<F> for Principled<F> {
    const CONTINUOUS: bool = true;
    // One that does is of no kind.
    const TRANSMITS: bool = false;

    #[inline(always)]
    fn eval_lanes(&self, wo: F::Vector, wi: F::Vector) -> (F::Spectrum, F::Spectrum) {
        self.eval_in(wo, wi, TransportMode::Radiance)
    }

    #[inline(always)]
    fn sample_lanes(&self, wo: F::Vector, u_lobe: F, u: [F; 2]) -> LaneBsdfSample<F> {
        self.sample_in(wo, u_lobe, u, TransportMode::Radiance)
    }

    #[inline(always)]
    fn albedo_lanes(&self, _: F::Vector) -> F::Spectrum {
        self.colour
    }
}

impl Bxdf for Principled {
    fn eval_and_density(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> (Vec4, Vec4) {
        self.eval_in(wo, wi, mode)
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        self.sample_in(wo, u_lobe, u.to_array(), mode).only()
    }

    fn has_continuous(&self) -> bool {
        true
    }

    fn has_discrete(&self) -> bool {
        false
    }

    fn transmits(&self) -> bool {
        self.through > 0.0
    }

    fn albedo(&self, wo: Vec3) -> Vec4 {
        self.albedo_lanes(wo)
    }
}
