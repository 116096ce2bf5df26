//! What stands after `WorldBegin`: shapes, lights, materials, textures and media.

use super::kinds::{self, Kinds, conversion};
use super::number::excerpt;
use super::parameter::{ColorSpace, ParameterType, Values};
use super::parameter_syntax::MOST_PARAMETERS;
use super::reader::Reader;
use super::scene::{
    Entity, Instance, Light, Material, Medium, MediumId, Shape, Texture, TextureKind,
};
use super::state::{Attributes, Inherited};
use super::statement::Statement;
use etalon_params::{Diagnostic, Spanned};
use std::sync::Arc;

pub(crate) fn shape(reader: &mut Reader<'_>, statement: Statement) {
    let Some(kind) = reader.kind(&kinds::SHAPE, &statement.name(0)) else {
        return;
    };
    let inherited = reader.state.attributes.shape.clone();
    let entity = reader.entity(kind, statement, &inherited);
    let state = &reader.state;
    let shape = Shape {
        entity,
        placement: state.ctm.clone(),
        reverse_orientation: state.reverse_orientation,
        material: state.material,
        area_light: state.area_light.clone(),
        inside: state.inside,
        outside: state.outside,
    };
    match &mut reader.open_object {
        Some(object) => object.shapes.push(shape),
        None => reader.shapes.push(shape),
    }
}

/// pbrt has no instances inside of objects; here they are taken as one would expect.
pub(crate) fn object_instance(reader: &mut Reader<'_>, statement: Statement) {
    let instance = Instance {
        object: reader.objects.mention(&statement.name(0)),
        span: statement.span,
        placement: reader.state.ctm.clone(),
    };
    match &mut reader.open_object {
        Some(object) => object.instances.push(instance),
        None => reader.instances.push(instance),
    }
}

pub(crate) fn light_source(reader: &mut Reader<'_>, statement: Statement) {
    let word = statement.word;
    let Some(kind) = reader.kind(&kinds::LIGHT, &statement.name(0)) else {
        return;
    };
    if let Some(object) = &reader.open_object {
        let message = "instances of an object do not repeat the lights in its definition";
        let note = Diagnostic::note(word, message).related(object.name.span, "this object");
        reader.report(note.help("the light shines once, where its own transform puts it"));
    }
    let inherited = reader.state.attributes.light.clone();
    let entity = reader.entity(kind, statement, &inherited);
    reader.lights.push(Light {
        entity,
        placement: reader.state.ctm.clone(),
        medium: reader.state.outside,
    });
}

/// An empty type ends the emission of surfaces.
pub(crate) fn area_light_source(reader: &mut Reader<'_>, statement: Statement) {
    let name = statement.name(0);
    if name.value.is_empty() {
        reader.state.area_light = None;
        return;
    }
    let Some(kind) = reader.kind(&kinds::AREA_LIGHT, &name) else {
        return;
    };
    let inherited = reader.state.attributes.light.clone();
    let entity = reader.entity(kind, statement, &inherited);
    reader.state.area_light = Some(Arc::new(entity));
}

pub(crate) fn material(reader: &mut Reader<'_>, statement: Statement) {
    let word = statement.word;
    let Some(kind) = material_kind(reader, &statement.name(0)) else {
        return;
    };
    let inherited = reader.state.attributes.material.clone();
    let entity = reader.entity(kind, statement, &inherited);
    let mixed = mixed(reader, &entity);
    let material = Material {
        name: None,
        entity,
        mixed,
    };
    reader.state.material = reader.materials.keep(material, word);
}

pub(crate) fn make_named_material(reader: &mut Reader<'_>, statement: Statement) {
    let name = statement.name(0);
    let inherited = reader.state.attributes.material.clone();
    let entity = typed_entity(reader, statement, &inherited, material_kind);
    // After a mistake there is a stand-in, so that its name is known.
    let entity = entity.unwrap_or_else(|| Entity::bare("diffuse", name.span));
    let mixed = mixed(reader, &entity);
    let material = Material {
        name: Some(name.clone()),
        entity,
        mixed,
    };
    if let Err(mistake) = reader.materials.define(&name, material) {
        reader.report(mistake);
    }
}

pub(crate) fn named_material(reader: &mut Reader<'_>, statement: Statement) {
    reader.state.material = reader.materials.mention(&statement.name(0));
}

pub(crate) fn make_named_medium(reader: &mut Reader<'_>, statement: Statement) {
    let name = statement.name(0);
    let inherited = reader.state.attributes.medium.clone();
    let kind = |reader: &mut Reader<'_>, name: &Spanned<String>| reader.kind(&kinds::MEDIUM, name);
    let entity = typed_entity(reader, statement, &inherited, kind);
    let entity = entity.unwrap_or_else(|| Entity::bare("homogeneous", name.span));
    let medium = Medium {
        name: name.clone(),
        entity,
        placement: reader.state.ctm.clone(),
    };
    if let Err(mistake) = reader.media.define(&name, medium) {
        reader.report(mistake);
    }
}

/// One name is that of both sides; an empty one is vacuum.
pub(crate) fn medium_interface(reader: &mut Reader<'_>, statement: Statement) {
    let inside = medium(reader, &statement.name(0));
    let outside = match statement.names.get(1) {
        Some(name) => medium(reader, name),
        None => inside,
    };
    (reader.state.inside, reader.state.outside) = (inside, outside);
}

fn medium(reader: &mut Reader<'_>, name: &Spanned<String>) -> Option<MediumId> {
    (!name.value.is_empty()).then(|| reader.media.mention(name))
}

