//! The tags of the scene language and the attributes each of them takes.

use etalon_params::Class;

/// What a tag means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tag {
    /// An object of a class.
    Object(Class),
    /// `<float>`.
    Float,
    /// `<integer>`.
    Integer,
    /// `<boolean>`.
    Boolean,
    /// `<string>`.
    String,
    /// `<point>` and `<vector>`.
    Vector,
    /// `<rgb>`.
    Rgb,
    /// `<srgb>`, which Mitsuba 0.x had.
    Srgb,
    /// `<blackbody>`, which Mitsuba 0.x had.
    Blackbody,
    /// `<spectrum>` without a `type`.
    Spectrum,
    /// `<transform>`.
    Transform,
    /// `<animation>`: values at moments. Mitsuba 0.x had it for transforms.
    Animation,
    /// An operation inside of a `<transform>`.
    Operation,
    /// `<ref>`.
    Reference,
    /// `<alias>`.
    Alias,
    /// `<include>`.
    Include,
    /// `<default>`.
    Default,
    /// `<path>`.
    Path,
}

/// Every tag that an object may contain.
pub const TAGS: [(&str, Tag); 31] = [
    ("scene", Tag::Object(Class::Scene)),
    ("bsdf", Tag::Object(Class::Bsdf)),
    ("emitter", Tag::Object(Class::Emitter)),
    ("film", Tag::Object(Class::Film)),
    ("integrator", Tag::Object(Class::Integrator)),
    ("medium", Tag::Object(Class::Medium)),
    ("phase", Tag::Object(Class::Phase)),
    ("rfilter", Tag::Object(Class::ReconstructionFilter)),
    ("sampler", Tag::Object(Class::Sampler)),
    ("sensor", Tag::Object(Class::Sensor)),
    ("shape", Tag::Object(Class::Shape)),
    ("subsurface", Tag::Object(Class::Subsurface)),
    ("texture", Tag::Object(Class::Texture)),
    ("volume", Tag::Object(Class::Volume)),
    ("float", Tag::Float),
    ("integer", Tag::Integer),
    ("boolean", Tag::Boolean),
    ("string", Tag::String),
    ("point", Tag::Vector),
    ("vector", Tag::Vector),
    ("rgb", Tag::Rgb),
    ("srgb", Tag::Srgb),
    ("blackbody", Tag::Blackbody),
    ("spectrum", Tag::Spectrum),
    ("transform", Tag::Transform),
    ("animation", Tag::Animation),
    ("ref", Tag::Reference),
    ("alias", Tag::Alias),
    ("include", Tag::Include),
    ("default", Tag::Default),
    ("path", Tag::Path),
];

/// The operations of a `<transform>` with the attributes each takes (`!` marks required ones).
pub const OPERATIONS: [(&str, &[&str]); 5] = [
    ("translate", &["x", "y", "z", "value"]),
    ("scale", &["x", "y", "z", "value"]),
    ("rotate", &["!angle", "x", "y", "z", "value"]),
    ("lookat", &["!origin", "!target", "up"]),
    ("matrix", &["!value"]),
];

impl Tag {
    /// The meaning of a tag's name.
    pub(crate) fn of(name: &str) -> Option<Self> {
        TAGS.iter()
            .find(|(known, _)| *known == name)
            .map(|(_, tag)| *tag)
            .or_else(|| {
                OPERATIONS
                    .iter()
                    .any(|(known, _)| *known == name)
                    .then_some(Self::Operation)
            })
    }

    /// The attributes it takes; `!` marks those it needs.
    pub fn attributes(self) -> &'static [&'static str] {
        match self {
            Self::Object(_) => &["!type", "id", "name"],
            Self::Float | Self::Integer | Self::Boolean | Self::String | Self::Srgb => {
                &["!name", "!value"]
            }
            Self::Rgb => &["!name", "!value", "intent"],
            Self::Blackbody => &["!name", "!temperature", "scale"],
            Self::Vector => &["!name", "x", "y", "z", "value"],
            Self::Spectrum => &["!name", "value", "filename", "intent"],
            Self::Transform => &["!name"],
            Self::Animation => &["!name", "interpolation"],
            Self::Reference => &["!id", "name"],
            Self::Alias => &["!id", "!as"],
            Self::Include => &["!filename", "name"],
            Self::Default => &["!name", "!value"],
            Self::Path => &["!value"],
            Self::Operation => &[],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_tag_is_found_by_its_name() {
        for (name, tag) in TAGS {
            assert_eq!(Tag::of(name), Some(tag));
        }
        assert_eq!(Tag::of("rotate"), Some(Tag::Operation));
        assert_eq!(Tag::of("lookAt"), None);
    }
}
