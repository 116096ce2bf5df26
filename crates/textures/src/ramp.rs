//! `ramp`: colours along a line, chosen by the number of another texture.
//!
//! ```text
//! S(λ; x) = (1 − w) S(cᵢ; λ) + w S(cᵢ₊₁; λ)        w = (x − xᵢ) / (xᵢ₊₁ − xᵢ),  xᵢ ≤ x < xᵢ₊₁
//! ```
//!
//! Before the first position and after the last one it is even; two colours at the same position are a step.

use crate::reader::Use;
use crate::spectra::numbers;
use crate::texture::TextureModel;
use crate::{Texture, TextureReader, TextureTable};
use etalon_params::{ParameterKind, Params};
use etalon_spectrum::Spectrum;
use etalon_transport::{Shapes, SpectrumKind, TextureId, TexturePoint};
use glam::{DVec3, Vec3, Vec4};

/// A colour with its spectrum.
#[derive(Clone, Debug, PartialEq)]
struct Stop {
    position: f32,
    colour: Vec3,
    spectrum: Spectrum,
}

/// Colours along a line.
#[derive(Clone, Debug, PartialEq)]
pub struct Ramp {
    input: TextureId,
    /// In ascending order, one at least.
    stops: Box<[Stop]>,
}

impl Ramp {
    /// The colours before and after a point, and the share of the second.
    fn around(
        &self,
        set: &TextureTable,
        shapes: &impl Shapes,
        at: &TexturePoint,
    ) -> ([&Stop; 2], f32) {
        let x = set.number(self.input, shapes, at);
        let after = self.stops.partition_point(|stop| stop.position <= x);
        let last = self.stops.len() - 1;
        let [a, b] = [after.saturating_sub(1), after.min(last)].map(|i| &self.stops[i]);
        let width = b.position - a.position;
        let share = if width > 0.0 {
            ((x - a.position) / width).clamp(0.0, 1.0)
        } else {
            0.0
        };
        ([a, b], share)
    }
}

impl TextureModel for Ramp {
    const VARIES: bool = false;

    fn spectrum(
        &self,
        set: &TextureTable,
        shapes: &impl Shapes,
        at: &TexturePoint,
        lambda: Vec4,
    ) -> Vec4 {
        let ([a, b], share) = self.around(set, shapes, at);
        a.spectrum.eval(lambda).lerp(b.spectrum.eval(lambda), share)
    }

    fn number(&self, set: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> f32 {
        crate::recovered::luminance(self.colour(set, shapes, at))
    }

    fn colour(&self, set: &TextureTable, shapes: &impl Shapes, at: &TexturePoint) -> Vec3 {
        let ([a, b], share) = self.around(set, shapes, at);
        a.colour.lerp(b.colour, share)
    }

    fn mean(&self, _: &TextureTable) -> f32 {
        let sum: Vec3 = self.stops.iter().map(|stop| stop.colour).sum();
        crate::recovered::luminance(sum / self.stops.len() as f32)
    }

    fn is_constant(&self, set: &TextureTable) -> bool {
        self.stops.len() == 1 || set.is_constant(self.input)
    }

    fn nested(&self) -> &[TextureId] {
        std::slice::from_ref(&self.input)
    }

    fn instead_in_space(&self) -> Option<&'static str> {
        None
    }

    fn most_within(&self, _: &TextureTable, _: Vec3, _: Vec3) -> f32 {
        let most = |stop: &Stop| stop.spectrum.maximum() as f32;
        self.stops.iter().map(most).fold(0.0, f32::max)
    }
}

/// Reads `input`, a number; `colors`, three numbers for each; and `positions`, by default evenly from 0 to 1.
pub(crate) fn read(
    reader: &mut TextureReader<'_>,
    params: &Params<'_>,
    Use { role, .. }: Use,
) -> Option<Texture> {
    let number = Use {
        role: SpectrumKind::Unbounded,
        nested: true,
    };
    let input = reader.parameter_in(params, "input", None, number);
    let components = numbers(params, "colors")?;
    let (colours, rest) = components.as_chunks::<3>();
    if colours.is_empty() || !rest.is_empty() {
        let message = format!(
            "`colors` has three numbers for each colour, not {} in all",
            components.len()
        );
        params.error_at("colors", message);
        return None;
    }
    let last = (colours.len() - 1).max(1) as f64;
    let even = || (0..colours.len()).map(|i| i as f64 / last).collect();
    let positions: Vec<f64> = match params.has("positions") {
        true => numbers(params, "positions")?,
        false => {
            params.note_default("positions", ParameterKind::Words("a list of numbers"), "");
            even()
        }
    };
    if positions.len() != colours.len() || !positions.iter().all(|x| x.is_finite()) {
        let message = format!(
            "`positions` has one finite number for each of the {} `colors`",
            colours.len()
        );
        params.error_at("positions", message);
        return None;
    }
    if !positions.is_sorted() {
        params.error_at("positions", "`positions` must ascend");
        return None;
    }
    let span = params.property("colors")?.span;
    let stop = |(colour, position): (&[f64; 3], &f64)| {
        let colour = DVec3::from_array(*colour);
        let purpose = Use { role, nested: true };
        Some(Stop {
            position: *position as f32,
            colour: colour.as_vec3(),
            spectrum: reader.colour(colour, purpose, span)?,
        })
    };
    let stops: Option<Box<[Stop]>> = colours.iter().zip(&positions).map(stop).collect();
    Some(Texture::from(Ramp {
        input,
        stops: stops?,
    }))
}
