//! Shapes, groups, instances and their materials.

pub(crate) mod attributes;
pub(crate) mod displacement;
pub(crate) mod groups;
pub(crate) mod merge;
pub(crate) mod solids;

use crate::builder::Builder;
use crate::media::bodies::Body;
use crate::surfaces::attributes::RequiredAttributes;
use crate::surfaces::groups::GroupedLamp;
use etalon_bsdf::Material;
use etalon_geometry::shapes::csg::Operation;
use etalon_geometry::{GeometryBuilder, GroupId, Shape};
use etalon_math::Motion;
use etalon_params::{Class, Diagnostic, Diagnostics, Node, Params, Span, Value};
use etalon_subsurface::MediumDescription;
use etalon_textures::{Constant, Texture};
use etalon_transport::{LightId, MaterialId, MediumId, MediumInterface, ShapeId};
use std::collections::HashMap;
use std::sync::Arc;

/// Plugins that gather or place other shapes.
pub(crate) const COMPOSED: [&str; 3] = ["shapegroup", "instance", "merge"];

/// A shape that emits light, with the description of the light.
pub struct Emitting {
    /// The shape.
    pub shape: ShapeId,
    /// The description of its emitter.
    pub emitter: Arc<Node>,
}

/// What people call the things of a scene, by their ids: the plugin, and its id in the file if it
/// has one.
#[derive(Clone, Debug, Default)]
pub struct Names {
    /// Of shapes, those in groups included.
    pub shapes: Vec<String>,
    /// Of materials.
    pub materials: Vec<String>,
}

/// The name of an object in messages.
pub(crate) fn name(node: &Node) -> String {
    let plugin = &node.plugin.value;
    match &node.id {
        Some(id) => format!("{plugin} `{id}`"),
        None => plugin.clone(),
    }
}

/// Everything a ray can hit.
#[derive(Default)]
pub struct Surfaces {
    /// Shapes, groups and instances.
    pub geometry: GeometryBuilder,
    /// Materials by id.
    pub materials: Vec<Material>,
    /// Shapes that emit.
    pub emitting: Vec<Emitting>,
    /// What all that is called.
    pub names: Names,
    /// Where the first classic Phong material is described, if a shape has one.
    pub classic: Option<Span>,
    /// What textures ask of the shapes.
    pub(crate) required_attributes: RequiredAttributes,
    /// Media by id.
    pub media: Vec<(MediumDescription, Span)>,
    /// The media on both sides of shapes that have any.
    pub interfaces: Vec<(ShapeId, MediumInterface)>,
    /// Shapes that may overlap.
    pub(crate) bodies: Vec<(ShapeId, Body, Span)>,
    /// Whether any of these shapes is seen through instances only, which have places of their own.
    pub placed_media: bool,
    /// Whether any body is placed as an instance.
    pub(crate) placed_bodies: bool,
    /// Descriptions made of others.
    pub(crate) boundaries: Vec<Arc<Node>>,
    pub(crate) medium_by_node: HashMap<usize, MediumId>,
    by_node: HashMap<usize, MaterialId>,
    pub(crate) groups: HashMap<usize, GroupId>,
    /// The shapes of groups that emit.
    pub(crate) lamps: HashMap<GroupId, Vec<GroupedLamp>>,
    /// The material of operands that have none of their own.
    pub(crate) inherited: Option<MaterialId>,
    black: Option<MaterialId>,
    grey: Option<MaterialId>,
}

/// Reads the shapes of a scene, and the materials defined at its top whether or not they are
/// used, so that mistakes in them are found.
pub fn read(scene: &Params<'_>, builder: &mut Builder<'_>) -> Surfaces {
    let mut surfaces = Surfaces::default();
    for (_, node) in scene.children(Class::Bsdf) {
        surfaces.material(node, builder);
    }
    for (_, node) in merge::shapes(scene) {
        surfaces.add(node, builder);
    }
    surfaces
}

