//! Nodes, properties and values.

use crate::Span;
use etalon_math::Motion;
use glam::{DMat4, DVec3};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// What family of things an object belongs to (the XML tag).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[allow(missing_docs)]
pub enum Class {
    Scene,
    Bsdf,
    Emitter,
    Film,
    Integrator,
    Medium,
    Phase,
    ReconstructionFilter,
    Sampler,
    Sensor,
    Shape,
    /// Subsurface scattering.
    Subsurface,
    /// A texture or a spectrum: one family, as in Mitsuba.
    Texture,
    Volume,
}

impl Class {
    /// The name used in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scene => "scene",
            Self::Bsdf => "bsdf",
            Self::Emitter => "emitter",
            Self::Film => "film",
            Self::Integrator => "integrator",
            Self::Medium => "medium",
            Self::Phase => "phase",
            Self::ReconstructionFilter => "rfilter",
            Self::Sampler => "sampler",
            Self::Sensor => "sensor",
            Self::Shape => "shape",
            Self::Subsurface => "subsurface",
            Self::Texture => "texture",
            Self::Volume => "volume",
        }
    }
}

/// A value with its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Spanned<T> {
    /// The value.
    pub value: T,
    /// Where it stands.
    pub span: Span,
}

/// The value of a `<spectrum>` tag, as written.
#[derive(Clone, Debug, PartialEq)]
pub enum SpectrumText {
    /// One number: constant over wavelength.
    Uniform(f64),
    /// Pairs of wavelength (nm) and value, in ascending order of wavelength.
    Samples(Vec<(f64, f64)>),
}

/// A typed property value.
#[derive(Clone, Debug)]
pub enum Value {
    /// `<float>`.
    Float(f64),
    /// `<integer>`.
    Integer(i64),
    /// `<boolean>`.
    Boolean(bool),
    /// `<string>`.
    String(String),
    /// `<point>` or `<vector>`.
    Vector(DVec3),
    /// `<rgb>`: linear Rec.709, may lie outside [0, 1].
    Rgb(DVec3),
    /// `<spectrum value=…>` or `<spectrum filename=…>`.
    Spectrum(SpectrumText),
    /// `<transform>`.
    Transform(DMat4),
    /// An `<animation>` of transforms.
    Animation {
        /// How it moves, with time counted as the shutter does.
        motion: Arc<Motion>,
        /// Its value in the middle of the shutter interval.
        middle: DMat4,
    },
    /// A nested object or a reference to one; a shared object is one `Arc`.
    Object(Arc<Node>),
}

impl Value {
    /// What kind of value it is, for messages.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Float(_) => "a float",
            Self::Integer(_) => "an integer",
            Self::Boolean(_) => "a boolean",
            Self::String(_) => "a string",
            Self::Vector(_) => "a point or vector",
            Self::Rgb(_) => "an rgb colour",
            Self::Spectrum(_) => "a spectrum",
            Self::Transform(_) => "a transform",
            Self::Animation { .. } => "an animation",
            Self::Object(node) => match node.class {
                Class::Texture => "a texture",
                _ => "an object",
            },
        }
    }
}

/// One named value of a node.
#[derive(Debug)]
pub struct Property {
    /// The name; children without a name have an empty one.
    pub name: String,
    /// Where the name stands (or the opening tag, if it has none).
    pub name_span: Span,
    /// The value.
    pub value: Value,
    /// Where the value stands.
    pub span: Span,
    used: AtomicBool,
}

impl Property {
    /// An unused property.
    pub fn new(name: impl Into<String>, name_span: Span, value: Value, span: Span) -> Self {
        Self {
            name: name.into(),
            name_span,
            value,
            span,
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
}

/// One object of the description.
#[derive(Debug)]
pub struct Node {
    /// Its family.
    pub class: Class,
    /// The plugin's name (`type="…"`) and where it stands.
    pub plugin: Spanned<String>,
    /// Its `id`, if it has one.
    pub id: Option<String>,
    /// The whole element.
    pub span: Span,
    /// Properties and children in the order of the file.
    pub properties: Vec<Property>,
}

impl Node {
    /// The plugin's name with its article, for messages: "a `cone`", "an `ellipsoid`".
    pub fn with_article(&self) -> String {
        let name = self.plugin.value.as_str();
        // As one says "a union".
        let vowel = name.starts_with(['a', 'e', 'i', 'o']);
        format!("{} `{name}`", if vowel { "an" } else { "a" })
    }

    /// The property of this name (does not mark it).
    pub fn property(&self, name: &str) -> Option<&Property> {
        self.properties.iter().find(|p| p.name == name)
    }

    /// The same with these properties, in the same place.
    pub fn with_properties(&self, properties: Vec<Property>) -> Self {
        Self {
            class: self.class,
            plugin: self.plugin.clone(),
            id: self.id.clone(),
            span: self.span,
            properties,
        }
    }

    /// The same with one property of another value; one that is not there is added where the plugin's name stands.
    pub fn with(&self, name: &str, value: Value) -> Self {
        let copied = |property: &Property| {
            let value = match property.name == name {
                true => value.clone(),
                false => property.value.clone(),
            };
            let copy = Property::new(&property.name, property.name_span, value, property.span);
            if property.is_used() {
                copy.mark_used();
            }
            copy
        };
        let mut properties: Vec<Property> = self.properties.iter().map(copied).collect();
        if !properties.iter().any(|property| property.name == name) {
            let span = self.plugin.span;
            properties.push(Property::new(name, span, value.clone(), span));
        }
        self.with_properties(properties)
    }
}
