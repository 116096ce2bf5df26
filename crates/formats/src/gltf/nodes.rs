//! The nodes of the scene and where they stand in the world (glTF 2.0, §3.5).

use super::pose::local;
use super::reader::Reader;
use etalon_params::DMat4;
use std::collections::HashSet;

/// A mesh at a place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
    pub(crate) node: usize,
    pub(crate) mesh: usize,
    pub(crate) world: DMat4,
}

/// What nodes hold beside meshes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Held {
    pub(crate) node: usize,
    /// The number of a camera or of a light.
    pub(crate) number: usize,
    pub(crate) world: DMat4,
}

/// What stands in the scene, in the order of the nodes.
#[derive(Debug, Default)]
pub(crate) struct Contents {
    pub(crate) meshes: Vec<Placed>,
    pub(crate) cameras: Vec<Held>,
    pub(crate) lights: Vec<Held>,
}

impl Reader<'_> {
    /// Walks over the nodes of the scene, at a moment.
    pub(crate) fn contents(&mut self, time: f64) -> Contents {
        let poses = self.poses(time);
        let mut contents = Contents::default();
        let mut seen = HashSet::new();
        let mut open: Vec<(usize, DMat4)> = self.first_nodes();
        open.reverse();
        while let Some((index, parent)) = open.pop() {
            let Some(node) = self.root.nodes.get(index) else {
                continue;
            };
            let path = format!("nodes[{index}]");
            if !seen.insert(index) {
                self.error(&path, "the node stands in two places, or within itself");
                continue;
            }
            let world = parent * local(node, poses.get(&index));
            if !world.is_finite() {
                self.error(&path, "its place in the world is not finite");
                continue;
            }
            self.hold(index, world, &mut contents);
            let children = node.children.iter().flatten().rev();
            open.extend(children.map(|child| (child.value(), world)));
        }
        contents
    }

    /// The nodes that have no parents: of the default scene, of the first one, or of the file.
    fn first_nodes(&self) -> Vec<(usize, DMat4)> {
        let root = self.root;
        let scene = root.scene.map_or(0, |scene| scene.value());
        let first: Vec<usize> = match root.scenes.get(scene) {
            Some(scene) => scene.nodes.iter().map(|node| node.value()).collect(),
            None => {
                let nodes = root.nodes.iter();
                let children = nodes.flat_map(|node| node.children.iter().flatten());
                let children: HashSet<usize> = children.map(|child| child.value()).collect();
                let all = 0..root.nodes.len();
                all.filter(|node| !children.contains(node)).collect()
            }
        };
        first
            .into_iter()
            .map(|node| (node, DMat4::IDENTITY))
            .collect()
    }

    fn hold(&mut self, index: usize, world: DMat4, contents: &mut Contents) {
        let Some(node) = self.root.nodes.get(index) else {
            return;
        };
        let path = format!("nodes[{index}]");
        if let Some(mesh) = node.mesh {
            if node.skin.is_some() {
                let message = "skins are not read: the mesh stands as it was before it was bound";
                self.note(&format!("{path}.skin"), message);
            }
            if world.determinant() == 0.0 {
                self.note(
                    &path,
                    "its place in the world is flat: the mesh is left out",
                );
            } else {
                contents.meshes.push(Placed {
                    node: index,
                    mesh: mesh.value(),
                    world,
                });
            }
        }
        let light = node.extensions.as_ref();
        let light = light.and_then(|extensions| extensions.khr_lights_punctual.as_ref());
        let held = |number| Held {
            node: index,
            number,
            world,
        };
        contents
            .lights
            .extend(light.map(|light| held(light.light.value())));
        contents
            .cameras
            .extend(node.camera.map(|camera| held(camera.value())));
    }
}
