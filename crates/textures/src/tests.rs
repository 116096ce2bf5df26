//! What the tests of textures share: nodes, files, shapes.

use crate::{TextureReader, TextureTable};
use etalon_images::{Frame, Image, exr};
use etalon_math::lane::Lane;
use etalon_params::{Class, Diagnostics, FileId, Node, Property, Span, Spanned, Value};
use etalon_transport::{
    AssetError, Assets, LanePoint, LaneReceiver, LightSampleContext, MeshData, MeshFormat,
    OpenFile, SampledPoint, ShapeId, Shapes, SpectrumKind, SurfacePoint, TextureId, TexturePoint,
    in_memory,
};
use glam::{Vec2, Vec3, Vec4};
use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

mod arithmetic;
mod bitmap;
mod integers;
mod lanes;
mod mesh_attribute;
mod procedural;
mod projected;
mod ranges;
mod recoding;
mod rules;

const NOWHERE: Span = Span {
    file: FileId(0),
    start: 0,
    end: 0,
};

/// The wavelengths (nm) at which Mitsuba was asked.
const LAMBDA: Vec4 = Vec4::new(400.0, 480.0, 560.0, 650.0);

fn node(plugin: &str, properties: Vec<(&str, Value)>) -> Arc<Node> {
    let property = |(name, value): (&str, Value)| Property::new(name, NOWHERE, value, NOWHERE);
    Arc::new(Node {
        class: Class::Texture,
        plugin: Spanned {
            value: plugin.into(),
            span: NOWHERE,
        },
        id: None,
        span: NOWHERE,
        properties: properties.into_iter().map(property).collect(),
    })
}

fn text(value: &str) -> Value {
    Value::String(value.into())
}

/// Files in memory.
#[derive(Default)]
struct Files(HashMap<String, Arc<Vec<u8>>>);

impl Files {
    /// Adds an OpenEXR file with the given channels of `width` columns.
    fn add(&mut self, name: &str, width: usize, channels: &[(&str, &[f32])]) {
        let height = channels[0].1.len() / width;
        let image = channels
            .iter()
            .fold(Image::new(width, height), |image, (name, samples)| {
                image.with(*name, samples.to_vec())
            });
        let size = [width, height];
        let part = exr::Part {
            name: None,
            image,
            offset: [0, 0],
        };
        let mut bytes = std::io::Cursor::new(Vec::new());
        exr::encode(&mut bytes, &[part], size, "").expect("an image can be written to memory");
        self.0.insert(name.into(), Arc::new(bytes.into_inner()));
    }
}

impl Assets for Files {
    fn bytes(&self, path: &str) -> Result<Arc<Vec<u8>>, AssetError> {
        self.0.get(path).cloned().ok_or_else(|| AssetError {
            message: format!("there is no file `{path}`"),
            help: None,
        })
    }

    fn open(&self, path: &str) -> Result<Box<dyn OpenFile>, AssetError> {
        self.bytes(path).map(in_memory)
    }

    fn mesh(&self, _: MeshFormat, path: &str) -> Result<MeshData, AssetError> {
        Err(AssetError {
            message: format!("`{path}` is no mesh"),
            help: None,
        })
    }
}

/// One shape, whose attribute `vertex_color` is (parameters, ½), `face_grey` 3, and
/// `vertex_bytes` (51, 102, −255).
pub(crate) struct OneShape;

impl Shapes for OneShape {
    fn area(&self, _: ShapeId, _: f32) -> f32 {
        1.0
    }
    fn bounds(&self, _: ShapeId) -> [Vec3; 2] {
        [Vec3::ZERO; 2]
    }
    fn normals(&self, _: ShapeId) -> etalon_math::DirectionCone {
        etalon_math::DirectionCone::ALL
    }
    fn sample_area(&self, _: ShapeId, _: Vec2, _: f32) -> SampledPoint {
        panic!("textures do not sample shapes")
    }
    fn sample_toward(&self, _: ShapeId, _: &LightSampleContext, _: Vec2) -> Option<SampledPoint> {
        None
    }
    fn are_alike(&self, _: [ShapeId; 2]) -> bool {
        false
    }

    fn points_toward<F: Lane>(
        &self,
        _: impl Fn(usize) -> ShapeId,
        _: &LaneReceiver<F>,
        _: [F; 2],
    ) -> LanePoint<F> {
        unreachable!("its points are chosen one by one")
    }
    fn density_toward(&self, _: ShapeId, _: &LightSampleContext, _: &SurfacePoint) -> f32 {
        0.0
    }
    fn attribute(
        &self,
        _: ShapeId,
        name: &str,
        _: u32,
        parameters: Vec2,
        [low, high]: [f32; 2],
    ) -> Option<Vec3> {
        let stored = match name {
            "vertex_color" => parameters.extend(0.5),
            "face_grey" => Vec3::splat(3.0),
            "vertex_bytes" => Vec3::new(51.0, 102.0, -255.0),
            _ => return None,
        };
        Some(stored.clamp(Vec3::splat(low), Vec3::splat(high)))
    }
}

/// A set with one texture in it, and the messages that reading it gave.
fn read(
    files: &Files,
    node: &Arc<Node>,
    role: SpectrumKind,
) -> (TextureTable, TextureId, Vec<String>) {
    let mut set = TextureTable::new();
    let diagnostics = Diagnostics::new();
    let mut reader = TextureReader {
        set: &mut set,
        assets: files,
        diagnostics: &diagnostics,
    };
    let id = reader.node(node, role);
    let messages = diagnostics.into_sorted();
    (set, id, messages.into_iter().map(|d| d.message).collect())
}

/// One texture without mistakes.
struct One {
    set: TextureTable,
    id: TextureId,
}

impl One {
    fn new(files: &Files, node: &Arc<Node>, role: SpectrumKind) -> Self {
        let (set, id, messages) = read(files, node, role);
        assert!(messages.is_empty(), "{messages:?}");
        Self { set, id }
    }

    fn number(&self, u: f32, v: f32) -> f32 {
        let at = TexturePoint::at_uv(Vec2::new(u, v));
        self.set.number(self.id, &OneShape, &at)
    }

    fn spectrum(&self, u: f32, v: f32) -> Vec4 {
        let at = TexturePoint::at_uv(Vec2::new(u, v));
        self.set.spectrum(self.id, &OneShape, &at, LAMBDA)
    }

    fn colour(&self, u: f32, v: f32) -> Vec3 {
        let at = TexturePoint::at_uv(Vec2::new(u, v));
        self.set.colour(self.id, &OneShape, &at)
    }
}

fn close(a: Vec4, b: [f32; 4], tolerance: f32) -> bool {
    (a - Vec4::from_array(b)).abs().max_element() <= tolerance
}

#[test]
fn files_in_memory_can_be_read() {
    let mut files = Files::default();
    files.add("grey.exr", 1, &[("Y", &[0.5])]);
    let bytes = files.bytes("grey.exr").expect("it was added");
    let document = exr::decode(&bytes, Path::new("grey.exr")).expect("valid");
    let (image, frame) = document.flatten();
    assert_eq!(frame, Frame::whole(&image));
}
