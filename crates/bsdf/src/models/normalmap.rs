//! `normalmap`: a nested material whose shading normal a texture gives,
//!
//! ```text
//! n = 2 c − 1        in the surface's shading frame, c the texture's three channels
//! ```
//!
//! Mitsuba's plugin of that name; see [`crate::tilt`].

use crate::tilt::Tilted;
use crate::{LobeList, MaterialFlags, ShadingContext};
use etalon_math::Frame;
use etalon_params::{Class, Diagnostic, Params, Value};
use etalon_transport::{Build, LegacyPhong, SpectrumKind, TextureId, Textures};
use glam::Vec3;

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &[
    "normalmap normalmap=u:0.8 ( diffuse )",
    "normalmap normalmap=u:0.75 use_shadowing_function=b:false ( roughconductor alpha=f:0.3 )",
    "normalmap normalmap=u:0.7 ( roughplastic alpha=f:0.2 )",
];

/// `normalmap` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    normals: TextureId,
    tilted: Tilted,
}

impl Description {
    /// Reads `normalmap` (required, raw), `flip_invalid_normals`, `use_shadowing_function` and a nested material.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let property = params
            .node
            .properties
            .iter()
            .find(|p| p.name == "normalmap");
        if let Some(Value::Object(node)) = property.map(|p| &p.value)
            && node.class == Class::Texture
            && node.plugin.value == "bitmap"
            && !Params::new(node, params.diagnostics).boolean_or("raw", false)
        {
            let message = "the image of a normal map holds numbers, not colours";
            let help = "add `<boolean name=\"raw\" value=\"true\"/>`";
            let diagnostic = Diagnostic::error(node.plugin.span, message).help(help);
            params.diagnostics.push(diagnostic);
        }
        let normals = build.texture(params, "normalmap", None, SpectrumKind::Reflectance);
        let tilted = Tilted::from_params(params, build)?;
        Some(Self { normals, tilted })
    }

    /// The flags of the nested material.
    pub fn traits(&self) -> MaterialFlags {
        self.tilted.traits()
    }

    /// The nested material with its tilt.
    pub(crate) fn tilted(&self) -> &Tilted {
        &self.tilted
    }

    /// The normal, of any length, in the surface's frame.
    fn normal<T: Textures>(&self, site: &ShadingContext<'_, T>) -> Vec3 {
        site.textures.colour(self.normals, &site.at()) * 2.0 - 1.0
    }

    /// The nested classic Phong material, tilted, if it is one.
    pub fn classic<T: Textures>(
        &self,
        site: &ShadingContext<'_, T>,
        frame: Frame,
    ) -> Option<LegacyPhong> {
        self.tilted.classic(site, frame, self.normal(site))
    }

    /// The nested material's lobes, tilted.
    pub fn flatten<'a, T: Textures>(
        &'a self,
        site: &ShadingContext<'_, T>,
        frame: Frame,
        weight: f32,
        into: &mut LobeList<'a>,
    ) {
        (self.tilted).flatten(site, frame, weight, self.normal(site), into);
    }
}
