//! The types of textures (`textures.cpp`).
//!
//! | pbrt | Etalon |
//! |---|---|
//! | constant | a number or a colour |
//! | scale: tex · scale | `scale`, or `multiply` of two |
//! | mix: (1 − amount) tex1 + amount tex2 | `mix` |
//! | bilerp over the unit square | `mix` of `mix`es by formulas of s and t |
//! | imagemap | `bitmap` |
//! | fbm, wrinkled, windy | `expression` (`noise_textures`) |
//! | checkerboard: tex1 where ⌊s⌋ + ⌊t⌋ is even | `checkerboard`, whose squares have the side ½ |
//!
//! Etalon's `checkerboard` exchanges its colours where it is a number (its own documentation says why), so they are given the other way
//! round there. pbrt filters the pattern over the pixel; the mean over its samples is the same. `marble` and `dots` have pbrt's own patterns.

use super::super::parameters::Parameters;
use super::super::scene::{TextureId, TextureKind};
use super::Mapper;
use super::node::{Draft, Given, given, word};
use super::spectrum::Role;
use super::textures::{Rows, times};
use etalon_params::{Class, Span, Value};

/// What may stand in place of a texture that has no equal.
const ACCEPTED: &str = "constant, scale, mix, bilerp, imagemap, checkerboard, fbm, wrinkled, windy";

impl<'a> Mapper<'a> {
    /// The value of a texture; `None` after a mistake.
    pub(crate) fn texture(&mut self, id: TextureId) -> Option<Given> {
        let scene = self.scene;
        let texture = &scene.textures[id];
        let params = self.read(&texture.entity);
        let kind = texture.kind;
        let found = match params.entity.kind {
            "constant" => self.part(&params, "value", 1.0, kind),
            "scale" => self.product(&params, kind),
            "mix" => self.mix(&params, kind),
            "bilerp" => self.bilerp(&params, kind),
            "imagemap" => self.image(&params, kind),
            "checkerboard" => self.checkerboard(&params, kind),
            "fbm" | "wrinkled" | "windy" => {
                let to_world = self.still(&texture.placement, "textures", params.entity.span);
                self.noise_texture(&params, to_world)
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

    fn bilerp(&mut self, params: &Parameters<'a>, kind: TextureKind) -> Option<Given> {
        let corners = [("v00", 0.0), ("v01", 1.0), ("v10", 0.0), ("v11", 1.0)];
        let [v00, v01, v10, v11] = corners.map(|(name, x)| self.part(params, name, x, kind));
        let to_uv = self.to_uv(params, Rows::FromBottom, 1.0)?;
        let (v00, v01, v10, v11) = (v00?, v01?, v10?, v11?);
        let span = params.entity.span;
        if to_uv.is_some() {
            let what = "`bilerp` beyond the unit square";
            self.refuse_value(params, "uscale", what, "no scale and no shift of (u, v)");
            return None;
        }
        let along = |variable: &str| {
            let formula = Draft::new(Class::Texture, "expression", span);
            formula.plain("value", word(variable)).value()
        };
        let below = mixed(span, v00, v10, along("u"));
        let above = mixed(span, v01, v11, along("u"));
        Some(mixed(span, below, above, along("v")))
    }

    fn checkerboard(&mut self, params: &Parameters<'a>, kind: TextureKind) -> Option<Given> {
        let parts =
            [("tex1", 1.0), ("tex2", 0.0)].map(|(name, x)| self.part(params, name, x, kind));
        if params.integer("dimension", 2) != 2 {
            let what = "`checkerboard` in space";
            self.refuse_value(params, "dimension", what, "2");
            return None;
        }
        let to_uv = self.to_uv(params, Rows::FromBottom, 0.5)?;
        let [even, odd] = parts;
        let (even, odd) = (even?, odd?);
        let [first, second] = match kind {
            TextureKind::Spectrum => [even, odd],
            TextureKind::Float => [odd, even],
        };
        let board = Draft::of(params, Class::Texture, "checkerboard")
            .given("color0", first)
            .given("color1", second);
        Some(board.maybe("to_uv", to_uv).value())
    }

    fn image(&mut self, params: &Parameters<'a>, kind: TextureKind) -> Option<Given> {
        let scale = params.float("scale", 1.0);
        let invert = params.boolean("invert", false);
        params.ignore(&["maxanisotropy"]);
        let bitmap = self.bitmap(params, kind)?;
        if !invert {
            return Some(times(bitmap, scale));
        }
        if kind == TextureKind::Spectrum {
            self.refuse_value(params, "invert", "inverted images of colours", "false");
            return None;
        }
        let span = params.span("invert");
        let formula = Draft::new(Class::Texture, "expression", span)
            .plain("value", word("1 - scale*image"))
            .from(params, "scale", "scale", Value::Float(scale))
            .given("image", bitmap);
        Some(formula.value())
    }

    /// An image, without factors.
    fn bitmap(&self, params: &Parameters<'_>, kind: TextureKind) -> Option<Given> {
        let filters = ["point", "bilinear", "trilinear", "ewa", "EWA"];
        let filter = match params.choice("filter", "bilinear", &filters) {
            "point" => "nearest",
            // Rays have no footprint here: samples average over it.
            _ => "bilinear",
        };
        let wraps = ["repeat", "black", "clamp", "octahedralsphere"];
        let wrap = params.choice("wrap", "repeat", &wraps);
        let encoding = params.string("encoding").unwrap_or("sRGB");
        let to_uv = self.to_uv(params, Rows::FromTop, 1.0)?;
        let Some(filename) = params.string("filename") else {
            params.missing("string filename");
            return None;
        };
        if !["repeat", "clamp"].contains(&wrap) {
            let what = format!("`wrap` `{wrap}` of images");
            self.refuse_value(params, "wrap", &what, "repeat, clamp");
            return None;
        }
        let mut draft = Draft::of(params, Class::Texture, "bitmap")
            .from(params, "filename", "filename", word(filename))
            .maybe("to_uv", to_uv);
        if filter != "bilinear" {
            draft = draft.from(params, "filter", "filter_type", word(filter));
        }
        if wrap != "repeat" {
            draft = draft.from(params, "wrap", "wrap_mode", word(wrap));
        }
        // The encoding is that of files with eight bits; others are linear in both.
        draft = match (encoding, kind) {
            ("sRGB", _) => draft,
            ("linear", TextureKind::Float) => {
                draft.from(params, "encoding", "raw", Value::Boolean(true))
            }
            ("linear", TextureKind::Spectrum) => {
                draft.from(params, "encoding", "gamma", Value::Float(1.0))
            }
            (other, _) => {
                let what = format!("`encoding` `{other}` of images");
                self.refuse_value(params, "encoding", &what, "sRGB, linear");
                return None;
            }
        };
        Some(draft.value())
    }
}

/// (1 − weight) a + weight b.
fn mixed(span: Span, a: Given, b: Given, weight: Given) -> Given {
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
