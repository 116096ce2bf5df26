//! The graphics state: what the directives so far say about the next shape.

use super::parameter::{ColorSpace, Parameter};
use super::placement::{Active, Placement};
use super::scene::{Entity, MaterialId, MediumId};
use std::sync::Arc;

/// The graphics state. `AttributeBegin` saves all of it, so it is cheap to copy.
#[derive(Clone, Debug)]
pub(crate) struct GraphicsState {
    /// The current transformation matrices.
    pub(crate) ctm: Arc<Placement>,
    /// Which of them the directives change.
    pub(crate) active: Active,
    pub(crate) reverse_orientation: bool,
    pub(crate) color_space: ColorSpace,
    pub(crate) material: MaterialId,
    pub(crate) area_light: Option<Arc<Entity>>,
    pub(crate) inside: Option<MediumId>,
    pub(crate) outside: Option<MediumId>,
    /// What `Attribute` directives say.
    pub(crate) attributes: Arc<Attributes>,
}

impl GraphicsState {
    /// The state at the beginning of a scene, with its default material.
    pub(crate) fn new(material: MaterialId) -> Self {
        Self {
            ctm: Arc::default(),
            active: Active::All,
            reverse_orientation: false,
            color_space: ColorSpace::Srgb,
            material,
            area_light: None,
            inside: None,
            outside: None,
            attributes: Arc::default(),
        }
    }
}

/// Parameters that hold for all entities of a family, unless they say otherwise.
pub(crate) type Inherited = Arc<[Arc<Parameter>]>;

/// The parameters that `Attribute` directives gave, by the families that they name.
#[derive(Clone, Debug, Default)]
pub(crate) struct Attributes {
    pub(crate) shape: Inherited,
    pub(crate) light: Inherited,
    pub(crate) material: Inherited,
    pub(crate) medium: Inherited,
    pub(crate) texture: Inherited,
}

impl Attributes {
    /// The words of the families.
    pub(crate) const FAMILIES: [&str; 5] = ["shape", "light", "material", "medium", "texture"];

    /// The parameters of a family.
    pub(crate) fn of_family(&mut self, word: &str) -> Option<&mut Inherited> {
        match word {
            "shape" => Some(&mut self.shape),
            "light" => Some(&mut self.light),
            "material" => Some(&mut self.material),
            "medium" => Some(&mut self.medium),
            "texture" => Some(&mut self.texture),
            _ => None,
        }
    }
}
