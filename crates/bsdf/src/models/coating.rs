//! A clear coat, smooth or rough, over another material; Mitsuba 0.6's `coating` and `roughcoating`.
//!
//! ```text
//! f(wo, wi) cos θi = f_coat cos θi + T(θo) T(θi) exp(−σ (1/cos θo' + 1/cos θi')) f_base(wo', wi') cos θi' · cos θi / (η² cos θi')
//! ```
//!
//! w' is w refracted into the coat, T what the interface lets through, σ the coat's absorption times its thickness.
//! The last factor is dω'/dω. Light that the base sends to the interface and that is reflected there is lost, as in
//! Weidlich and Wilkie (2007), *Arbitrarily Layered Micro-Facet Surfaces*. A smooth coat reflects by Fresnel's
//! equations, a rough one as facets do; its T is tabulated ([`crate::interface::rough_fresnel`]).

use crate::interface::fresnel;
use crate::interface::relative_index::RelativeIndex;
use crate::interface::rough_fresnel::RoughFresnel;
use crate::microfacet::Microfacet;
use crate::microfacet::roughness;
use crate::models::conductor::Conductor;
use crate::models::diffuse::Diffuse;
use crate::models::mirror::Mirror;
use crate::models::phong::Phong;
use crate::models::roughconductor::RoughConductor;
use crate::models::roughdiffuse::RoughDiffuse;
use crate::models::ward::Ward;
use crate::{AnyBxdf, Bxdf, LobeList, Material, MaterialFlags, ShadingContext};
use etalon_math::{Frame, float};
use etalon_params::Params;
use etalon_transport::{BsdfSample, Build, SpectrumKind, TextureId, Textures, TransportMode};
use glam::{Vec2, Vec3, Vec4};

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &[
    "coating ( diffuse reflectance=t:400:0.2,700:0.9 )",
    "coating int_ior=f:1.8 thickness=f:0.5 sigma_a=t:400:0.1,700:1 ( roughconductor alpha=f:0.3 eta=u:0.2 k=u:3.9 )",
    "coating sigma_a=u:0.2 specular_reflectance=u:0.7 ( conductor )",
    "coating ( phong exponent=f:20 )",
];

/// The probability of sampling the coat's own reflection: the same for every direction, since the way back must have it.
const COAT_SHARE: f32 = 0.3;

/// The materials that can be coated.
const COATABLE: &str =
    "`diffuse`, `roughdiffuse`, `conductor`, `roughconductor`, `phong` and `ward`";

/// `coating` or `roughcoating` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    base: Box<Material>,
    eta: f32,
    thickness: f32,
    absorption: TextureId,
    specular: TextureId,
    rough: Option<Box<(Microfacet, RoughFresnel)>>,
}

