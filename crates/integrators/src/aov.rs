//! `aov`: arbitrary output variables of the first surface, beside the pictures of nested
//! integrators.
//!
//! With x the first surface on the ray of a sample, the channel of a variable v is
//!
//! ```text
//! C = 1/n Σᵢ wᵢ v(xᵢ),   v = 0 where no surface is hit
//! ```
//!
//! over the n samples of a pixel, placed by its filter with weights wᵢ (1 without negative lobes): the
//! geometric buffers of Saito & Takahashi 1990 ("Comprehensible Rendering of 3-D Shapes"), with
//! antialiasing. Except for the albedo ρ, all variables are numbers. The channels of ρ, a spectrum, are its colour under
//! daylight D ([`QuadratureNode`] with 36 wavelengths), so that a grey albedo has a grey colour:
//!
//! ```text
//! v = ∫ ρ(x, λ) D(λ) s(λ) dλ,   clamped to [0, 1], as ρ(x, λ) is
//! ```
//!
//! Channels, named as Mitsuba names them: for each nested integrator `NAME` its `NAME.R`,
//! `NAME.G`, `NAME.B`, `NAME.A` and its own channels; then for each entry `name:type` of `aovs`
//! one to three channels `name.…`. The picture is that of the first nested integrator (black if
//! there is none).

use crate::list::Nested;
use crate::steps::camera_ray::camera_ray;
use crate::steps::dimensions as dim;
use etalon_params::{Diagnostic, Params};
use etalon_sampling::{ReplicateKind, Sampler};
use etalon_spectrum::QuadratureNode;
use etalon_transport::{
    Bsdf, Camera, Channel, Incompatibility, Integrator, Pass, PixelSample, Placing, Ray,
    SceneCapabilities, Sink, SurfaceInteraction, Surfaces, World, one_by_one,
};
use glam::{Vec2, Vec3, Vec4};
use std::sync::LazyLock;

/// A variable of the first surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variable {
    /// Albedo under daylight (linear Rec.709).
    Albedo,
    /// Distance along the ray (m).
    Depth,
    /// Position (m, world).
    Position,
    /// Texture coordinates.
    Uv,
    /// Geometric normal.
    GeometricNormal,
    /// Shading normal.
    ShadingNormal,
    /// ∂p/∂u.
    DpDu,
    /// ∂p/∂v.
    DpDv,
    /// ∂(u, v)/∂x per sample spacing (pixels / √spp).
    DuvDx,
    /// ∂(u, v)/∂y per sample spacing.
    DuvDy,
    /// Index of the primitive in its shape.
    PrimitiveIndex,
    /// Number of the shape in the scene, from 1, in the order of the file; 0 is no shape.
    ShapeIndex,
}

/// A fourth of the number of wavelengths at which an albedo is evaluated.
const NODES: u32 = 9;

/// These wavelengths.
static DAYLIGHT: LazyLock<Vec<QuadratureNode>> =
    LazyLock::new(|| QuadratureNode::standard(NODES).collect());

/// Name, variable, channel suffixes: one line per variable.
const VARIABLES: [(&str, Variable, &[&str]); 12] = [
    ("albedo", Variable::Albedo, &["R", "G", "B"]),
    ("depth", Variable::Depth, &["T"]),
    ("position", Variable::Position, &["X", "Y", "Z"]),
    ("uv", Variable::Uv, &["U", "V"]),
    ("geo_normal", Variable::GeometricNormal, &["X", "Y", "Z"]),
    ("sh_normal", Variable::ShadingNormal, &["X", "Y", "Z"]),
    ("dp_du", Variable::DpDu, &["X", "Y", "Z"]),
    ("dp_dv", Variable::DpDv, &["X", "Y", "Z"]),
    ("duv_dx", Variable::DuvDx, &["U", "V"]),
    ("duv_dy", Variable::DuvDy, &["U", "V"]),
    ("prim_index", Variable::PrimitiveIndex, &["I"]),
    ("shape_index", Variable::ShapeIndex, &["I"]),
];

/// One requested variable.
#[derive(Clone, Debug)]
struct Request {
    name: String,
    variable: Variable,
    suffixes: &'static [&'static str],
}

