//! `displacement`: a shape moved along its normal by a texture, as fine triangles (see [`Shape::displaced`]).

use crate::builder::Builder;
use crate::surfaces::COMPOSED;
use etalon_geometry::shapes::csg::Operation;
use etalon_geometry::{GeometryBuilder, Shape};
use etalon_params::{Class, Diagnostic, Params, Value, plugins};
use etalon_transport::{Build, SpectrumKind, TexturePoint};
use glam::{Vec2, Vec3};

/// Its name in a scene file.
pub(crate) const NAME: &str = "displacement";

/// What the moved shape has in common with every other, and so belongs to the `displacement`.
const NOT_OF_THE_SHAPE: [Class; 4] = [
    Class::Bsdf,
    Class::Emitter,
    Class::Medium,
    Class::Subsurface,
];

/// Reads a shape's own parameters. `None` if there is no such plugin; a shape unless there was a mistake.
pub(crate) fn shape(params: &Params<'_>, builder: &mut Builder<'_>) -> Option<Option<Shape>> {
    let plugin = params.node.plugin.value.as_str();
    if plugin == NAME {
        return Some(displaced(params, builder));
    }
    if !Shape::plugins().any(|name| name == plugin) {
        let built = Shape::plugins().chain(COMPOSED).chain(Operation::NAMES);
        let diagnostic = plugins::not_built(params.node, built.chain([NAME]));
        builder.diagnostics.push(diagnostic);
        return None;
    }
    Some(Shape::from_params(params, builder))
}

/// Reads `height` (a texture or a number), `scale` (1; metres per unit of it), `midlevel` (0; the height that moves
/// nothing), `edge_length` (m), `face_normals`, and the one shape that is moved.
fn displaced(params: &Params<'_>, builder: &mut Builder<'_>) -> Option<Shape> {
    let diagnostics = builder.diagnostics;
    let scale = params.float_where("scale", 1.0, "a finite number", f64::is_finite) as f32;
    let midlevel = params.float_where("midlevel", 0.0, "a finite number", f64::is_finite) as f32;
    let face_normals = params.boolean_or("face_normals", false);
    let edge = match params.has("edge_length") {
        true => params.float_where("edge_length", 1.0, "a positive length", |length| {
            length.is_finite() && length > 0.0
        }),
        false => {
            params.missing("edge_length", "the longest edge of a triangle, in metres");
            1.0
        }
    };
    let height = builder.texture(params, "height", None, SpectrumKind::Unbounded);
    let children = params.children(Class::Shape);
    let [(_, child)] = children.as_slice() else {
        params.error(format!("`{NAME}` moves one shape, not {}", children.len()));
        return None;
    };
    let own = Params::new(child, diagnostics);
    let plugin = child.plugin.value.as_str();
    let refused = |message: String| {
        let help =
            "accepted: meshes, and shapes that know their points by their texture coordinates";
        diagnostics.push(Diagnostic::error(child.plugin.span, message).help(help));
        None
    };
    if COMPOSED.contains(&plugin)
        || Operation::named(plugin).is_some()
        || own.is_animated("to_world")
    {
        return refused(format!(
            "{} cannot be moved by a texture",
            child.with_article()
        ));
    }
    for property in &child.properties {
        if let Value::Object(inner) = &property.value
            && NOT_OF_THE_SHAPE.contains(&inner.class)
        {
            let message = format!(
                "the {} of a shape that is moved by a texture belongs to the `{NAME}`",
                inner.class.name()
            );
            let help = format!("write it beside the shape, within the `{NAME}`");
            diagnostics.push(Diagnostic::error(inner.plugin.span, message).help(help));
            property.mark_used();
        }
    }
    let shape = Shape::from_params(&own, builder);
    own.finish_after(shape.is_some());
    let shape = shape?;
    if !shape.can_be_displaced() {
        return refused(format!(
            "{} cannot be moved by a texture",
            child.with_article()
        ));
    }
    let textures = &builder.textures;
    let mut attributes = textures.attributes();
    if let Some((_, name, span)) = attributes.find(|(id, ..)| textures.uses(height, *id)) {
        let message = format!("`height` cannot ask for the mesh attribute `{name}`");
        diagnostics.push(Diagnostic::error(span, message));
        return None;
    }
    if diagnostics.has_errors() {
        return None;
    }
    // These textures do not look up shapes.
    let nothing = GeometryBuilder::new().build();
    let height = |position: Vec3, uv: Vec2| {
        let at = TexturePoint {
            position,
            ..TexturePoint::at_uv(uv)
        };
        scale * (textures.number(height, &nothing, &at) - midlevel)
    };
    let displaced = shape.displaced(edge as f32, height, face_normals);
    displaced
        .map_err(|message| params.error_at("edge_length", message))
        .ok()
}
