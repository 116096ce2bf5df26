//! Makes sure that shapes have what the textures of their materials and lights ask for: mesh
//! attributes, with values that these can have, and texture coordinates.

use etalon_geometry::Shape;
use etalon_params::{Class, Diagnostic, Diagnostics, Node, Span, Value, suggest};
use etalon_textures::{Texture, TextureTable};
use etalon_transport::Attribute;
use std::sync::Arc;

/// The most attributes that a message lists.
const MOST_LISTED: usize = 16;

/// The mesh attributes that textures need.
#[derive(Default)]
pub(crate) struct RequiredAttributes {
    attributes: Vec<RequiredAttribute>,
}

/// A `mesh_attribute` texture, and the values that it finds on its shapes.
struct RequiredAttribute {
    texture: Arc<Node>,
    name: String,
    /// The source position of its name.
    span: Span,
    least: f32,
    greatest: f32,
}

impl RequiredAttributes {
    /// Looks at every texture within `user`, a material or light of the shape that was described
    /// at `place`, and reports what the shape lacks.
    pub(crate) fn by(
        &mut self,
        user: &Node,
        shape: &Shape,
        place: Span,
        diagnostics: &Diagnostics,
    ) {
        for property in &user.properties {
            let Value::Object(child) = &property.value else {
                continue;
            };
            if child.class == Class::Texture {
                match child.plugin.value.as_str() {
                    "mesh_attribute" => self.attribute(child, shape, place, diagnostics),
                    "bitmap" | "checkerboard" => coordinates(child, shape, place, diagnostics),
                    _ => {}
                }
            }
            self.by(child, shape, place, diagnostics);
        }
    }

    fn attribute(
        &mut self,
        texture: &Arc<Node>,
        shape: &Shape,
        place: Span,
        diagnostics: &Diagnostics,
    ) {
        let named = texture.property("name");
        let Some((name, span)) = named.and_then(|p| match &p.value {
            Value::String(name) => Some((name, p.span)),
            _ => None,
        }) else {
            // The texture itself has said so.
            return;
        };
        let stored = shape.attributes();
        let Some(attribute) = stored.iter().find(|a| a.name == *name) else {
            diagnostics.push(missing(name, span, stored).related(place, "this shape uses it"));
            return;
        };
        let values = &attribute.values;
        let bad = values.iter().filter(|v| !v.is_finite()).count();
        if bad > 0 {
            let message = format!(
                "{bad} of the {} numbers of the mesh attribute `{name}` are not finite",
                values.len()
            );
            diagnostics.push(Diagnostic::error(span, message).related(place, "this shape uses it"));
            return;
        }
        let least = values.iter().copied().fold(f32::INFINITY, f32::min);
        let greatest = values.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        let known = (self.attributes.iter_mut()).find(|a| Arc::ptr_eq(&a.texture, texture));
        match known {
            Some(known) => {
                known.least = known.least.min(least);
                known.greatest = known.greatest.max(greatest);
            }
            None => self.attributes.push(RequiredAttribute {
                texture: Arc::clone(texture),
                name: name.clone(),
                span,
                least,
                greatest,
            }),
        }
    }

    /// Notes attributes whose values are clamped to the range of their use; to be called when all
    /// textures have been read.
    pub(crate) fn note_ranges(&self, textures: &TextureTable, diagnostics: &Diagnostics) {
        for required in &self.attributes {
            for id in textures.read_as(&required.texture) {
                if let Texture::MeshAttribute(texture) = textures.get(id) {
                    required.note_range(texture.scale, texture.range(), diagnostics);
                }
            }
        }
    }
}

impl RequiredAttribute {
    fn note_range(&self, scale: f32, [low, high]: [f32; 2], diagnostics: &Diagnostics) {
        // An excess by rounding of `scale` is not reported.
        if low <= self.least && f64::from(self.greatest) <= f64::from(high) * (1.0 + 1e-6) {
            return;
        }
        let allowed = match high == f32::MAX {
            true => "below 0 count as 0",
            false => "outside of [0, 1] count as the nearest that is inside",
        };
        let message = format!(
            "the mesh attribute `{}` goes from {} to {}; values {allowed}",
            self.name,
            self.least * scale,
            self.greatest * scale,
        );
        let note = Diagnostic::note(self.span, message);
        let may_be_bytes = self.greatest > 1.0 && self.greatest <= 255.0 && self.greatest > high;
        diagnostics.push(match may_be_bytes {
            true => note.help(
                "attributes are read as numbers, colours in bytes too, which go from 0 to 255: \
                 a `scale` of 0.003921569 takes them to [0, 1]",
            ),
            false => note,
        });
    }
}

/// The diagnostic for an attribute that is not among those that are `stored`.
fn missing(name: &str, span: Span, stored: &[Attribute]) -> Diagnostic {
    let names = || stored.iter().map(|a| a.name.as_str());
    let listed: Vec<String> = (names().take(MOST_LISTED).map(|n| format!("`{n}`"))).collect();
    let held = match listed.as_slice() {
        [] => "the shape stores none".to_owned(),
        _ if stored.len() > MOST_LISTED => format!("the shape stores {}, …", listed.join(", ")),
        _ => format!("the shape stores {}", listed.join(", ")),
    };
    let message = format!("no mesh attribute `{name}`: {held}");
    let error = Diagnostic::error(span, message).label("not stored in the shape's file");
    match suggest::nearest(name, names()) {
        Some(near) => error.help(format!("did you mean `{near}`?")),
        None => error,
    }
}

fn coordinates(texture: &Node, shape: &Shape, place: Span, diagnostics: &Diagnostics) {
    if matches!(shape, Shape::Mesh(mesh) if !mesh.has_uvs() && mesh.triangle_count() > 0) {
        diagnostics.push(
            Diagnostic::note(
                texture.plugin.span,
                format!(
                    "this `{}` is put on a mesh without texture coordinates: \
                     each triangle shows half of it",
                    texture.plugin.value
                ),
            )
            .related(place, "the mesh"),
        );
    }
}
