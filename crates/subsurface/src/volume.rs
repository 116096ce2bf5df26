//! What varies in space, or does not: the volumes of a medium's parameters.

use etalon_params::{Class, Params, Value, plugins};
use etalon_transport::{Build, SpectrumKind, TextureId, refuse_varying};

/// Names of the volumes that are built.
const BUILT: [&str; 1] = ["constvolume"];

/// The spectrum of the parameter `name`: a number, a colour, a spectrum, or a volume that is the same everywhere.
pub(crate) fn constant(
    params: &Params<'_>,
    name: &str,
    default: f64,
    kind: SpectrumKind,
    build: &mut dyn Build,
) -> TextureId {
    let property = params.node.properties.iter().find(|p| p.name == name);
    match property.map(|p| &p.value) {
        // As in Mitsuba, whatever the colour is of; one beyond 1 has no such spectrum.
        Some(Value::Rgb(rgb)) if rgb.max_element() <= 1.0 => {
            build.texture(params, name, Some(default), SpectrumKind::Reflectance)
        }
        Some(Value::Object(node)) if node.class == Class::Volume => {
            params.property(name);
            if !BUILT.contains(&node.plugin.value.as_str()) {
                params.diagnostics.push(plugins::not_built(node, BUILT));
            }
            let volume = Params::new(node, params.diagnostics);
            refuse_varying(&volume, "value");
            let spectrum = build.texture(&volume, "value", Some(1.0), kind);
            if BUILT.contains(&node.plugin.value.as_str()) {
                volume.finish();
            }
            spectrum
        }
        _ => {
            refuse_varying(params, name);
            build.texture(params, name, Some(default), kind)
        }
    }
}
