//! What the tests of cameras share: sensor nodes, films, placements.

use crate::{FilmWindow, MeasuredSurface, SensorShapes};
use etalon_params::{Class, DMat4, DVec3};
use etalon_params::{Diagnostics, FileId, Node, Params, Property, Span, Spanned, Value};
use etalon_transport::{SurfacePoint, TexturePoint};
use glam::{UVec2, Vec2, Vec3};
use std::sync::Arc;

mod batches;
mod connections;
mod lanes;
mod lenses;
mod meters;
mod mistakes;
mod mitsuba;
mod panoramas;
mod receptions;

/// Any camera; it measures on squares.
type AnyCamera = crate::AnyCamera<Square>;

/// The square from (0, 0, 1) to (2, 2, 1), which looks to +z.
#[derive(Clone, Debug, PartialEq)]
struct Square;

impl MeasuredSurface for Square {
    fn point(&self, u: Vec2) -> SurfacePoint {
        SurfacePoint {
            position: (u * 2.0).extend(1.0),
            error: Vec3::ZERO,
            normal: Vec3::Z,
            texture: TexturePoint::at_uv(u),
        }
    }
}

const NOWHERE: Span = Span {
    file: FileId(0),
    start: 0,
    end: 0,
};

fn node(plugin: &str, properties: &[(&str, Value)]) -> Node {
    let property =
        |(name, value): &(&str, Value)| Property::new(*name, NOWHERE, value.clone(), NOWHERE);
    Node {
        class: Class::Sensor,
        plugin: Spanned {
            value: plugin.into(),
            span: NOWHERE,
        },
        id: None,
        span: NOWHERE,
        properties: properties.iter().map(property).collect(),
    }
}

/// The messages that a sensor gives, and the camera if there is one.
fn read(
    plugin: &str,
    properties: &[(&str, Value)],
    window: FilmWindow,
) -> (Option<AnyCamera>, Vec<String>) {
    read_node(&node(plugin, properties), window, None)
}

/// The same of a node, perhaps the child of a shape.
fn read_node(
    node: &Node,
    window: FilmWindow,
    carrier: Option<Square>,
) -> (Option<AnyCamera>, Vec<String>) {
    let diagnostics = Diagnostics::new();
    let mut read = |_: &Arc<Node>| Some(Square);
    let mut shapes = SensorShapes {
        carrier,
        read: &mut read,
    };
    let camera = AnyCamera::from_params(&Params::new(node, &diagnostics), window, &mut shapes);
    let messages = diagnostics.into_sorted().into_iter().map(|d| d.message);
    (camera.map(|(camera, _)| camera), messages.collect())
}

fn camera(plugin: &str, properties: &[(&str, Value)], window: FilmWindow) -> AnyCamera {
    let (camera, messages) = read(plugin, properties, window);
    assert!(messages.is_empty(), "{messages:?}");
    camera.expect("a camera")
}

const FILM: FilmWindow = FilmWindow {
    size: UVec2::new(40, 30),
    origin: UVec2::ZERO,
    crop: UVec2::new(40, 30),
};
const CROPPED: FilmWindow = FilmWindow {
    origin: UVec2::new(4, 6),
    crop: UVec2::new(10, 8),
    ..FILM
};
const TALL: FilmWindow = FilmWindow {
    size: UVec2::new(30, 40),
    origin: UVec2::ZERO,
    crop: UVec2::new(30, 40),
};

/// Mitsuba's `look_at` from (1, 2, 3) to (4, 1, −2) with +Y up, as it defines it: the columns
/// are left, up and forward.
fn look_at() -> DMat4 {
    let origin = DVec3::new(1.0, 2.0, 3.0);
    let forward = (DVec3::new(4.0, 1.0, -2.0) - origin).normalize();
    let left = DVec3::Y.cross(forward).normalize();
    let up = forward.cross(left);
    DMat4::from_cols(
        left.extend(0.0),
        up.extend(0.0),
        forward.extend(0.0),
        origin.extend(1.0),
    )
}

fn placed(matrix: DMat4) -> (&'static str, Value) {
    ("to_world", Value::Transform(matrix))
}

fn number(name: &'static str, value: f64) -> (&'static str, Value) {
    (name, Value::Float(value))
}

fn word(name: &'static str, value: &str) -> (&'static str, Value) {
    (name, Value::String(value.into()))
}

fn lens_parameters() -> [(&'static str, Value); 6] {
    [
        number("fov", 50.0),
        number("aperture_radius", 0.3),
        number("near_clip", 0.5),
        number("far_clip", 20.0),
        number("focus_distance", 5.0),
        placed(look_at()),
    ]
}
