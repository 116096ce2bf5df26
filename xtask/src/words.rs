//! `docs/plugins.toml`: what is said of every plugin and parameter, and an example of each.

use etalon_validation::folders;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs;

/// `docs/plugins.toml`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Words {
    /// What parameters of a name are, whatever the plugin.
    pub(crate) parameters: BTreeMap<String, String>,
    /// All plugins, in the order of the page.
    pub(crate) plugin: Vec<Plugin>,
}

impl Words {
    /// Reads the file.
    pub(crate) fn read() -> Result<Self, String> {
        let path = folders::root().join("docs/plugins.toml");
        let words = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        toml::from_str(&words).map_err(|e| format!("{}: {e}", path.display()))
    }
}

/// A plugin, or several with the same words.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Plugin {
    /// Its class, as scenes name it.
    pub(crate) class: String,
    /// The name; several plugins with the same parameters share their words.
    pub(crate) names: Vec<String>,
    /// What it is.
    pub(crate) is: String,
    /// An element of a scene, which must load; `NAME` stands for the plugin's name.
    pub(crate) example: String,
    /// What the gallery shows, if not the example.
    pub(crate) picture: Option<String>,
    /// The class on whose stage it is shown, if not its own.
    pub(crate) pictured_as: Option<String>,
    /// How much brighter its picture is shown (stops).
    pub(crate) exposure: Option<f32>,
    /// Why there is no picture of it.
    pub(crate) unpictured: Option<String>,
    /// The scene around the example, where that of its class does not do.
    pub(crate) scene: Option<String>,
    /// Whether the example loads: not if it names a file that is not here.
    #[serde(default = "yes")]
    pub(crate) loads: bool,
    /// Further elements, for parameters that are asked for in some circumstances only. They need not load.
    #[serde(default)]
    pub(crate) probes: Vec<String>,
    /// What its file holds, if Python may give an array in its place.
    pub(crate) file: Option<Array>,
    /// Tags of what may be nested in it under any name.
    #[serde(default)]
    pub(crate) inputs: Vec<String>,
    /// Words for parameters, where those for all plugins do not fit.
    #[serde(default)]
    pub(crate) parameters: BTreeMap<String, String>,
    /// What holds without a parameter, where that depends on others.
    #[serde(default)]
    pub(crate) defaults: BTreeMap<String, String>,
}

/// What arrays may stand for.
#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Array {
    Picture,
    Volume,
}

impl Array {
    /// What it is, for readers.
    pub(crate) fn described(self) -> &'static str {
        match self {
            Self::Picture => "height × width, or with 1, 3 or 4 channels",
            Self::Volume => "along z, y and x, or with 1, 3 or 6 channels",
        }
    }
}

fn yes() -> bool {
    true
}
