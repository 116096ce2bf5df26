//! Surfaces that sensors measure on.

use core::fmt::Debug;
use etalon_params::Node;
use etalon_transport::SurfacePoint;
use glam::Vec2;
use std::sync::Arc;

/// A surface whose points can be chosen uniformly by area.
pub trait MeasuredSurface: Clone + Debug + Send + Sync {
    /// The point chosen by `u`, on the side that the shape calls outside.
    fn point(&self, u: Vec2) -> SurfacePoint;
}

/// The shapes that belong to a sensor.
pub struct SensorShapes<'a, S> {
    /// The shape that the sensor is a child of.
    pub carrier: Option<S>,
    /// Reads a shape inside of the sensor; `None` after a mistake, which has been recorded.
    pub read: &'a mut dyn FnMut(&Arc<Node>) -> Option<S>,
}
