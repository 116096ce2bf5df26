//! Reading a node's properties, the one way every plugin does it.
//!
//! Each getter marks the property as used, checks its type and, on a mistake, records a
//! diagnostic and returns a harmless value, so that reading continues and finds further mistakes.
//! The caller refuses the scene if [`Diagnostics::has_errors`]. [`Params::finish`] reports unused
//! properties.

use crate::questions::{self, Question};
use crate::unused::Unused;
use crate::{Class, Diagnostic, Diagnostics, Node, ParameterKind, Property, Value, suggest};
use etalon_math::Motion;
use glam::{DMat4, DVec3};
use std::cell::RefCell;
use std::fmt::Display;
use std::sync::Arc;

/// A node being read by its plugin.
pub struct Params<'a> {
    /// The node.
    pub node: &'a Node,
    /// Where mistakes go.
    pub diagnostics: &'a Diagnostics,
    known: RefCell<Vec<String>>,
}

impl<'a> Params<'a> {
    /// Begins to read `node`.
    pub fn new(node: &'a Node, diagnostics: &'a Diagnostics) -> Self {
        Self {
            node,
            diagnostics,
            known: RefCell::new(Vec::new()),
        }
    }

    /// Records a parameter for the documentation of scenes.
    pub fn note(&self, name: &str, question: impl FnOnce() -> Question) {
        questions::note(self.node.class, &self.node.plugin.value, name, question);
    }

    /// The same of a parameter with this kind and default.
    pub fn note_default(&self, name: &str, kind: ParameterKind, default: impl Display) {
        self.note(name, || Question {
            kind,
            default: default.to_string(),
            ..Question::default()
        });
    }

