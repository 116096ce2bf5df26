//! Clouds without a grid (`media.h`, `CloudMedium`): a formula of noise n, in the box from `p0` to `p1`.
//!
//! ```text
//! q = frequency p;   twice: q ← q + ω ∇n(κ q)       ω = 0.05 wispiness, then half of it;  κ = 10, then 1.99 times as much
//! d = Σ 2⁻ⁱ⁻¹ n(1.99ⁱ q)                                                                     i = 0 … 4
//! density(p) = min(1, clamp₀₁(4.5 density (1 − y) d) + 2 max(0, ½ − y))
//! ```
//!
//! ∇n is taken from differences over 0.01, as in pbrt. The random numbers of the noise are others, which a note says.

use super::super::parameters::Parameters;
use super::super::scene::Medium;
use super::Mapper;
use super::grid_media::{box_of, volume_file};
use super::node::{Draft, Given, word};
use crate::document::embedded_name;
use etalon_params::{Class, DMat4, Node, Value};
use std::sync::Arc;

/// The step of differences.
const STEP: f64 = 0.01;

/// How much finer each octave is than the one before.
const LACUNARITY: f64 = 1.99;

impl<'a> Mapper<'a> {
    /// A cloud; `None` after a mistake.
    pub(crate) fn cloud(&mut self, params: &Parameters<'a>, medium: &Medium) -> Option<Arc<Node>> {
        let finite =
            |name, default| params.float_where(name, default, "a finite number", f64::is_finite);
        let [density, wispiness, frequency] =
            [("density", 1.0), ("wispiness", 1.0), ("frequency", 5.0)].map(|(n, x)| finite(n, x));
        let [low, high] = box_of(params)?;
        let to_world = self.still(&medium.placement, "media", params.entity.span);
        self.note_noise(params);
        let formula = formula(density, wispiness, frequency);
        let mut billows = Draft::of(params, Class::Texture, "expression");
        billows = billows.plain("value", word(&formula));
        if to_world != DMat4::IDENTITY {
            billows = billows.plain("to_world", Value::Transform(to_world));
        }
        // A single cell says where the medium ends.
        let place = DMat4::from_translation(low) * DMat4::from_scale(high - low);
        let file = embedded_name(self.embedded.len());
        self.embedded.push(Arc::new(volume_file([1; 3], [[1.0]])));
        let cell = Draft::of(params, Class::Volume, "gridvolume")
            .plain("filename", word(&file))
            .plain("to_world", Value::Transform(to_world * place));
        let product: Given = Draft::of(params, Class::Texture, "multiply")
            .given("a", cell.value())
            .given("b", billows.value())
            .value();
        Some(self.by_density(params, product)?.node())
    }
}

/// The density as a formula of x, y and z.
fn formula(density: f64, wispiness: f64, frequency: f64) -> String {
    let noise = |[x, y, z]: &[String; 3]| format!("noise({x}, {y}, {z})");
    let scaled = |factor: f64, q: &[String; 3]| q.each_ref().map(|c| format!("({factor})*{c}"));
    let mut q = ["x", "y", "z"].map(|c| format!("(({frequency})*{c})"));
    if wispiness > 0.0 {
        for (strength, fineness) in [(0.05, 10.0), (0.025, 10.0 * LACUNARITY)] {
            let here = scaled(fineness, &q);
            let factor = strength * wispiness / STEP;
            let moved = |axis: usize| {
                let mut there = here.clone();
                there[axis] = format!("({} + {STEP})", there[axis]);
                let slope = format!("({} - {})", noise(&there), noise(&here));
                format!("({} + ({factor})*{slope})", q[axis])
            };
            q = [moved(0), moved(1), moved(2)];
        }
    }
    let (mut terms, mut weight, mut k) = (Vec::new(), 0.5, 1.0);
    for _ in 0..5 {
        terms.push(format!("({weight})*{}", noise(&scaled(k, &q))));
        weight *= 0.5;
        k *= LACUNARITY;
    }
    let sum = terms.join(" + ");
    let high = format!("max(0, min(1, (1 - y)*({})*({sum})))", 4.5 * density);
    format!("min(1, {high} + 2*max(0, 0.5 - y))")
}
