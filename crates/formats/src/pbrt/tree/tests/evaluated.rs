//! Values of a scene's parameters at points.

use super::*;
use etalon_math::{DirectionCone, lane::Lane};
use etalon_params::{Diagnostics, Property};
use etalon_textures::{TextureReader, TextureTable};
use etalon_transport::{
    AssetError, Assets, LanePoint, LaneReceiver, LightSampleContext, MeshData, MeshFormat,
    OpenFile, SampledPoint, ShapeId, Shapes, SpectrumKind, SurfacePoint, TextureId, TexturePoint,
    in_memory,
};
use glam::{Vec2, Vec3, Vec4};
use std::sync::Arc;

/// What textures know of surfaces beside the point: nothing.
struct Nothing;

impl Shapes for Nothing {
    fn area(&self, _: ShapeId, _: f32) -> f32 {
        0.0
    }
    fn bounds(&self, _: ShapeId) -> [Vec3; 2] {
        [Vec3::ZERO; 2]
    }
    fn normals(&self, _: ShapeId) -> DirectionCone {
        DirectionCone::ALL
    }
    fn sample_area(&self, _: ShapeId, _: Vec2, _: f32) -> SampledPoint {
        unreachable!("there are no shapes")
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
        unreachable!("there are no shapes")
    }
    fn density_toward(&self, _: ShapeId, _: &LightSampleContext, _: &SurfacePoint) -> f32 {
        0.0
    }
    fn attribute(&self, _: ShapeId, _: &str, _: u32, _: Vec2, _: [f32; 2]) -> Option<Vec3> {
        None
    }
}

/// The files that stand in a document.
struct Files<'d>(&'d Document);

impl Assets for Files<'_> {
    fn bytes(&self, path: &str) -> Result<Arc<Vec<u8>>, AssetError> {
        let embedded = self.0.embedded.iter();
        let mut found = embedded.filter(|(index, _)| crate::embedded_name(**index) == path);
        found
            .next()
            .map(|(_, bytes)| Arc::clone(bytes))
            .ok_or_else(|| AssetError {
                message: format!("there is no file `{path}`"),
                help: None,
            })
    }
    fn open(&self, path: &str) -> Result<Box<dyn OpenFile>, AssetError> {
        self.bytes(path).map(in_memory)
    }
    fn mesh(&self, _: MeshFormat, path: &str) -> Result<MeshData, AssetError> {
        self.bytes(path).map(|_| MeshData::default())
    }
}

/// A parameter as a texture.
pub(super) struct Evaluated {
    set: TextureTable,
    id: TextureId,
}

impl Evaluated {
    /// The first property of that name in a document.
    #[track_caller]
    pub(super) fn of(document: &Document, name: &str, role: SpectrumKind) -> Self {
        let property = property(&document.root, name).expect("a property of that name");
        let (mut set, diagnostics) = (TextureTable::new(), Diagnostics::new());
        let mut reader = TextureReader {
            set: &mut set,
            assets: &Files(document),
            diagnostics: &diagnostics,
        };
        let id = reader.property(property, role);
        let said: Vec<String> = diagnostics
            .into_sorted()
            .into_iter()
            .map(|d| d.message)
            .collect();
        assert_eq!(said, [""; 0]);
        Self { set, id }
    }

    pub(super) fn number(&self, position: Vec3, uv: Vec2) -> f32 {
        self.set.number(self.id, &Nothing, &at(position, uv))
    }

    pub(super) fn colour(&self, position: Vec3, uv: Vec2) -> Vec3 {
        self.set.colour(self.id, &Nothing, &at(position, uv))
    }

    pub(super) fn spectrum(&self, position: Vec3, lambda: Vec4) -> Vec4 {
        (self.set).spectrum(self.id, &Nothing, &at(position, Vec2::ZERO), lambda)
    }
}

fn at(position: Vec3, uv: Vec2) -> TexturePoint {
    TexturePoint {
        position,
        ..TexturePoint::at_uv(uv)
    }
}

fn property<'n>(node: &'n Node, name: &str) -> Option<&'n Property> {
    node.properties.iter().find_map(|found| match &found.value {
        _ if found.name == name => Some(found),
        Value::Object(nested) => property(nested, name),
        _ => None,
    })
}
