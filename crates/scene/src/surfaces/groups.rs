//! Groups of shapes, and their instances.
//!
//! An accelerator stores the shapes of a group once for all its instances. An emitter is an exception: each instance of
//! it is a light and a shape of the world, read again with the `to_world` of the enclosing instances composed with its own,
//! so that its points are sampled uniformly even if an instance stretches it. Moving instances carry it, from the
//! outermost motion to the innermost; static transforms inside these are part of the shape's own `to_world`.

use crate::builder::Builder;
use crate::surfaces::merge;
use crate::surfaces::{ShapeExtras, Surfaces, name};
use etalon_geometry::{GroupId, Placement, Shape};
use etalon_math::{Animated, Motion};
use etalon_params::{Class, DMat4, Diagnostic, Node, Params, Value};
use etalon_transport::ShapeId;
use std::sync::Arc;

/// A shape of a group that emits.
#[derive(Clone, Debug)]
pub(crate) struct GroupedLamp {
    node: Arc<Node>,
    /// The instances around it within the group, the outermost first.
    within: Vec<Motion>,
}

impl Surfaces {
    /// Adds a shape that is only seen through instances.
    fn member(&mut self, shape: Shape, carried: &ShapeExtras) -> ShapeId {
        self.placed_media |= carried.media.is_some();
        self.placed_bodies |= carried.body.is_some();
        let id = self.geometry.add_member(shape, carried.material);
        self.carry(id, carried);
        id
    }

    /// Adds a shape that moves: the only member of a group, which an instance moves, itself moved by others.
    pub(crate) fn moving(
        &mut self,
        shape: Shape,
        carried: &ShapeExtras,
        carriers: &[Motion],
        builder: &Builder<'_>,
    ) -> ShapeId {
        let member = self.member(shape, carried);
        if let Some(emitter) = &carried.emitter
            && !carriers.iter().all(Motion::keeps_angles)
        {
            let message = "a light that moves must keep its angles";
            let help = "its `to_world`, and that of the instances around it, may turn, mirror, shift and scale uniformly";
            (builder.diagnostics).push(Diagnostic::error(emitter.span, message).help(help));
        }
        let mut group = self.geometry.add_members(vec![member], Vec::new());
        for inner in carriers[1..].iter().rev() {
            let placement = Animated::<Placement>::new(inner.clone());
            let instance = self.geometry.add_nested_instance(group, placement);
            group = self.geometry.add_members(Vec::new(), vec![instance]);
        }
        let outermost = Animated::<Placement>::new(carriers[0].clone());
        let instance = self.geometry.add_instance(group, outermost);
        if let Some(instance) = instance.filter(|_| carried.emitter.is_some()) {
            let depth = carriers.len() as u32 - 1;
            self.geometry.set_carrier(member, instance, depth);
        }
        member
    }

    /// Adds a lamp of a group where an instance of the world has placed that.
    fn place_lamp(&mut self, lamp: &GroupedLamp, instance: &Motion, builder: &mut Builder<'_>) {
        let own = Params::new(&lamp.node, builder.diagnostics);
        let Some(own) = builder.shutter.motion(&own, "to_world") else {
            return;
        };
        let mut maps = vec![instance.clone()];
        maps.extend(lamp.within.iter().cloned());
        maps.push(own);
        let still = maps
            .iter()
            .rposition(Motion::moves)
            .map_or(0, |last| last + 1);
        let to_world = (maps[still..].iter()).fold(DMat4::IDENTITY, |outer, map| {
            outer * DMat4::from(map.at(0.0))
        });
        let node = lamp.node.with("to_world", Value::Transform(to_world));
        self.place(&Arc::new(node), &maps[..still], builder);
    }

    /// The shapes of a group, read once however often they are placed.
    pub(crate) fn group(&mut self, node: &Arc<Node>, builder: &mut Builder<'_>) -> GroupId {
        let key = Arc::as_ptr(node) as usize;
        if let Some(group) = self.groups.get(&key) {
            return *group;
        }
        let params = Params::new(node, builder.diagnostics);
        let (mut members, mut instances, mut lamps) = (Vec::new(), Vec::new(), Vec::new());
        for (property, child) in merge::shapes(&params) {
            match child.plugin.value.as_str() {
                "instance" => {
                    if let Some((group, motion)) = self.placed_group(child, builder) {
                        let inner = self.lamps.get(&group).into_iter().flatten();
                        lamps.extend(inner.map(|lamp| {
                            let mut lamp = lamp.clone();
                            lamp.within.insert(0, motion.clone());
                            lamp
                        }));
                        let placement = Animated::<Placement>::new(motion);
                        instances.push(self.geometry.add_nested_instance(group, placement));
                    }
                    continue;
                }
                "shapegroup" => {
                    let message = "a `shapegroup` cannot hold a `shapegroup`";
                    let diagnostic = Diagnostic::error(property.name_span, message);
                    let help = "place it: put it, or a `ref` to it, into an `instance`";
                    builder.diagnostics.push(diagnostic.help(help));
                    continue;
                }
                _ => {}
            }
            let Some((shape, carried)) = self.shape(child, builder) else {
                continue;
            };
            if carried.emitter.is_some() {
                lamps.push(GroupedLamp {
                    node: Arc::clone(child),
                    within: Vec::new(),
                });
                continue;
            }
            let member = self.member(shape, &carried);
            self.names.shapes.push(name(child));
            let own = Params::new(child, builder.diagnostics);
            if own.is_animated("to_world") {
                if let Some(motion) = builder.shutter.motion(&own, "to_world") {
                    let group = self.geometry.add_members(vec![member], Vec::new());
                    let placement = Animated::<Placement>::new(motion);
                    instances.push(self.geometry.add_nested_instance(group, placement));
                }
            } else {
                members.push(member);
            }
        }
        params.finish();
        let group = self.geometry.add_members(members, instances);
        self.groups.insert(key, group);
        if !lamps.is_empty() {
            self.lamps.insert(group, lamps);
        }
        group
    }

    /// The group that an instance places, and where.
    fn placed_group(
        &mut self,
        node: &Arc<Node>,
        builder: &mut Builder<'_>,
    ) -> Option<(GroupId, Motion)> {
        let params = Params::new(node, builder.diagnostics);
        let motion = builder.shutter.motion(&params, "to_world");
        let group = match params.child(Class::Shape) {
            Some(group) if group.plugin.value == "shapegroup" => Some(self.group(group, builder)),
            Some(other) => {
                params.error(format!(
                    "an `instance` places a `shapegroup`, not {}",
                    other.with_article()
                ));
                None
            }
            None => {
                params.missing("shapegroup", "a reference to a shape group");
                None
            }
        };
        params.finish_after(group.is_some());
        Some((group?, motion?))
    }

    /// Adds an instance of the world.
    pub(crate) fn instance(&mut self, node: &Arc<Node>, builder: &mut Builder<'_>) {
        let Some((group, motion)) = self.placed_group(node, builder) else {
            return;
        };
        let placement = Animated::<Placement>::new(motion.clone());
        if self.geometry.add_instance(group, placement).is_none() {
            let message = "too many placements of groups: with this `instance` more than 2³¹";
            let diagnostic = Diagnostic::error(node.plugin.span, message);
            builder.diagnostics.push(diagnostic);
        }
        for lamp in self.lamps.get(&group).cloned().unwrap_or_default() {
            self.place_lamp(&lamp, &motion, builder);
        }
    }
}
