//! What materials emit (glTF 2.0, §3.9.3; KHR_materials_emissive_strength, KHR_materials_unlit): `area`.
//!
//! The strength is the radiance, as Blender's importer has it: glTF's unit is the nit, and nothing says how many of them are white. Where a
//! surface is not opaque, its light is covered as its colour is.

use super::materials::{Maker, coloured};
use super::textures::{Look, product};
use crate::draft::{Draft, Given, given, times};
use etalon_params::{Class, DVec3, Node, Value};
use std::sync::Arc;

impl Maker<'_, '_> {
    /// The light, if there is any; the outer `None` is after a mistake.
    pub(crate) fn emitter(
        &mut self,
        colour: &Option<Given>,
        opacity: &Option<Option<Given>>,
    ) -> Option<Option<Arc<Node>>> {
        let extensions = self.material.extensions.as_ref();
        let unlit = extensions.is_some_and(|e| e.unlit.is_some());
        let strength = extensions.and_then(|e| e.emissive_strength.as_ref());
        let strength = strength.map_or(1.0, |strength| f64::from(strength.emissive_strength.0));
        let factor = DVec3::from(self.material.emissive_factor.0.map(f64::from)) * strength;
        let span = self.span("emissiveFactor");
        let radiance = if unlit {
            let message =
                "KHR_materials_unlit: the surface shines with its colour, on other things as well";
            let path = format!("{}.extensions.KHR_materials_unlit", self.path);
            self.reader.note(&path, message);
            colour.clone()?
        } else if factor == DVec3::ZERO {
            return Some(None);
        } else {
            let texture = match self.material.emissive_texture.clone() {
                Some(info) => {
                    let sample = self.sample("emissiveTexture", &info);
                    Some(self.reader.bitmap(&sample, Look::Colour)?)
                }
                None => None,
            };
            // Products of colours are at most 1, lights are not.
            let most = factor.max_element();
            match texture {
                Some(texture) => times(coloured(Some(texture), factor / most, span), most),
                None => given(Value::Rgb(factor), span),
            }
        };
        if self.material.double_sided && !unlit {
            let message = "a surface shines in front only, although `doubleSided`";
            self.reader
                .note(&format!("{}.doubleSided", self.path), message);
        }
        let radiance = match opacity.clone()? {
            Some(opacity) => product(opacity, radiance),
            None => radiance,
        };
        let radiance = match radiance.value {
            // A texture alone would not be multiplied by the white of its colours.
            Value::Object(texture) => {
                let lit = Draft::new(Class::Texture, "d65", radiance.span);
                lit.child(texture).value()
            }
            value => given(value, radiance.span),
        };
        let draft = Draft::new(Class::Emitter, "area", span);
        Some(Some(draft.given("radiance", radiance).node()))
    }
}
