//! From what was read to the scene: names that nobody defined, circles of references, and defaults.

use super::definitions::suggested;
use super::number::excerpt;
use super::open_block;
use super::order::{MOST_LEVELS, Tangle, order};
use super::parameter::{Parameter, ParameterType, Values};
use super::reader::Reader;
use super::scene::{Camera, Entity, Material, Medium, Object, Scene, Texture, TextureKind};
use etalon_params::{Diagnostic, Diagnostics, FileId, Sources, Span, Spanned};
use std::collections::HashMap;

/// Ends reading.
pub(crate) fn finish(mut reader: Reader<'_>) -> (Sources, Vec<Diagnostic>, Option<Scene>) {
    if reader.mistakes.is_full() {
        return (reader.sources, reader.mistakes.into_sorted(), None);
    }
    open_block::close_all(&mut reader);
    if reader.world.is_none() && !reader.said_no_world() {
        reader.report(Diagnostic::error_nowhere("the scene has no `WorldBegin`"));
    }
    report_unknown_textures(&mut reader);
    let mistakes = &mut reader.mistakes;
    let objects = reader.objects.finish(mistakes, |name| Object {
        name,
        shapes: Vec::new(),
        instances: Vec::new(),
    });
    let materials = reader.materials.finish(mistakes, |name| Material {
        entity: Entity::bare("diffuse", name.span),
        name: Some(name),
        mixed: Vec::new(),
    });
    let media = reader.media.finish(mistakes, |name| Medium {
        entity: Entity::bare("homogeneous", name.span),
        name,
        placement: Default::default(),
    });
    let mut ordered = |family: &str, names: &[(&str, Span)], references: &[Vec<usize>]| {
        let (order, tangles) = order(references);
        for tangle in tangles {
            mistakes.report(describe(family, names, tangle));
        }
        order
    };
    let names: Vec<_> = objects.iter().map(|object| named(&object.name)).collect();
    let contained = |object: &Object| object.instances.iter().map(|i| i.object).collect();
    let contained: Vec<Vec<usize>> = objects.iter().map(contained).collect();
    let object_order = ordered("object", &names, &contained);

    let names = materials.iter().map(|material| match &material.name {
        Some(name) => named(name),
        None => ("", material.entity.span),
    });
    let names: Vec<_> = names.collect();
    let mixed: Vec<Vec<usize>> = materials.iter().map(|m| m.mixed.clone()).collect();
    let material_order = ordered("material", &names, &mixed);

    let textures = &reader.textures;
    let names: Vec<_> = textures
        .iter()
        .map(|texture| named(&texture.name))
        .collect();
    let referred = textures
        .iter()
        .map(|texture| texture_references(texture, &reader.texture_ids));
    let referred: Vec<Vec<usize>> = referred.collect();
    let texture_order = ordered("texture", &names, &referred);

    let start = Span {
        file: FileId(0),
        start: 0,
        end: 0,
    };
    let default = |given: Option<Entity>, kind| given.unwrap_or_else(|| Entity::bare(kind, start));
    let camera = || Camera {
        entity: Entity::bare("perspective", start),
        placement: Default::default(),
        medium: None,
    };
    let settings = reader.settings;
    let mut search = reader.files.search;
    for folder in reader.files.included_folders {
        search.append(folder);
    }
    let scene = Scene {
        camera: settings.camera.unwrap_or_else(camera),
        film: default(settings.film, "rgb"),
        sampler: default(settings.sampler, "zsobol"),
        filter: default(settings.filter, "gaussian"),
        integrator: default(settings.integrator, "volpath"),
        accelerator: default(settings.accelerator, "bvh"),
        options: reader.scene_options,
        shapes: reader.shapes,
        lights: reader.lights,
        instances: reader.instances,
        objects,
        object_order,
        materials,
        material_order,
        media,
        textures: reader.textures,
        texture_order,
        search,
        files: reader.files.paths,
        texture_ids: reader.texture_ids,
    };
    (reader.sources, reader.mistakes.into_sorted(), Some(scene))
}

fn named(name: &Spanned<String>) -> (&str, Span) {
    (&name.value, name.span)
}

