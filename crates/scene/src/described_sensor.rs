//! A sensor as described: camera, film, filter and sampler.

use crate::builder::Builder;
use crate::measured_shape::MeasuredShape;
use crate::sampler::SamplerSettings;
use crate::sensor::{Response, curve};
use crate::sensor_choice::PlacedSensor;
use etalon_cameras::{AnyCamera, FilmWindow, SensorShapes};
use etalon_film::{BoxFilter, FilmSettings, Filter, Framing};
use etalon_params::{Class, Diagnostic, Diagnostics, Node, Params, Property, Value, plugins};
use etalon_spectrum::Sensor;
use etalon_transport::Shutter;
use std::sync::Arc;

/// A sensor with its film, filter and sampler.
pub(crate) struct DescribedSensor {
    pub(crate) camera: AnyCamera<MeasuredShape>,
    pub(crate) film: FilmSettings,
    pub(crate) sampler: SamplerSettings,
    pub(crate) shutter: Shutter,
    /// Response curves of the film's channels, three each.
    pub(crate) responses: Vec<Sensor>,
}

impl DescribedSensor {
    /// Reads them; `None` after a mistake.
    pub(crate) fn read(
        placed: PlacedSensor<'_>,
        framing: &Framing,
        builder: &mut Builder<'_>,
    ) -> Option<Self> {
        let diagnostics = builder.diagnostics;
        let sensor = Params::new(placed.node, diagnostics);
        let film = film(&sensor, builder).and_then(|(mut film, response)| {
            let framed = framing.apply(&mut film).map_err(Diagnostic::error_nowhere);
            diagnostics.keep(framed).map(|()| (film, response))
        });
        let filter = sensor.has("srf").then(|| curve(&sensor, "srf", builder));
        let sampler = SamplerSettings::from_sensor(&sensor);
        // After a mistake in the film, any film will do to find those of the camera.
        let stand_in = || {
            let film = FilmSettings::new(768, 576, Filter::default());
            (film, Response::default())
        };
        let (mut film, response) = film.unwrap_or_else(stand_in);
        let window = FilmWindow {
            size: film.size,
            origin: film.crop_offset,
            crop: film.crop_size,
        };
        let carrier = match placed.carrier {
            Some(shape) => Some(MeasuredShape::read(shape, false, builder)?),
            None => None,
        };
        let mut shapes = SensorShapes {
            carrier,
            read: &mut |shape| MeasuredShape::read(shape, true, builder),
        };
        let (camera, shutter) = AnyCamera::from_params(&sensor, window, &mut shapes)?;
        if camera.is_meter() {
            measure(&sensor, &mut film);
        }
        let filter = match filter {
            Some(filter) => Some(filter?),
            None => None,
        };
        Some(Self {
            camera,
            film,
            sampler,
            shutter,
            responses: response.sensors(filter.as_ref()),
        })
    }
}

/// Gives the film of a sensor that measures numbers the filter with which every sample of a pixel counts alike.
fn measure(sensor: &Params<'_>, film: &mut FilmSettings) {
    let is_given = |node: &Arc<Node>| {
        let filters = |p: &Property| matches!(&p.value, Value::Object(child) if child.class == Class::ReconstructionFilter);
        node.properties.iter().any(filters)
    };
    let filter = Filter::Box(BoxFilter);
    if film.filter != filter && sensor.child(Class::Film).is_some_and(is_given) {
        let message = format!(
            "`{}` measures with the filter `box`, in which every sample counts alike",
            sensor.node.plugin.value
        );
        let span = sensor.node.plugin.span;
        (sensor.diagnostics).push(Diagnostic::note(span, message));
    }
    film.filter = filter;
}

/// The film of a sensor, by default Mitsuba's `hdrfilm`.
fn film(sensor: &Params<'_>, builder: &mut Builder<'_>) -> Option<(FilmSettings, Response)> {
    let (mut film, response) = match sensor.child(Class::Film) {
        Some(node) => read_film(node, builder)?,
        None => {
            let film = FilmSettings::new(768, 576, Filter::default());
            (film, Response::default())
        }
    };
    if let Some(node) = sensor.child(Class::ReconstructionFilter) {
        let has_own = |film: &Arc<Node>| {
            let film = Params::new(film, builder.diagnostics);
            !film.children(Class::ReconstructionFilter).is_empty()
        };
        if sensor.child(Class::Film).is_some_and(has_own) {
            let message = "the film has a filter of its own";
            (builder.diagnostics).push(Diagnostic::error(node.plugin.span, message));
            return None;
        }
        let message = "an `rfilter` stands in the film: this one is taken as the film's";
        (builder.diagnostics).push(Diagnostic::note(node.plugin.span, message));
        film.filter = read_filter(node, builder.diagnostics);
    }
    Some((film, response))
}

/// A filter by itself.
pub(crate) fn read_filter(node: &Node, diagnostics: &Diagnostics) -> Filter {
    let params = Params::new(node, diagnostics);
    let filter = Filter::from_params(&params);
    params.finish();
    filter
}

/// An `hdrfilm` or `specfilm`, or one of Mitsuba 0.6's other films, which is read as an `hdrfilm`.
pub(crate) fn read_film(
    node: &Node,
    builder: &mut Builder<'_>,
) -> Option<(FilmSettings, Response)> {
    let diagnostics = builder.diagnostics;
    let name = node.plugin.value.as_str();
    if FilmSettings::OTHER_PLUGINS.contains(&name) {
        diagnostics.push(
            Diagnostic::note(
                node.plugin.span,
                format!("the film `{name}` is read as an `hdrfilm`: the picture stays linear"),
            )
            .help("`etalon convert` makes a picture for the screen of it"),
        );
    } else if !FilmSettings::PLUGINS.contains(&name) {
        diagnostics.push(plugins::not_built(node, FilmSettings::PLUGINS));
        return None;
    }
    let params = Params::new(node, diagnostics);
    let mut film = FilmSettings::from_params(&params);
    let response = Response::read(&params, &mut film, builder);
    params.finish();
    Some((film, response?))
}
