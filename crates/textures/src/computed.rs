//! `expression`: a texture or a volume by a formula, in the language of `implicit`.
//!
//! ```text
//! value = f(x, y, z, u, v, inputs)        or one formula for each of red, green, blue
//! ```
//!
//! x, y and z are the world position mapped by the inverse of `to_world`; u and v texture coordinates; inputs are nested textures
//! and numbers by name, evaluated as numbers. Undefined values (a root of a negative number) and negative ones count as 0;
//! reflectances are clamped to 1.
//!
//! Bounds in a box come from interval arithmetic ([`etalon_math::expression::Interval`]), so that tracking through a density
//! by a formula stays unbiased.

use crate::place;
use crate::reader::Use;
use crate::recovered::{luminance, spectrum_of};
use crate::texture::TextureModel;
use crate::{Texture, TextureReader, TextureTable};
use etalon_math::Expression;
use etalon_math::expression::Interval;
use etalon_params::{Class, Params, Property, Value};
use etalon_transport::{Shapes, SpectrumKind, TextureId, TexturePoint};
use glam::{DAffine3, DVec3, Vec3, Vec4};

/// The variables that every formula has.
const PLACE: [&str; 5] = ["x", "y", "z", "u", "v"];

/// The most inputs.
const MOST_INPUTS: usize = 11;

/// Number of cells along a medium with bounds of their own, see [`TextureModel::cells`].
const CELLS: u32 = 256;

/// Values of the variables.
type Variables<N> = [N; PLACE.len() + MOST_INPUTS];

/// One formula, or three.
#[derive(Clone, Debug, PartialEq)]
enum Formulas {
    Number(Expression),
    Colour(Box<[Expression; 3]>),
}

/// A texture by a formula.
#[derive(Clone, Debug, PartialEq)]
pub struct Computed {
    formulas: Formulas,
    inputs: Vec<TextureId>,
    /// From the world to x, y, z.
    place: DAffine3,
    role: SpectrumKind,
}

impl Computed {
    fn variables(
        &self,
        set: &TextureTable,
        shapes: &impl Shapes,
        at: &TexturePoint,
    ) -> Variables<f64> {
        let p = self.place.transform_point3(at.position.as_dvec3());
        let (u, v) = (f64::from(at.uv.x), f64::from(at.uv.y));
        let mut variables = [
            p.x, p.y, p.z, u, v, 0., 0., 0., 0., 0., 0., 0., 0., 0., 0., 0.,
        ];
        for (variable, input) in variables[PLACE.len()..].iter_mut().zip(&self.inputs) {
            *variable = f64::from(set.number(*input, shapes, at));
        }
        variables
    }

    /// The most that may come out.
    fn most(&self) -> f64 {
        match self.role {
            SpectrumKind::Reflectance => 1.0,
            _ => f64::from(f32::MAX),
        }
    }

    fn held(&self, value: f64) -> f32 {
        // False for NaN, too.
        if value > 0.0 {
            value.min(self.most()) as f32
        } else {
            0.0
        }
    }

    /// The formulas in a box of the world: what each is at least, and at most.
    fn within(&self, set: &TextureTable, low: Vec3, high: Vec3) -> [f32; 2] {
        let (low64, high64) = (low.as_dvec3(), high.as_dvec3());
        let mut variables = [Interval::ALL; PLACE.len() + MOST_INPUTS];
        if low.is_finite() && high.is_finite() {
            let corner = |index: usize| {
                let part = |axis: usize| {
                    if index >> axis & 1 == 0 {
                        low64[axis]
                    } else {
                        high64[axis]
                    }
                };
                self.place
                    .transform_point3(DVec3::new(part(0), part(1), part(2)))
            };
            let ends = (1..8).fold([corner(0); 2], |[a, b], i| {
                [a.min(corner(i)), b.max(corner(i))]
            });
            // A little more, so that rounding of places to 32 bits does not matter.
            let more = 1e-6 * (ends[0].abs().max(ends[1].abs()) + (ends[1] - ends[0]));
            for axis in 0..3 {
                variables[axis] =
                    Interval::around(ends[0][axis] - more[axis], ends[1][axis] + more[axis]);
            }
        }
        for (variable, input) in variables[PLACE.len()..].iter_mut().zip(&self.inputs) {
            let input = set.get(*input);
            let ends = [
                input.least_within(set, low, high),
                input.most_within(set, low, high),
            ];
            *variable = Interval::around(f64::from(ends[0]), f64::from(ends[1]));
        }
        let range = |formula: &Expression| {
            let Interval { low, high } = formula.eval(&variables);
            // Undefined: 0.
            [low, high].map(|end| {
                if end.is_nan() {
                    0.0
                } else {
                    end.clamp(0.0, self.most())
                }
            })
        };
        match &self.formulas {
            Formulas::Number(formula) => range(formula).map(|end| end as f32),
            Formulas::Colour(formulas) => {
                let high = formulas.iter().map(|f| range(f)[1]).fold(0.0, f64::max);
                // A spectrum may go beyond its colour: to 1, or to twice the greatest channel.
                let most = if high > 1.0 {
                    2.0 * high
                } else {
                    f64::from(u8::from(high > 0.0))
                };
                [0.0, most.min(self.most()) as f32]
            }
        }
    }
}

