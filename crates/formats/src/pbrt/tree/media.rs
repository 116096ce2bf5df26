//! Participating media (`media.cpp`): `homogeneous` (others in `grid_media`), with the phase function of Henyey and Greenstein.
//!
//! σₐ and σₛ are per unit of length in both, 1 by default in pbrt; g means the same; those that pbrt has by name are Etalon's. What a
//! medium emits is σₐ Lₑ in both, Lₑ divided by its luminance and times `Lescale`.

use super::super::parameters::Parameters;
use super::super::scene::MediumId;
use super::super::spectrum_value::SpectrumValue;
use super::Mapper;
use super::node::{Draft, given, word};
use super::spectrum::Role;
use etalon_params::{Class, Node, Value};
use std::sync::Arc;

impl<'a> Mapper<'a> {
    /// The medium; `None` after a mistake.
    pub(crate) fn medium(&mut self, id: MediumId) -> Option<Arc<Node>> {
        if let Some(found) = self.media.get(id)? {
            return found.clone();
        }
        let scene = self.scene;
        let medium = &scene.media[id];
        let params = self.read(&medium.entity);
        let found = match params.entity.kind {
            "homogeneous" => self.homogeneous(&params),
            "uniformgrid" => self.uniform_grid(&params, medium),
            "rgbgrid" => self.rgb_grid(&params, medium),
            "nanovdb" => self.nanovdb(&params, medium),
            // All that pbrt knows are here.
            _ => self.cloud(&params, medium),
        };
        if found.is_some() {
            params.finish();
        }
        self.media[id] = Some(found.clone());
        found
    }

    fn homogeneous(&mut self, params: &Parameters<'a>) -> Option<Arc<Node>> {
        let draft = Draft::of(params, Class::Medium, "homogeneous");
        let preset = params.string("preset");
        let draft = match preset {
            Some(name) => {
                params.ignore(&["sigma_a", "sigma_s"]);
                Some(draft.from(params, "preset", "material", word(name)))
            }
            None => self
                .coefficients(params, [Value::Float(1.0), Value::Float(1.0)])
                .map(|[absorbed, scattered]| {
                    draft.given("sigma_a", absorbed).given("sigma_s", scattered)
                }),
        };
        let scale = params.float("scale", 1.0);
        let g = params.float_where("g", 0.0, "a number between −1 and 1", |g| g.abs() < 1.0);
        let strength = params.float("Lescale", 1.0);
        let emitted = params.spectrum("Le");
        let mut draft = draft?;
        if scale != 1.0 {
            draft = draft.from(params, "scale", "scale", Value::Float(scale));
        }
        if let Some(emitted) = emitted.filter(|emitted| !is_dark(emitted)) {
            let value = self.spectrum(params, "Le", emitted, Role::Emission(strength))?;
            draft = draft.given("emission", given(value, params.span("Le")));
        }
        let phase = Draft::of(params, Class::Phase, "hg");
        let phase = phase.from(params, "g", "g", Value::Float(g));
        Some(draft.child(phase.node()).node())
    }
}

/// Whether a spectrum is no light at all, which pbrt admits here.
pub(crate) fn is_dark(spectrum: &SpectrumValue<'_>) -> bool {
    match spectrum {
        SpectrumValue::Rgb(rgb, _) => *rgb == [0.0; 3],
        SpectrumValue::Samples(samples) => samples.iter().all(|[_, value]| *value == 0.0),
        _ => false,
    }
}
