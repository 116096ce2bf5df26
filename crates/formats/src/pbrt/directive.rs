//! The directives: where each may stand, what follows it, and what it does.

use super::kinds::conversion;
use super::number::excerpt;
use super::reader::Reader;
use super::statement::Statement;
use super::tokens::Token;
use super::{ctm, include, open_block, options, settings, world};
use etalon_params::Diagnostic;

/// On which side of `WorldBegin` a directive may stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    /// Before it.
    Options,
    /// After it.
    World,
    /// On both sides.
    Both,
}

/// What follows a directive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Arguments {
    /// Nothing.
    None,
    /// So many numbers, which may stand in brackets.
    Numbers(usize),
    /// Sixteen numbers in brackets.
    Matrix,
    /// One of a few words without quotes.
    Word(&'static [&'static str]),
    /// A name.
    Name,
    /// One name or two.
    Names,
    /// A name, and a word or a string.
    Setting,
    /// A type or name, and parameters.
    Entity,
    /// A name, `"float"` or `"spectrum"`, a type, and parameters.
    Texture,
}

/// A directive.
#[derive(Debug)]
pub(crate) struct Directive {
    pub(crate) name: &'static str,
    pub(crate) side: Side,
    pub(crate) arguments: Arguments,
    /// Does what it says.
    pub(crate) apply: fn(&mut Reader<'_>, Statement),
}

const fn entry(
    name: &'static str,
    side: Side,
    arguments: Arguments,
    apply: fn(&mut Reader<'_>, Statement),
) -> Directive {
    Directive {
        name,
        side,
        arguments,
        apply,
    }
}

use Arguments as A;
use Side::{Both, Options, World};

/// All directives of pbrt-v4, the most frequent ones first.
pub(crate) const DIRECTIVES: &[Directive] = &[
    entry("Shape", World, A::Entity, world::shape),
    entry(
        "AttributeBegin",
        World,
        A::None,
        open_block::attribute_begin,
    ),
    entry("AttributeEnd", World, A::None, open_block::attribute_end),
    entry("NamedMaterial", World, A::Name, world::named_material),
    entry("ObjectInstance", World, A::Name, world::object_instance),
    entry("ConcatTransform", Both, A::Matrix, ctm::concat_transform),
    entry("Transform", Both, A::Matrix, ctm::transform),
    entry("Translate", Both, A::Numbers(3), ctm::translate),
    entry("Rotate", Both, A::Numbers(4), ctm::rotate),
    entry("Scale", Both, A::Numbers(3), ctm::scale),
    entry("LookAt", Both, A::Numbers(9), ctm::look_at),
    entry("Identity", Both, A::None, ctm::identity),
    entry("CoordinateSystem", Both, A::Name, ctm::coordinate_system),
    entry("CoordSysTransform", Both, A::Name, ctm::coord_sys_transform),
    entry(
        "ActiveTransform",
        Both,
        A::Word(&["All", "StartTime", "EndTime"]),
        ctm::active_transform,
    ),
    entry(
        "TransformTimes",
        Options,
        A::Numbers(2),
        ctm::transform_times,
    ),
    entry(
        "TransformBegin",
        World,
        A::None,
        open_block::transform_begin,
    ),
    entry("TransformEnd", World, A::None, open_block::transform_end),
    entry("ObjectBegin", World, A::Name, open_block::object_begin),
    entry("ObjectEnd", World, A::None, open_block::object_end),
    entry("Attribute", Both, A::Entity, world::attribute),
    entry("Material", World, A::Entity, world::material),
    entry(
        "MakeNamedMaterial",
        World,
        A::Entity,
        world::make_named_material,
    ),
    entry("Texture", World, A::Texture, world::texture),
    entry("LightSource", World, A::Entity, world::light_source),
    entry(
        "AreaLightSource",
        World,
        A::Entity,
        world::area_light_source,
    ),
    entry("MakeNamedMedium", Both, A::Entity, world::make_named_medium),
    entry("MediumInterface", Both, A::Names, world::medium_interface),
    entry(
        "ReverseOrientation",
        World,
        A::None,
        world::reverse_orientation,
    ),
    entry("ColorSpace", Both, A::Name, world::color_space),
    entry("Camera", Options, A::Entity, settings::camera),
    entry("Film", Options, A::Entity, settings::film),
    entry("Sampler", Options, A::Entity, settings::sampler),
    entry("PixelFilter", Options, A::Entity, settings::filter),
    entry("Integrator", Options, A::Entity, settings::integrator),
    entry("Accelerator", Options, A::Entity, settings::accelerator),
    entry("Option", Both, A::Setting, options::option),
    entry("WorldBegin", Options, A::None, settings::world_begin),
    entry("Include", Both, A::Name, include::include),
    entry("Import", World, A::Name, include::import),
];

/// Directives of earlier versions, each with what became of it.
const OLD: &[(&str, &str)] = &[
    ("Exterior", "`MediumInterface`"),
    ("Interior", "`MediumInterface`"),
    ("Renderer", "`Integrator`"),
    ("SearchPath", ""),
    ("SurfaceIntegrator", "`Integrator`"),
    ("Volume", "`MakeNamedMedium`"),
    ("VolumeIntegrator", "`Integrator`"),
    ("WorldEnd", "the end of the file"),
];

/// The directive that a word names, or what is wrong with the word.
pub(crate) fn find(token: Token<'_>) -> Result<&'static Directive, Diagnostic> {
    let word = token.text;
    if let Some(found) = DIRECTIVES.iter().find(|directive| directive.name == word) {
        return Ok(found);
    }
    if let Some((old, new)) = OLD.iter().find(|(old, _)| *old == word) {
        let message = format!("`{old}` is of an earlier version, not of pbrt-v4");
        return Err(Diagnostic::error(token.span, message).help(conversion(new)));
    }
    let message = format!("`{}` is not a directive", excerpt(word));
    let mistake = Diagnostic::error(token.span, message);
    Err(mistake.suggest(word, DIRECTIVES.iter().map(|directive| directive.name)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_begin_with_a_capital() {
        for (i, directive) in DIRECTIVES.iter().enumerate() {
            let name = directive.name;
            assert!(name.starts_with(|c: char| c.is_ascii_uppercase()), "{name}");
            let others = DIRECTIVES[..i].iter().map(|other| other.name);
            assert!(
                others
                    .chain(OLD.iter().map(|(old, _)| *old))
                    .all(|other| other != name)
            );
        }
    }
}
