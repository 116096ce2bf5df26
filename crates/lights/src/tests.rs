//! What the tests of lights share: a small world of textures and rectangles.

use crate::{BoundingSphere, Light, LightDescription, LightSamplerKind};
use etalon_math::lane::{Lane, Spectral};
use etalon_math::{DirectionCone, Frame};
use etalon_params::{Class, Diagnostics, FileId, Node, Params, Property, Span, Spanned, Value};
use etalon_sampling::{Independent, Sampler};
use etalon_spectrum::{Spectrum, Wavelengths};
use etalon_transport::{
    AssetError, Assets, Build, InstanceId, LanePoint, LaneReceiver, LightId, LightSampleContext,
    MaterialId, MeshData, MeshFormat, OpenFile, SampledPoint, ShapeId, Shapes, Shutter,
    SpectrumKind, SurfaceInteraction, SurfacePoint, TextureId, TexturePoint, Textures, in_memory,
};
use glam::{Vec2, Vec3, Vec4};
use std::collections::HashMap;
use std::sync::Arc;

mod adjoint;
mod constant;
mod environment;
mod few;
mod goniometric;
mod ies;
mod mistakes;
mod mitsuba;
mod selection;
mod sunsky;
mod timed_sunsky;
mod tree;

const NOWHERE: Span = Span {
    file: FileId(0),
    start: 0,
    end: 0,
};

/// The wavelengths (nm) at which Mitsuba was asked, and D65 there.
const WAVELENGTHS: Wavelengths = Wavelengths {
    lambda: Vec4::new(400.0, 480.0, 560.0, 650.0),
    density: Vec4::ONE,
};

fn white() -> Vec4 {
    Spectrum::d65(1.0).expect("finite").eval(WAVELENGTHS.lambda)
}

/// A texture of the small world.
#[derive(Clone)]
enum Pattern {
    /// One spectrum.
    Plain(Spectrum),
    /// 3 × 2 squares of grey, as in the test of Mitsuba's spot.
    Squares,
    /// u, everywhere between 0 and 1 with mean ½.
    Ramp,
}

const SQUARES: [[f32; 3]; 2] = [[0.1, 0.5, 0.9], [0.3, 0.7, 0.2]];

/// Textures, files, and rectangles [−1, 1]² moved to a place, whose normal is +z or −z.
#[derive(Default)]
struct SmallWorld {
    shutter: Shutter,
    patterns: Vec<Pattern>,
    files: HashMap<String, Arc<Vec<u8>>>,
    rectangles: Vec<(Vec3, Vec3)>,
}

