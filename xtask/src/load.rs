//! Loading an element of a scene: the scene around it, by the class of its plugin.

use etalon_params::{Class, Severity};
use etalon_render::pipeline::{self, LoadOptions};
use etalon_validation::folders;
use std::fs;
use std::sync::{Mutex, MutexGuard};

/// The classes that have plugins, in the order of the page, with their titles and the scene around an element.
pub(crate) const CLASSES: [(Class, &str, &str); 13] = [
    (
        Class::Integrator,
        "Integrators",
        "ELEMENT<sensor type='perspective'/>",
    ),
    (Class::Sensor, "Sensors", "ELEMENT"),
    (
        Class::Film,
        "Films",
        "<sensor type='perspective'>ELEMENT</sensor>",
    ),
    (
        Class::ReconstructionFilter,
        "Reconstruction filters",
        "<sensor type='perspective'><film type='hdrfilm'>ELEMENT</film></sensor>",
    ),
    (
        Class::Sampler,
        "Samplers",
        "<sensor type='perspective'>ELEMENT</sensor>",
    ),
    (
        Class::Shape,
        "Shapes",
        "<sensor type='perspective'/>ELEMENT",
    ),
    (
        Class::Bsdf,
        "BSDFs",
        "<sensor type='perspective'/><shape type='sphere'>ELEMENT</shape>",
    ),
    (
        Class::Subsurface,
        "Below surfaces",
        "<sensor type='perspective'/><integrator type='volpath'/><shape type='sphere'>ELEMENT</shape>",
    ),
    (
        Class::Emitter,
        "Emitters",
        "<sensor type='perspective'/><shape type='sphere'><transform name='to_world'><translate z='5'/></transform></shape>ELEMENT",
    ),
    (
        Class::Texture,
        "Textures and spectra",
        "<sensor type='perspective'/><shape type='obj'><string name='filename' value='files/ball.obj'/><bsdf type='diffuse'>ELEMENT</bsdf></shape>",
    ),
    (
        Class::Medium,
        "Media",
        "<sensor type='perspective'/><integrator type='volpath'/><shape type='sphere'><bsdf type='null'/>ELEMENT</shape>",
    ),
    (
        Class::Phase,
        "Phase functions",
        "<sensor type='perspective'/><integrator type='volpath'/><shape type='sphere'><bsdf type='null'/><medium type='heterogeneous' name='interior'>ELEMENT</medium></shape>",
    ),
    (
        Class::Volume,
        "Volumes",
        "<sensor type='perspective'/><integrator type='volpath'/><shape type='sphere'><bsdf type='null'/><medium type='heterogeneous' name='interior'>ELEMENT</medium></shape>",
    ),
];

/// What is asked is noted for the whole program, and scenes are loaded from one file: one page at a time.
static TURN: Mutex<()> = Mutex::new(());

/// Waits for the turn to make a page.
pub(crate) fn turn() -> MutexGuard<'static, ()> {
    TURN.lock().unwrap_or_else(|e| e.into_inner())
}

/// Loads a scene with an element in its place, and gives back what was wrong.
pub(crate) fn load(surroundings: &str, element: &str) -> Vec<String> {
    load_as("3.0.0", surroundings, element)
}

/// The same with a scene of this version.
pub(crate) fn load_as(version: &str, surroundings: &str, element: &str) -> Vec<String> {
    // Lights of shapes stand in one; a beam is seen by integrators that follow it.
    let is = |name: &str| element.contains(&format!("type=\"{name}\""));
    let surroundings = match surroundings {
        _ if is("directionalarea") => {
            "<integrator type='ptracer'/><sensor type='perspective'/><shape type='sphere'>ELEMENT</shape>"
        }
        _ if is("area") => "<sensor type='perspective'/><shape type='sphere'>ELEMENT</shape>",
        surroundings => surroundings,
    };
    let scene = format!(
        "<scene version=\"{version}\">{}</scene>",
        surroundings.replace("ELEMENT", element)
    );
    let folder = std::env::temp_dir();
    let path = folder.join(format!("etalon-plugins-{}.xml", std::process::id()));
    if let Err(error) = fs::write(&path, scene) {
        return vec![error.to_string()];
    }
    let options = LoadOptions {
        data: vec![folders::scenes()],
        ..LoadOptions::default()
    };
    let loaded = pipeline::load(&path, &options);
    let _ = fs::remove_file(&path);
    match loaded {
        Ok(_) => Vec::new(),
        Err(refusal) => (refusal.diagnostics.into_iter())
            .filter(|d| d.severity == Severity::Error)
            .map(|d| d.message + &d.help.map_or(String::new(), |help| format!(" ({help})")))
            .collect(),
    }
}
