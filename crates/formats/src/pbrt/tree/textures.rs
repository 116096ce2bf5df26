//! Textures (`textures.cpp`, `textures.h`): parameters that may be textures, and where patterns lie.
//!
//! A texture becomes a value of the tree: a number, a colour, or an object that all its users share. `texture_kinds` maps each type.
//!
//! Where pbrt looks a 2-D texture up (`coordinates`) is Mitsuba's `to_uv`. Of images, pbrt counts t from the bottom row and Mitsuba v from
//! the top one, so for them v becomes 1 − t. Texture coordinates of meshes stand as they are in both (Mitsuba turns only those of `obj`
//! files over).

use super::super::parameters::Parameters;
use super::super::scene::TextureId;
use super::super::spectrum_value::{FloatOrTexture, SpectrumOrTexture};
use super::Mapper;
use super::node::{Given, given};
use super::spectrum::Role;
pub(crate) use crate::draft::times;
use etalon_params::{DMat4, Node, Span, Value};
use glam::DVec4;
use std::collections::HashSet;

/// How t is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rows {
    /// From the bottom, as pbrt does.
    FromBottom,
    /// From the top, as images are in Mitsuba.
    FromTop,
}

impl Rows {
    /// The `to_uv` that counts rows the other way: (u, 1 − v).
    pub(crate) fn turned() -> DMat4 {
        let shift = DVec4::new(0.0, 1.0, 0.0, 1.0);
        DMat4::from_cols(DVec4::X, DVec4::NEG_Y, DVec4::Z, shift)
    }
}

impl<'a> Mapper<'a> {
    /// A number or a float texture, or the default; `None` after a mistake.
    pub(crate) fn number(
        &mut self,
        params: &Parameters<'a>,
        name: &str,
        default: f64,
    ) -> Option<Given> {
        match self.number_if_given(params, name) {
            None if params.has(name) => None,
            None => Some(given(Value::Float(default), params.entity.span)),
            found => found,
        }
    }

    /// The same, `None` if it is not given as well.
    pub(crate) fn number_if_given(&mut self, params: &Parameters<'a>, name: &str) -> Option<Given> {
        let span = params.span(name);
        match params.float_texture(name)? {
            FloatOrTexture::Value(x) => Some(given(Value::Float(x), span)),
            FloatOrTexture::Texture(id) => self.texture_at(id, span),
        }
    }

    /// A spectrum or a texture of them in its role, or a number by default; `None` after a mistake.
    pub(crate) fn colour(
        &mut self,
        params: &Parameters<'a>,
        name: &str,
        default: f64,
        role: Role,
    ) -> Option<Given> {
        match self.colour_if_given(params, name, role) {
            None if params.has(name) => None,
            None => Some(given(Value::Float(default), params.entity.span)),
            found => found,
        }
    }

    /// The same, `None` if it is not given as well.
    pub(crate) fn colour_if_given(
        &mut self,
        params: &Parameters<'a>,
        name: &str,
        role: Role,
    ) -> Option<Given> {
        let span = params.span(name);
        match params.spectrum_texture(name)? {
            SpectrumOrTexture::Value(value) => {
                let value = self.spectrum(params, name, value, role)?;
                Some(given(value, span))
            }
            SpectrumOrTexture::Texture(id) => self.texture_at(id, span),
        }
    }

    /// The texture for a parameter at `span`.
    fn texture_at(&mut self, id: TextureId, span: Span) -> Option<Given> {
        let found = match self.textures.get(id)? {
            Some(found) => found.clone(),
            None => {
                // That textures contain each other in no circle, nor too deep, was seen when the file was read.
                let found = self.texture(id);
                self.textures[id] = Some(found.clone());
                found
            }
        };
        found.map(|texture| given(texture.value, span))
    }
}

/// Whether something is looked up by a surface's texture coordinates within a node.
pub(crate) fn looks_at_uv(node: &Node) -> bool {
    any_within(node, |node| match node.plugin.value.as_str() {
        "bitmap" | "checkerboard" | "dots" => true,
        _ => has_formula_of(node, &["u", "v"]),
    })
}

/// Whether something is looked up by the place in space within a node.
pub(crate) fn looks_at_place(node: &Node) -> bool {
    any_within(node, |node| match node.plugin.value.as_str() {
        "projected" | "cubes" => true,
        _ => has_formula_of(node, &["x", "y", "z"]),
    })
}

/// Whether a node is an `expression` of some variables.
fn has_formula_of(node: &Node, variables: &[&str]) -> bool {
    let asks = |formula: &str| {
        let mut words = formula.split(|c: char| !c.is_ascii_alphanumeric());
        words.any(|word| variables.contains(&word))
    };
    let mut properties = node.properties.iter();
    node.plugin.value == "expression"
        && properties.any(|p| matches!(&p.value, Value::String(formula) if asks(formula)))
}

/// Whether a material within a node is rougher along one tangent than along the other.
pub(crate) fn has_tangents(node: &Node) -> bool {
    any_within(node, |node| {
        node.properties.iter().any(|p| p.name == "alpha_u")
    })
}

/// Whether something holds for a node, or for one in it that has the surface's own coordinates. Shared nodes are looked at once: there may be exponentially many ways to them.
fn any_within(node: &Node, holds: impl Fn(&Node) -> bool) -> bool {
    let mut seen = HashSet::new();
    let mut open = vec![node];
    while let Some(node) = open.pop() {
        if !seen.insert(std::ptr::from_ref(node)) {
            continue;
        }
        if holds(node) {
            return true;
        }
        if node.plugin.value == "projected" {
            continue;
        }
        open.extend(
            node.properties
                .iter()
                .filter_map(|property| match &property.value {
                    Value::Object(nested) => Some(&**nested),
                    _ => None,
                }),
        );
    }
    false
}
