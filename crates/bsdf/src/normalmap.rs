//! `normalmap`: a nested material whose shading normal a texture gives,
//!
//! ```text
//! n = 2 c − 1        in the surface's shading frame, c the texture's three channels
//! ```
//!
//! Mitsuba's plugin of that name; see [`crate::tilt`].

use crate::tilt::Tilt;
use crate::{LobeList, Material, MaterialFlags, ShadingContext};
use etalon_math::Frame;
use etalon_params::{Class, Diagnostic, Params, Value};
use etalon_transport::{Build, SpectrumKind, TextureId, Textures};

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
    flips: bool,
    shadows: bool,
    nested: Box<Material>,
}

/// Reads `flip_invalid_normals`, `use_shadowing_function` and the nested material.
pub(crate) fn read_tilted(
    params: &Params<'_>,
    build: &mut dyn Build,
) -> Option<(bool, bool, Box<Material>)> {
    let flips = params.boolean_or("flip_invalid_normals", true);
    let shadows = params.boolean_or("use_shadowing_function", true);
    let [nested] = Material::nested::<1>(params, build)?;
    if nested.traits().tilted {
        let name = &params.node.plugin.value;
        params.error(format!(
            "`{name}` cannot hold another material that tilts normals"
        ));
        return None;
    }
    Some((flips, shadows, Box::new(nested)))
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
        let (flips, shadows, nested) = read_tilted(params, build)?;
        Some(Self {
            normals,
            flips,
            shadows,
            nested,
        })
    }

    /// What the nested material can do.
    pub fn traits(&self) -> MaterialFlags {
        MaterialFlags {
            tilted: true,
            ..self.nested.traits()
        }
    }

    /// The nested material's lobes, tilted.
    pub fn flatten<'a, T: Textures>(
        &'a self,
        site: &ShadingContext<'_, T>,
        frame: Frame,
        weight: f32,
        into: &mut LobeList<'a>,
    ) {
        let normal = site.textures.colour(self.normals, &site.at) * 2.0 - 1.0;
        let tilt = Tilt::new(normal, self.flips, self.shadows);
        into.tilted(tilt, |into| self.nested.flatten(site, frame, weight, into));
    }
}
