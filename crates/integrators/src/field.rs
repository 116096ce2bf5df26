//! `field`: one variable of the first surface as a picture, as Mitsuba 0.6's `field` shows it; nested in an `aov`, which
//! its `multichannel` is read as, one picture beside others.
//!
//! ```text
//! C = 1/n Σᵢ wᵢ v(xᵢ)
//! ```
//!
//! over the n samples of a pixel, with weights wᵢ and variables v as in [`crate::aov`]; v is `undefined` where no
//! surface is hit. The three numbers of a variable are those of a colour, (u, v) are (u, v, 0), and one number is grey.

use crate::aov::{Variable, evaluate};
use crate::steps::camera_ray::camera_ray;
use etalon_params::{ParameterKind, Params, SpectrumText, Value};
use etalon_sampling::{ReplicateKind, Sampler};
use etalon_transport::{
    Channel, Incompatibility, Integrator, Pass, PixelSample, Placing, SceneCapabilities, Sink,
    Surfaces, World, one_by_one,
};
use glam::Vec3;

/// Mitsuba 0.6's names, and what is added to the variable: its shapes are counted from 0.
const FIELDS: [(&str, Variable, f32); 8] = [
    ("position", Variable::Position, 0.0),
    ("distance", Variable::Depth, 0.0),
    ("geoNormal", Variable::GeometricNormal, 0.0),
    ("shNormal", Variable::ShadingNormal, 0.0),
    ("uv", Variable::Uv, 0.0),
    ("albedo", Variable::Albedo, 0.0),
    ("shapeIndex", Variable::ShapeIndex, -1.0),
    ("primIndex", Variable::PrimitiveIndex, 0.0),
];

/// The integrator that shows a variable.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    variable: Variable,
    offset: f32,
    undefined: Vec3,
}

impl Field {
    /// Reads `field`, which is needed, and `undefined` (0), a number or a colour.
    pub fn from_params(params: &Params<'_>) -> Option<Self> {
        let undefined = undefined(params);
        let names = FIELDS.map(|(name, ..)| name);
        if !params.has("field") {
            let list = format!("one of {}", names.join(", "));
            params.missing("field", &list);
            return None;
        }
        if params.string("field") == Some("relPosition") {
            params.error_with_help(
                "field",
                "positions in the camera's space, `relPosition`, are not built",
                "`position` is that in the world, which the inverse of the sensor's `to_world` takes to the camera's space",
            );
            return None;
        }
        let chosen = params.choice("field", names[0], &names);
        let (_, variable, offset) = FIELDS.into_iter().find(|(name, ..)| *name == chosen)?;
        Some(Self {
            variable,
            offset,
            undefined: undefined?,
        })
    }
}

/// What is shown where there is nothing.
fn undefined(params: &Params<'_>) -> Option<Vec3> {
    params.note_default("undefined", ParameterKind::Words("a number or a colour"), 0);
    let value = match params.property("undefined").map(|p| &p.value) {
        None => Vec3::ZERO,
        Some(Value::Rgb(colour)) => colour.as_vec3(),
        Some(Value::Float(x) | Value::Spectrum(SpectrumText::Uniform(x))) => Vec3::splat(*x as f32),
        Some(Value::Integer(i)) => Vec3::splat(*i as f32),
        Some(_) => Vec3::NAN,
    };
    if !value.is_finite() {
        let message = "`undefined` must be a finite number or an `rgb` colour";
        params.error_at("undefined", message);
    }
    value.is_finite().then_some(value)
}

impl Integrator for Field {
    const UNBIASED: bool = false;
    /// They do not hide what it shows.
    const MEDIA: bool = true;
    const DIFFUSION: bool = true;
    const FOLLOWS_LIGHT: bool = false;

    type State = ();

    fn channels(&self) -> Vec<Channel> {
        Vec::new()
    }

    fn splats(&self) -> bool {
        false
    }

    /// It needs no light.
    fn incompatibilities(&self, _: &SceneCapabilities) -> Vec<Incompatibility> {
        Vec::new()
    }

    fn replicate_kind(&self) -> ReplicateKind {
        ReplicateKind::Blocks
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
        let (_, ray, _) = camera_ray(world, site, sampler);
        let Some(hit) = world.surfaces().intersect(&ray) else {
            sink.radiance(self.undefined.to_array(), 0.0);
            return;
        };
        let vertex = world.surfaces().vertex(&ray, &hit);
        let value = evaluate(self.variable, world, &ray, &vertex, site, sampler);
        sink.radiance((value + self.offset).to_array(), 1.0);
    }

    one_by_one!();
}
