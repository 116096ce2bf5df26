//! Reading an entity's parameters, the one way everything that understands entities does it.
//!
//! Each getter marks the parameter as used, checks its type and the number of its values and, on a mistake, records a diagnostic
//! and gives the default or nothing, so that reading continues. [`Parameters::finish`] refuses what nobody asked for. Getters
//! of several values are in `arrays.rs`, those of spectra and textures in `spectrum_value.rs`.

use super::number::excerpt;
use super::parameter::{Parameter, ParameterType, Values};
use super::scene::{Entity, Scene};
use etalon_params::{DVec3, Diagnostic, Diagnostics, Span};
use std::cell::RefCell;
use std::fmt::Display;

/// An entity whose parameters are being read.
pub struct Parameters<'a> {
    /// The scene, which knows the textures.
    pub scene: &'a Scene,
    /// The entity.
    pub entity: &'a Entity,
    /// Where mistakes go.
    pub diagnostics: &'a Diagnostics,
    asked: RefCell<Vec<String>>,
}

impl<'a> Parameters<'a> {
    pub(crate) fn new(scene: &'a Scene, entity: &'a Entity, diagnostics: &'a Diagnostics) -> Self {
        Self {
            scene,
            entity,
            diagnostics,
            asked: RefCell::default(),
        }
    }

