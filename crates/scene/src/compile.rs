//! From a description to a scene.

use crate::builder::Builder;
use crate::described_sensor::{DescribedSensor, read_film, read_filter};
use crate::media::bodies::{Bodies, Extent};
use crate::media::short_flights;
use crate::media::subsurface;
use crate::media::{self, LightMedium, SceneMedia};
use crate::sampler::SamplerSettings;
use crate::scene::Scene;
use crate::scene_tables::SceneTables;
use crate::sensor_choice::{self, SensorChoice};
use crate::surfaces::{self, Emitting, Names, Surfaces};
use etalon_film::{FilmSettings, Framing};
use etalon_geometry::AcceleratorKind;
use etalon_lights::{BoundingSphere, LightDescription, LightSamplerKind, LightSet};
use etalon_params::{Class, Diagnostic, Diagnostics, Node, Params, Property, Span};
use etalon_subsurface::PhaseFunction;
use etalon_transport::{Assets, Build, LightId, MediumId, ShapeId, Shapes, Shutter, SpectrumKind};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A scene, and what its description says about rendering it.
pub struct Compiled {
    /// The scene.
    pub scene: Scene,
    /// The same for each group of three of the film's bands: one, unless it is a spectral film of more.
    pub scenes: Vec<Scene>,
    /// The description of the sensor that is rendered.
    pub sensor: Arc<Node>,
    /// The film of the sensor.
    pub film: FilmSettings,
    /// The sampler of the sensor.
    pub sampler: SamplerSettings,
    /// Where a classic Phong material is described, if any surface has one: it is no scattering
    /// model, and few integrators can show it.
    pub classic: Option<Span>,
    /// The integrator's description, if the scene has one.
    pub integrator: Option<Arc<Node>>,
    /// The names of its objects.
    pub names: Names,
    /// Time spent building the accelerator.
    pub build_time: Duration,
}

/// Compiles the `<scene>` node `root`. `None` if anything was wrong; the mistakes, as many as
/// could be found in one run, are in `diagnostics`.
pub fn compile(root: &Node, assets: &dyn Assets, diagnostics: &Diagnostics) -> Option<Compiled> {
    compile_with(root, assets, diagnostics, &CompileOptions::default())
}

/// Options that complete or override the description.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CompileOptions {
    /// The rendered sensor, if not the first.
    pub sensor: Option<SensorChoice>,
    /// Replacements for the size of its film and the crop window.
    pub framing: Framing,
    /// The kind of all accelerators.
    pub accelerator: AcceleratorKind,
    /// The rule of light selection, if not the scene's.
    pub light_chooser: Option<LightSamplerKind>,
    /// See [`Shutter::frame`].
    pub time: f64,
}

/// As [`compile`], with options.
pub fn compile_with(
    root: &Node,
    assets: &dyn Assets,
    diagnostics: &Diagnostics,
    options: &CompileOptions,
) -> Option<Compiled> {
    let params = Params::new(root, diagnostics);
    let mut builder = Builder::new(assets, diagnostics);
    let placed_sensor = sensor_choice::chosen(&params, options.sensor.as_ref());
    let sensor_node = placed_sensor.map(|placed| placed.node);
    let sensor = placed_sensor
        .and_then(|placed| DescribedSensor::read(placed, &options.framing, &mut builder));
    if let Some(sensor) = &sensor {
        builder.shutter = Shutter {
            frame: options.time,
            ..sensor.shutter
        };
    }
    let integrator = params.child(Class::Integrator).cloned();
    let mut surfaces = surfaces::read(&params, &mut builder);
    let (lights, placed) = lights(&params, &mut surfaces, &mut builder);
    for (_, node) in params.children(Class::Medium) {
        surfaces.medium(node, &mut builder);
    }
    let camera_medium = camera_medium(sensor_node, &mut surfaces, &mut builder);
    let named = params.choice(
        "light_chooser",
        LightSamplerKind::default().name(),
        &LightSamplerKind::ALL.map(LightSamplerKind::name),
    );
    read_unused(&params, &mut builder);
    read_definitions(&params, &mut builder);
    params.finish();
    if diagnostics.has_errors() {
        return None;
    }
    let DescribedSensor {
        mut camera,
        film,
        sampler,
        shutter,
        responses,
    } = sensor?;
    surfaces
        .required_attributes
        .note_ranges(&builder.textures, diagnostics);
    builder.textures.finish_reading();
    let start = Instant::now();
    let geometry = surfaces.geometry.build_with(options.accelerator);
    let build_time = start.elapsed();
    let bounds = geometry.bounds();
    let lookup = SceneTables {
        geometry,
        textures: builder.textures,
    };
    let bodies = Bodies::new(
        &surfaces.bodies,
        surfaces.media.len(),
        &surfaces.interfaces,
        camera_medium,
        |shape| {
            let extent = Extent {
                bounds: Shapes::bounds(&lookup, shape),
                is_simple: lookup.geometry.shape(shape).is_solid(),
            };
            (!surfaces.placed_bodies).then_some(extent)
        },
        diagnostics,
    );
    if bodies.is_some() {
        media::refuse_varying_bodies(&surfaces.media, diagnostics);
    }
    if diagnostics.has_errors() {
        return None;
    }
    short_flights::hold(
        &mut surfaces.media,
        &surfaces.interfaces,
        &lookup,
        diagnostics,
    );
    let bounded = (!surfaces.placed_media).then_some(surfaces.interfaces.as_slice());
    let media = media::prepared(surfaces.media, bounded, camera_medium, &lookup, diagnostics)?;
    let mut media = SceneMedia::new(
        media,
        &surfaces.interfaces,
        surfaces.placed_media,
        &placed,
        camera_medium,
        bodies,
        &lookup,
    );
    media.find_dark(&surfaces.interfaces, &surfaces.materials, &lights, &lookup);
    let [low, high] = media.extent([bounds.min, bounds.max]);
    camera.surround([low, high]);
    let bounds = BoundingSphere::of_box(low, high);
    let kind = (options.light_chooser)
        .or_else(|| LightSamplerKind::named(named))
        .unwrap_or_default();
    let lights = LightSet::new(lights, &lookup, bounds, kind);
    let scenes = Scene::new(
        camera,
        lookup,
        surfaces.materials,
        lights,
        media,
        shutter.rolling,
    )
    .with_sensors(responses);
    Some(Compiled {
        scene: scenes.first()?.clone(),
        sensor: Arc::clone(sensor_node?),
        scenes,
        film,
        sampler,
        classic: surfaces.classic,
        integrator,
        names: surfaces.names,
        build_time,
    })
}

