//! The types of textures (`textures.cpp`).
//!
//! | pbrt | Etalon |
//! |---|---|
//! | constant | a number or a colour |
//! | scale: tex · scale | `scale`, or `multiply` of two |
//! | mix: (1 − amount) tex1 + amount tex2 | `mix` |
//! | bilerp over the unit square | `mix` of `mix`es by formulas of s and t |
//! | imagemap | `bitmap` (`image_textures`) |
//! | fbm, wrinkled, windy, marble, dots | formulas and patterns (`noise_textures`) |
//! | checkerboard: tex1 where ⌊s⌋ + ⌊t⌋ is even | `checkerboard`, whose squares have the side ½; in space `cubes` |
//!
//! Etalon's `checkerboard` exchanges its colours where it is a number (its own documentation says why), so they are given the other way
//! round there. pbrt filters the pattern over the pixel; the mean over its samples is the same.

use super::super::parameters::Parameters;
use super::super::placement::Placement;
use super::super::scene::{TextureId, TextureKind};
use super::Mapper;
use super::node::{Draft, Given, given, word};
use super::placement::placed;
use super::spectrum::Role;
use super::textures::{Rows, times};
use etalon_params::{Class, Span, Value};

/// What may stand in place of a texture that has no equal.
const ACCEPTED: &str =
    "constant, scale, mix, bilerp, imagemap, checkerboard, dots, marble, fbm, wrinkled, windy";

impl<'a> Mapper<'a> {
    /// The value of a texture; `None` after a mistake.
    pub(crate) fn texture(&mut self, id: TextureId) -> Option<Given> {
        let scene = self.scene;
        let texture = &scene.textures[id];
        let params = self.read(&texture.entity);
        let kind = texture.kind;
        let placement = &texture.placement;
        let found = match params.entity.kind {
            "constant" => self.part(&params, "value", 1.0, kind),
            "scale" => self.product(&params, kind),
            "mix" => self.mix(&params, kind),
            "bilerp" => self.bilerp(&params, kind, placement),
            "imagemap" => self.image(&params, kind, placement),
            "checkerboard" => self.checkerboard(&params, kind, placement),
            "dots" => self.dotted(&params, kind, placement),
            "fbm" | "wrinkled" | "windy" => {
                let to_world = self.still(placement, "textures", params.entity.span);
                self.noise_texture(&params, to_world)
            }
            "marble" => {
                let to_world = self.still(placement, "textures", params.entity.span);
                Some(self.marble(&params, to_world))
            }
            "ptex" => {
                let help = "an image that is painted by (u, v), as an `imagemap`";
                self.refuse(&params, "texture", help);
                return None;
            }
            _ => {
                self.refuse(&params, "texture", ACCEPTED);
                return None;
            }
        };
        params.finish();
        found
    }

    /// A parameter of the texture's own kind.
    fn part(
        &mut self,
        params: &Parameters<'a>,
        name: &str,
        default: f64,
        kind: TextureKind,
    ) -> Option<Given> {
        match kind {
            TextureKind::Float => self.number(params, name, default),
            TextureKind::Spectrum => self.colour(params, name, default, Role::Unbounded),
        }
    }

    fn product(&mut self, params: &Parameters<'a>, kind: TextureKind) -> Option<Given> {
        let texture = self.part(params, "tex", 1.0, kind);
        let scale = self.number(params, "scale", 1.0)?;
        let texture = texture?;
        if let Value::Float(factor) = scale.value {
            return Some(times(texture, factor));
        }
        let product = Draft::of(params, Class::Texture, "multiply");
        Some(product.given("a", texture).given("b", scale).value())
    }

    fn mix(&mut self, params: &Parameters<'a>, kind: TextureKind) -> Option<Given> {
        let parts =
            [("tex1", 0.0), ("tex2", 1.0)].map(|(name, x)| self.part(params, name, x, kind));
        let amount = self.number(params, "amount", 0.5)?;
        let [a, b] = parts;
        Some(mixed(params.entity.span, a?, b?, amount))
    }

