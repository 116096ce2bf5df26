//! `mixture`: a stochastic mixture of diffuse scattering, perfect reflection and refraction.
//!
//! ```text
//! f(wo, wi) = d · ρd / π  +  r · ρs δ(wi = mirror of wo) / |cos θi|  +  t · f_dielectric(wo, wi)       d + r + t = 1
//! ```
//!
//! Whitted (1980), *An Improved Illumination Model for Shaded Display*, with the choice by chance of Cook (1986),
//! *Stochastic Sampling in Computer Graphics*: one of the three is chosen with its share as probability. Within the
//! refractive share Fresnel's equations decide between reflection and refraction, as in [`crate::models::dielectric`].
//! Diffuse light stays on the side that it came from, inside and outside.

use crate::models::dielectric::{self, Dielectric};
use crate::models::diffuse;
use crate::models::mirror;
use crate::{AnyBxdf, LobeList, MaterialFlags, ShadingContext};
use etalon_math::Frame;
use etalon_params::{Params, Value};
use etalon_transport::{Build, SpectrumKind, TextureId, Textures};

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &[
    "mixture diffuse=f:0.5 reflective=f:0.2 refractive=f:0.3",
    "mixture diffuse=f:0.6 diffuse_reflectance=t:400:0.2,700:0.8 reflective=f:0.4 specular_reflectance=u:0.9",
    "mixture diffuse=f:0.25 refractive=f:0.75 int_ior=s:cauchy:1.5,0.01 specular_transmittance=u:0.7",
];

/// The parameters of the three shares.
const SHARES: [&str; 3] = ["diffuse", "reflective", "refractive"];

/// Tolerance on the sum of the shares, for rounding in the file.
const ROUNDING: f64 = 1e-4;

/// `mixture` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    /// d, r and t.
    shares: [TextureId; 3],
    /// ρd.
    diffuse: TextureId,
    /// ρs.
    reflective: TextureId,
    /// Whether each lobe is present.
    present: [bool; 3],
    dielectric: dielectric::Description,
}

impl Description {
    /// Reads the shares `diffuse`, `reflective` and `refractive` (0 where absent), the colours `diffuse_reflectance`
    /// (0.5), `specular_reflectance` (1), `specular_transmittance` (1), and `int_ior` (bk7), `ext_ior` (air).
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let mut constant = Some(0.0);
        let mut present = [false; 3];
        for (name, present) in SHARES.into_iter().zip(&mut present) {
            let number = match params.property(name).map(|property| &property.value) {
                None => Some(0.0),
                Some(Value::Float(number)) => Some(*number),
                Some(Value::Integer(number)) => Some(*number as f64),
                // A texture is known only at a point.
                Some(_) => None,
            };
            if let Some(number) = number.filter(|number| !(0.0..=1.0).contains(number)) {
                params.refuse(name, number, "a share from 0 to 1");
                return None;
            }
            *present = number != Some(0.0);
            constant = constant.zip(number).map(|(sum, number)| sum + number);
        }
        if let Some(sum) = constant.filter(|sum| (sum - 1.0).abs() > ROUNDING) {
            let sum = sum as f32;
            params.error(format!(
                "the shares `diffuse`, `reflective` and `refractive` add up to {sum}, not to 1"
            ));
            return None;
        }
        let mut texture =
            |name, default| build.texture(params, name, Some(default), SpectrumKind::Reflectance);
        let shares = SHARES.map(|name| texture(name, 0.0));
        let diffuse = texture("diffuse_reflectance", 0.5);
        let reflective = texture("specular_reflectance", 1.0);
        Some(Self {
            shares,
            diffuse,
            reflective,
            present,
            dielectric: dielectric::Description::from_params(params, build)?,
        })
    }

    /// A diffuse lobe and a specular one, which transmits if anything is refracted.
    pub fn traits(&self) -> MaterialFlags {
        MaterialFlags {
            lobes: usize::from(self.present[0]) + usize::from(self.present[1] || self.present[2]),
            transmission: self.present[2],
            refraction: self.present[2],
            ..MaterialFlags::default()
        }
    }

    /// The three shares at a point. Textures whose shares do not add up to one are normalised.
    pub fn flatten<'a, T: Textures>(
        &'a self,
        site: &ShadingContext<'_, T>,
        frame: Frame,
        weight: f32,
        into: &mut LobeList<'a>,
    ) {
        let shares = self.shares.map(|share| site.share(share));
        let sum: f32 = shares.iter().sum();
        if !(sum > 0.0) {
            return;
        }
        let [diffuse, reflective, refractive] = shares.map(|share| weight * share / sum);
        let toward = match frame.n.dot(site.wo) < 0.0 {
            true => frame.flipped(),
            false => frame,
        };
        let lambert = diffuse::Diffuse {
            reflectance: site.spectrum(self.diffuse),
        };
        into.push(AnyBxdf::Diffuse(lambert), toward, diffuse, diffuse);
        let specular = reflective + refractive;
        if refractive > 0.0 {
            // Both reflect in the same direction: one lobe, whose Fresnel term has the mirror's share.
            let glass = Dielectric {
                mirrored: reflective / specular,
                ..self.dielectric.resolve(site)
            };
            into.push(AnyBxdf::Dielectric(glass), frame, specular, specular);
        } else {
            let reflectance = site.spectrum(self.reflective);
            let mirror = AnyBxdf::Mirror(mirror::Mirror { reflectance });
            into.push(mirror, frame, specular, specular);
        }
    }
}