/// Refuses sensors on a shape that is not one of the scene itself: those have been seen.
fn refuse_sensors(node: &Node, diagnostics: &Diagnostics) {
    for property in node.properties.iter().filter(|p| !p.is_used()) {
        if matches!(&property.value, Value::Object(child) if child.class == Class::Sensor) {
            property.mark_used();
            let message = "a sensor stands on a shape of the scene, not on a part of another";
            diagnostics.push(Diagnostic::error(property.span, message));
        }
    }
}

/// What a shape carries besides its form.
pub(crate) struct ShapeExtras {
    pub(crate) material: MaterialId,
    pub(crate) emitter: Option<Arc<Node>>,
    /// The materials of its faces, if they have their own.
    pub(crate) faces: Vec<MaterialId>,
    pub(crate) media: Option<MediumInterface>,
    pub(crate) body: Option<(Body, Span)>,
}

impl Surfaces {
    /// Adds a shape, group or instance of the world. Mistakes have been recorded.
    fn add(&mut self, node: &Arc<Node>, builder: &mut Builder<'_>) {
        match node.plugin.value.as_str() {
            "shapegroup" => {
                self.group(node, builder);
            }
            "instance" => self.instance(node, builder),
            _ => {
                let params = Params::new(node, builder.diagnostics);
                if !params.is_animated("to_world") {
                    self.place(node, &[], builder);
                } else if let Some(motion) = builder.shutter.motion(&params, "to_world") {
                    self.place(node, &[motion], builder);
                }
            }
        }
    }

    /// Adds a shape of the world, carried by these motions, the outermost first.
    pub(crate) fn place(
        &mut self,
        node: &Arc<Node>,
        carriers: &[Motion],
        builder: &mut Builder<'_>,
    ) {
        let Some((shape, carried)) = self.shape(node, builder) else {
            return;
        };
        let can_emit = shape.can_emit();
        self.names.shapes.push(name(node));
        let id = if carriers.is_empty() {
            let id = (self.geometry).add_shape(shape, carried.material, LightId::NONE);
            if self.refracts(&carried) {
                self.geometry.set_refractive(id);
            }
            self.carry(id, &carried);
            id
        } else {
            self.moving(shape, &carried, carriers, builder)
        };
        if let Some(emitter) = carried.emitter {
            if !can_emit {
                let message = format!(
                    "{} cannot emit light here: points of it cannot be sampled uniformly",
                    node.with_article()
                );
                let help = "shapes whose points are known by parameters can, and so can all meshes";
                let diagnostic = Diagnostic::error(emitter.span, message).help(help);
                builder.diagnostics.push(diagnostic);
            }
            self.emitting.push(Emitting { shape: id, emitter });
        }
    }

    /// Whether light may be bent where it enters a shape.
    fn refracts(&self, carried: &ShapeExtras) -> bool {
        let materials = carried.faces.iter().chain([&carried.material]);
        let mut known = materials.filter_map(|id| self.materials.get(id.0 as usize));
        known.any(|material| material.traits().refraction)
    }

    /// Stores the properties of a shape that an accelerator does not need.
    pub(crate) fn carry(&mut self, shape: ShapeId, carried: &ShapeExtras) {
        if !carried.faces.is_empty() {
            self.geometry.set_face_materials(shape, &carried.faces);
        }
        if let Some(media) = carried.media {
            self.interfaces.push((shape, media));
        }
        if let Some((body, place)) = carried.body {
            self.bodies.push((shape, body, place));
        }
    }

