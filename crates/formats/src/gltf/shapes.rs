//! Meshes as shapes: one for each part. A mesh that stands in several places is a `shapegroup`, which `instance`s place.

use super::materials::{MaterialKey, Surface};
use super::nodes::Placed;
use super::reader::Reader;
use crate::document::mesh_name;
use crate::draft::{Draft, word};
use etalon_params::{Class, Node, Value};
use std::collections::HashMap;
use std::sync::Arc;

/// A part of a mesh that was read.
#[derive(Clone, Debug)]
pub(crate) struct Loaded {
    /// Its number in the document.
    pub(crate) mesh: usize,
    surface: Surface,
}

impl Reader<'_> {
    /// The shapes of all placed meshes.
    pub(crate) fn shapes(&mut self, placed: &[Placed]) -> Vec<Arc<Node>> {
        let mut uses: HashMap<usize, usize> = HashMap::new();
        for place in placed {
            *uses.entry(place.mesh).or_default() += 1;
        }
        let mut groups: HashMap<usize, Arc<Node>> = HashMap::new();
        let mut shapes = Vec::new();
        for place in placed {
            let to_world = Value::Transform(place.world);
            if uses.get(&place.mesh) == Some(&1) {
                let parts = self.parts(place.mesh).into_iter();
                shapes.extend(parts.map(|part| part.plain("to_world", to_world.clone()).node()));
                continue;
            }
            let group = match groups.get(&place.mesh) {
                Some(group) => Arc::clone(group),
                None => {
                    let group = self.group(place.mesh);
                    groups.insert(place.mesh, Arc::clone(&group));
                    shapes.push(Arc::clone(&group));
                    group
                }
            };
            if group.properties.is_empty() {
                continue;
            }
            let span = self.span(&format!("nodes[{}]", place.node));
            let instance = Draft::new(Class::Shape, "instance", span);
            let instance = instance.plain("to_world", to_world);
            shapes.push(instance.child(group).node());
        }
        shapes.retain(|shape| shape.plugin.value != "shapegroup" || !shape.properties.is_empty());
        shapes
    }

    fn group(&mut self, mesh: usize) -> Arc<Node> {
        let span = self.span(&format!("meshes[{mesh}]"));
        let name = self.root.meshes.get(mesh).and_then(|m| m.name.clone());
        let name = name.unwrap_or_else(|| format!("mesh {mesh}"));
        let group = Draft::new(Class::Shape, "shapegroup", span).named(name);
        let parts = self.parts(mesh).into_iter().map(Draft::node);
        parts.fold(group, Draft::child).node()
    }

    /// The parts of a mesh, not yet placed.
    fn parts(&mut self, mesh: usize) -> Vec<Draft> {
        let root = self.root;
        let Some(found) = root.meshes.get(mesh) else {
            return Vec::new();
        };
        if found.primitives.iter().any(|part| part.targets.is_some()) {
            let message = "morph targets are not read: the shape is the one without them";
            self.note(&format!("meshes[{mesh}]"), message);
        }
        let numbers = 0..found.primitives.len();
        numbers.filter_map(|part| self.part(mesh, part)).collect()
    }

    fn part(&mut self, mesh: usize, part: usize) -> Option<Draft> {
        let path = format!("meshes[{mesh}].primitives[{part}]");
        let Loaded { mesh, surface } = self.loaded(mesh, part, &path)?;
        let draft = Draft::new(Class::Shape, "ply", self.span(&path));
        let mut draft = draft.plain("filename", word(&mesh_name(mesh)));
        draft = draft.child(surface.bsdf);
        if let Some(emitter) = surface.emitter {
            draft = draft.child(emitter);
        }
        if let Some(interior) = surface.interior {
            draft = draft.nested("interior", interior);
        }
        Some(draft)
    }

    /// Reads a part once.
    pub(crate) fn loaded(&mut self, mesh: usize, part: usize, path: &str) -> Option<Loaded> {
        if let Some(found) = self.primitives.get(&(mesh, part)) {
            return found.clone();
        }
        let found = self.load(mesh, part, path);
        self.primitives.insert((mesh, part), found.clone());
        found
    }

    fn load(&mut self, mesh: usize, part: usize, path: &str) -> Option<Loaded> {
        let root = self.root;
        let primitive = root.meshes.get(mesh)?.primitives.get(part)?;
        let key = MaterialKey {
            material: primitive.material.map(|index| index.value()),
            colours: self.colour_channels(primitive),
        };
        let surface = self.surface(key)?;
        let data = self.mesh_data(path, primitive, surface.set)?;
        self.meshes.push(Arc::new(data));
        Some(Loaded {
            mesh: self.meshes.len() - 1,
            surface,
        })
    }
}