impl Description {
    /// Reads `int_ior` (bk7), `ext_ior` (air), `thickness` (1), `sigma_a` (0), `specular_reflectance` (1) and the
    /// material underneath.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        Self::read(params, build, None)
    }

    /// The same for a rough coat, with `distribution` (beckmann) and `alpha` (0.1, one number).
    pub(crate) fn rough(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let microfacet = roughness::constant_from_params(params);
        Self::read(params, build, Some(microfacet))
    }

    fn read(params: &Params<'_>, build: &mut dyn Build, rough: Option<Microfacet>) -> Option<Self> {
        let eta = RelativeIndex::constant_from_params(params, "bk7")? as f32;
        let what = "a finite number not below 0";
        let thickness = params.float_where("thickness", 1.0, what, |x| x >= 0.0 && x.is_finite());
        let absorption = build.texture(params, "sigma_a", Some(0.0), SpectrumKind::Unbounded);
        let specular = build.texture(
            params,
            "specular_reflectance",
            Some(1.0),
            SpectrumKind::Reflectance,
        );
        let [base] = Material::nested(params, build)?;
        if !coatable(&base) {
            let name = &params.node.plugin.value;
            params.error(format!("`{name}` is over {COATABLE} only"));
            return None;
        }
        Some(Self {
            base: Box::new(base),
            eta,
            thickness: thickness as f32,
            absorption,
            specular,
            rough: rough.map(|facets| Box::new((facets, RoughFresnel::new(facets, eta)))),
        })
    }

    /// The material's flags.
    pub fn traits(&self) -> MaterialFlags {
        MaterialFlags {
            lobes: 2,
            ..MaterialFlags::default()
        }
    }

    /// The coat's reflection, and the base seen through it.
    pub fn flatten<'a, T: Textures>(
        &'a self,
        site: &ShadingContext<'_, T>,
        frame: Frame,
        weight: f32,
        into: &mut LobeList<'a>,
    ) {
        let wo = frame.to_local(site.wo);
        let Some(inner) = refracted(wo, self.eta).filter(|_| wo.z > 0.0) else {
            return;
        };
        let layer = Layer {
            eta: self.eta,
            rough: self.rough.as_deref().map(|(_, interface)| interface),
            absorption: site.spectrum(self.absorption).max(Vec4::ZERO) * self.thickness,
        };
        let through = layer.transmittance(wo.z);
        let below = ShadingContext {
            wo: frame.to_world(inner),
            ..*site
        };
        let specular = site.spectrum(self.specular);
        let base = match &*self.base {
            Material::Diffuse(base) => Base::Diffuse(base.resolve(&below)),
            Material::RoughDiffuse(base) => Base::RoughDiffuse(base.resolve(&below)),
            Material::RoughConductor(base) => Base::RoughConductor(base.resolve(&below)),
            Material::Phong(base) => Base::Phong(base.resolve(&below)),
            Material::Ward(base) => Base::Ward(base.resolve(&below)),
            Material::Conductor(base) => Base::Conductor(base.resolve(&below)),
            _ => return,
        };
        let coated = Coated { layer, base };
        if let Some((facets, _)) = self.rough.as_deref() {
            let coat = RoughConductor {
                eta: Vec4::splat(self.eta),
                k: Vec4::ZERO,
                reflectance: specular,
                microfacet: *facets,
            };
            into.push(
                AnyBxdf::RoughConductor(coat),
                frame,
                weight,
                weight * COAT_SHARE,
            );
            into.push(
                AnyBxdf::Coated(coated),
                frame,
                weight,
                weight * (1.0 - COAT_SHARE),
            );
            return;
        }
        let mut reflectance = specular * (1.0 - through);
        if let Base::Conductor(mirror) = &coated.base {
            // Both mirrors have the same direction: one lobe has the light of both.
            let found = mirror.discrete(inner, 0, TransportMode::Radiance);
            let value = found.map_or(Vec4::ZERO, |sample| sample.value);
            reflectance += value * coated.layer.both_ways(wo, inner, wo, inner);
            let mirror = Mirror { reflectance };
            into.push(AnyBxdf::Mirror(mirror), frame, weight, weight);
            return;
        }
        let mirror = Mirror { reflectance };
        into.push(AnyBxdf::Mirror(mirror), frame, weight, weight * COAT_SHARE);
        into.push(
            AnyBxdf::Coated(coated),
            frame,
            weight,
            weight * (1.0 - COAT_SHARE),
        );
    }
}

fn coatable(base: &Material) -> bool {
    matches!(
        base,
        Material::Diffuse(_)
            | Material::RoughDiffuse(_)
            | Material::RoughConductor(_)
            | Material::Conductor(_)
            | Material::Phong(_)
            | Material::Ward(_)
    )
}

/// Refracts a direction that leaves the point through the interface; `None` under total internal reflection.
#[inline]
fn refracted(v: Vec3, eta: f32) -> Option<Vec3> {
    let across = v.truncate() / eta;
    let rest = 1.0 - across.length_squared();
    (rest > 0.0).then(|| across.extend(rest.sqrt()))
}

/// The coat at a point.
#[derive(Clone, Copy, Debug)]
pub struct Layer<'a> {
    eta: f32,
    /// Transmittance of a rough interface.
    rough: Option<&'a RoughFresnel>,
    /// Absorption times thickness, per lane.
    absorption: Vec4,
}

