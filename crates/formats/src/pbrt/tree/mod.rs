//! From pbrt's entities to the description tree, the one that the reader of Mitsuba's XML makes.
//!
//! One file per family of entities says how pbrt's rule becomes Mitsuba's, and where pbrt's is known from (paths are those of its
//! repository, below `src/pbrt`). Three things hold everywhere:
//!
//! - What has no equal is an error that names it, or a note where something near stands in for it; nothing is dropped silently. Only
//!   what can make no difference to the picture that a render converges to is asked for and ignored.
//! - What pbrt gives no value has pbrt's default, which is written into the tree wherever Mitsuba's is another.
//! - Materials, textures and media that nothing uses are not looked at.

mod area_light;
mod bilinear;
mod camera;
mod cloud_medium;
mod coated;
mod color_space;
mod coordinates;
mod curves;
mod dielectrics;
mod film;
mod filter;
mod glowing_media;
mod grid_media;
mod hair;
mod image_textures;
mod instances;
mod integrator;
mod lights;
mod loop_subdivision;
mod materials;
mod media;
mod meshes;
mod metals;
mod node;
mod noise_textures;
mod options;
mod picture;
mod placement;
mod ply_mesh;
mod profile_point;
mod quadrics;
mod roughness;
mod sampler;
mod shapes;
mod spectrum;
mod spectrum_file;
mod subsurface;
#[cfg(test)]
mod tests;
mod texture_kinds;
mod textures;

use super::parameters::Parameters;
use super::scene::{Entity, Scene};
use crate::document::{Document, ReadOptions, SourceFile};
use crate::ply::Carried;
use etalon_params::{Class, Diagnostic, Diagnostics, FileId, Node, Span};
use etalon_transport::MeshData;
use materials::Surface;
use node::{Draft, Given};
use std::collections::HashMap;
use std::sync::Arc;

/// A scene whose entities are becoming nodes.
pub(crate) struct Mapper<'a> {
    scene: &'a Scene,
    diagnostics: &'a Diagnostics,
    /// The moment that the shutter counts from, and the middle of its interval (units of scene time).
    time: f64,
    middle: f64,
    /// What was mapped so far; the inner option is `None` after a mistake.
    textures: Vec<Option<Option<Given>>>,
    materials: Vec<Option<Option<Surface>>>,
    media: Vec<Option<Option<Arc<Node>>>>,
    groups: Vec<Option<Arc<Node>>>,
    meshes: Vec<Arc<MeshData>>,
    /// Contents of files that the scene file has within.
    embedded: Vec<Arc<Vec<u8>>>,
    /// What the vertices of PLY files carry.
    ply_files: HashMap<String, Option<Carried>>,
    /// Files of spectra.
    files: Vec<SourceFile>,
}

/// The description of a scene without mistakes; whoever calls it looks at the diagnostics.
pub(crate) fn document(
    scene: &Scene,
    options: &ReadOptions,
    integrator: Option<FileId>,
    diagnostics: &Diagnostics,
) -> Document {
    let mut mapper = Mapper::new(scene, options, diagnostics);
    let root = mapper.root(options.integrator.as_deref().zip(integrator));
    scene.report_unused_attributes(diagnostics);
    Document {
        root,
        search: scene.search.clone(),
        files: mapper.files,
        parameters: Vec::new(),
        meshes: mapper.meshes,
        embedded: mapper.embedded.into_iter().enumerate().collect(),
    }
}

impl<'a> Mapper<'a> {
    fn new(scene: &'a Scene, options: &ReadOptions, diagnostics: &'a Diagnostics) -> Self {
        let [open, close] = camera::shutter(scene);
        Self {
            scene,
            diagnostics,
            time: options.time,
            middle: options.time + 0.5 * (open + close),
            textures: vec![None; scene.textures.len()],
            materials: vec![None; scene.materials.len()],
            media: vec![None; scene.media.len()],
            groups: vec![None; scene.objects.len()],
            meshes: Vec::new(),
            embedded: Vec::new(),
            ply_files: HashMap::new(),
            files: Vec::new(),
        }
    }

    /// The node of the scene; `integrator` is a type in place of the scene's own, with the text that it stands in.
    fn root(&mut self, integrator: Option<(&str, FileId)>) -> Arc<Node> {
        let start = Span {
            file: FileId(0),
            start: 0,
            end: 0,
        };
        self.refuse_options();
        let mut parts: Vec<Arc<Node>> = Vec::new();
        parts.extend(self.integrator(integrator));
        parts.extend(self.sensor());
        parts.extend(self.shapes(&self.scene.shapes, true));
        for light in &self.scene.lights {
            parts.extend(self.light(light));
        }
        let groups = self.object_groups();
        parts.extend(groups);
        for instance in &self.scene.instances {
            parts.extend(self.instance(instance));
        }
        let whole = Draft::new(Class::Scene, "scene", start);
        parts.into_iter().fold(whole, Draft::child).node()
    }

    /// Begins to read an entity.
    fn read(&self, entity: &'a Entity) -> Parameters<'a> {
        self.scene.parameters(entity, self.diagnostics)
    }

    /// Says that an entity has no equal; its parameters are not looked at.
    fn refuse(&self, params: &Parameters<'_>, family: &str, accepted: &str) {
        let kind = params.entity.kind;
        let message = format!("Etalon does not have pbrt's {family} `{kind}`");
        let mistake = Diagnostic::error(params.entity.span, message);
        self.diagnostics
            .push(mistake.help(format!("accepted: {accepted}")));
    }

    /// Says that a parameter's value has no equal.
    fn refuse_value(&self, params: &Parameters<'_>, name: &str, what: &str, accepted: &str) {
        let message = format!("Etalon does not have pbrt's {what}");
        let mistake = Diagnostic::error(params.span(name), message);
        self.diagnostics
            .push(mistake.help(format!("accepted: {accepted}")));
    }

    /// Says that something near stands in for what was asked for.
    fn note(&self, span: Span, message: impl Into<String>, help: impl Into<String>) {
        let note = Diagnostic::note(span, message).help(help);
        self.diagnostics.push(note);
    }
}
