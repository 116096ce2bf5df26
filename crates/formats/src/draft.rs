//! Building nodes of the description tree by hand, each with the places of the text that it came from.
//!
//! A property that the text gives has the place of its values there, so that whoever reads the tree complains about that
//! text; one that follows from a default has the place of the node.

use etalon_params::{Class, DVec3, Node, Property, Span, Spanned, SpectrumText, Value};
use std::sync::Arc;

/// A value with the place that it came from.
pub(crate) type Given = Spanned<Value>;

/// A value with its place.
pub(crate) fn given(value: Value, span: Span) -> Given {
    Spanned { value, span }
}

/// A node that is being built.
#[derive(Debug)]
pub(crate) struct Draft {
    class: Class,
    plugin: Spanned<String>,
    id: Option<String>,
    properties: Vec<Property>,
}

impl Draft {
    /// A node without properties, for what stands at `span`.
    pub(crate) fn new(class: Class, plugin: &str, span: Span) -> Self {
        let value = plugin.to_owned();
        Self {
            class,
            plugin: Spanned { value, span },
            id: None,
            properties: Vec::new(),
        }
    }

    /// Gives it a name.
    pub(crate) fn named(mut self, id: impl Into<String>) -> Self {
        self.id = Some(id.into());
        self
    }

    /// Where it stands.
    pub(crate) fn span(&self) -> Span {
        self.plugin.span
    }

    /// Adds a property that came from `span`.
    pub(crate) fn with(mut self, name: &str, value: Value, span: Span) -> Self {
        let property = Property::new(name, span, value, span);
        self.properties.push(property);
        self
    }

    /// Adds a property that follows from the node itself.
    pub(crate) fn plain(self, name: &str, value: Value) -> Self {
        let span = self.plugin.span;
        self.with(name, value, span)
    }

    /// Adds a property that was found.
    pub(crate) fn given(self, name: &str, found: Given) -> Self {
        self.with(name, found.value, found.span)
    }

    /// Adds a property if there is one.
    pub(crate) fn maybe(self, name: &str, found: Option<Given>) -> Self {
        match found {
            Some(found) => self.given(name, found),
            None => self,
        }
    }

    /// Adds a nested object without a name.
    pub(crate) fn child(self, node: Arc<Node>) -> Self {
        self.nested("", node)
    }

    /// Adds a nested object.
    pub(crate) fn nested(self, name: &str, node: Arc<Node>) -> Self {
        let span = node.span;
        self.with(name, Value::Object(node), span)
    }

    /// The node.
    pub(crate) fn node(self) -> Arc<Node> {
        Arc::new(Node {
            class: self.class,
            span: self.plugin.span,
            plugin: self.plugin,
            id: self.id,
            properties: self.properties,
        })
    }

    /// The node as a value.
    pub(crate) fn value(self) -> Given {
        let span = self.plugin.span;
        given(Value::Object(self.node()), span)
    }
}

/// A string as a value.
pub(crate) fn word(text: &str) -> Value {
    Value::String(text.to_owned())
}

/// A point or a vector as a value.
pub(crate) fn vector(v: impl Into<DVec3>) -> Value {
    Value::Vector(v.into())
}

/// A value times a number, an object by the texture `scale`.
pub(crate) fn times(value: Given, factor: f64) -> Given {
    let span = value.span;
    if factor == 1.0 {
        return value;
    }
    let product = match value.value {
        Value::Float(x) => Value::Float(x * factor),
        Value::Rgb(rgb) => Value::Rgb(rgb * factor),
        Value::Spectrum(SpectrumText::Uniform(x)) => {
            Value::Spectrum(SpectrumText::Uniform(x * factor))
        }
        Value::Spectrum(SpectrumText::Samples(pairs)) => {
            let pairs = pairs.into_iter().map(|(nm, x)| (nm, x * factor));
            Value::Spectrum(SpectrumText::Samples(pairs.collect()))
        }
        other => {
            return Draft::new(Class::Texture, "scale", span)
                .with("", other, span)
                .plain("scale", Value::Float(factor))
                .value();
        }
    };
    given(product, span)
}
