//! Solids made of solids: `union`, `intersection`, `difference` with the materials of their operands.

use crate::builder::Builder;
use crate::media::bodies::Body;
use crate::surfaces::{COMPOSED, ShapeExtras, Surfaces};
use etalon_geometry::shapes::csg::{Csg, Operation};
use etalon_geometry::{Placement, Shape};
use etalon_params::{Class, Diagnostic, Node, Params};
use std::sync::Arc;

impl Surfaces {
    /// A solid made of its children, each with a material of its own, or else with that of the whole.
    pub(crate) fn solid(
        &mut self,
        operation: Operation,
        node: &Arc<Node>,
        builder: &mut Builder<'_>,
    ) -> Option<(Shape, ShapeExtras)> {
        let diagnostics = builder.diagnostics;
        let params = Params::new(node, diagnostics);
        let placement = Placement::from_params(&params);
        let flip = params.boolean_or("flip_normals", false);
        // As in POV-Ray: a cut surface has the material of the minuend.
        let cutaway =
            operation == Operation::Difference && params.boolean_or("cutaway_textures", false);
        let emitter = params.child(Class::Emitter).cloned();
        let below = self.below(&params, builder);
        let boundary = below.as_ref().map(|(boundary, _)| boundary);
        let bsdf = boundary.or_else(|| params.child(Class::Bsdf));
        let named = (bsdf.is_some() || emitter.is_some())
            .then(|| self.material_or_default(bsdf, emitter.is_some(), builder));
        let whole = named.or(self.inherited);
        let outer = core::mem::replace(&mut self.inherited, whole);
        let (mut operands, mut faces) = (Vec::new(), Vec::new());
        let children = params.children(Class::Shape);
        for (_, child) in &children {
            let operand = Params::new(child, diagnostics);
            if COMPOSED.contains(&child.plugin.value.as_str()) || operand.is_animated("to_world") {
                let message = format!("{} is made of solids that stand still", node.with_article());
                diagnostics.push(Diagnostic::error(child.plugin.span, message));
                continue;
            }
            let has_own = !operand.children(Class::Bsdf).is_empty();
            let Some((shape, carried)) = self.shape(child, builder) else {
                continue;
            };
            if let Some(emitter) = &carried.emitter {
                let message = "an operand cannot emit light: the whole can";
                diagnostics.push(Diagnostic::error(emitter.span, message));
            }
            if carried.media.is_some() || carried.body.is_some() {
                let message = "what is in an operand is in the whole: its medium, `subsurface` and `priority` are the whole's";
                diagnostics.push(Diagnostic::error(child.plugin.span, message));
            }
            if !shape.is_solid() {
                let message = format!("{} bounds no volume here", child.with_article());
                let help = match child.plugin.value.as_str() {
                    // Which has no ends.
                    "cylinder" => "a `cone` with equal radii at both ends is a closed cylinder",
                    _ => {
                        "accepted: shapes without holes, and meshes only if they are convex, of at most 64 triangles"
                    }
                };
                diagnostics.push(Diagnostic::error(child.plugin.span, message).help(help));
                continue;
            }
            let count = shape.faces() as usize;
            match whole {
                _ if cutaway && !faces.is_empty() => faces.extend(vec![faces[0]; count]),
                Some(material) if !has_own && carried.faces.is_empty() => {
                    faces.extend(vec![material; count]);
                }
                _ if carried.faces.is_empty() => faces.extend(vec![carried.material; count]),
                _ => faces.extend(carried.faces),
            }
            operands.push(shape);
        }
        self.inherited = outer;
        match children.as_slice() {
            [] => params.missing("shape", "solids to make it of"),
            [_] if operation == Operation::Difference => {
                let message = "nothing is taken away from the only solid of this `difference`";
                diagnostics.push(Diagnostic::note(node.plugin.span, message));
            }
            _ => {}
        }
        let inside = below.as_ref().map(|(_, medium)| *medium);
        let media = self.media(&params, inside, builder);
        let material = whole.unwrap_or_else(|| self.grey(builder));
        let body = Body::from_params(&params, material, media);
        params.finish();
        if operands.len() < children.len() {
            return None;
        }
        let csg = Csg::new(operation, operands, placement?, flip)?;
        let shape = Shape::Csg(csg);
        let carried = ShapeExtras {
            material,
            emitter,
            faces,
            media,
            body,
        };
        Some((shape, carried))
    }
}
