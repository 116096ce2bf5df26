//! Objects and their instances: `shapegroup` and `instance`.
//!
//! A shape of an object has the CTM of its definition in it, and an instance its own before that, in both programs. pbrt makes no lights of an
//! object's shapes (`scene.cpp` says so in a warning), so they do not shine.

use super::super::scene::{Instance, ObjectId};
use super::Mapper;
use super::node::Draft;
use super::placement::placed;
use etalon_params::{Class, DMat4, Node};
use std::sync::Arc;

impl<'a> Mapper<'a> {
    /// The groups of all objects that something repeats; each comes after those that it contains.
    pub(crate) fn object_groups(&mut self) -> Vec<Arc<Node>> {
        let scene = self.scene;
        let mut used = vec![false; scene.objects.len()];
        let mark = |used: &mut Vec<bool>, instances: &[Instance]| {
            for instance in instances {
                used[instance.object] = true;
            }
        };
        mark(&mut used, &scene.instances);
        for id in scene.object_order.iter().rev() {
            if used[*id] {
                mark(&mut used, &scene.objects[*id].instances);
            }
        }
        let order = scene.object_order.iter().copied();
        order
            .filter(|id| used[*id])
            .map(|id| self.group(id))
            .collect()
    }

    fn group(&mut self, id: ObjectId) -> Arc<Node> {
        let scene = self.scene;
        let object = &scene.objects[id];
        let mut parts: Vec<Arc<Node>> = Vec::new();
        for shape in &object.shapes {
            if shape.area_light.is_some() {
                let message = "as in pbrt, shapes of an object do not shine";
                self.note(
                    shape.entity.span,
                    message,
                    "lights stand outside of `ObjectBegin`",
                );
            }
        }
        parts.extend(self.shapes(&object.shapes, false));
        for instance in &object.instances {
            parts.extend(self.instance(instance));
        }
        let draft = Draft::new(Class::Shape, "shapegroup", object.name.span);
        let draft = draft.named(object.name.value.as_str());
        let node = parts.into_iter().fold(draft, Draft::child).node();
        self.groups[id] = Some(Arc::clone(&node));
        node
    }

    /// An object put somewhere; `None` after a mistake.
    pub(crate) fn instance(&mut self, instance: &Instance) -> Option<Arc<Node>> {
        let group = self.groups.get(instance.object)?.clone()?;
        let draft = Draft::new(Class::Shape, "instance", instance.span);
        let to_world = self.to_world(&instance.placement, DMat4::IDENTITY, instance.span)?;
        Some(placed(draft, to_world).child(group).node())
    }
}