    fn bilerp(
        &mut self,
        params: &Parameters<'a>,
        kind: TextureKind,
        placement: &Placement,
    ) -> Option<Given> {
        let corners = [("v00", 0.0), ("v01", 1.0), ("v10", 0.0), ("v11", 1.0)];
        let [v00, v01, v10, v11] = corners.map(|(name, x)| self.part(params, name, x, kind));
        let coordinates = self.coordinates(params, placement)?;
        let corners = [v00?, v01?, v10?, v11?];
        let span = params.entity.span;
        let by_formula = |text: &str| {
            let formula = Draft::new(Class::Texture, "expression", span);
            coordinates.projected(params, formula.plain("value", word(text)).value())
        };
        let [s, t] = [0, 1].map(|which| coordinates.formula(which));
        if coordinates.within_unit {
            let [v00, v01, v10, v11] = corners;
            let below = mixed(span, v00, v10, by_formula(&s));
            let above = mixed(span, v01, v11, by_formula(&s));
            return Some(mixed(span, below, above, by_formula(&t)));
        }
        if let [
            Value::Float(v00),
            Value::Float(v01),
            Value::Float(v10),
            Value::Float(v11),
        ] = corners.each_ref().map(|corner| &corner.value)
        {
            return Some(by_formula(&format!(
                "(1 - {s})*((1 - {t})*({v00}) + {t}*({v01})) + {s}*((1 - {t})*({v10}) + {t}*({v11}))"
            )));
        }
        let what = "`bilerp` of colours beyond the unit square";
        let accepted = "the mappings uv, without scale and shift, and spherical";
        self.refuse_value(params, "mapping", what, accepted);
        None
    }

    fn checkerboard(
        &mut self,
        params: &Parameters<'a>,
        kind: TextureKind,
        placement: &Placement,
    ) -> Option<Given> {
        let parts =
            [("tex1", 1.0), ("tex2", 0.0)].map(|(name, x)| self.part(params, name, x, kind));
        let [even, odd] = parts;
        let span = params.entity.span;
        match params.integer("dimension", 2) {
            2 => {}
            3 => {
                let to_world = self.still(placement, "textures", span);
                let cubes = Draft::of(params, Class::Texture, "cubes")
                    .given("color0", even?)
                    .given("color1", odd?);
                let to_world = given(Value::Transform(to_world), span);
                return Some(placed(cubes, to_world).value());
            }
            other => {
                params.refuse("dimension", other, "2, 3");
                return None;
            }
        }
        let coordinates = self.coordinates(params, placement)?;
        let (even, odd) = (even?, odd?);
        let board = |first, second| {
            Draft::of(params, Class::Texture, "checkerboard")
                .given("color0", first)
                .given("color1", second)
                .maybe("to_uv", coordinates.to_uv(params, Rows::FromBottom, 0.5))
                .value()
        };
        if coordinates.is_projected() {
            // What is within the squares has coordinates of its own.
            let [zero, one] = [0.0, 1.0].map(|x| given(Value::Float(x), span));
            let weight = coordinates.projected(params, board(one, zero));
            return Some(mixed(span, even, odd, weight));
        }
        Some(match kind {
            TextureKind::Spectrum => board(even, odd),
            TextureKind::Float => board(odd, even),
        })
    }

    /// pbrt's program shows `inside` between the dots and `outside` in them (`Create` hands them over in the other order than the
    /// constructor takes them), and so do the pictures that people know.
    fn dotted(
        &mut self,
        params: &Parameters<'a>,
        kind: TextureKind,
        placement: &Placement,
    ) -> Option<Given> {
        let [between, within] =
            [("inside", 1.0), ("outside", 0.0)].map(|(name, x)| self.part(params, name, x, kind));
        let coordinates = self.coordinates(params, placement)?;
        let dots = self.dots(params, &coordinates)?;
        Some(mixed(params.entity.span, between?, within?, dots))
    }
}

/// (1 − weight) a + weight b.
pub(crate) fn mixed(span: Span, a: Given, b: Given, weight: Given) -> Given {
    let same = matches!((&a.value, &b.value), (Value::Float(x), Value::Float(y)) if x == y);
    if same {
        return given(a.value, span);
    }
    Draft::new(Class::Texture, "mix", span)
        .given("a", a)
        .given("b", b)
        .given("weight", weight)
        .value()
}