    /// The property called `name`, marked as used. The name becomes one that this plugin knows.
    pub fn property(&self, name: &str) -> Option<&'a Property> {
        self.note(name, Question::default);
        if !self.known.borrow().iter().any(|k| k == name) {
            self.known.borrow_mut().push(name.to_owned());
        }
        let found = self.node.property(name)?;
        found.mark_used();
        Some(found)
    }

    /// Whether the property is present (does not mark it).
    pub fn has(&self, name: &str) -> bool {
        self.note(name, Question::default);
        self.node.property(name).is_some()
    }

    /// Whether the property is the number 0, or not there (does not mark it).
    pub fn is_zero_or_absent(&self, name: &str) -> bool {
        let mut named = self.node.properties.iter().filter(|p| p.name == name);
        named.all(|p| matches!(p.value, Value::Float(0.0) | Value::Integer(0)))
    }

    /// Records an error at the value of a property (or at the plugin's name if it is absent).
    pub fn error_at(&self, name: &str, message: impl Into<String>) {
        let property = self.node.property(name);
        let span = property.map_or(self.node.plugin.span, |p| p.span);
        self.diagnostics.push(Diagnostic::error(span, message));
    }

    /// The same with what helps.
    pub fn error_with_help(&self, name: &str, message: &str, help: &str) {
        let property = self.node.property(name);
        let span = property.map_or(self.node.plugin.span, |p| p.span);
        (self.diagnostics).push(Diagnostic::error(span, message).help(help));
    }

    /// Records an error about the node as a whole.
    pub fn error(&self, message: impl Into<String>) {
        self.diagnostics
            .push(Diagnostic::error(self.node.plugin.span, message));
    }

    fn wrong_kind(&self, property: &Property, wanted: ParameterKind) {
        let wanted = wanted.with_article();
        self.diagnostics.push(
            Diagnostic::error(
                property.span,
                format!(
                    "parameter `{}` of `{}` must be {wanted}, not {}",
                    property.name,
                    self.node.plugin.value,
                    property.value.kind()
                ),
            )
            .label(format!("expected {wanted}")),
        );
    }

    /// A missing required property.
    pub fn missing(&self, name: &str, wanted: &str) {
        self.note(name, || Question {
            accepted: wanted.to_owned(),
            required: true,
            ..Question::default()
        });
        self.diagnostics.push(
            Diagnostic::error(
                self.node.plugin.span,
                format!(
                    "`{}` needs the parameter `{name}` ({wanted})",
                    self.node.plugin.value
                ),
            )
            .label(format!("`{name}` is missing")),
        );
    }

    fn get<T>(
        &self,
        name: &str,
        wanted: ParameterKind,
        convert: impl Fn(&'a Value) -> Option<T>,
    ) -> Option<T> {
        self.note_default(name, wanted, "");
        let property = self.property(name)?;
        let value = convert(&property.value);
        if value.is_none() {
            self.wrong_kind(property, wanted);
        }
        value
    }

    /// A number, if given.
    pub fn float(&self, name: &str) -> Option<f64> {
        self.get(name, ParameterKind::Number, |v| match v {
            Value::Float(x) => Some(*x),
            Value::Integer(i) => Some(*i as f64),
            _ => None,
        })
    }

    /// A number, or its default.
    pub fn float_or(&self, name: &str, default: f64) -> f64 {
        self.note_default(name, ParameterKind::Number, default);
        self.float(name).unwrap_or(default)
    }

    /// A number for which `accept` holds, or its default; `what` describes the accepted values.
    pub fn float_where(
        &self,
        name: &str,
        default: f64,
        what: &str,
        accept: impl Fn(f64) -> bool,
    ) -> f64 {
        self.note(name, || Question {
            accepted: what.to_owned(),
            ..Question::default()
        });
        let value = self.float_or(name, default);
        if accept(value) {
            value
        } else {
            self.refuse(name, value, what);
            default
        }
    }

    /// Records that a value is not accepted.
    pub fn refuse(&self, name: &str, value: impl Display, what: &str) {
        let property = self.node.property(name);
        let span = property.map_or(self.node.plugin.span, |p| p.span);
        self.diagnostics.push(
            Diagnostic::error(
                span,
                format!(
                    "parameter `{name}` of `{}` cannot be {value}",
                    self.node.plugin.value
                ),
            )
            .help(format!("accepted: {what}")),
        );
    }

    /// An integer, if given.
    pub fn integer(&self, name: &str) -> Option<i64> {
        self.get(name, ParameterKind::Integer, |v| match v {
            Value::Integer(i) => Some(*i),
            _ => None,
        })
    }

    /// An integer, or its default.
    pub fn integer_or(&self, name: &str, default: i64) -> i64 {
        self.note_default(name, ParameterKind::Integer, default);
        self.integer(name).unwrap_or(default)
    }

    /// A truth value, or its default.
    pub fn boolean_or(&self, name: &str, default: bool) -> bool {
        self.note_default(name, ParameterKind::Boolean, default);
        self.get(name, ParameterKind::Boolean, |v| match v {
            Value::Boolean(b) => Some(*b),
            _ => None,
        })
        .unwrap_or(default)
    }

    /// A string, if given.
    pub fn string(&self, name: &str) -> Option<&'a str> {
        self.get(name, ParameterKind::String, |v| match v {
            Value::String(s) => Some(s.as_str()),
            _ => None,
        })
    }

    /// One of a few words, or the default; anything else is an error that lists them.
    pub fn choice(
        &self,
        name: &str,
        default: &'static str,
        choices: &[&'static str],
    ) -> &'static str {
        self.note(name, || Question {
            default: default.to_owned(),
            accepted: format!("`{}`", choices.join("`, `")),
            ..Question::default()
        });
        let Some(word) = self.string(name) else {
            return default;
        };
        if let Some(found) = choices.iter().find(|c| c.eq_ignore_ascii_case(word)) {
            return found;
        }
        let property = self.node.property(name);
        let span = property.map_or(self.node.plugin.span, |p| p.span);
        self.diagnostics.push(
            Diagnostic::error(span, format!("`{word}` is not a value of `{name}`"))
                .suggest(word, choices.iter().copied()),
        );
        default
    }

    /// A point or vector, if given.
    pub fn vector(&self, name: &str) -> Option<DVec3> {
        self.get(name, ParameterKind::Vector, |v| match v {
            Value::Vector(x) => Some(*x),
            _ => None,
        })
    }

    /// A transform, or the identity. One that moves is held in the middle of the shutter's interval.
    pub fn transform(&self, name: &str) -> DMat4 {
        self.note_default(name, ParameterKind::Transform, "identity");
        self.get(name, ParameterKind::Transform, |v| match v {
            Value::Transform(m) => Some(*m),
            Value::Animation { middle, .. } => Some(*middle),
            _ => None,
        })
        .unwrap_or(DMat4::IDENTITY)
    }

    /// The transforms of an animation's keys, or the only one; the identity if the property is not given.
    pub fn keyframes(&self, name: &str) -> Vec<DMat4> {
        self.note_default(name, ParameterKind::Motion, "identity");
        self.get(name, ParameterKind::Motion, |v| match v {
            Value::Transform(m) => Some(vec![*m]),
            Value::Animation { motion, .. } => Some(motion.keys().to_vec()),
            _ => None,
        })
        .unwrap_or_else(|| vec![DMat4::IDENTITY])
    }

    /// How the property moves things, the identity if it is not given. `None` if it is one transform that is
    /// projective, singular or not finite, which has been reported.
    pub fn motion(&self, name: &str) -> Option<Motion> {
        self.note_default(name, ParameterKind::Motion, "identity");
        let property = self.property(name);
        if let Some(Value::Animation { motion, .. }) = property.map(|p| &p.value) {
            return Some((**motion).clone());
        }
        let still = Motion::still(self.transform(name)).ok();
        if still.is_none() {
            self.cannot_be_undone(name);
        }
        still
    }

    /// Records that a transform is projective, singular or not finite.
    pub fn cannot_be_undone(&self, name: &str) {
        let property = self.node.property(name);
        let span = property.map_or(self.node.plugin.span, |p| p.span);
        let diagnostic = Diagnostic::error(span, format!("`{name}` cannot be undone"))
            .label("flattens space, is projective, or is not finite")
            .help("accepted: an invertible affine transform");
        self.diagnostics.push(diagnostic);
    }

    /// Whether the property is an animation; it then counts as used.
    pub fn is_animated(&self, name: &str) -> bool {
        let is_named = |p: &&Property| p.name == name;
        let property = self.node.properties.iter().find(is_named);
        let animated = property.filter(|p| matches!(p.value, Value::Animation { .. }));
        animated.is_some_and(|_| self.property(name).is_some())
    }

    /// The nested objects of one class, named or not, in the order of the file; marked as used.
    pub fn children(&self, class: Class) -> Vec<(&'a Property, &'a Arc<Node>)> {
        if questions::is_recording() {
            self.note_default(&format!("<{}>", class.name()), ParameterKind::Nested, "");
        }
        let children: Vec<_> = self
            .node
            .properties
            .iter()
            .filter_map(|p| match &p.value {
                Value::Object(node) if node.class == class => Some((p, node)),
                _ => None,
            })
            .collect();
        children.iter().for_each(|(p, _)| p.mark_used());
        children
    }

    /// The only nested object of a class, if there is one; a second one is an error.
    pub fn child(&self, class: Class) -> Option<&'a Arc<Node>> {
        let children = self.children(class);
        if let [_, (second, _), ..] = children.as_slice() {
            self.diagnostics.push(Diagnostic::error(
                second.name_span,
                format!(
                    "`{}` takes one {} only",
                    self.node.plugin.value,
                    class.name()
                ),
            ));
        }
        children.first().map(|(_, node)| *node)
    }

    /// Marks properties as used without reading them, since a mistake about them has been reported.
    /// Parameters without effect belong to the list of [`crate::ignored`] instead.
    pub fn ignore(&self, names: &[&str]) {
        for name in names {
            self.property(name);
        }
    }

    /// Reports every unused property, with the nearest name that exists.
    pub fn finish(&self) {
        self.finish_after(true);
    }

    /// The same after an attempt to read the plugin. If it was given up after a mistake, which has been recorded, not all of its
    /// parameters were read: an unused one is then called unknown only if its name is close to one that was missing.
    pub fn finish_after(&self, is_read: bool) {
        let known = self.known.borrow();
        let known = || known.iter().map(String::as_str);
        let missed = || known().filter(|name| !self.has(name));
        let gave_up = !is_read && self.diagnostics.has_errors();
        let plugin = self.node.plugin.value.as_str();
        for property in self.node.properties.iter().filter(|p| !p.is_used()) {
            if gave_up && suggest::nearest(&property.name, missed()).is_none() {
                continue;
            }
            let unused = Unused {
                class: self.node.class,
                plugin,
                name: &property.name,
                span: property.name_span,
            };
            if let Some(diagnostic) = unused.judge(&property.value, known()) {
                self.diagnostics.push(diagnostic);
            }
        }
    }
}