/// The medium that the camera is in.
fn camera_medium(
    sensor: Option<&Arc<Node>>,
    surfaces: &mut Surfaces,
    builder: &mut Builder<'_>,
) -> MediumId {
    let sensor = sensor.map(|node| Params::new(node, builder.diagnostics));
    let medium = sensor.and_then(|sensor| medium_of(&sensor, surfaces, builder));
    medium.unwrap_or(MediumId::NONE)
}

/// The lights with the media around them: emitting shapes first, then those without shape, in the order of the file.
fn lights(
    params: &Params<'_>,
    surfaces: &mut Surfaces,
    builder: &mut Builder<'_>,
) -> (Vec<LightDescription>, Vec<LightMedium>) {
    let diagnostics = builder.diagnostics;
    let (mut lights, mut placed) = (Vec::new(), Vec::new());
    for Emitting { shape, emitter } in core::mem::take(&mut surfaces.emitting) {
        let (shape, emitter) = (&shape, &emitter);
        let params = Params::new(emitter, diagnostics);
        let declared = medium_of(&params, surfaces, builder);
        if let Some(light) = LightDescription::from_params(&params, Some(*shape), builder) {
            surfaces
                .geometry
                .set_light(*shape, LightId(lights.len() as u32));
            lights.push(light);
            placed.push(LightMedium {
                shape: Some(*shape),
                declared,
            });
        }
    }
    for (_, node) in params.children(Class::Emitter) {
        // At the top of a scene it is no light but a definition, with or without an `id`.
        let is_definition = node.plugin.value == "area";
        let is_unused = !node.properties.iter().any(Property::is_used);
        let params = Params::new(node, diagnostics);
        // One that shapes refer to has been read with them.
        let shape = is_definition.then_some(ShapeId(0));
        let declared = medium_of(&params, surfaces, builder);
        let light = LightDescription::from_params(&params, shape, builder);
        if !is_definition {
            placed.extend(light.iter().map(|_| LightMedium {
                shape: None,
                declared,
            }));
            lights.extend(light);
        } else if is_unused {
            let message = "no shape refers to this `area` light: it shines nowhere";
            diagnostics.push(Diagnostic::note(node.plugin.span, message));
        }
    }
    (lights, placed)
}

/// The medium that a sensor or a light says it is in.
fn medium_of(
    params: &Params<'_>,
    surfaces: &mut Surfaces,
    builder: &mut Builder<'_>,
) -> Option<MediumId> {
    let medium = params.child(Class::Medium)?;
    Some(surfaces.medium(medium, builder))
}

/// Reads films, filters and samplers at the top of a scene, which others may refer to, so that mistakes in
/// unused ones are found.
fn read_definitions(params: &Params<'_>, builder: &mut Builder<'_>) {
    let diagnostics = builder.diagnostics;
    for (_, node) in params.children(Class::Film) {
        read_film(node, builder);
    }
    for (_, node) in params.children(Class::Sampler) {
        SamplerSettings::from_node(node, diagnostics);
    }
    for (_, node) in params.children(Class::ReconstructionFilter) {
        read_filter(node, diagnostics);
    }
}

/// Reads unused textures, volumes, phase functions and subsurface descriptions at the top of a scene, so that mistakes in them
/// are found. Textures are read as emission, which accepts any colour.
fn read_unused(params: &Params<'_>, builder: &mut Builder<'_>) {
    let unused = |class| {
        let children = params.children(class).into_iter().map(|(_, node)| node);
        children.filter(|node| !node.properties.iter().any(Property::is_used))
    };
    for node in unused(Class::Texture).chain(unused(Class::Volume)) {
        builder.nested_texture(node, SpectrumKind::Emission);
    }
    for node in unused(Class::Phase) {
        PhaseFunction::from_params(&Params::new(node, builder.diagnostics), builder);
    }
    for node in unused(Class::Subsurface) {
        subsurface::read(node, builder);
    }
}
