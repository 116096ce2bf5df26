//! Textures of noise (`textures.cpp`, `util/noise.cpp`), as formulas.
//!
//! ```text
//! fbm(p, ω, n) = Σ ωⁱ noise(1.99ⁱ p)          wrinkled: Σ ωⁱ |noise(1.99ⁱ p)|          i = 0 … n − 1
//! windy = |fbm(p/10, ½, 3)| · fbm(p, ½, 6)
//! ```
//!
//! p is the place in the texture's space. pbrt's noise and Etalon's are both Perlin's of 2002 with random numbers of their own: the patterns
//! look alike, and are not the same. pbrt leaves out the octaves that are finer than pixels; here samples average over them.

use super::super::parameters::Parameters;
use super::Mapper;
use super::node::{Draft, Given, word};
use etalon_params::{Class, DMat4, Value};

/// How much finer each octave is than the one before.
const LACUNARITY: f64 = 1.99;

/// The most octaves that a formula has.
const MOST_OCTAVES: i32 = 64;

impl Mapper<'_> {
    /// The value of `fbm`, `wrinkled` or `windy`.
    pub(crate) fn noise_texture(&self, params: &Parameters<'_>, to_world: DMat4) -> Option<Given> {
        let formula = match params.entity.kind {
            "windy" => {
                let (wind, wave) = (octaves(3, 0.5, 0.1, plain), octaves(6, 0.5, 1.0, plain));
                format!("abs({wind})*({wave})")
            }
            kind => {
                let count = params.integer_from("octaves", 8, 0).min(MOST_OCTAVES);
                let omega = params.float_where("roughness", 0.5, "a finite number", f64::is_finite);
                let of = if kind == "wrinkled" { folded } else { plain };
                octaves(count, omega, 1.0, of)
            }
        };
        let message = "pbrt's noise has other random numbers: the pattern is alike, not the same";
        self.note(
            params.entity.span,
            message,
            "an image of pbrt's pattern would be the same",
        );
        let mut draft = Draft::of(params, Class::Texture, "expression");
        draft = draft.plain("value", word(&formula));
        if to_world != DMat4::IDENTITY {
            draft = draft.plain("to_world", Value::Transform(to_world));
        }
        Some(draft.value())
    }
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