    /// The parameter of a name, marked as used. The name becomes one that this entity knows. A parameter whose values were
    /// refused when the file was read counts as not given.
    pub fn parameter(&self, name: &str) -> Option<&'a Parameter> {
        let is_new = !self.asked.borrow().iter().any(|known| known == name);
        if is_new {
            self.asked.borrow_mut().push(name.to_owned());
        }
        let found = self.entity.params.find(name)?;
        found.mark_used();
        Some(found).filter(|found| found.values != Values::Broken)
    }

    /// Whether the parameter is given, even if it is broken (does not mark it).
    pub fn has(&self, name: &str) -> bool {
        self.entity.params.find(name).is_some()
    }

    /// Where the values of the parameter stand, or the entity if it is not given.
    pub fn span(&self, name: &str) -> Span {
        let parameter = self.entity.params.find(name);
        parameter.map_or(self.entity.span, |parameter| parameter.span)
    }

    /// Records an error at the values of a parameter, or at the entity if it is not given.
    pub fn error_at(&self, name: &str, message: impl Into<String>) {
        let mistake = Diagnostic::error(self.span(name), message);
        self.diagnostics.push(mistake);
    }

    /// Records an error about the entity as a whole.
    pub fn error(&self, message: impl Into<String>) {
        let mistake = Diagnostic::error(self.entity.span, message);
        self.diagnostics.push(mistake);
    }

    /// Records that a value is not accepted; `what` describes those that are.
    pub fn refuse(&self, name: &str, value: impl Display, what: &str) {
        let message = format!("`{name}` of `{}` cannot be {value}", self.entity.kind);
        let mistake = Diagnostic::error(self.span(name), message);
        (self.diagnostics).push(mistake.help(format!("accepted: {what}")));
    }

    /// Records that a parameter is missing, unless it is there and broken; `wanted` is its declaration, such as `string filename`.
    pub fn missing(&self, wanted: &str) {
        let name = wanted.rsplit(' ').next().unwrap_or(wanted);
        if self.has(name) {
            return;
        }
        let message = format!("`{}` needs the parameter `\"{wanted}\"`", self.entity.kind);
        let mistake = Diagnostic::error(self.entity.span, message);
        let label = format!("`{name}` is missing");
        self.diagnostics.push(mistake.label(label));
    }

    /// A number, or its default.
    pub fn float(&self, name: &str, default: f64) -> f64 {
        self.float_if_given(name).unwrap_or(default)
    }

    /// A number, if given.
    pub fn float_if_given(&self, name: &str) -> Option<f64> {
        let parameter = self.typed(name, &[ParameterType::Float])?;
        self.one(parameter, numbers(parameter))
    }

    /// A number for which `accept` holds, or its default; `what` describes the accepted ones.
    pub fn float_where(
        &self,
        name: &str,
        default: f64,
        what: &str,
        accept: impl Fn(f64) -> bool,
    ) -> f64 {
        let value = self.float(name, default);
        if accept(value) {
            return value;
        }
        self.refuse(name, value, what);
        default
    }

    /// An integer, or its default.
    pub fn integer(&self, name: &str, default: i32) -> i32 {
        self.integer_if_given(name).unwrap_or(default)
    }

    /// An integer, if given.
    pub fn integer_if_given(&self, name: &str) -> Option<i32> {
        let parameter = self.typed(name, &[ParameterType::Integer])?;
        self.one(parameter, integers(parameter))
    }

    /// An integer from `least` on, or its default.
    pub fn integer_from(&self, name: &str, default: i32, least: i32) -> i32 {
        let value = self.integer(name, default);
        if value >= least {
            return value;
        }
        self.refuse(name, value, &format!("integers from {least} on"));
        default
    }

    /// A truth value, or its default.
    pub fn boolean(&self, name: &str, default: bool) -> bool {
        let read = || {
            let parameter = self.typed(name, &[ParameterType::Bool])?;
            match &parameter.values {
                Values::Booleans(list) => self.one(parameter, list),
                _ => None,
            }
        };
        read().unwrap_or(default)
    }

    /// A string, if given.
    pub fn string(&self, name: &str) -> Option<&'a str> {
        let parameter = self.typed(name, &[ParameterType::String])?;
        self.one_string(parameter)
    }

    /// One of a few words, or the default; anything else is an error that lists them.
    pub fn choice(
        &self,
        name: &str,
        default: &'static str,
        choices: &[&'static str],
    ) -> &'static str {
        let Some(word) = self.string(name) else {
            return default;
        };
        if let Some(found) = choices.iter().find(|choice| **choice == word) {
            return found;
        }
        let message = format!("`{}` is not a value of `{name}`", excerpt(word));
        let mistake = Diagnostic::error(self.span(name), message);
        (self.diagnostics).push(mistake.suggest(word, choices.iter().copied()));
        default
    }

    /// A point, or its default.
    pub fn point3(&self, name: &str, default: DVec3) -> DVec3 {
        self.triple(name, ParameterType::Point3).unwrap_or(default)
    }

    /// A vector, or its default.
    pub fn vector3(&self, name: &str, default: DVec3) -> DVec3 {
        self.triple(name, ParameterType::Vector3).unwrap_or(default)
    }

    /// Marks parameters as used without reading them: they change nothing here, or a mistake about them was recorded.
    pub fn ignore(&self, names: &[&str]) {
        for name in names {
            self.parameter(name);
        }
    }

    /// Reports every parameter that nobody asked for, with the nearest name that was. Those of `Attribute` directives may be
    /// meant for others.
    pub fn finish(&self) {
        let own = self.entity.params.own.iter();
        for parameter in own.filter(|parameter| !parameter.is_used()) {
            let name = &parameter.name;
            let message = format!(
                "`{}` has no parameter `{}`",
                self.entity.kind,
                excerpt(name)
            );
            let mistake = Diagnostic::error(parameter.declaration, message);
            let asked = self.asked.borrow();
            let unclaimed = asked.iter().filter(|asked| !self.has(asked));
            (self.diagnostics).push(mistake.suggest(name, unclaimed.map(String::as_str)));
        }
    }

    fn triple(&self, name: &str, kind: ParameterType) -> Option<DVec3> {
        let parameter = self.typed(name, &[kind])?;
        let triples = numbers(parameter).as_chunks::<3>().0;
        self.one(parameter, triples).map(DVec3::from_array)
    }

    /// The parameter if it has one of some types; any other type is a mistake.
    pub(crate) fn typed(&self, name: &str, kinds: &[ParameterType]) -> Option<&'a Parameter> {
        let parameter = self.parameter(name)?;
        if kinds.contains(&parameter.kind) {
            return Some(parameter);
        }
        let words: Vec<&str> = kinds.iter().map(|kind| kind.name()).collect();
        let message = format!(
            "`{name}` of `{}` must be declared as {}, not as {}",
            self.entity.kind,
            words.join(", ").replace(", texture", " or texture"),
            parameter.kind.name()
        );
        let mistake = Diagnostic::error(parameter.declaration, message);
        let help = format!("write `\"{} {name}\"`", words[0]);
        self.diagnostics.push(mistake.help(help));
        None
    }

    /// The only one of some values; another number of them is a mistake.
    pub(crate) fn one<T: Copy>(&self, parameter: &Parameter, values: &[T]) -> Option<T> {
        if let [value] = values {
            return Some(*value);
        }
        self.wrong_count(parameter, values.len(), "one value");
        None
    }

    /// The only string of a parameter.
    pub(crate) fn one_string(&self, parameter: &'a Parameter) -> Option<&'a str> {
        let strings: Vec<&str> = match &parameter.values {
            Values::Strings(list) => list.iter().map(|s| s.value.as_str()).take(2).collect(),
            _ => Vec::new(),
        };
        self.one(parameter, &strings)
    }

    /// Records that there are too many values or too few.
    pub(crate) fn wrong_count(&self, parameter: &Parameter, found: usize, wanted: &str) {
        let message = format!(
            "`\"{}\"` has {found} {}, and needs {wanted}",
            parameter.declared(),
            if found == 1 { "value" } else { "values" }
        );
        (self.diagnostics).push(Diagnostic::error(parameter.span, message));
    }
}

/// The numbers of a parameter, none if it has other values.
pub(crate) fn numbers(parameter: &Parameter) -> &[f64] {
    match &parameter.values {
        Values::Numbers(list) => list,
        _ => &[],
    }
}

/// The integers of a parameter, none if it has other values.
pub(crate) fn integers(parameter: &Parameter) -> &[i32] {
    match &parameter.values {
        Values::Integers(list) => list,
        _ => &[],
    }
}