impl Assets for SmallWorld {
    fn bytes(&self, path: &str) -> Result<Arc<Vec<u8>>, AssetError> {
        self.files.get(path).cloned().ok_or_else(|| AssetError {
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

impl Build for SmallWorld {
    fn assets(&self) -> &dyn Assets {
        self
    }

    fn shutter(&self) -> Shutter {
        self.shutter
    }

    fn texture(
        &mut self,
        params: &Params<'_>,
        name: &str,
        default: Option<f64>,
        role: SpectrumKind,
    ) -> TextureId {
        let pattern = match params.property(name).map(|p| &p.value) {
            Some(Value::Object(node)) if node.plugin.value == "ramp" => Pattern::Ramp,
            Some(Value::Object(_)) => Pattern::Squares,
            value => {
                let number = match value {
                    Some(Value::Float(x)) => *x,
                    _ => default.unwrap_or(0.0),
                };
                let spectrum = match role {
                    SpectrumKind::Emission => Spectrum::d65(number),
                    _ => Spectrum::uniform(number),
                };
                Pattern::Plain(spectrum.expect("finite"))
            }
        };
        self.patterns.push(pattern);
        TextureId(self.patterns.len() as u32 - 1)
    }

    fn volume(
        &mut self,
        params: &Params<'_>,
        name: &str,
        default: Option<f64>,
        role: SpectrumKind,
    ) -> TextureId {
        self.texture(params, name, default, role)
    }

    fn nested_texture(&mut self, _: &Arc<Node>, _: SpectrumKind) -> TextureId {
        TextureId::NONE
    }

    fn varies(&self, plugin: &str) -> bool {
        matches!(plugin, "bitmap" | "checkerboard")
    }

    fn resolution(&self, _: TextureId) -> [u32; 2] {
        [1; 2]
    }

    fn spectrum(&mut self, spectrum: Spectrum) -> TextureId {
        self.patterns.push(Pattern::Plain(spectrum));
        TextureId(self.patterns.len() as u32 - 1)
    }
}

impl Textures for SmallWorld {
    fn spectrum(&self, texture: TextureId, at: &TexturePoint, lambda: Vec4) -> Vec4 {
        match &self.patterns[texture.0 as usize] {
            Pattern::Plain(spectrum) => spectrum.eval(lambda),
            Pattern::Squares => {
                let place = (at.uv * Vec2::new(3.0, 2.0)).floor();
                let (x, y) = (place.x.clamp(0.0, 2.0), place.y.clamp(0.0, 1.0));
                Vec4::splat(SQUARES[y as usize][x as usize])
            }
            Pattern::Ramp => white() * at.uv.x,
        }
    }

    fn spectra<F: Lane>(
        &self,
        texture: impl Fn(usize) -> TextureId,
        at: impl Fn(usize) -> TexturePoint,
        lambda: impl Fn(usize) -> Vec4,
    ) -> F::Spectrum {
        F::Spectrum::of_lanes(|i| self.spectrum(texture(i), &at(i), lambda(i)))
    }

    fn number(&self, _: TextureId, _: &TexturePoint) -> f32 {
        0.0
    }

    fn gradient(&self, _: TextureId, _: &TexturePoint, _: [Vec3; 2]) -> Vec2 {
        Vec2::ZERO
    }

    fn colour(&self, _: TextureId, _: &TexturePoint) -> Vec3 {
        Vec3::ZERO
    }

    fn mean(&self, texture: TextureId) -> f32 {
        match &self.patterns[texture.0 as usize] {
            Pattern::Plain(spectrum) => spectrum.mean() as f32,
            _ => 0.5,
        }
    }

    fn is_constant(&self, _: TextureId) -> bool {
        true
    }
}

impl SmallWorld {
    fn vertex(&self, shape: ShapeId, uv: Vec2) -> SurfaceInteraction {
        let (centre, normal) = self.rectangles[shape.0 as usize];
        SurfaceInteraction {
            position: centre + (2.0 * uv - 1.0).extend(0.0),
            uv,
            shape,
            light: LightId(shape.0),
            ..upward(Vec3::ZERO, normal)
        }
    }
}

impl Shapes for SmallWorld {
    fn area(&self, _: ShapeId, _: f32) -> f32 {
        4.0
    }

    fn bounds(&self, shape: ShapeId) -> [Vec3; 2] {
        let (centre, _) = self.rectangles[shape.0 as usize];
        [-1.0, 1.0].map(|side| centre + Vec3::new(side, side, 0.0))
    }

    fn normals(&self, shape: ShapeId) -> DirectionCone {
        let (_, normal) = self.rectangles[shape.0 as usize];
        DirectionCone::along(normal.as_dvec3())
    }

    fn sample_area(&self, shape: ShapeId, u: Vec2, _: f32) -> SampledPoint {
        SampledPoint {
            point: SurfacePoint::from(&self.vertex(shape, u)),
            density: 0.25,
        }
    }

    fn sample_toward(
        &self,
        shape: ShapeId,
        from: &LightSampleContext,
        u: Vec2,
    ) -> Option<SampledPoint> {
        let point = SurfacePoint::from(&self.vertex(shape, u));
        let density = self.density_toward(shape, from, &point);
        Some(SampledPoint { point, density })
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

    fn density_toward(&self, _: ShapeId, from: &LightSampleContext, at: &SurfacePoint) -> f32 {
        let d = at.position - from.position;
        let cosine = d.normalize().dot(at.normal).abs();
        0.25 * d.length_squared() / cosine
    }

    fn attribute(&self, _: ShapeId, _: &str, _: u32, _: Vec2, _: [f32; 2]) -> Option<Vec3> {
        None
    }
}

/// A receiver with the given normal.
fn receiver(position: Vec3, normal: Vec3) -> LightSampleContext {
    LightSampleContext::on_surface(position, normal)
}

/// A point of a surface with the given normal.
fn upward(position: Vec3, normal: Vec3) -> SurfaceInteraction {
    SurfaceInteraction {
        position,
        error: Vec3::splat(1e-6),
        depth: f32::NAN,
        normal,
        shading: Frame::from_normal(normal),
        uv: Vec2::ZERO,
        dp_du: Vec3::X,
        dp_dv: Vec3::Y,
        t: 0.0,
        time: 0.0,
        parameters: Vec2::ZERO,
        shape: ShapeId::NONE,
        primitive: 0,
        instance: InstanceId::NONE,
        material: MaterialId::NONE,
        light: LightId::NONE,
        media: etalon_transport::MediumInterface::NONE,
    }
}

fn node(class: Class, plugin: &str, properties: Vec<(&str, Value)>) -> Node {
    let property = |(name, value): (&str, Value)| Property::new(name, NOWHERE, value, NOWHERE);
    Node {
        class,
        plugin: Spanned {
            value: plugin.into(),
            span: NOWHERE,
        },
        id: None,
        span: NOWHERE,
        properties: properties.into_iter().map(property).collect(),
    }
}

/// A texture object; the small world knows `ramp`, and takes every other for `Squares`.
fn texture(plugin: &str) -> Value {
    Value::Object(Arc::new(node(Class::Texture, plugin, vec![])))
}

/// The light of a description, or the messages that it gave.
fn read(
    world: &mut SmallWorld,
    plugin: &str,
    properties: Vec<(&str, Value)>,
) -> Result<LightDescription, Vec<String>> {
    let diagnostics = Diagnostics::new();
    let node = node(Class::Emitter, plugin, properties);
    let params = Params::new(&node, &diagnostics);
    let shape = matches!(plugin, "area" | "directionalarea")
        .then(|| ShapeId(world.rectangles.len() as u32 - 1));
    let description = LightDescription::from_params(&params, shape, world);
    let messages: Vec<String> = diagnostics
        .into_sorted()
        .into_iter()
        .map(|d| d.message)
        .collect();
    match description {
        Some(description) if messages.is_empty() => Ok(description),
        _ => Err(messages),
    }
}

/// A light whose description is right.
fn light(world: &mut SmallWorld, plugin: &str, properties: Vec<(&str, Value)>) -> LightDescription {
    read(world, plugin, properties).unwrap_or_else(|messages| panic!("{messages:?}"))
}

/// A generator with a fixed seed.
fn numbers(seed: u64) -> Independent {
    Independent::from_key(seed)
}

/// Adds the PFM file `name` of `width` columns with the given linear pixels, rows from the top.
fn add_file(world: &mut SmallWorld, name: &str, width: usize, rgb: &[[f32; 3]]) {
    let height = rgb.len() / width;
    let mut bytes = format!("PF\n{width} {height}\n-1.0\n").into_bytes();
    for row in rgb.chunks_exact(width).rev() {
        for value in row.iter().flatten() {
            bytes.extend_from_slice(&value.to_le_bytes());
        }
    }
    world.files.insert(name.into(), Arc::new(bytes));
}
