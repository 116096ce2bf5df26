//! From a scene description to textures: the forms of a property that takes a texture.
//!
//! | written | reflectance | emission | unbounded |
//! |---|---|---|---|
//! | number x | constant x | x·D65 | constant x |
//! | `rgb` c | smooth spectrum of c, in [0, 1] | D65 times the scaled spectrum of c | smooth spectrum of c, of any brightness |
//! | `spectrum` as text | as written | as written | as written |
//! | nested object | what the plugin says | likewise | likewise |
//!
//! These are Mitsuba's rules in spectral mode, which however clamps the last column to [0, 1]. In particular an
//! emitting image is *not* multiplied by D65 unless it is wrapped in a `d65` object. Values inside nested
//! textures follow the first column for every outermost property.

use crate::{Constant, Texture, TextureTable};
use etalon_params::questions::Question;
use etalon_params::{
    Class, Diagnostic, Diagnostics, Node, ParameterKind, Params, Property, Span, Value,
};
use etalon_params::{DVec3, SpectrumText};
use etalon_spectrum::{Spectrum, SpectrumError, refractive_index};
use etalon_transport::{Assets, SpectrumKind, TextureId};
use std::sync::Arc;

/// Reads textures into a set. Mistakes go to the diagnostics, and a constant texture replaces the faulty one.
pub struct TextureReader<'a> {
    /// The table of textures.
    pub set: &'a mut TextureTable,
    /// The scene's files.
    pub assets: &'a dyn Assets,
    /// The diagnostics.
    pub diagnostics: &'a Diagnostics,
}

/// A role, and whether the value stands inside of another texture.
#[derive(Clone, Copy)]
pub(crate) struct Use {
    pub(crate) role: SpectrumKind,
    pub(crate) nested: bool,
}

