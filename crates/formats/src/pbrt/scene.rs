//! The scene as it is described: plain data, in which names are resolved and parameters are not yet read.
//!
//! Materials, media, textures and objects stand in lists, and are referred to by their index there. What nobody gave is pbrt's
//! default. [`Scene::parameters`] begins to read an entity.

use super::options::Options;
use super::parameter::ParameterList;
use super::parameters::Parameters;
use super::placement::Placement;
use crate::SearchPath;
use etalon_params::{Diagnostics, Span, Spanned};
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

/// The index of an item in [`Scene::materials`].
pub type MaterialId = usize;
/// The index of an item in [`Scene::media`].
pub type MediumId = usize;
/// The index of an item in [`Scene::textures`].
pub type TextureId = usize;
/// The index of an item in [`Scene::objects`].
pub type ObjectId = usize;

/// A thing with a type and parameters: `Shape "sphere" "float radius" 2`.
#[derive(Debug)]
pub struct Entity {
    /// The type, one of those that pbrt knows for such a thing.
    pub kind: &'static str,
    /// Where it stands, for messages; where the file begins for a default that nobody wrote.
    pub span: Span,
    /// The parameters.
    pub params: ParameterList,
}

impl Entity {
    /// An entity without parameters.
    pub(crate) fn bare(kind: &'static str, span: Span) -> Self {
        let params = ParameterList::default();
        Self { kind, span, params }
    }
}

/// The camera.
#[derive(Debug)]
pub struct Camera {
    /// Its type and parameters.
    pub entity: Entity,
    /// From the world to the camera, which looks along +z; +y is up and +x to the right.
    pub placement: Arc<Placement>,
    /// The medium that surrounds it.
    pub medium: Option<MediumId>,
}

/// A shape with what holds for it.
#[derive(Debug)]
pub struct Shape {
    /// Its type and parameters.
    pub entity: Entity,
    /// From the shape to the world, or to the object whose definition it is part of.
    pub placement: Arc<Placement>,
    /// Whether its normals point the other way.
    pub reverse_orientation: bool,
    /// Its material.
    pub material: MaterialId,
    /// The light that its surface emits.
    pub area_light: Option<Arc<Entity>>,
    /// The medium on the side that the normal points away from; `None` is vacuum.
    pub inside: Option<MediumId>,
    /// The medium on the side that the normal points to.
    pub outside: Option<MediumId>,
}

/// A light that is no surface.
#[derive(Debug)]
pub struct Light {
    /// Its type and parameters.
    pub entity: Entity,
    /// From the light to the world. pbrt moves no lights: it takes the start.
    pub placement: Arc<Placement>,
    /// The medium that surrounds it.
    pub medium: Option<MediumId>,
}

/// A material.
#[derive(Debug)]
pub struct Material {
    /// Its name, if it is a named one (`MakeNamedMaterial`).
    pub name: Option<Spanned<String>>,
    /// Its type and parameters.
    pub entity: Entity,
    /// What a `mix` mixes.
    pub mixed: Vec<MaterialId>,
}

/// A participating medium.
#[derive(Debug)]
pub struct Medium {
    /// Its name.
    pub name: Spanned<String>,
    /// Its type and parameters.
    pub entity: Entity,
    /// From the medium to the world. pbrt moves no media: it takes the start.
    pub placement: Arc<Placement>,
}

/// What the values of a texture are. A float and a spectrum texture may have the same name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TextureKind {
    /// Numbers.
    Float,
    /// Spectra.
    Spectrum,
}

impl TextureKind {
    /// The word of the language.
    pub fn name(self) -> &'static str {
        match self {
            Self::Float => "float",
            Self::Spectrum => "spectrum",
        }
    }
}

/// A texture.
#[derive(Debug)]
pub struct Texture {
    /// Its name.
    pub name: Spanned<String>,
    /// What its values are.
    pub kind: TextureKind,
    /// Its type and parameters.
    pub entity: Entity,
    /// From the texture to the world. pbrt moves no textures: it takes the start.
    pub placement: Arc<Placement>,
}

/// The definition of an object that instances repeat (`ObjectBegin`).
#[derive(Debug)]
pub struct Object {
    /// Its name.
    pub name: Spanned<String>,
    /// Its shapes. Their placements have the CTM at the definition in them, as in pbrt.
    pub shapes: Vec<Shape>,
    /// The objects that it contains; pbrt itself has no such nesting.
    pub instances: Vec<Instance>,
}

/// An object put somewhere (`ObjectInstance`).
#[derive(Debug)]
pub struct Instance {
    /// What is put there.
    pub object: ObjectId,
    /// The whole directive.
    pub span: Span,
    /// From the object to the world, or to the object that contains it.
    pub placement: Arc<Placement>,
}

/// A scene as it was described.
#[derive(Debug)]
pub struct Scene {
    /// The camera.
    pub camera: Camera,
    /// The film.
    pub film: Entity,
    /// The sampler.
    pub sampler: Entity,
    /// The reconstruction filter.
    pub filter: Entity,
    /// The integrator.
    pub integrator: Entity,
    /// The accelerator.
    pub accelerator: Entity,
    /// What `Option` directives say.
    pub options: Options,
    /// The shapes that are not part of an object.
    pub shapes: Vec<Shape>,
    /// The lights that are no surfaces.
    pub lights: Vec<Light>,
    /// The instances that are not part of an object.
    pub instances: Vec<Instance>,
    /// The objects.
    pub objects: Vec<Object>,
    /// The objects' indices; each comes after those that it contains.
    pub object_order: Vec<ObjectId>,
    /// The materials; the first one is the default.
    pub materials: Vec<Material>,
    /// The materials' indices; each comes after those that it mixes.
    pub material_order: Vec<MaterialId>,
    /// The media.
    pub media: Vec<Medium>,
    /// The textures.
    pub textures: Vec<Texture>,
    /// The textures' indices; each comes after those that it refers to.
    pub texture_order: Vec<TextureId>,
    /// Where the files that the scene refers to are looked for.
    pub search: SearchPath,
    /// The scene files that the description consists of, in the order of reading.
    pub files: Vec<PathBuf>,
    /// Textures by their name.
    pub(crate) texture_ids: HashMap<(TextureKind, String), TextureId>,
}

impl Scene {
    /// Begins to read the parameters of an entity; mistakes go to `diagnostics`.
    pub fn parameters<'a>(
        &'a self,
        entity: &'a Entity,
        diagnostics: &'a Diagnostics,
    ) -> Parameters<'a> {
        Parameters::new(self, entity, diagnostics)
    }

    /// Notes the parameters of `Attribute` directives that no entity asked for; to be called when all were read.
    pub fn report_unused_attributes(&self, diagnostics: &Diagnostics) {
        super::finish::unused_attributes(self, diagnostics);
    }

    /// The texture of a name.
    pub fn texture(&self, kind: TextureKind, name: &str) -> Option<TextureId> {
        self.texture_ids.get(&(kind, name.to_owned())).copied()
    }
}