/// The output-variable integrator.
#[derive(Clone, Debug)]
pub struct Aov {
    nested: Vec<Nested>,
    requests: Vec<Request>,
}

impl Aov {
    /// Reads the integrator, its `aovs` list and the integrators nested in it.
    pub fn from_params(params: &Params<'_>) -> Option<Self> {
        let Some(text) = params.string("aovs") else {
            if !params.has("aovs") {
                params.missing("aovs", "a list such as \"d:depth,n:sh_normal\"");
            }
            return None;
        };
        let mut requests = Vec::new();
        for entry in text.split(',').map(str::trim).filter(|e| !e.is_empty()) {
            requests.push(Self::request(params, entry)?);
        }
        Some(Self {
            nested: Nested::all(params)?,
            requests,
        })
    }

    /// The features of a denoiser: `albedo`, `normal` and `depth` of the first surface, without a picture.
    pub fn features() -> Self {
        let named = [
            ("albedo", "albedo"),
            ("normal", "sh_normal"),
            ("depth", "depth"),
        ];
        let requests = named.into_iter().filter_map(|(name, kind)| {
            let (_, variable, suffixes) = VARIABLES.iter().find(|(k, ..)| *k == kind)?;
            Some(Request {
                name: name.to_owned(),
                variable: *variable,
                suffixes,
            })
        });
        Self {
            nested: Vec::new(),
            requests: requests.collect(),
        }
    }

    fn request(params: &Params<'_>, entry: &str) -> Option<Request> {
        let Some((name, kind)) = entry.split_once(':') else {
            params.error_at("aovs", format!("`{entry}` is not of the form `name:type`"));
            return None;
        };
        let (name, kind) = (name.trim(), kind.trim());
        let Some((_, variable, suffixes)) = VARIABLES.iter().find(|(k, ..)| *k == kind) else {
            let span = params.property("aovs").map_or(params.node.span, |p| p.span);
            params.diagnostics.push(
                Diagnostic::error(span, format!("`{kind}` is not an output variable"))
                    .suggest(kind, VARIABLES.iter().map(|(k, ..)| *k)),
            );
            return None;
        };
        Some(Request {
            name: name.to_owned(),
            variable: *variable,
            suffixes,
        })
    }
}

impl Integrator for Aov {
    const UNBIASED: bool = false;
    /// Its nested integrators decide.
    const MEDIA: bool = true;
    const DIFFUSION: bool = true;
    const FOLLOWS_LIGHT: bool = false;

    type State = ();

    fn channels(&self) -> Vec<Channel> {
        let mut names = Vec::new();
        for Nested {
            name, integrator, ..
        } in &self.nested
        {
            names.extend(["R", "G", "B", "A"].map(|c| format!("{name}.{c}")));
            for Channel(channel) in integrator.channels() {
                names.push(format!("{name}.{channel}"));
            }
        }
        for request in &self.requests {
            names.extend(
                request
                    .suffixes
                    .iter()
                    .map(|s| format!("{}.{s}", request.name)),
            );
        }
        names.into_iter().map(Channel).collect()
    }

    fn splats(&self) -> bool {
        false
    }

    /// Those of the integrators inside.
    fn incompatibilities(&self, capabilities: &SceneCapabilities) -> Vec<Incompatibility> {
        Nested::incompatibilities(&self.nested, capabilities)
    }

    fn replicate_kind(&self) -> ReplicateKind {
        Nested::replicate_kind(&self.nested)
    }

    fn samples_per_pass(&self) -> Option<u32> {
        None
    }

    fn prepare<W: World>(&self, _: &W, _: &impl Placing, _: &Pass, _: Option<()>) {}

    fn sample<W: World, S: Sampler, K: Sink>(
        &self,
        world: &W,
        (): &(),
        site: &PixelSample,
        sampler: &mut S,
        sink: &mut K,
    ) {
        let mut index = 0;
        for (position, nested) in self.nested.iter().enumerate() {
            let mut labelled = Labelled {
                sink: &mut *sink,
                base: index,
                picture: position == 0,
            };
            nested
                .integrator
                .sample_nested(world, site, sampler, &mut labelled);
            index += 4 + nested.channels;
        }

        let (_, ray, _) = camera_ray(world, site, sampler);
        let hit = world.surfaces().intersect(&ray);
        if self.nested.is_empty() {
            sink.radiance([0.0; 3], if hit.is_some() { 1.0 } else { 0.0 });
        }
        let Some(hit) = hit else {
            return;
        };
        let vertex = world.surfaces().vertex(&ray, &hit);
        for request in &self.requests {
            let value = evaluate(request.variable, world, &ray, &vertex, site, sampler);
            for (i, _) in request.suffixes.iter().enumerate() {
                sink.channel(index, value[i]);
                index += 1;
            }
        }
    }

