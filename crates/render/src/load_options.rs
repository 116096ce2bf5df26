//! Options for loading a scene, and overrides of its settings.

use etalon_film::Framing;
use etalon_formats::ReadOptions;
use etalon_scene::{AcceleratorKind, LightSamplerKind, SensorChoice};
use std::path::PathBuf;

/// How to read a scene.
#[derive(Clone, Debug, Default)]
pub struct LoadOptions {
    /// Values of scene parameters (`-D key=value`).
    pub defines: Vec<(String, String)>,
    /// Replaces the type of the innermost integrator.
    pub integrator: Option<String>,
    /// Further folders with data.
    pub data: Vec<PathBuf>,
    /// A picture of the surroundings of a scene that has none of its own (of glTF).
    pub environment: Option<PathBuf>,
    /// How points choose the light that they ask, if not as the scene says.
    pub light_chooser: Option<LightSamplerKind>,
    /// How surfaces are looked up.
    pub accelerator: AcceleratorKind,
    /// The moment that the shutter counts from (units of scene time).
    pub time: f64,
    /// Which sensor is rendered, if not the first.
    pub sensor: Option<SensorChoice>,
    /// What replaces the size of its film, and the part that is rendered.
    pub framing: Framing,
}

impl LoadOptions {
    /// Those of them that are for reading the scene's file.
    pub fn reading(&self) -> ReadOptions {
        ReadOptions {
            defines: self.defines.clone(),
            integrator: self.integrator.clone(),
            search: self.data.clone(),
            environment: self.environment.clone(),
            time: self.time,
        }
    }
}
