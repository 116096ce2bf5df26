//! `bumpmap`: a nested material whose shading normal is that of the surface displaced by a height h along its normal
//! (J. Blinn, Simulation of wrinkled surfaces, 1978), the change of the normal itself neglected:
//!
//! ```text
//! n ∝ p′ᵤ × p′ᵥ,   p′ᵤ = pᵤ + (s ∂h/∂u − nₛ·pᵤ) nₛ,   p′ᵥ likewise
//! ```
//!
//! with the shading normal nₛ and the factor s (`scale`). Mitsuba's plugin of that name; see [`crate::tilt`].

use crate::tilt::Tilted;
use crate::{LobeList, MaterialFlags, ShadingContext};
use etalon_math::Frame;
use etalon_params::{Class, Params};
use etalon_transport::{Build, LegacyPhong, SpectrumKind, TextureId, Textures};
use glam::Vec3;

/// Parameters to test with (see [`crate::test_materials`]); how heights tilt is tested in scenes.
pub const EXEMPLARS: &[&str] = &[];

/// `bumpmap` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    heights: TextureId,
    scale: f32,
    tilted: Tilted,
}

impl Description {
    /// Reads a nested texture of any name (required), `scale`, `flip_invalid_normals`, `use_shadowing_function` and a
    /// nested material.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let scale = params.float_where("scale", 1.0, "a finite number", f64::is_finite);
        let tilted = Tilted::from_params(params, build);
        let Some(heights) = params.child(Class::Texture) else {
            params.missing("texture", "a texture of heights");
            return None;
        };
        let heights = build.nested_texture(heights, SpectrumKind::Reflectance);
        Some(Self {
            heights,
            scale: scale as f32,
            tilted: tilted?,
        })
    }

    /// The flags of the nested material.
    pub fn traits(&self) -> MaterialFlags {
        self.tilted.traits()
    }

    /// The nested material with its tilt.
    pub(crate) fn tilted(&self) -> &Tilted {
        &self.tilted
    }

    /// The normal, of any length, in `frame`.
    fn normal<T: Textures>(&self, site: &ShadingContext<'_, T>, frame: Frame) -> Vec3 {
        let moved = [site.vertex.dp_du, site.vertex.dp_dv];
        let slope = site.textures.gradient(self.heights, &site.at(), moved) * self.scale;
        // Heights rise outward, seen from either side.
        let side = 1.0_f32.copysign(frame.n.dot(site.vertex.shading.n));
        let n = frame.n * side;
        let u = site.vertex.dp_du + n * (slope.x - n.dot(site.vertex.dp_du));
        let v = site.vertex.dp_dv + n * (slope.y - n.dot(site.vertex.dp_dv));
        let bumped = u.cross(v);
        let bumped = if bumped.dot(site.vertex.normal) < 0.0 {
            -bumped
        } else {
            bumped
        };
        let mut local = frame.to_local(bumped);
        local.z *= side;
        local
    }

    /// The nested classic Phong material, tilted, if it is one.
    pub fn classic<T: Textures>(
        &self,
        site: &ShadingContext<'_, T>,
        frame: Frame,
    ) -> Option<LegacyPhong> {
        self.tilted.classic(site, frame, self.normal(site, frame))
    }

    /// The nested material's lobes, tilted.
    pub fn flatten<'a, T: Textures>(
        &'a self,
        site: &ShadingContext<'_, T>,
        frame: Frame,
        weight: f32,
        into: &mut LobeList<'a>,
    ) {
        let normal = self.normal(site, frame);
        self.tilted.flatten(site, frame, weight, normal, into);
    }
}