    one_by_one!();
}

/// The value of a variable where a ray meets a surface: three numbers, or the same one three times.
pub(crate) fn evaluate<W: World, S: Sampler>(
    variable: Variable,
    world: &W,
    ray: &Ray,
    vertex: &SurfaceInteraction,
    site: &PixelSample,
    sampler: &mut S,
) -> Vec3 {
    match variable {
        Variable::Albedo => {
            let wo = -ray.direction;
            let colour: Vec3 = DAYLIGHT
                .iter()
                .map(|node| {
                    let albedo = world
                        .surfaces()
                        .bsdf(vertex, wo, &node.wavelengths)
                        .albedo(wo);
                    let light = node.daylight / (4 * NODES) as f32;
                    node.response
                        .rgb(albedo.clamp(Vec4::ZERO, Vec4::ONE) * light)
                })
                .sum();
            colour.clamp(Vec3::ZERO, Vec3::ONE)
        }
        Variable::Depth => Vec3::splat(vertex.t),
        Variable::Position => vertex.position,
        Variable::Uv => vertex.uv.extend(0.0),
        Variable::GeometricNormal => vertex.normal,
        Variable::ShadingNormal => vertex.shading.n,
        Variable::DpDu => vertex.dp_du,
        Variable::DpDv => vertex.dp_dv,
        Variable::DuvDx => duv(world, vertex, site, sampler, Vec2::X),
        Variable::DuvDy => duv(world, vertex, site, sampler, Vec2::Y),
        Variable::PrimitiveIndex => Vec3::splat(vertex.primitive as f32),
        Variable::ShapeIndex => Vec3::splat((vertex.shape.0 + 1) as f32),
    }
}

/// The change of texture coordinates from this film position to the one a sample spacing away
/// along `axis`: where the neighbouring ray meets the tangent plane, expressed in ∂p/∂u and
/// ∂p/∂v by least squares. Zero where those are degenerate.
fn duv<W: World, S: Sampler>(
    world: &W,
    vertex: &SurfaceInteraction,
    site: &PixelSample,
    sampler: &mut S,
    axis: Vec2,
) -> Vec3 {
    sampler.skip_to(dim::LENS);
    let lens = sampler.next_2d();
    let next = world
        .camera()
        .ray(site.raster + axis * site.spacing, lens, vertex.time)
        .ray;
    let along = next.direction.dot(vertex.normal);
    let t = (vertex.position - next.origin).dot(vertex.normal) / along;
    let dp = next.at(t) - vertex.position;
    let (u, v) = (vertex.dp_du, vertex.dp_dv);
    let (a, b, c) = (u.dot(u), u.dot(v), v.dot(v));
    let (x, y) = (u.dot(dp), v.dot(dp));
    let determinant = a * c - b * b;
    let solved = Vec3::new(c * x - b * y, a * y - b * x, 0.0) / determinant;
    if solved.is_finite() {
        solved
    } else {
        Vec3::ZERO
    }
}

/// Gives a nested integrator's findings their channels.
struct Labelled<'a> {
    sink: &'a mut dyn Sink,
    base: usize,
    picture: bool,
}

impl Sink for Labelled<'_> {
    fn radiance(&mut self, rgb: [f32; 3], alpha: f32) {
        if self.picture {
            self.sink.radiance(rgb, alpha);
        }
        let [r, g, b] = rgb;
        for (i, value) in [r, g, b, alpha].into_iter().enumerate() {
            self.sink.channel(self.base + i, value);
        }
    }

    fn splat(&mut self, _: Vec2, _: [f32; 3]) {
        unreachable!("integrators that splat are refused when the scene is read");
    }

    fn channel(&mut self, index: usize, value: f32) {
        self.sink.channel(self.base + 4 + index, value);
    }
}