pub(crate) fn texture(reader: &mut Reader<'_>, statement: Statement) {
    let (name, class) = (statement.name(0), statement.name(1));
    let (kind, kinds): (_, &Kinds) = match class.value.as_str() {
        "float" => (TextureKind::Float, &kinds::FLOAT_TEXTURE),
        "spectrum" => (TextureKind::Spectrum, &kinds::SPECTRUM_TEXTURE),
        other => {
            let message = format!("a texture cannot be of `{}`", excerpt(other));
            let mistake = Diagnostic::error(class.span, message);
            reader.report(match other {
                "color" => mistake.help(conversion("`spectrum`")),
                _ => mistake.suggest(other, ["float", "spectrum"]),
            });
            (TextureKind::Spectrum, &kinds::SPECTRUM_TEXTURE)
        }
    };
    let found = reader.kind(kinds, &statement.name(2));
    let inherited = reader.state.attributes.texture.clone();
    let entity = match found {
        Some(found) => reader.entity(found, statement, &inherited),
        None => Entity::bare("constant", statement.word),
    };
    let key = (kind, name.value.clone());
    if let Some(&first) = reader.texture_ids.get(&key) {
        let message = format!(
            "the {} texture `{}` is defined twice",
            kind.name(),
            excerpt(&name.value)
        );
        let first = reader.textures[first].name.span;
        reader.report(Diagnostic::error(name.span, message).related(first, "first here"));
        return;
    }
    reader.texture_ids.insert(key, reader.textures.len());
    reader.textures.push(Texture {
        name,
        kind,
        entity,
        placement: reader.state.ctm.clone(),
    });
}

pub(crate) fn reverse_orientation(reader: &mut Reader<'_>, _: Statement) {
    reader.state.reverse_orientation = !reader.state.reverse_orientation;
}

pub(crate) fn color_space(reader: &mut Reader<'_>, statement: Statement) {
    let name = statement.name(0);
    let is_meant = |known: &&(&str, ColorSpace)| known.0.eq_ignore_ascii_case(&name.value);
    match ColorSpace::NAMES.iter().find(is_meant) {
        Some((_, space)) => reader.state.color_space = *space,
        None => {
            let message = format!("there is no colour space `{}`", excerpt(&name.value));
            let names = ColorSpace::NAMES.iter().map(|(name, _)| *name);
            reader.report(Diagnostic::error(name.span, message).suggest(&name.value, names));
        }
    }
}

/// Gives parameters to all entities of a family that follow in this block; a later value of a name takes the place of an earlier.
pub(crate) fn attribute(reader: &mut Reader<'_>, statement: Statement) {
    let family = statement.name(0);
    reader.note_textures(statement.parameters.iter());
    let Some(inherited) = Arc::make_mut(&mut reader.state.attributes).of_family(&family.value)
    else {
        let message = format!("`{}` is not a family of attributes", excerpt(&family.value));
        let mistake = Diagnostic::error(family.span, message);
        reader.report(mistake.suggest(&family.value, Attributes::FAMILIES));
        return;
    };
    let given = statement.parameters.into_iter().map(|mut parameter| {
        parameter.is_inherited = true;
        Arc::new(parameter)
    });
    let mut all: Vec<_> = given.collect();
    let count = all.len();
    for before in inherited.iter() {
        let is_replaced = all[..count].iter().any(|given| given.name == before.name);
        if !is_replaced {
            all.push(before.clone());
        }
    }
    if all.len() > MOST_PARAMETERS {
        let message = format!("there are more than {MOST_PARAMETERS} attributes");
        reader
            .mistakes
            .give_up(Diagnostic::error(family.span, message));
        return;
    }
    *inherited = all.into();
}

/// An entity whose type is a parameter: `"string type" "diffuse"`.
fn typed_entity(
    reader: &mut Reader<'_>,
    statement: Statement,
    inherited: &Inherited,
    kind: impl Fn(&mut Reader<'_>, &Spanned<String>) -> Option<&'static str>,
) -> Option<Entity> {
    let word = statement.word;
    // The type is known after the parameters; until then the entity has none.
    let mut entity = reader.entity("", statement, inherited);
    let Some(parameter) = entity.params.find("type") else {
        let message = "the parameter `\"string type\"` is missing";
        reader.report(Diagnostic::error(word, message));
        return None;
    };
    parameter.mark_used();
    let name = match &parameter.values {
        Values::Strings(names) if parameter.kind == ParameterType::String && names.len() == 1 => {
            &names[0]
        }
        Values::Broken => return None,
        _ => {
            let message = "the type must be one string, declared as `\"string type\"`";
            reader.report(Diagnostic::error(parameter.span, message));
            return None;
        }
    };
    entity.kind = kind(reader, name)?;
    Some(entity)
}

/// The type of a material; the two names that pbrt-v4 still takes for `interface` are worth a note.
fn material_kind(reader: &mut Reader<'_>, name: &Spanned<String>) -> Option<&'static str> {
    if matches!(name.value.as_str(), "" | "none") {
        let message = format!(
            "the material `\"{}\"` is now called `interface`",
            name.value
        );
        reader.report(Diagnostic::note(name.span, message));
        return Some("interface");
    }
    reader.kind(&kinds::MATERIAL, name)
}

/// The materials that a `mix` names, which are two.
fn mixed(reader: &mut Reader<'_>, entity: &Entity) -> Vec<usize> {
    let names = entity
        .params
        .find("materials")
        .filter(|_| entity.kind == "mix");
    match names.map(|parameter| &parameter.values) {
        Some(Values::Strings(names)) => {
            let two = names.iter().take(2);
            let ids = two.map(|name| reader.materials.mention(name));
            ids.collect()
        }
        _ => Vec::new(),
    }
}
