//! The scene's textures and shapes, for look-up by materials and lights.

use etalon_geometry::Geometry;
use etalon_math::DirectionCone;
use etalon_math::lane::Lane;
use etalon_textures::TextureTable;
use etalon_transport::{
    LanePoint, LaneReceiver, LightSampleContext, SampledPoint, ShapeId, Shapes, SurfacePoint,
    TextureId, TexturePoint, Textures,
};
use glam::{Vec2, Vec3, Vec4};

/// Textures and shapes by id, as materials and lights refer to them.
#[derive(Debug)]
pub struct SceneTables {
    /// All shapes and their accelerators.
    pub geometry: Geometry,
    /// All textures.
    pub textures: TextureTable,
}

impl Textures for SceneTables {
    #[inline]
    fn spectrum(&self, texture: TextureId, at: &TexturePoint, lambda: Vec4) -> Vec4 {
        self.textures.spectrum(texture, &self.geometry, at, lambda)
    }

    #[inline]
    fn spectra<F: Lane>(
        &self,
        texture: impl Fn(usize) -> TextureId,
        at: impl Fn(usize) -> TexturePoint,
        lambda: impl Fn(usize) -> Vec4,
    ) -> F::Spectrum {
        self.textures
            .spectra::<F>(texture, &self.geometry, at, lambda)
    }

    #[inline]
    fn number(&self, texture: TextureId, at: &TexturePoint) -> f32 {
        self.textures.number(texture, &self.geometry, at)
    }

    fn gradient(&self, texture: TextureId, at: &TexturePoint, moved: [Vec3; 2]) -> Vec2 {
        self.textures.gradient(texture, &self.geometry, at, moved)
    }

    #[inline]
    fn colour(&self, texture: TextureId, at: &TexturePoint) -> Vec3 {
        self.textures.colour(texture, &self.geometry, at)
    }

    fn mean(&self, texture: TextureId) -> f32 {
        self.textures.mean(texture)
    }

    fn is_constant(&self, texture: TextureId) -> bool {
        self.textures.is_constant(texture)
    }
}

impl Shapes for SceneTables {
    fn area(&self, shape: ShapeId, time: f32) -> f32 {
        self.geometry.area(shape, time)
    }

    fn bounds(&self, shape: ShapeId) -> [Vec3; 2] {
        Shapes::bounds(&self.geometry, shape)
    }

    fn normals(&self, shape: ShapeId) -> DirectionCone {
        self.geometry.normals(shape)
    }

    #[inline]
    fn sample_area(&self, shape: ShapeId, u: Vec2, time: f32) -> SampledPoint {
        self.geometry.sample_area(shape, u, time)
    }

    #[inline]
    fn sample_toward(
        &self,
        shape: ShapeId,
        from: &LightSampleContext,
        u: Vec2,
    ) -> Option<SampledPoint> {
        self.geometry.sample_toward(shape, from, u)
    }

    fn are_alike(&self, shapes: [ShapeId; 2]) -> bool {
        self.geometry.are_alike(shapes)
    }

    #[inline]
    fn points_toward<F: Lane>(
        &self,
        shape: impl Fn(usize) -> ShapeId,
        from: &LaneReceiver<F>,
        u: [F; 2],
    ) -> LanePoint<F> {
        self.geometry.points_toward(shape, from, u)
    }

    #[inline]
    fn density_toward(&self, shape: ShapeId, from: &LightSampleContext, at: &SurfacePoint) -> f32 {
        self.geometry.density_toward(shape, from, at)
    }

    fn attribute(
        &self,
        shape: ShapeId,
        name: &str,
        primitive: u32,
        parameters: Vec2,
        range: [f32; 2],
    ) -> Option<Vec3> {
        let geometry = &self.geometry;
        geometry.attribute(shape, name, primitive, parameters, range)
    }
}
