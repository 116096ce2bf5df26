//! `scale`, `multiply`, `add`, `mix`: textures computed from others, point by point.
//!
//! ```text
//! scale = s t        multiply = a b        add = a + b        mix = (1 − w) a + w b
//! ```
//!
//! `scale` is Mitsuba 0.6's. Reflectances are held to 1.

use crate::reader::Use;
use crate::texture::TextureModel;
use crate::{Texture, TextureReader, TextureTable};
use core::ops::{Add, Mul, Sub};
use etalon_params::{Class, Params};
use etalon_transport::{Shapes, SpectrumKind, TextureId, TexturePoint};
use glam::{Vec3, Vec4};

/// The operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Operation {
    Multiply,
    Add,
    /// With the share of the second, the third texture.
    Mix,
}

/// A texture computed from others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arithmetic {
    operation: Operation,
    /// The operands; `mix` has a third.
    parts: [TextureId; 3],
    /// Whether what comes out is at most 1.
    is_share: bool,
}

impl Arithmetic {
    #[inline]
    fn of<T>(&self, a: T, b: T, weight: impl FnOnce() -> f32) -> T
    where
        T: Copy + Add<Output = T> + Sub<Output = T> + Mul<Output = T> + Mul<f32, Output = T>,
    {
        match self.operation {
            Operation::Multiply => a * b,
            Operation::Add => a + b,
            Operation::Mix => a + (b - a) * weight(),
        }
    }

    #[inline]
    fn weight(&self, set: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> f32 {
        set.number(self.parts[2], shapes, at).clamp(0.0, 1.0)
    }

    /// Bounds of the result in a box.
    fn range_within(&self, set: &TextureTable, low: Vec3, high: Vec3) -> [f32; 2] {
        let [a, b] = [0, 1].map(|part| {
            let part = set.get(self.parts[part]);
            [
                part.least_within(set, low, high),
                part.most_within(set, low, high),
            ]
        });
        let range = match self.operation {
            Operation::Multiply => {
                // 0 · ∞ = 0: an unbounded factor of nothing is nothing.
                let product = |x: f32, y: f32| if x == 0.0 || y == 0.0 { 0.0 } else { x * y };
                let ends = a.map(|x| b.map(|y| product(x, y)));
                (ends.as_flattened().iter())
                    .fold([f32::INFINITY, f32::NEG_INFINITY], |[a, b], x| {
                        [a.min(*x), b.max(*x)]
                    })
            }
            Operation::Add => [a[0] + b[0], a[1] + b[1]],
            Operation::Mix => [a[0].min(b[0]), a[1].max(b[1])],
        };
        range.map(|end| end.min(self.most()))
    }

    /// The greatest value that may come out.
    #[inline]
    fn most(&self) -> f32 {
        if self.is_share { 1.0 } else { f32::INFINITY }
    }
}

impl TextureModel for Arithmetic {
    const VARIES: bool = false;

    #[inline]
    fn spectrum(
        &self,
        set: &TextureTable,
        shapes: &impl Shapes,
        at: &TexturePoint,
        lambda: Vec4,
    ) -> Vec4 {
        let [a, b] = [0, 1].map(|part| set.spectrum(self.parts[part], shapes, at, lambda));
        let value = self.of(a, b, || self.weight(set, shapes, at));
        value.min(Vec4::splat(self.most()))
    }

    #[inline]
    fn number(&self, set: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> f32 {
        let [a, b] = [0, 1].map(|part| set.number(self.parts[part], shapes, at));
        let value = self.of(a, b, || self.weight(set, shapes, at));
        value.min(self.most())
    }

    #[inline]
    fn colour(&self, set: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> Vec3 {
        let [a, b] = [0, 1].map(|part| set.colour(self.parts[part], shapes, at));
        let value = self.of(a, b, || self.weight(set, shapes, at));
        value.min(Vec3::splat(self.most()))
    }

    fn mean(&self, set: &TextureTable) -> f32 {
        let [a, b] = [0, 1].map(|part| set.mean(self.parts[part]));
        let value = self.of(a, b, || set.mean(self.parts[2]));
        value.min(self.most())
    }

    fn most_within(&self, set: &TextureTable, low: Vec3, high: Vec3) -> f32 {
        self.range_within(set, low, high)[1]
    }

    fn least_within(&self, set: &TextureTable, low: Vec3, high: Vec3) -> f32 {
        self.range_within(set, low, high)[0]
    }

    fn extent(&self, set: &TextureTable) -> Option<[Vec3; 2]> {
        let [a, b] = [0, 1].map(|part| set.get(self.parts[part]).extent(set));
        match (self.operation, a, b) {
            (Operation::Multiply, Some([a, b]), Some([c, d])) => Some([a.max(c), b.min(d)]),
            (Operation::Multiply, a, b) => a.or(b),
            (_, a, b) => a.zip(b).map(|([a, b], [c, d])| [a.min(c), b.max(d)]),
        }
    }

    fn is_constant(&self, set: &TextureTable) -> bool {
        self.nested().iter().all(|&part| set.is_constant(part))
    }

    fn nested(&self) -> &[TextureId] {
        &self.parts[..if self.operation == Operation::Mix {
            3
        } else {
            2
        }]
    }

    fn instead_in_space(&self) -> Option<&'static str> {
        None
    }
}

/// Reads `a` and `b`, and `weight` (0.5) of `mix`; of `scale`, the nested texture and the factor `scale` (1).
pub(crate) fn read(
    reader: &mut TextureReader<'_>,
    params: &Params<'_>,
    Use { role, .. }: Use,
) -> Option<Texture> {
    let nested = Use { role, nested: true };
    // A factor may exceed 1, even if the scaled texture may not.
    let factor = Use {
        role: match role {
            SpectrumKind::Reflectance => SpectrumKind::Unbounded,
            role => role,
        },
        nested: true,
    };
    let plugin = params.node.plugin.value.as_str();
    let (operation, parts) = if plugin == "scale" {
        let factor = reader.parameter_in(params, "scale", Some(1.0), factor);
        let mut others = params.children(Class::Texture);
        others.retain(|(property, _)| property.name != "scale");
        let [(property, _)] = others.as_slice() else {
            params.error(format!(
                "`scale` has one nested texture, not {}",
                others.len()
            ));
            return None;
        };
        (
            Operation::Multiply,
            [reader.value(property, nested), factor],
        )
    } else {
        let operation = match plugin {
            "multiply" => Operation::Multiply,
            "add" => Operation::Add,
            _ => Operation::Mix,
        };
        let parts = ["a", "b"].map(|name| reader.parameter_in(params, name, None, nested));
        (operation, parts)
    };
    let third = match operation {
        Operation::Mix => reader.parameter_in(params, "weight", Some(0.5), nested),
        _ => parts[0],
    };
    Some(Texture::from(Arithmetic {
        operation,
        parts: [parts[0], parts[1], third],
        is_share: role == SpectrumKind::Reflectance,
    }))
}
