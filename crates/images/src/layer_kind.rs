//! What a layer's name says of its channels: the whole picture, a pass, or no colours at all.

/// What the name of a layer says of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum LayerKind {
    Unnamed,
    /// Called as pictures are.
    Main,
    Other,
    /// Colours that are a part of the picture, or of the scene.
    Pass,
    /// Vectors and statistics: no colours, even if the channels are named so.
    Data,
}

/// What layers are called that are the whole picture; words of six letters and more may be a part
/// of a name.
const MAIN: &[&str] = &[
    "beauty",
    "c",
    "ci",
    "color",
    "colour",
    "combined",
    "composite",
    "default",
    "final",
    "image",
    "main",
    "master",
    "picture",
    "primary",
    "render",
    "rendering",
    "result",
    "rgb",
    "rgba",
];

/// What layers are called that are passes, in the same way.
const PASSES: &[&str] = &[
    "albedo",
    "ambient",
    "ao",
    "background",
    "basecolor",
    "diffuse",
    "direct",
    "emission",
    "emit",
    "env",
    "environment",
    "glossy",
    "gi",
    "indirect",
    "mask",
    "matte",
    "mist",
    "occlusion",
    "reflection",
    "refraction",
    "shadow",
    "specular",
    "sss",
    "transmission",
    "volume",
];

/// What layers are called that hold no colours, in the same way.
const DATA: &[&str] = &[
    "depth",
    "error",
    "forward",
    "id",
    "motion",
    "n",
    "ng",
    "normal",
    "ns",
    "p",
    "point",
    "position",
    "pref",
    "pworld",
    "st",
    "standard_error",
    "tangent",
    "uv",
    "variance",
    "vector",
    "velocity",
    "z",
];

impl LayerKind {
    pub(crate) fn of(layer: &str) -> Self {
        if layer.is_empty() {
            return Self::Unnamed;
        }
        let lower = layer.to_lowercase();
        let last = lower.rsplit('.').next().unwrap_or_default();
        let has = |name: &str, words: &[&str]| {
            let long = |word: &&str| word.len() >= 6 && name.contains(*word);
            words.contains(&name) || words.iter().any(long)
        };
        if lower.split('.').any(|name| has(name, DATA)) {
            Self::Data
        } else if MAIN.contains(&last) {
            Self::Main
        } else if lower.split('.').any(|name| has(name, PASSES)) {
            Self::Pass
        } else if has(last, MAIN) {
            Self::Main
        } else {
            Self::Other
        }
    }
}
