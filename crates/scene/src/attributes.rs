//! Makes sure that shapes have the mesh attributes for which their materials and lights ask.

use etalon_geometry::Shape;
use etalon_params::{Class, Diagnostic, Diagnostics, Node, Span, Value};

/// Reports every `mesh_attribute` texture within `user`, a material or light of the shape that
/// was described at `place`, which names an attribute that the shape does not have.
pub(crate) fn check(shape: &Shape, place: Span, user: &Node, diagnostics: &Diagnostics) {
    for property in &user.properties {
        let Value::Object(child) = &property.value else {
            continue;
        };
        if child.class == Class::Texture && child.plugin.value == "mesh_attribute" {
            check_texture(shape, place, child, diagnostics);
        }
        check(shape, place, child, diagnostics);
    }
}

fn check_texture(shape: &Shape, place: Span, texture: &Node, diagnostics: &Diagnostics) {
    let named = texture.properties.iter().find(|p| p.name == "name");
    let Some((name, span)) = named.and_then(|p| match &p.value {
        Value::String(name) => Some((name, p.span)),
        _ => None,
    }) else {
        // The texture itself has said so.
        return;
    };
    let found = match shape {
        Shape::Mesh(mesh) => mesh.has_attribute(name),
        _ => false,
    };
    if !found {
        diagnostics.push(
            Diagnostic::error(span, format!("no mesh attribute `{name}`"))
                .label("not stored in the shape's file")
                .related(place, "this shape uses it"),
        );
    }
}
