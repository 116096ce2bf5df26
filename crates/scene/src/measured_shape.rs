//! Shapes that sensors measure on, apart from those that rays hit.

use crate::builder::Builder;
use crate::surfaces::{COMPOSED, displacement};
use etalon_cameras::MeasuredSurface;
use etalon_geometry::shapes::csg::Operation;
use etalon_geometry::{Geometry, GeometryBuilder};
use etalon_params::{Class, Diagnostic, Node, Params};
use etalon_transport::{LightId, MaterialId, ShapeId, Shapes, SurfacePoint};
use glam::Vec2;
use std::sync::Arc;

/// A shape that points are chosen of.
#[derive(Clone, Debug)]
pub struct MeasuredShape(Arc<Geometry>);

impl MeasuredShape {
    /// Reads a shape; `None` after a mistake. That of a sensor is `whole`: all of its parameters are its own, and the rest is unknown. One that
    /// carries a sensor is a shape of the scene, too, which reads them all.
    pub(crate) fn read(node: &Arc<Node>, whole: bool, builder: &mut Builder<'_>) -> Option<Self> {
        let params = Params::new(node, builder.diagnostics);
        let plugin = node.plugin.value.as_str();
        let refuse = |why: &str| {
            let message = format!("a sensor cannot measure on {}: {why}", node.with_article());
            let error = Diagnostic::error(node.plugin.span, message);
            params.diagnostics.push(error.help(
                "meshes, and shapes such as `rectangle`, `disk` and `sphere`, can be measured on",
            ));
            None
        };
        if COMPOSED.contains(&plugin) || Operation::named(plugin).is_some() {
            return refuse("it is made of other shapes");
        }
        if params.is_animated("to_world") {
            return refuse("it moves");
        }
        let shape = displacement::shape(&params, builder)?;
        if whole {
            params.children(Class::Bsdf);
            params.finish_after(shape.is_some());
        }
        let shape = shape?;
        if !shape.can_emit() {
            return refuse("points of it cannot be chosen uniformly");
        }
        let mut geometry = GeometryBuilder::new();
        geometry.add_shape(shape, MaterialId(0), LightId::NONE);
        Some(Self(Arc::new(geometry.build())))
    }
}

impl MeasuredSurface for MeasuredShape {
    fn point(&self, u: Vec2) -> SurfacePoint {
        self.0.sample_area(ShapeId(0), u, 0.0).point
    }
}
