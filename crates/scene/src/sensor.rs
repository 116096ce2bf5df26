//! What a sensor responds to: its film's curves, behind its filter.
//!
//! ```text
//! C = ∫ L(λ) s(λ) f(λ) dλ
//! ```
//!
//! with f the `srf` of the sensor (1 if there is none) and s, for each channel of the film,
//!
//! - `hdrfilm`: the CIE 1931 observer in linear Rec. 709, or a camera's measured curves, each scaled so that D65 is 1
//!   (`response_red`, `response_green`, `response_blue`); with `white_balance` the observer's colours are mapped so that a light of that
//!   temperature is white;
//! - `specfilm`: the curve of each band as it is, so that a band's unit is W·sr⁻¹·m⁻² where the curve is 1.

use etalon_film::{FilmSettings, PixelFormat};
use etalon_params::{Class, Params, Value};
use etalon_spectrum::{Sensor, Spectrum, white_balance};
use etalon_textures::Texture;
use etalon_transport::{Build, SpectrumKind};

use crate::builder::Builder;

/// The parameters of an `hdrfilm` with curves of its own.
const CURVES: [&str; 3] = ["response_red", "response_green", "response_blue"];

/// The curves of a film.
#[derive(Clone, Debug, Default)]
pub(crate) enum Response {
    /// The standard observer.
    #[default]
    Observer,
    /// The standard observer with a white balance: a matrix in linear Rec. 709.
    Balanced([[f64; 3]; 3]),
    /// A camera's red, green and blue.
    Camera(Box<[Spectrum; 3]>),
    /// Bands.
    Bands(Vec<Spectrum>),
}

impl Response {
    /// Reads the curves of a film; `None` after a mistake. Bands become channels of `settings`.
    pub(crate) fn read(
        params: &Params<'_>,
        settings: &mut FilmSettings,
        builder: &mut Builder<'_>,
    ) -> Option<Self> {
        if params.node.plugin.value == "specfilm" {
            return Self::bands(params, settings, builder);
        }
        let has_curves = CURVES.iter().any(|name| params.has(name));
        if let Some(kelvin) = params.float("white_balance") {
            let balance = white_balance(kelvin).map(Self::Balanced);
            if balance.is_none() {
                let message = format!("`white_balance` cannot be {kelvin}");
                let accepted = "accepted: the temperature of a light in kelvin, 1000 to 25000";
                params.error_with_help("white_balance", &message, accepted);
            }
            if has_curves {
                params.error_at(
                    "white_balance",
                    "a film has either `white_balance` or curves of its own",
                );
            }
            return balance.filter(|_| !has_curves);
        }
        if !has_curves {
            return Some(Self::Observer);
        }
        let [red, green, blue] = CURVES.map(|name| curve(params, name, builder));
        let (red, green, blue) = (red?, green?, blue?);
        let d65 = Spectrum::d65(1.0).ok()?;
        let white =
            |curve: &Spectrum| integral(|lambda| curve.eval_at(lambda) * d65.eval_at(lambda));
        let scaled = [red, green, blue].map(|curve| {
            let white = white(&curve);
            (white > 0.0).then(|| curve.scaled((1.0 / white) as f32))
        });
        for (name, curve) in CURVES.iter().zip(&scaled) {
            if curve.is_none() {
                params.error_at(
                    name,
                    format!("`{name}` does not see daylight: it is 0 from 360 to 830 nm"),
                );
            }
        }
        let [red, green, blue] = scaled;
        Some(Self::Camera(Box::new([red?, green?, blue?])))
    }

    /// The bands of a `specfilm`: its spectra, by their names.
    fn bands(
        params: &Params<'_>,
        settings: &mut FilmSettings,
        builder: &mut Builder<'_>,
    ) -> Option<Self> {
        let is_spectrum = |value: &Value| match value {
            Value::Spectrum(_) => true,
            Value::Object(node) => node.class == Class::Texture,
            _ => false,
        };
        let named = params.node.properties.iter();
        let named: Vec<_> = named
            .filter(|property| is_spectrum(&property.value))
            .collect();
        if named.is_empty() {
            params.missing(
                "band",
                "a spectrum for each band, which its channel is named after",
            );
            return None;
        }
        settings.pixel_format = PixelFormat::Bands;
        settings.bands = named.iter().map(|property| property.name.clone()).collect();
        let curves: Vec<_> = (named.iter())
            .map(|property| curve(params, &property.name, builder))
            .collect();
        Some(Self::Bands(curves.into_iter().collect::<Option<_>>()?))
    }

    /// Sensors of three channels each, behind a filter.
    pub(crate) fn sensors(&self, filter: Option<&Spectrum>) -> Vec<Sensor> {
        let passed = |lambda: f64| filter.map_or(1.0, |filter| filter.eval_at(lambda));
        let of_curves = |curves: &[Spectrum]| {
            let seen = |k: usize| {
                move |lambda: f64| {
                    curves
                        .get(k)
                        .map_or(0.0, |c| c.eval_at(lambda) * passed(lambda))
                }
            };
            Sensor::new([&seen(0), &seen(1), &seen(2)])
        };
        match (self, filter) {
            (Self::Observer, None) => vec![Sensor::default()],
            (Self::Observer, Some(filter)) => vec![Sensor::behind(filter)],
            (Self::Balanced(matrix), filter) => vec![Sensor::mapped(filter, *matrix)],
            (Self::Camera(curves), _) => vec![of_curves(&curves[..])],
            (Self::Bands(curves), _) => curves.chunks(3).map(of_curves).collect(),
        }
    }
}

/// A spectrum that is the same everywhere and nowhere below zero; `None` after a mistake.
pub(crate) fn curve(
    params: &Params<'_>,
    name: &str,
    builder: &mut Builder<'_>,
) -> Option<Spectrum> {
    let texture = builder.texture(params, name, None, SpectrumKind::Unbounded);
    let Texture::Constant(constant) = builder.textures.get(texture) else {
        params.error_at(
            name,
            format!("`{name}` must be the same everywhere: a spectrum, not an image"),
        );
        return None;
    };
    let spectrum = constant.spectrum.clone();
    let lowest = (360..=830)
        .map(|nm| spectrum.eval_at(f64::from(nm)))
        .fold(0.0, f64::min);
    if lowest < 0.0 {
        params.refuse(name, lowest, "values not below 0");
        return None;
    }
    Some(spectrum)
}

/// ∫ f dλ from 360 to 830 nm, by the midpoint rule.
fn integral(f: impl Fn(f64) -> f64) -> f64 {
    const PARTS: u32 = 4700;
    let step = 470.0 / f64::from(PARTS);
    let middle = |i: u32| 360.0 + (f64::from(i) + 0.5) * step;
    (0..PARTS).map(|i| f(middle(i))).sum::<f64>() * step
}