impl TextureModel for Computed {
    const VARIES: bool = false;

    fn spectrum(
        &self,
        set: &TextureTable,
        shapes: &impl Shapes,
        at: &TexturePoint,
        lambda: Vec4,
    ) -> Vec4 {
        match &self.formulas {
            Formulas::Number(_) => Vec4::splat(self.number(set, shapes, at)),
            Formulas::Colour(_) => {
                spectrum_of(self.colour(set, shapes, at), 1.0, self.role, lambda)
            }
        }
    }

    fn number(&self, set: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> f32 {
        match &self.formulas {
            Formulas::Number(formula) => self.held(formula.eval(&self.variables(set, shapes, at))),
            Formulas::Colour(_) => luminance(self.colour(set, shapes, at)),
        }
    }

    fn colour(&self, set: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> Vec3 {
        let variables = self.variables(set, shapes, at);
        let of = |formula: &Expression| self.held(formula.eval(&variables));
        match &self.formulas {
            Formulas::Number(formula) => Vec3::splat(of(formula)),
            Formulas::Colour(formulas) => Vec3::from_array(formulas.each_ref().map(of)),
        }
    }

    fn mean(&self, set: &TextureTable) -> f32 {
        let [low, high] = self.within(set, Vec3::NEG_INFINITY, Vec3::INFINITY);
        let is_bounded = high < f32::MAX;
        if is_bounded { 0.5 * (low + high) } else { 0.5 }
    }

    fn most_within(&self, set: &TextureTable, low: Vec3, high: Vec3) -> f32 {
        let [_, most] = self.within(set, low, high);
        if most < f32::MAX { most } else { f32::INFINITY }
    }

    fn least_within(&self, set: &TextureTable, low: Vec3, high: Vec3) -> f32 {
        let [least, _] = self.within(set, low, high);
        if least < f32::MAX { least } else { 0.0 }
    }

    fn cells(&self, _: &TextureTable) -> u32 {
        CELLS
    }

    fn nested(&self) -> &[TextureId] {
        &self.inputs
    }

    fn instead_in_space(&self) -> Option<&'static str> {
        let formulas = match &self.formulas {
            Formulas::Number(formula) => core::slice::from_ref(formula),
            Formulas::Colour(formulas) => &formulas[..],
        };
        let is_flat = formulas
            .iter()
            .any(|formula| formula.has(3) || formula.has(4));
        is_flat.then_some("an `expression` without u and v has a value in space")
    }
}

/// The inputs: all properties that are not the plugin's own.
fn inputs<'p>(params: &Params<'p>) -> Vec<&'p Property> {
    let own = ["value", "red", "green", "blue", "to_world"];
    let given = params.node.properties.iter();
    given
        .filter(|property| !own.contains(&property.name.as_str()))
        .filter(|property| match &property.value {
            Value::Float(_) | Value::Integer(_) => true,
            Value::Object(node) => matches!(node.class, Class::Texture | Class::Volume),
            _ => false,
        })
        .collect()
}

/// Whether a name is valid in a formula and has no other meaning there.
fn is_free(name: &str) -> bool {
    let mut letters = name.chars();
    letters
        .next()
        .is_some_and(|c| c.is_ascii_alphabetic() || c == '_')
        && letters.all(|c| c.is_ascii_alphanumeric() || c == '_')
        && !PLACE.contains(&name)
        && !Expression::names().any(|known| known == name)
}

