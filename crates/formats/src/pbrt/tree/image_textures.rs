//! Images as textures (`textures.cpp`, `ImageTextureBase`; `util/mipmap.cpp`, `util/color.cpp`): `bitmap`.
//!
//! pbrt filters images over the pixel; the mean over its samples is the same. `invert` is max(0, 1 − scale c): of numbers by a formula, of
//! colours by the texels. `encoding` is that of integers; other files are linear in both. A number is the opacity of the image, if it is not
//! opaque everywhere, or else the mean of its channels.

use super::super::parameters::Parameters;
use super::super::placement::Placement;
use super::super::scene::TextureKind;
use super::Mapper;
use super::node::{Draft, Given, word};
use super::picture::Number;
use super::textures::{Rows, times};
use etalon_params::{Class, Value};

impl Mapper<'_> {
    /// The value of an `imagemap`; `None` after a mistake.
    pub(crate) fn image(
        &self,
        params: &Parameters<'_>,
        kind: TextureKind,
        placement: &Placement,
    ) -> Option<Given> {
        let scale = params.float("scale", 1.0);
        let invert = params.boolean("invert", false);
        params.ignore(&["maxanisotropy"]);
        let bitmap = self.bitmap(params, kind, placement, invert)?;
        if !invert {
            return Some(times(bitmap, scale));
        }
        if kind == TextureKind::Spectrum {
            if scale != 1.0 {
                let what = "`scale` of inverted images of colours";
                self.refuse_value(params, "scale", what, "1");
                return None;
            }
            return Some(bitmap);
        }
        let span = params.span("invert");
        let formula = Draft::new(Class::Texture, "expression", span)
            .plain("value", word("1 - scale*image"))
            .from(params, "scale", "scale", Value::Float(scale))
            .given("image", bitmap);
        Some(formula.value())
    }

    /// An image, without factors.
    fn bitmap(
        &self,
        params: &Parameters<'_>,
        kind: TextureKind,
        placement: &Placement,
        invert: bool,
    ) -> Option<Given> {
        let filters = ["point", "bilinear", "trilinear", "ewa", "EWA"];
        let filter = match params.choice("filter", "bilinear", &filters) {
            "point" => "nearest",
            // Rays have no footprint here: samples average over it.
            _ => "bilinear",
        };
        let wraps = ["repeat", "black", "clamp", "octahedralsphere"];
        let wrap = params.choice("wrap", "repeat", &wraps);
        let encoding = params.string("encoding").unwrap_or("sRGB");
        let coordinates = self.coordinates(params, placement)?;
        let Some(filename) = params.string("filename") else {
            params.missing("string filename");
            return None;
        };
        if wrap == "octahedralsphere" {
            let what = "`wrap` `octahedralsphere` of images";
            self.refuse_value(params, "wrap", what, "repeat, black, clamp");
            return None;
        }
        let number = match kind {
            TextureKind::Float => self.number_in(filename),
            TextureKind::Spectrum => Number::Grey,
        };
        let bitmap = |channel: Option<&str>| {
            let mut draft = Draft::of(params, Class::Texture, "bitmap")
                .from(params, "filename", "filename", word(filename))
                .maybe("to_uv", coordinates.to_uv(params, Rows::FromTop, 1.0));
            if filter != "bilinear" {
                draft = draft.from(params, "filter", "filter_type", word(filter));
            }
            if wrap != "repeat" {
                let own = if wrap == "black" { "zero" } else { wrap };
                draft = draft.from(params, "wrap", "wrap_mode", word(own));
            }
            if invert && kind == TextureKind::Spectrum {
                draft = draft.from(params, "invert", "invert", Value::Boolean(true));
            }
            if let Some(channel) = channel {
                draft = draft.plain("channel", word(channel));
            }
            Some(encoded(params, draft, encoding, kind)?.value())
        };
        let texture = match number {
            Number::Grey => bitmap(None)?,
            Number::Alpha => bitmap(Some("a"))?,
            Number::Mean => Draft::of(params, Class::Texture, "expression")
                .plain("value", word("(r + g + b)/3"))
                .given("r", bitmap(Some("r"))?)
                .given("g", bitmap(Some("g"))?)
                .given("b", bitmap(Some("b"))?)
                .value(),
        };
        Some(coordinates.projected(params, texture))
    }
}

/// Adds how integers become numbers; `None` after a mistake.
fn encoded(
    params: &Parameters<'_>,
    draft: Draft,
    encoding: &str,
    kind: TextureKind,
) -> Option<Draft> {
    Some(match (encoding, kind) {
        ("sRGB", _) => draft,
        ("linear", TextureKind::Float) => {
            draft.from(params, "encoding", "raw", Value::Boolean(true))
        }
        ("linear", TextureKind::Spectrum) => {
            draft.from(params, "encoding", "exponent", Value::Float(1.0))
        }
        (other, _) => {
            let exponent = other.strip_prefix("gamma ").map(str::trim);
            let exponent = exponent.and_then(|text| text.parse::<f64>().ok());
            let Some(exponent) = exponent.filter(|x| *x > 0.0 && x.is_finite()) else {
                let accepted = "sRGB, linear, and gamma with a number above 0 behind it";
                params.refuse("encoding", format!("`{other}`"), accepted);
                return None;
            };
            draft.from(params, "encoding", "exponent", Value::Float(exponent))
        }
    })
}
