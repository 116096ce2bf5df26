//! The `sampler` of a sensor: kind, samples per pixel, seed.

use etalon_params::{Class, Diagnostic, Diagnostics, Node, Params, plugins};
use etalon_sampling::SamplerKind;

/// Samplers of Mitsuba that are not built; `sobol` replaces them.
const REPLACED: [&str; 7] = [
    "multijitter",
    "orthogonal",
    "bose",
    "bush",
    "ldsampler",
    "halton",
    "hammersley",
];

/// Samplers that are built.
const BUILT: [&str; 3] = ["independent", "stratified", "sobol"];

/// The settings of a scene's sampler.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SamplerSettings {
    /// The kind of sampler.
    pub kind: SamplerKind,
    /// Samples per pixel.
    pub spp: u32,
    /// The seed of the image.
    pub seed: u64,
}

impl Default for SamplerSettings {
    /// Owen-scrambled Sobol' points where the scene does not insist; 4 samples per pixel, as
    /// Mitsuba.
    fn default() -> Self {
        Self {
            kind: SamplerKind::Sobol,
            spp: 4,
            seed: 0,
        }
    }
}

impl SamplerSettings {
    /// Reads the sampler of a sensor.
    pub fn from_sensor(sensor: &Params<'_>) -> Self {
        sensor
            .child(Class::Sampler)
            .map_or_else(Self::default, |node| {
                Self::from_node(node, sensor.diagnostics)
            })
    }

    /// Reads a sampler.
    pub(crate) fn from_node(node: &Node, diagnostics: &Diagnostics) -> Self {
        let params = Params::new(node, diagnostics);
        let name = node.plugin.value.as_str();
        let kind = match name {
            "independent" => SamplerKind::Independent,
            "stratified" => SamplerKind::Stratified {
                jitter: params.boolean_or("jitter", true),
            },
            "sobol" => SamplerKind::Sobol,
            _ if REPLACED.contains(&name) => {
                diagnostics.push(
                    Diagnostic::note(
                        node.plugin.span,
                        format!("the sampler `{name}` is not built yet: `sobol` stands in for it"),
                    )
                    .label("sampled with `sobol`"),
                );
                SamplerKind::Sobol
            }
            _ => {
                diagnostics.push(plugins::not_built(node, BUILT.into_iter().chain(REPLACED)));
                // Its parameters are not ours to judge.
                return Self::default();
            }
        };
        let default = Self::default();
        let whole = |name: &str, default: u64, least: i64| {
            let value = params.integer_or(name, default as i64);
            if value < least || value > i64::from(u32::MAX) {
                params.refuse(name, value, &format!("{least} … {}", u32::MAX));
                return default;
            }
            value as u64
        };
        let spp = whole("sample_count", u64::from(default.spp), 1) as u32;
        let seed = whole("seed", default.seed, 0);
        params.finish();
        Self { kind, spp, seed }
    }
}