/// Reads `value`, or `red`, `green` and `blue`; `to_world`; and inputs of any other name.
pub(crate) fn read(
    reader: &mut TextureReader<'_>,
    params: &Params<'_>,
    Use { role, .. }: Use,
) -> Option<Texture> {
    let given = inputs(params);
    if given.len() > MOST_INPUTS {
        params.error(format!(
            "an `expression` has at most {MOST_INPUTS} inputs, not {}",
            given.len()
        ));
        return None;
    }
    for property in &given {
        if !is_free(&property.name) {
            let message = format!("`{}` cannot be the name of an input", property.name);
            let help = "letters, digits and `_`, beginning with a letter; none of x, y, z, u, v and the functions";
            params.error_with_help(&property.name, &message, help);
            return None;
        }
    }
    let names: Vec<&str> = (PLACE.into_iter())
        .chain(given.iter().map(|property| property.name.as_str()))
        .collect();
    let number = Use {
        role: SpectrumKind::Unbounded,
        nested: true,
    };
    let inputs = given
        .iter()
        .map(|property| reader.value(property, number))
        .collect();
    let channels = ["red", "green", "blue"];
    let is_colour = channels.iter().any(|name| params.has(name));
    let formulas = match is_colour {
        true => {
            if params.has("value") {
                params.error_at("value", "give either `value`, or `red`, `green` and `blue`");
                return None;
            }
            for name in channels.iter().filter(|name| !params.has(name)) {
                params.missing(name, "an expression of x, y, z, u, v and the inputs");
            }
            let [red, green, blue] = channels.map(|name| params.expression(name, &names));
            Formulas::Colour(Box::new([red?, green?, blue?]))
        }
        false => {
            if !params.has("value") {
                params.missing("value", "an expression of x, y, z, u, v and the inputs");
            }
            Formulas::Number(params.expression("value", &names)?)
        }
    };
    let place = place::from_world(params)?;
    Some(Texture::from(Computed {
        formulas,
        inputs,
        place,
        role,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::OneShape;
    use proptest::prelude::*;

    fn computed(text: &str, role: SpectrumKind) -> Computed {
        Computed {
            formulas: Formulas::Number(Expression::parse(text, &PLACE).expect("it can be read")),
            inputs: Vec::new(),
            place: DAffine3::from_rotation_z(0.3) * DAffine3::from_scale(DVec3::new(2.0, 1.0, 0.5)),
            role,
        }
    }

    fn at(position: Vec3) -> TexturePoint {
        TexturePoint::in_space(position)
    }

    #[test]
    fn what_has_no_value_is_nothing_and_shares_are_held() {
        let set = TextureTable::new();
        let value = |text: &str, role, p| computed(text, role).number(&set, &OneShape, &at(p));
        assert_eq!(
            value("sqrt(-1 - x^2)", SpectrumKind::Unbounded, Vec3::ONE),
            0.0
        );
        assert_eq!(value("-2", SpectrumKind::Unbounded, Vec3::ONE), 0.0);
        assert_eq!(value("3", SpectrumKind::Reflectance, Vec3::ONE), 1.0);
        assert_eq!(value("3", SpectrumKind::Unbounded, Vec3::ONE), 3.0);
    }

    proptest! {
        /// With a rotated and stretched position, waves, poles, roots of possibly negative terms, and noise.
        #[test]
        fn nothing_in_a_box_is_beyond_its_bounds(
            low in prop::array::uniform3(-3.0_f32..3.0),
            size in 0.05_f32..1.4,
            part in prop::array::uniform3(0.0_f32..1.0),
            text in prop::sample::select(vec![
                "2 + sin(3*x)*cos(y)", "1/(0.1 + x^2 + z^2)", "sqrt(x - y)", "noise(x, y, z) + 0.3*y", "exp(-x^2-y^2) - 0.2", "max(x, y)*z",
            ]),
        ) {
            let set = TextureTable::new();
            let texture = computed(text, SpectrumKind::Unbounded);
            let low = Vec3::from_array(low);
            let high = low + size;
            let inside = low + Vec3::from_array(part) * (high - low);
            let value = texture.number(&set, &OneShape, &at(inside));
            prop_assert!(value <= texture.most_within(&set, low, high), "{value}");
            prop_assert!(value >= texture.least_within(&set, low, high), "{value}");
        }
    }
}
