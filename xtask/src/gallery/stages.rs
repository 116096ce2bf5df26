//! One picture for each plugin: what it is shown with, `docs/stages.toml`.

use crate::words::{Plugin, Words};
use etalon_validation::folders;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs;

/// Width and height of a plugin's picture (pixels).
const SIZE: [u32; 2] = [160, 120];

/// Samples per pixel of a plugin's picture, if its class has no number of its own.
const SAMPLES: u32 = 40;

/// `docs/stages.toml`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Stages {
    stages: BTreeMap<String, String>,
    cameras: BTreeMap<String, String>,
    classes: BTreeMap<String, Class>,
}

/// How plugins of a class are shown.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Class {
    stage: String,
    /// The camera; none of a class that is one.
    camera: Option<String>,
    /// What stands around the plugin.
    around: String,
    /// Samples per pixel.
    #[serde(default = "samples")]
    samples: u32,
}

fn samples() -> u32 {
    SAMPLES
}

/// The scene that shows a plugin.
pub(crate) struct Shown {
    /// The picture's name, with its folder.
    pub(crate) name: String,
    /// The scene.
    pub(crate) scene: String,
    /// Samples per pixel.
    pub(crate) samples: u32,
    /// How much brighter it is shown (stops).
    pub(crate) exposure: f32,
}

impl Stages {
    /// Reads the file.
    pub(crate) fn read() -> Result<Self, String> {
        let path = folders::root().join("docs/stages.toml");
        let text = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        toml::from_str(&text).map_err(|e| format!("{}: {e}", path.display()))
    }

    /// The names of a plugin's pictures, one for each of its names; none if it is not shown.
    pub(crate) fn pictures(&self, plugin: &Plugin) -> Vec<String> {
        let shown = self.classes.contains_key(&plugin.class) && plugin.unpictured.is_none();
        let names = plugin.names.iter().filter(|_| shown);
        names
            .map(|name| format!("plugins/{}-{name}", plugin.class))
            .collect()
    }

    /// The scenes of all plugins that are shown.
    ///
    /// # Errors
    /// If a stage, a camera or a class is none.
    pub(crate) fn scenes(&self) -> Result<Vec<Shown>, String> {
        let mut scenes = Vec::new();
        for plugin in &Words::read()?.plugin {
            for (name, picture) in plugin.names.iter().zip(self.pictures(plugin)) {
                let scene = self.scene(plugin, name);
                let (scene, samples) =
                    scene.map_err(|missing| format!("docs/stages.toml: {picture}: {missing}"))?;
                scenes.push(Shown {
                    scene,
                    samples,
                    name: picture,
                    exposure: plugin.exposure.unwrap_or(0.0),
                });
            }
        }
        Ok(scenes)
    }

    /// The scene that shows a plugin under one of its names, and its samples per pixel.
    fn scene(&self, plugin: &Plugin, name: &str) -> Result<(String, u32), String> {
        let class = plugin.pictured_as.as_ref().unwrap_or(&plugin.class);
        let missing = |what: &str, name: &str| format!("there is no {what} `{name}`");
        let class = (self.classes.get(class)).ok_or_else(|| missing("class", class))?;
        let stage = self.stages.get(&class.stage);
        let stage = stage.ok_or_else(|| missing("stage", &class.stage))?;
        let camera = match &class.camera {
            Some(name) => self
                .cameras
                .get(name)
                .ok_or_else(|| missing("camera", name))?,
            None => "",
        };
        let element = plugin.picture.as_ref().unwrap_or(&plugin.example);
        let [width, height] = SIZE;
        let film = format!(
            "<film type=\"hdrfilm\"><integer name=\"width\" value=\"{width}\"/><integer name=\"height\" value=\"{height}\"/></film><sampler type=\"sobol\"/>"
        );
        let around = class
            .around
            .replace("ELEMENT", &element.replace("NAME", name));
        let scene = format!("<scene version=\"3.0.0\">\n{camera}{stage}{around}\n</scene>\n");
        Ok((scene.replace("FILM", &film), class.samples))
    }
}
