//! A mixture of several materials with constant weights:
//!
//! ```text
//! f(wo, wi) = Σ wᵢ fᵢ(wo, wi)        wᵢ ≥ 0, Σ wᵢ ≤ 1
//! ```
//!
//! Mitsuba 0.6's plugin of that name (Mitsuba 3 has `blendbsdf` only). What the weights leave of
//! one is absorbed: a black material has that share.

use crate::models::diffuse;
use crate::{LobeList, Material, MaterialFlags, ShadingContext};
use etalon_math::Frame;
use etalon_params::Params;
use etalon_spectrum::Spectrum;
use etalon_transport::{Build, Textures};

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &[
    "mixturebsdf weights=s:0.7,0.3 ( diffuse reflectance=u:0.8 ) ( roughconductor alpha=f:0.3 )",
    "mixturebsdf weights=s:0.5,0.2,0.1 ( diffuse ) ( plastic ) ( roughdielectric alpha=f:0.4 )",
];

/// Tolerance on the sum of the weights, for rounding in the file.
const ROUNDING: f32 = 1e-4;

/// `mixturebsdf` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    /// Materials with their shares, which add up to 1.
    parts: Box<[(f32, Material)]>,
}

impl Description {
    /// Reads `weights` (a number for each nested material) and the materials.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let weights = weights(params);
        let given = params.children(etalon_params::Class::Bsdf).len();
        let materials = Material::all_nested(params, build)?;
        let weights = weights?;
        if weights.len() != given || given == 0 {
            params.error_at(
                "weights",
                format!(
                    "`weights` has {} numbers for {given} nested BSDFs",
                    weights.len()
                ),
            );
            return None;
        }
        if materials.len() != given {
            return None;
        }
        let sum: f32 = weights.iter().sum();
        if sum > 1.0 + ROUNDING {
            params.error_at("weights", format!("the weights add up to {sum}, above 1"));
            return None;
        }
        let scale = if sum > 1.0 - ROUNDING { 1.0 / sum } else { 1.0 };
        let mut parts: Vec<(f32, Material)> = weights
            .iter()
            .map(|weight| weight * scale)
            .zip(materials)
            .collect();
        if scale == 1.0 && sum < 1.0 {
            let black = build.spectrum(Spectrum::Uniform(0.0));
            parts.push((
                1.0 - sum,
                Material::Diffuse(diffuse::Description::new(black)),
            ));
        }
        Some(Self {
            parts: parts.into(),
        })
    }

    /// The union of all flags.
    pub fn traits(&self) -> MaterialFlags {
        (self.parts.iter()).fold(MaterialFlags::default(), |all, (_, material)| {
            all.with(material.traits())
        })
    }

    /// All nested materials with their shares.
    pub fn flatten<'a, T: Textures>(
        &'a self,
        site: &ShadingContext<'_, T>,
        frame: Frame,
        weight: f32,
        into: &mut LobeList<'a>,
    ) {
        for (share, material) in &self.parts {
            material.flatten(site, frame, weight * share, into);
        }
    }
}

/// The numbers in `weights`, none of them negative.
fn weights(params: &Params<'_>) -> Option<Vec<f32>> {
    let Some(text) = params.string("weights") else {
        if !params.has("weights") {
            params.missing(
                "weights",
                "a number for each nested BSDF, such as \"0.7, 0.3\"",
            );
        }
        return None;
    };
    let words = text.split(|c: char| c == ',' || c.is_whitespace());
    let number = |word: &str| match word.parse::<f32>() {
        Ok(weight) if weight >= 0.0 && weight.is_finite() => Some(weight),
        _ => {
            let message = format!("`{word}` in `weights` is no number from 0 to 1");
            params.error_at("weights", message);
            None
        }
    };
    words.filter(|word| !word.is_empty()).map(number).collect()
}