impl TextureReader<'_> {
    /// The texture in the property `name` of a plugin; the number `default` if it is absent; a
    /// diagnostic if it is absent and there is no default.
    pub fn parameter(
        &mut self,
        params: &Params<'_>,
        name: &str,
        default: Option<f64>,
        role: SpectrumKind,
    ) -> TextureId {
        let top = Use {
            role,
            nested: false,
        };
        self.parameter_in(params, name, default, top)
    }

    /// The same for look-up at points in space: textures that have values on surfaces only are refused.
    pub fn parameter_in_space(
        &mut self,
        params: &Params<'_>,
        name: &str,
        default: Option<f64>,
        role: SpectrumKind,
    ) -> TextureId {
        let id = self.parameter(params, name, default, role);
        if let Some(Value::Object(node)) = params.property(name).map(|p| &p.value) {
            self.refuse_on_surfaces(node);
        }
        id
    }

    /// Refuses every texture within `node` that has values on surfaces only.
    fn refuse_on_surfaces(&self, node: &Arc<Node>) {
        let mut read = self.set.read_as(node).map(|id| self.set.get(id));
        if let Some(help) = read.find_map(Texture::instead_in_space) {
            let name = node.with_article();
            let message = format!(
                "{name} looks at where it is on a surface, and points in a medium are on none"
            );
            let error = Diagnostic::error(node.plugin.span, message);
            self.diagnostics.push(error.help(help));
        }
        for property in &node.properties {
            if let Value::Object(nested) = &property.value {
                self.refuse_on_surfaces(nested);
            }
        }
    }

    pub(crate) fn parameter_in(
        &mut self,
        params: &Params<'_>,
        name: &str,
        default: Option<f64>,
        purpose: Use,
    ) -> TextureId {
        params.note(name, || Question {
            kind: ParameterKind::SpectrumOrTexture,
            default: default.map_or(String::new(), |number| number.to_string()),
            ..Question::default()
        });
        match (params.property(name), default) {
            (Some(property), _) => self.value(property, purpose),
            (None, Some(number)) => {
                let spectrum = self.number(number, purpose, params.node.plugin.span);
                self.add_constant(spectrum)
            }
            (None, None) => {
                params.missing(name, "a colour, spectrum or texture");
                self.stand_in()
            }
        }
    }

    /// The texture of a property's value.
    pub fn property(&mut self, property: &Property, role: SpectrumKind) -> TextureId {
        let top = Use {
            role,
            nested: false,
        };
        self.value(property, top)
    }

    pub(crate) fn value(&mut self, property: &Property, purpose: Use) -> TextureId {
        property.mark_used();
        let span = property.span;
        let is_object = matches!(property.value, Value::Object(_));
        if matches!(purpose.role, SpectrumKind::Raw(1..)) && !is_object {
            return self.set.add(Texture::Constant(Constant::uniform(0.0)));
        }
        let spectrum = match &property.value {
            Value::Float(x) => self.number(*x, purpose, span),
            Value::Integer(i) => self.number(*i as f64, purpose, span),
            Value::Rgb(rgb) => self.colour(*rgb, purpose, span),
            Value::Spectrum(text) => self.text(text, purpose, span),
            Value::Object(node) if matches!(node.class, Class::Texture | Class::Volume) => {
                return self.object(node, purpose);
            }
            other => {
                let message = format!(
                    "`{}` must be a number, a colour, a spectrum or a texture, not {}",
                    property.name,
                    other.kind()
                );
                self.diagnostics.push(Diagnostic::error(span, message));
                None
            }
        };
        self.add_constant(spectrum)
    }

    /// The texture described by an object. The same object in the same role is read once.
    pub fn node(&mut self, node: &Arc<Node>, role: SpectrumKind) -> TextureId {
        let top = Use {
            role,
            nested: false,
        };
        self.object(node, top)
    }

    fn object(&mut self, node: &Arc<Node>, purpose: Use) -> TextureId {
        let key = (Arc::as_ptr(node) as usize, purpose.role);
        if let Some(&id) = self.set.read.get(&key) {
            return id;
        }
        // What has more than three channels has been read with the first of them.
        if matches!(purpose.role, SpectrumKind::Raw(1..)) {
            return self.set.add(Texture::Constant(Constant::uniform(0.0)));
        }
        let texture = self.plugin(&Params::new(node, self.diagnostics), purpose);
        let id = match texture {
            Some(texture) => self.set.add(texture),
            None => self.stand_in(),
        };
        if matches!(self.set.get(id), Texture::MeshAttribute(_)) {
            self.set.note_attribute(id, node.plugin.span);
        }
        self.set.nodes.push(Arc::clone(node));
        self.set.read.insert(key, id);
        id
    }

    /// Keeps the channels of an object that follow the first three ([`SpectrumKind::Raw`]).
    pub(crate) fn keep_rest(&mut self, node: &Node, rest: TextureId) {
        let key = (core::ptr::from_ref(node) as usize, SpectrumKind::Raw(3));
        self.set.read.insert(key, rest);
    }

    fn number(&self, x: f64, purpose: Use, span: Span) -> Option<Spectrum> {
        let spectrum = if purpose.role == SpectrumKind::Emission && !purpose.nested {
            Spectrum::d65(x)
        } else {
            Spectrum::uniform(x)
        };
        if x < 0.0 && purpose.role != SpectrumKind::Unbounded {
            self.refuse(span, format!("{x} is negative"), "numbers not below 0");
            return None;
        }
        let spectrum = self.checked(spectrum, span)?;
        Some(self.held(spectrum, purpose, span))
    }

    /// A spectrum in its role: what no more than all light can be reflected of is held to 1, with
    /// a note. (Mitsuba 3 takes such numbers and spectra as they are and makes light of nothing.)
    pub(crate) fn held(&self, spectrum: Spectrum, purpose: Use, span: Span) -> Spectrum {
        if purpose.role != SpectrumKind::Reflectance || !(spectrum.maximum() > 1.0) {
            return spectrum;
        }
        self.note_held(span);
        spectrum.held_to(1.0)
    }

    /// Says that a value was held to 1.
    pub(crate) fn note_held(&self, span: Span) {
        let message =
            "a reflectance, opacity or weight cannot be above 1: what is above counts as 1";
        self.diagnostics.push(Diagnostic::note(span, message));
    }

    pub(crate) fn colour(&self, rgb: DVec3, purpose: Use, span: Span) -> Option<Spectrum> {
        let values = rgb.to_array();
        let bounded = values.iter().all(|x| (0.0..=1.0).contains(x));
        let spectrum = match purpose.role {
            SpectrumKind::Emission if !purpose.nested => Spectrum::emission(values),
            SpectrumKind::Emission | SpectrumKind::Unbounded | SpectrumKind::Index if !bounded => {
                Spectrum::unbounded(values)
            }
            _ => {
                if values.iter().any(|&x| x > 1.0) {
                    self.note_held(span);
                }
                Spectrum::reflectance(values.map(|x| x.min(1.0)))
            }
        };
        self.checked(spectrum, span)
    }

    fn text(&self, text: &SpectrumText, purpose: Use, span: Span) -> Option<Spectrum> {
        let spectrum = match text {
            SpectrumText::Uniform(x) => Spectrum::uniform(*x),
            SpectrumText::Samples(pairs) => {
                let (wavelengths, values): (Vec<f64>, Vec<f64>) = pairs.iter().copied().unzip();
                self.table(&wavelengths, &values, purpose, span)
            }
        };
        let spectrum = self.checked(spectrum, span)?;
        self.admitted(spectrum, purpose, span)
    }

    /// A table of `values` at `wavelengths` (nm): zero beyond its ends, except that an index is constant there, with a note.
    pub(crate) fn table(
        &self,
        wavelengths: &[f64],
        values: &[f64],
        purpose: Use,
        span: Span,
    ) -> Result<Spectrum, SpectrumError> {
        if purpose.role != SpectrumKind::Index {
            return Spectrum::tabulated(wavelengths, values);
        }
        let (table, note) = refractive_index::held_table(wavelengths, values)?;
        if let Some(note) = note {
            self.diagnostics.push(Diagnostic::note(span, note));
        }
        Ok(table)
    }

    /// Refuses spectra below zero: no surface reflects and no light emits a negative amount. Holds
    /// those to 1 that cannot be above.
    pub(crate) fn admitted(
        &self,
        spectrum: Spectrum,
        purpose: Use,
        span: Span,
    ) -> Option<Spectrum> {
        let [lowest, _] = spectrum.range();
        if lowest < 0.0 && purpose.role != SpectrumKind::Unbounded {
            self.refuse(
                span,
                format!("this spectrum falls to {lowest}"),
                "values not below 0",
            );
            return None;
        }
        Some(self.held(spectrum, purpose, span))
    }

    pub(crate) fn refuse(&self, span: Span, message: String, accepted: &str) {
        let diagnostic = Diagnostic::error(span, message).help(format!("accepted: {accepted}"));
        self.diagnostics.push(diagnostic);
    }

    pub(crate) fn checked(
        &self,
        spectrum: Result<Spectrum, SpectrumError>,
        span: Span,
    ) -> Option<Spectrum> {
        let diagnostic = |error: SpectrumError| Diagnostic::error(span, error.to_string());
        self.diagnostics.keep(spectrum.map_err(diagnostic))
    }

    fn add_constant(&mut self, spectrum: Option<Spectrum>) -> TextureId {
        match spectrum {
            Some(spectrum) => self.set.add_spectrum(spectrum),
            None => self.stand_in(),
        }
    }

    /// A constant texture after a mistake, so that further mistakes are found.
    fn stand_in(&mut self) -> TextureId {
        self.set.add(Texture::Constant(Constant::uniform(0.5)))
    }
}