    /// One shape with its material and emitter.
    pub(crate) fn shape(
        &mut self,
        node: &Arc<Node>,
        builder: &mut Builder<'_>,
    ) -> Option<(Shape, ShapeExtras)> {
        let params = Params::new(node, builder.diagnostics);
        if let Some(operation) = Operation::named(&node.plugin.value) {
            return self.solid(operation, node, builder);
        }
        let shape = displacement::shape(&params, builder)?;
        let emitter = params.child(Class::Emitter).cloned();
        let below = self.below(&params, builder);
        let boundary = below.as_ref().map(|(boundary, _)| boundary);
        let bsdf = boundary.or_else(|| params.child(Class::Bsdf));
        if let Some(shape) = &shape {
            let others = params.child(Class::Subsurface);
            for user in emitter.iter().chain(bsdf).chain(others) {
                let place = node.plugin.span;
                self.required_attributes
                    .by(user, shape, place, builder.diagnostics);
            }
        }
        let material = self.material_or_default(bsdf, emitter.is_some(), builder);
        if let Some(bsdf) = bsdf.filter(|_| self.is_classic(material)) {
            self.classic.get_or_insert(bsdf.plugin.span);
        }
        refuse_sensors(node, builder.diagnostics);
        let inside = below.as_ref().map(|(_, medium)| *medium);
        let media = self.media(&params, inside, builder);
        let body = Body::from_params(&params, material, media);
        params.finish_after(shape.is_some());
        let shape = shape?;
        let carried = ShapeExtras {
            material,
            emitter,
            faces: Vec::new(),
            media,
            body,
        };
        if shape.has_inner_side() {
            Self::expect_closed(&params, &shape, below.is_some(), body.is_some());
        } else if self.refracts(&carried) || media.is_some() || body.is_some() {
            Self::no_way_out(&params);
        }
        Some((shape, carried))
    }

    /// Says that light which enters a shape does not meet it again.
    fn no_way_out(params: &Params<'_>) {
        let message = "this shape is seen from outside only, as in Mitsuba: light that enters it does not meet its surface from within";
        let help = "glass, media and `subsurface` need another shape, such as a mesh; the BSDF `hair` knows of the way out by itself";
        let note = Diagnostic::note(params.node.plugin.span, message);
        params.diagnostics.push(note.help(help));
    }

    /// The material of a BSDF node, read once however often it is used.
    pub(crate) fn material(&mut self, node: &Arc<Node>, builder: &mut Builder<'_>) -> MaterialId {
        let key = Arc::as_ptr(node) as usize;
        if let Some(id) = self.by_node.get(&key) {
            return *id;
        }
        let diagnostics = builder.diagnostics;
        let id = match Material::from_params(node, builder, diagnostics) {
            Some(material) => self.push(material, name(node)),
            // The mistake has been recorded; anything will do.
            None => self.grey(builder),
        };
        self.by_node.insert(key, id);
        id
    }

    /// The material of a shape: the one that it names, or else black if it emits light and grey if not.
    pub(crate) fn material_or_default(
        &mut self,
        bsdf: Option<&Arc<Node>>,
        emits: bool,
        builder: &mut Builder<'_>,
    ) -> MaterialId {
        match bsdf {
            Some(bsdf) => self.material(bsdf, builder),
            None if emits => self.black(builder),
            None => self.grey(builder),
        }
    }

    fn is_classic(&self, material: MaterialId) -> bool {
        (self.materials.get(material.0 as usize)).is_some_and(Material::is_classic)
    }

    fn push(&mut self, material: Material, name: String) -> MaterialId {
        self.materials.push(material);
        self.names.materials.push(name);
        MaterialId(self.materials.len() as u32 - 1)
    }

    /// The material of shapes that name none: diffuse, reflectance one half.
    pub(crate) fn grey(&mut self, builder: &mut Builder<'_>) -> MaterialId {
        if self.grey.is_none() {
            let material = diffuse(builder, 0.5);
            self.grey = Some(self.push(material, "diffuse (by default)".to_owned()));
        }
        self.grey.unwrap_or(MaterialId::NONE)
    }

    /// The material of lights that name none: it reflects nothing.
    fn black(&mut self, builder: &mut Builder<'_>) -> MaterialId {
        if self.black.is_none() {
            let material = diffuse(builder, 0.0);
            self.black = Some(self.push(material, "black (by default)".to_owned()));
        }
        self.black.unwrap_or(MaterialId::NONE)
    }
}

fn diffuse(builder: &mut Builder<'_>, reflectance: f32) -> Material {
    let constant = Texture::Constant(Constant::uniform(reflectance));
    Material::Diffuse(etalon_bsdf::models::diffuse::Description::new(
        builder.textures.add(constant),
    ))
}