/// The textures that a texture refers to. The parameters of spectrum textures name spectrum textures, but for two that pbrt
/// knows to be numbers.
fn texture_references(
    texture: &Texture,
    ids: &HashMap<(TextureKind, String), usize>,
) -> Vec<usize> {
    let is_texture = |parameter: &&Parameter| parameter.kind == ParameterType::Texture;
    let mut references = Vec::new();
    for parameter in texture.entity.params.iter().filter(is_texture) {
        let kind = match parameter.name.as_str() {
            "amount" | "scale" => TextureKind::Float,
            _ => texture.kind,
        };
        if let Values::Strings(names) = &parameter.values {
            // There is one; more are a mistake that is found when they are read.
            let name = names.first().map(|name| name.value.clone());
            references.extend(name.and_then(|name| ids.get(&(kind, name))));
        }
    }
    references
}

/// Reports the names of textures that nobody defined.
fn report_unknown_textures(reader: &mut Reader<'_>) {
    let is_known = |name: &str| {
        let mut kinds = [TextureKind::Float, TextureKind::Spectrum].into_iter();
        kinds.any(|kind| reader.texture_ids.contains_key(&(kind, name.to_owned())))
    };
    let uses = reader.texture_uses.iter();
    let mut unknown: Vec<(&String, Span)> = uses
        .filter(|(name, _)| !is_known(name))
        .map(|(name, span)| (name, *span))
        .collect();
    unknown.sort_unstable_by_key(|(_, span)| *span);
    for (name, span) in unknown {
        if reader.mistakes.is_full() {
            return;
        }
        let message = format!("there is no texture `{}`", excerpt(name));
        let names = reader.textures.iter().map(|t| t.name.value.as_str());
        let mistake = suggested(Diagnostic::error(span, message), name, names);
        reader.mistakes.report(mistake);
    }
}

/// The message about references that cannot be put into an order.
fn describe(family: &str, names: &[(&str, Span)], tangle: Tangle) -> Diagnostic {
    const MOST_SHOWN: usize = 8;
    let quoted = |id: &usize| match names[*id].0 {
        "" => "a nameless one".to_owned(),
        name => format!("`{}`", excerpt(name)),
    };
    match tangle {
        Tangle::Depth(id) => {
            let (_, place) = names[id];
            let message =
                format!("this {family} contains others more than {MOST_LEVELS} levels deep");
            Diagnostic::error(place, message)
        }
        Tangle::Circle(mut circle) => {
            // It is told from the place that stands first.
            let first = (0..circle.len()).min_by_key(|&i| names[circle[i]].1);
            circle.rotate_left(first.unwrap_or_default());
            let place = circle.first().map_or(names[0].1, |id| names[*id].1);
            if let [alone] = circle.as_slice() {
                let message = format!("the {family} {} contains itself", quoted(alone));
                return Diagnostic::error(place, message);
            }
            let shown: Vec<String> = circle.iter().take(MOST_SHOWN).map(quoted).collect();
            let rest = match circle.len() > MOST_SHOWN {
                true => " → …".to_owned(),
                false => format!(" → {}", shown[0]),
            };
            let message = format!("{family}s contain each other: {}{rest}", shown.join(" → "));
            let others = circle[1..].iter().take(MOST_SHOWN);
            others.fold(Diagnostic::error(place, message), |mistake, id| {
                mistake.related(names[*id].1, "this one, too")
            })
        }
    }
}

/// Notes the parameters of `Attribute` directives that no entity asked for.
pub(crate) fn unused_attributes(scene: &Scene, diagnostics: &Diagnostics) {
    let shapes = scene.shapes.iter();
    let in_objects = scene.objects.iter().flat_map(|object| &object.shapes);
    let shapes = shapes.chain(in_objects);
    let entities = shapes.flat_map(|shape| {
        let light = shape.area_light.iter().map(|light| &**light);
        std::iter::once(&shape.entity).chain(light)
    });
    let lights = scene.lights.iter().map(|light| &light.entity);
    let materials = scene.materials.iter().map(|material| &material.entity);
    let media = scene.media.iter().map(|medium| &medium.entity);
    let textures = scene.textures.iter().map(|texture| &texture.entity);
    let all = entities
        .chain(lights)
        .chain(materials)
        .chain(media)
        .chain(textures);
    let mut seen = std::collections::HashSet::new();
    for entity in all {
        let list = &entity.params.inherited;
        if !seen.insert(list.as_ptr()) {
            continue;
        }
        for parameter in list.iter().filter(|parameter| !parameter.is_used()) {
            let name = excerpt(&parameter.name);
            let message = format!("no entity took the attribute `{name}`");
            diagnostics.push(Diagnostic::note(parameter.declaration, message));
        }
    }
}
