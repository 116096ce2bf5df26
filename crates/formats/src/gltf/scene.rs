//! The whole scene.

use super::reader::Reader;
use crate::document::ReadOptions;
use crate::draft::Draft;
use etalon_params::{Class, Node, Sources, Span};
use std::sync::Arc;

/// The node of the scene, at the moment that is asked for.
pub(crate) fn root(
    reader: &mut Reader<'_>,
    options: &ReadOptions,
    sources: &mut Sources,
) -> Arc<Node> {
    let contents = reader.contents(options.time);
    let shapes = reader.shapes(&contents.meshes);
    let bounds = reader.bounds(&contents.meshes);
    let lights: Vec<Arc<Node>> = (contents.lights.iter())
        .filter_map(|held| reader.light(held))
        .collect();
    let surfaces = reader.materials.values().flatten();
    let shines = !lights.is_empty() || surfaces.clone().any(|surface| surface.emitter.is_some());
    let environment = options.environment.as_deref();
    let surroundings = reader.surroundings(environment, shines, sources);
    let mut parts = vec![integrator(reader, options.integrator.as_deref(), sources)];
    parts.extend(reader.sensors(&contents.cameras, bounds));
    parts.extend(shapes);
    parts.extend(lights);
    parts.extend(surroundings);
    let whole = Draft::new(Class::Scene, "scene", reader.span("scene"));
    parts.into_iter().fold(whole, Draft::child).node()
}

/// `path`, unless another one is asked for.
fn integrator(reader: &Reader<'_>, other: Option<&str>, sources: &mut Sources) -> Arc<Node> {
    let draft = match other {
        None => Draft::new(Class::Integrator, "path", reader.span("scene")),
        Some(name) => {
            let file = sources.add("--integrator", name);
            let end = name.len() as u32;
            Draft::new(
                Class::Integrator,
                name,
                Span {
                    file,
                    start: 0,
                    end,
                },
            )
        }
    };
    draft.node()
}
