//! A parameter: a declaration such as `"float radius"` with its values.

use etalon_params::{Span, Spanned};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// The declared type of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum ParameterType {
    Integer,
    Float,
    Point2,
    Vector2,
    Point3,
    Vector3,
    Normal,
    Spectrum,
    Rgb,
    Blackbody,
    Bool,
    String,
    Texture,
}

impl ParameterType {
    /// The words of the language. `point`, `vector` and `normal3` are pbrt-v3's.
    pub(crate) const WORDS: [(&str, Self); 16] = [
        ("integer", Self::Integer),
        ("float", Self::Float),
        ("point2", Self::Point2),
        ("vector2", Self::Vector2),
        ("point3", Self::Point3),
        ("vector3", Self::Vector3),
        ("normal", Self::Normal),
        ("spectrum", Self::Spectrum),
        ("rgb", Self::Rgb),
        ("blackbody", Self::Blackbody),
        ("bool", Self::Bool),
        ("string", Self::String),
        ("texture", Self::Texture),
        ("point", Self::Point3),
        ("vector", Self::Vector3),
        ("normal3", Self::Normal),
    ];

    /// The word of pbrt-v4.
    pub fn name(self) -> &'static str {
        let mut words = Self::WORDS.iter();
        words
            .find(|(_, kind)| *kind == self)
            .map_or("", |(word, _)| word)
    }

    /// How many numbers make one value; 1 where values are no numbers.
    pub fn numbers_per_value(self) -> usize {
        match self {
            Self::Point2 | Self::Vector2 => 2,
            Self::Point3 | Self::Vector3 | Self::Normal | Self::Rgb => 3,
            _ => 1,
        }
    }
}

/// The RGB colour space that a `ColorSpace` directive sets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ColorSpace {
    /// Primaries of Rec. 709, white D65.
    #[default]
    Srgb,
    /// Primaries of DCI-P3, white D65.
    DciP3,
    /// Primaries of Rec. 2020, white D65.
    Rec2020,
    /// The ACES interchange space: primaries AP0, white near D60.
    Aces2065,
}

impl ColorSpace {
    /// The names in scene files, of which the case does not matter.
    pub(crate) const NAMES: [(&str, Self); 4] = [
        ("srgb", Self::Srgb),
        ("dci-p3", Self::DciP3),
        ("rec2020", Self::Rec2020),
        ("aces2065-1", Self::Aces2065),
    ];
}

/// The values of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Of an `integer`.
    Integers(Box<[i32]>),
    /// Of everything made of numbers: a point is three of them, one after the other.
    Numbers(Box<[f64]>),
    /// Of a `bool`.
    Booleans(Box<[bool]>),
    /// Of a `string`, a `texture`, or a `spectrum` by its name or file.
    Strings(Box<[Spanned<String>]>),
    /// A mistake about them was reported.
    Broken,
}

/// A parameter as it was read.
#[derive(Debug)]
pub struct Parameter {
    /// Its declared type.
    pub kind: ParameterType,
    /// Its name.
    pub name: String,
    /// Where its declaration stands.
    pub declaration: Span,
    /// Its values.
    pub values: Values,
    /// Where they stand, with their brackets.
    pub span: Span,
    /// The colour space where the parameter stands, which an `rgb` refers to.
    pub color_space: ColorSpace,
    /// Whether it comes from an `Attribute` directive, and so may be meant for others.
    pub is_inherited: bool,
    used: AtomicBool,
}

impl Parameter {
    /// An unused parameter.
    pub(crate) fn new(
        kind: ParameterType,
        name: String,
        declaration: Span,
        (values, span): (Values, Span),
        color_space: ColorSpace,
    ) -> Self {
        Self {
            kind,
            name,
            declaration,
            values,
            span,
            color_space,
            is_inherited: false,
            used: AtomicBool::new(false),
        }
    }

    /// Marks it as used.
    pub fn mark_used(&self) {
        self.used.store(true, Ordering::Relaxed);
    }

    /// Whether it is used.
    pub fn is_used(&self) -> bool {
        self.used.load(Ordering::Relaxed)
    }

    /// The declaration as it would be written, for messages.
    pub(crate) fn declared(&self) -> String {
        format!("{} {}", self.kind.name(), self.name)
    }
}

/// The parameters of an entity: its own, and those that `Attribute` directives gave to all of its family.
#[derive(Debug, Default)]
pub struct ParameterList {
    /// Its own, in the order of the file.
    pub own: Box<[Parameter]>,
    /// What holds where it says nothing itself; one list shared by many entities.
    pub inherited: Arc<[Arc<Parameter>]>,
}

impl ParameterList {
    /// The parameter of a name; an own one hides an inherited one, whatever its type.
    pub fn find(&self, name: &str) -> Option<&Parameter> {
        self.iter().find(|parameter| parameter.name == name)
    }

    /// All of them, first its own; inherited ones may be hidden.
    pub fn iter(&self) -> impl Iterator<Item = &Parameter> {
        let inherited = self.inherited.iter().map(|parameter| &**parameter);
        self.own.iter().chain(inherited)
    }
}
