//! Roughness (`materials.h`, `util/scattering.h`).
//!
//! pbrt's facets are distributed as GGX has it, everywhere. The roughness is α itself, or with `remaproughness` its square; a surface
//! with α < 10⁻³ in both directions is smooth.

use super::super::parameters::Parameters;
use super::Mapper;
use super::node::{Draft, Given, given, word};
use etalon_params::{Class, Value};

/// Below this α a surface is smooth.
const SMOOTH: f64 = 1e-3;

/// How rough a surface is.
pub(crate) enum Roughness {
    /// Not at all.
    Smooth,
    /// α along both tangents.
    Even(Given),
    /// α along the first and along the second.
    Uneven([Given; 2]),
}

impl<'a> Mapper<'a> {
    /// The roughness in the parameters `…roughness`, `…uroughness` and `…vroughness`, whose names begin with `prefix`; `None`
    /// after a mistake.
    pub(crate) fn roughness(&mut self, params: &Parameters<'a>, prefix: &str) -> Option<Roughness> {
        let remap = params.boolean("remaproughness", true);
        let both = self.number(params, &format!("{prefix}roughness"), 0.0);
        let mut along = |axis: &str| {
            let name = format!("{prefix}{axis}roughness");
            match self.number_if_given(params, &name) {
                None if params.has(&name) => None,
                None => both.clone(),
                found => found,
            }
        };
        let [u, v] = [along("u"), along("v")];
        let alpha = |roughness: Given| {
            if remap {
                square_root(roughness)
            } else {
                roughness
            }
        };
        let (u, v) = (alpha(u?), alpha(v?));
        let flat = |alpha: &Given| matches!(alpha.value, Value::Float(x) if x < SMOOTH);
        if flat(&u) && flat(&v) {
            return Some(Roughness::Smooth);
        }
        Some(match same(&u, &v) {
            true => Roughness::Even(u),
            false => Roughness::Uneven([u, v]),
        })
    }

    /// The one α of a model that has one for both directions and everywhere; `None` after a mistake.
    pub(crate) fn single_alpha(
        &mut self,
        params: &Parameters<'a>,
        prefix: &str,
    ) -> Option<Option<Given>> {
        match self.roughness(params, prefix)? {
            Roughness::Smooth => Some(None),
            Roughness::Even(alpha) if matches!(alpha.value, Value::Float(_)) => Some(Some(alpha)),
            _ => {
                let name = format!("{prefix}roughness");
                let what = format!("`{}` of a roughness that varies", params.entity.kind);
                self.refuse_value(params, &name, &what, "one number for both directions");
                None
            }
        }
    }
}

impl Roughness {
    /// A node of the plugin `smooth`, or of that with "rough" before its name, with its roughness.
    pub(crate) fn model(self, params: &Parameters<'_>, smooth: &str) -> Draft {
        if matches!(self, Self::Smooth) {
            return Draft::of(params, Class::Bsdf, smooth);
        }
        let rough = Draft::of(params, Class::Bsdf, &format!("rough{smooth}"));
        let rough = rough.plain("distribution", word("ggx"));
        self.on(rough.plain("masking", word("correlated")), "")
    }

    /// A node with this roughness, in parameters whose names begin with `prefix`; a smooth one is its default.
    pub(crate) fn on(self, draft: Draft, prefix: &str) -> Draft {
        let along = |axis: &str| format!("{prefix}alpha{axis}");
        match self {
            Self::Smooth => draft,
            Self::Even(alpha) => draft.given(&along(""), alpha),
            Self::Uneven([u, v]) => draft.given(&along("_u"), u).given(&along("_v"), v),
        }
    }
}

fn same(a: &Given, b: &Given) -> bool {
    match (&a.value, &b.value) {
        (Value::Float(a), Value::Float(b)) => a == b,
        (Value::Object(a), Value::Object(b)) => std::sync::Arc::ptr_eq(a, b),
        _ => false,
    }
}

/// √x of a number or of a texture.
fn square_root(x: Given) -> Given {
    match x.value {
        // A negative one stays what it is, for Etalon to refuse.
        Value::Float(number) => given(
            Value::Float(number.max(0.0).sqrt() + number.min(0.0)),
            x.span,
        ),
        _ => {
            let formula = Draft::new(Class::Texture, "expression", x.span);
            let formula = formula.plain("value", word("sqrt(roughness)"));
            formula.given("roughness", x).value()
        }
    }
}
