//! The classic Phong material of recursive ray tracing, which is no BSDF.
//!
//! ```text
//! L = (1 − α) (kₐ Lₐ + Σ E (k_d cos θ + kₛ cosⁿ ρ) + k_g L_mirror) + α L_refracted
//! ```
//!
//! Phong (1975), *Illumination for Computer Generated Pictures*; Whitted (1980), *An Improved
//! Illumination Model for Shaded Display*. This file only reads the parameters and looks up their
//! textures, for integrators that evaluate the model ([`Material::legacy_phong`]). As a BSDF it is
//! black, so other integrators refuse the scene.
//!
//! [`Material::legacy_phong`]: crate::Material::legacy_phong

use crate::inputs::non_negative;
use crate::interface::relative_index::RelativeIndex;
use crate::{LobeList, Material, MaterialFlags, ShadingContext};
use etalon_math::Frame;
use etalon_params::Params;
use etalon_spectrum::Wavelengths;
use etalon_transport::{Build, LegacyPhong, SpectrumKind, SurfaceInteraction, TextureId, Textures};
use glam::Vec3;

/// Nothing for the harness of scattering models.
pub const EXEMPLARS: &[&str] = &[];

/// `classicphong` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    ambient: TextureId,
    diffuse: TextureId,
    specular: TextureId,
    global: TextureId,
    exponent: TextureId,
    transparency: TextureId,
    eta: RelativeIndex,
    is_opaque: bool,
}

impl Description {
    /// Reads `ambient` (0), `diffuse` (0.5), `specular` (0), `global` (0), `exponent` (30),
    /// `transparency` (0), `int_ior` (bk7) and `ext_ior` (air).
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        // The ambient term is white light times this colour, so it is read as an emission spectrum.
        let ambient = build.texture(params, "ambient", Some(0.0), SpectrumKind::Emission);
        let mut factor =
            |name, default| build.texture(params, name, Some(default), SpectrumKind::Reflectance);
        let diffuse = factor("diffuse", 0.5);
        let specular = factor("specular", 0.0);
        let global = factor("global", 0.0);
        let transparency = factor("transparency", 0.0);
        let accepted = "a finite number not below 0";
        let exponent = non_negative(params, build, ("exponent", Some(30.0)), accepted)?;
        Some(Self {
            ambient,
            diffuse,
            specular,
            global,
            exponent,
            transparency,
            eta: RelativeIndex::from_params(params, build, "bk7")?,
            is_opaque: params.is_zero_or_absent("transparency"),
        })
    }

    /// No lobes: it does not scatter.
    pub fn traits(&self) -> MaterialFlags {
        MaterialFlags {
            transmission: !self.is_opaque,
            ..MaterialFlags::default()
        }
    }

    /// The material at a point whose normal is that of `frame`.
    pub fn resolve<T: Textures>(&self, site: &ShadingContext<'_, T>, frame: Frame) -> LegacyPhong {
        LegacyPhong {
            ambient: site.spectrum(self.ambient),
            diffuse: site.spectrum(self.diffuse),
            specular: site.spectrum(self.specular),
            global: site.spectrum(self.global),
            exponent: site.number(self.exponent).max(0.0),
            transparency: site.share(self.transparency),
            eta: self.eta.eval(site),
            normal: frame.n,
            opacity: 1.0,
        }
    }

    /// Adds nothing.
    pub fn flatten<T: Textures>(
        &self,
        _: &ShadingContext<'_, T>,
        _: Frame,
        _: f32,
        _: &mut LobeList<'_>,
    ) {
    }
}

impl Material {
    /// Whether it is, or holds, a classic Phong material, which is no scattering model.
    pub fn is_classic(&self) -> bool {
        match self {
            Self::LegacyPhong(_) => true,
            Self::Mask(mask) => mask.nested().is_classic(),
            Self::TwoSided(sides) => sides.nested().any(Self::is_classic),
            Self::NormalMap(map) => map.tilted().nested().is_classic(),
            Self::BumpMap(map) => map.tilted().nested().is_classic(),
            _ => false,
        }
    }

    /// The classic Phong material at a point for the known direction `wo`, if it is one and no scattering model.
    pub fn legacy_phong<T: Textures>(
        &self,
        textures: &T,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        wavelengths: &Wavelengths,
    ) -> Option<LegacyPhong> {
        let site = ShadingContext::new(textures, vertex, wo, wavelengths);
        self.classic(&site, vertex.shading)
    }

    /// The same within another material, which may have made the normal that of `frame`.
    pub(crate) fn classic<T: Textures>(
        &self,
        site: &ShadingContext<'_, T>,
        frame: Frame,
    ) -> Option<LegacyPhong> {
        match self {
            Self::LegacyPhong(phong) => Some(phong.resolve(site, frame)),
            Self::Mask(mask) => mask.classic(site, frame),
            Self::TwoSided(sides) => sides.classic(site, frame),
            Self::NormalMap(map) => map.classic(site, frame),
            Self::BumpMap(map) => map.classic(site, frame),
            _ => None,
        }
    }
}