impl Layer<'_> {
    /// T at the cosine `cos` outside.
    #[inline]
    fn transmittance(&self, cos: f32) -> f32 {
        match self.rough {
            Some(interface) => RoughFresnel::transmittance([interface], cos),
            None => 1.0 - fresnel::dielectric(cos.min(1.0), self.eta).0,
        }
    }

    /// Transmittance of the coating on the way in and out: Fresnel or rough transmittance, and absorption.
    #[inline]
    fn both_ways(&self, wo: Vec3, inner_o: Vec3, wi: Vec3, inner_i: Vec3) -> Vec4 {
        let way = -(1.0 / inner_o.z + 1.0 / inner_i.z);
        let left = (self.absorption * way).to_array().map(float::exp);
        Vec4::from_array(left) * (self.transmittance(wo.z) * self.transmittance(wi.z))
    }
}

/// The material under the coating.
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs)]
pub enum Base {
    Diffuse(Diffuse),
    RoughDiffuse(RoughDiffuse),
    RoughConductor(RoughConductor),
    Conductor(Conductor),
    Phong(Phong),
    Ward(Ward),
}

/// Dispatches to the base.
macro_rules! ask {
    ($base:expr, $it:ident => $answer:expr) => {
        match $base {
            Base::Diffuse($it) => $answer,
            Base::RoughDiffuse($it) => $answer,
            Base::RoughConductor($it) => $answer,
            Base::Conductor($it) => $answer,
            Base::Phong($it) => $answer,
            Base::Ward($it) => $answer,
        }
    };
}

/// A material as seen through a coat.
#[derive(Clone, Copy, Debug)]
pub struct Coated<'a> {
    layer: Layer<'a>,
    base: Base,
}

impl Coated<'_> {
    /// A discrete sample of the base, outside; `None` if the coat reflects it back.
    fn out(&self, wo: Vec3, o: Vec3, sample: BsdfSample) -> Option<BsdfSample> {
        let wi = refracted(sample.wi, 1.0 / self.layer.eta).filter(|_| sample.wi.z > 0.0)?;
        Some(BsdfSample {
            wi,
            value: sample.value * self.layer.both_ways(wo, o, wi, sample.wi),
            ..sample
        })
    }
}

impl Bxdf for Coated<'_> {
    fn eval_and_density(&self, wo: Vec3, wi: Vec3, mode: TransportMode) -> (Vec4, Vec4) {
        let eta = self.layer.eta;
        let inside = refracted(wo, eta).zip(refracted(wi, eta));
        let Some((o, i)) = inside.filter(|_| wo.z > 0.0 && wi.z > 0.0) else {
            return (Vec4::ZERO, Vec4::ZERO);
        };
        let (value, density) = ask!(&self.base, base => base.eval_and_density(o, i, mode));
        let jacobian = wi.z / (eta * eta * i.z);
        let left = self.layer.both_ways(wo, o, wi, i);
        (value * left * jacobian, density * jacobian)
    }

    fn sample(&self, wo: Vec3, u_lobe: f32, u: Vec2, mode: TransportMode) -> Option<BsdfSample> {
        let o = refracted(wo, self.layer.eta).filter(|_| wo.z > 0.0)?;
        let sample = ask!(&self.base, base => base.sample(o, u_lobe, u, mode))?;
        if sample.chance.is_delta() {
            return self.out(wo, o, sample);
        }
        let wi = refracted(sample.wi, 1.0 / self.layer.eta).filter(|_| sample.wi.z > 0.0)?;
        self.continuous(wo, wi, 1.0, mode)
    }

    fn discrete(&self, wo: Vec3, index: u32, mode: TransportMode) -> Option<BsdfSample> {
        let o = refracted(wo, self.layer.eta).filter(|_| wo.z > 0.0)?;
        let sample = ask!(&self.base, base => base.discrete(o, index, mode))?;
        self.out(wo, o, sample)
    }

    fn has_continuous(&self) -> bool {
        ask!(&self.base, base => base.has_continuous())
    }

    fn has_discrete(&self) -> bool {
        ask!(&self.base, base => base.has_discrete())
    }

    fn transmits(&self) -> bool {
        false
    }
}
