//! Textures of noise (`textures.cpp`, `util/noise.cpp`), as formulas.
//!
//! ```text
//! fbm(p, ω, n) = Σ ωⁱ noise(1.99ⁱ p)          wrinkled: Σ ωⁱ |noise(1.99ⁱ p)|          i = 0 … n − 1
//! windy = |fbm(p/10, ½, 3)| · fbm(p, ½, 6)
//! marble: the colour at ½ + ½ sin(q.y + variation fbm(q, ω, n)), q = scale p, of six cubic Bézier curves of colours one after another
//! ```
//!
//! p is the place in the texture's space. The colours of `marble` are a `ramp` that has some places of each curve. pbrt's noise and Etalon's are both Perlin's of 2002 with random numbers of their own: the patterns
//! look alike, and are not the same. pbrt leaves out the octaves that are finer than pixels; here samples average over them.

use super::super::parameters::Parameters;
use super::Mapper;
use super::coordinates::Coordinates;
use super::node::{Draft, Given, word};
use etalon_params::{Class, DMat4, Value};

/// How much finer each octave is than the one before.
const LACUNARITY: f64 = 1.99;

/// The most octaves that a formula has room for: the last are seven million times finer than the first.
const MOST_OCTAVES: i32 = 24;

/// Control points of the curves of `marble`: curve i has those from i to i + 3.
const MARBLE: [[f64; 3]; 9] = [
    [0.58, 0.58, 0.6],
    [0.58, 0.58, 0.6],
    [0.58, 0.58, 0.6],
    [0.5, 0.5, 0.5],
    [0.6, 0.59, 0.58],
    [0.58, 0.58, 0.6],
    [0.58, 0.58, 0.6],
    [0.2, 0.2, 0.33],
    [0.58, 0.58, 0.6],
];

/// By how much the curves of `marble` are brightened.
const MARBLE_GAIN: f64 = 1.5;

/// Parts of each curve of `marble` that are linear here.
const MARBLE_STEPS: usize = 12;

impl Mapper<'_> {
    /// The value of `fbm`, `wrinkled` or `windy`.
    pub(crate) fn noise_texture(&self, params: &Parameters<'_>, to_world: DMat4) -> Option<Given> {
        let formula = match params.entity.kind {
            "windy" => {
                let (wind, wave) = (octaves(3, 0.5, 0.1, plain), octaves(6, 0.5, 1.0, plain));
                format!("abs({wind})*({wave})")
            }
            kind => {
                let (count, omega) = roughness(params);
                let of = if kind == "wrinkled" { folded } else { plain };
                octaves(count, omega, 1.0, of)
            }
        };
        self.note_noise(params);
        Some(in_space(params, &formula, to_world))
    }

    /// The value of `marble`.
    pub(crate) fn marble(&self, params: &Parameters<'_>, to_world: DMat4) -> Given {
        let (count, omega) = roughness(params);
        let finite =
            |name, default| params.float_where(name, default, "a finite number", f64::is_finite);
        let (scale, variation) = (finite("scale", 1.0), finite("variation", 0.2));
        let veins = octaves(count, omega, scale, plain);
        let formula = format!("0.5 + 0.5*sin(({scale})*y + ({variation})*({veins}))");
        self.note_noise(params);
        let [colors, positions] = marble_colours();
        Draft::of(params, Class::Texture, "ramp")
            .given("input", in_space(params, &formula, to_world))
            .plain("colors", word(&colors))
            .plain("positions", word(&positions))
            .value()
    }

    /// The value of `dots`: 1 in them, 0 between. `None` after a mistake.
    pub(crate) fn dots(&self, params: &Parameters<'_>, coordinates: &Coordinates) -> Option<Given> {
        let mut draft = Draft::of(params, Class::Texture, "dots");
        let place = coordinates.back_to_uv(params)?;
        if place != DMat4::IDENTITY {
            draft = draft.plain("to_world", Value::Transform(place));
        }
        self.note_noise(params);
        Some(coordinates.projected(params, draft.value()))
    }

    pub(crate) fn note_noise(&self, params: &Parameters<'_>) {
        let message = "pbrt's noise has other random numbers: the pattern is alike, not the same";
        self.note(
            params.entity.span,
            message,
            "an image of pbrt's pattern would be the same",
        );
    }
}

/// `octaves` and `roughness`.
fn roughness(params: &Parameters<'_>) -> (i32, f64) {
    let count = params.integer_from("octaves", 8, 0).min(MOST_OCTAVES);
    let omega = params.float_where("roughness", 0.5, "a finite number", f64::is_finite);
    (count, omega)
}

/// A formula of x, y and z in the texture's space.
fn in_space(params: &Parameters<'_>, formula: &str, to_world: DMat4) -> Given {
    let mut draft = Draft::of(params, Class::Texture, "expression");
    draft = draft.plain("value", word(formula));
    if to_world != DMat4::IDENTITY {
        draft = draft.plain("to_world", Value::Transform(to_world));
    }
    draft.value()
}

/// `colors` and `positions` of the ramp of `marble`. Where one curve does not begin as the one before ends there is a step.
fn marble_colours() -> [String; 2] {
    let curves = MARBLE.windows(4);
    let count = curves.len() as f64;
    let mut texts = [const { Vec::new() }; 2];
    for (curve, points) in curves.enumerate() {
        for step in 0..=MARBLE_STEPS {
            let t = step as f64 / MARBLE_STEPS as f64;
            let s = 1.0 - t;
            let weights = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
            let [r, g, b] = core::array::from_fn(|channel| {
                let terms = points.iter().zip(weights).map(|(p, w)| p[channel] * w);
                MARBLE_GAIN * terms.sum::<f64>()
            });
            texts[0].push(format!("{r} {g} {b}"));
            texts[1].push(((curve as f64 + t) / count).to_string());
        }
    }
    texts.map(|list| list.join(", "))
}

fn plain(noise: &str) -> String {
    noise.to_owned()
}

fn folded(noise: &str) -> String {
    format!("abs({noise})")
}

/// The formula of a sum of octaves, the first of which has features of the size 1/`frequency`.
fn octaves(count: i32, omega: f64, frequency: f64, of: fn(&str) -> String) -> String {
    let (mut weight, mut k) = (1.0, frequency);
    let mut terms = vec!["0".to_owned()];
    for _ in 0..count {
        terms.push(format!(
            "({weight})*{}",
            of(&format!("noise({k}*x, {k}*y, {k}*z)"))
        ));
        weight *= omega;
        k *= LACUNARITY;
    }
    terms.join(" + ")
}
