//! All textures of a scene.

use crate::decode::ImageChannel;
use crate::lane_texture::LaneTexture;
use crate::picture::Picture;
use crate::{Constant, Texture};
use etalon_params::{Node, Span};
use etalon_spectrum::Spectrum;
use etalon_transport::{Shapes, SpectrumKind, TextureId, TexturePoint};
use glam::{Vec2, Vec3, Vec4};
use std::collections::HashMap;
use std::sync::Arc;

/// What one decoding of an image differs from another by: file, whether raw, channel, whether held to 1, and recoding.
pub(crate) type ImageKey = (String, bool, Option<ImageChannel>, bool, [u64; 2]);

/// Textures by id. A texture refers only to textures that were added before it, so lookups end.
///
/// A scene's implementation of [`etalon_transport::Textures`] forwards to the methods of the
/// same names, which take the scene's shapes besides.
#[derive(Debug, Default)]
pub struct TextureTable {
    textures: Vec<Texture>,
    /// What lanes ask of each first.
    pub(crate) in_lanes: Vec<LaneTexture>,
    attributes: Vec<(TextureId, Span)>,
    /// Textures already read, by address of the node.
    pub(crate) read: HashMap<(usize, SpectrumKind), TextureId>,
    /// Keeps the nodes in `read` alive, so that no address is used twice.
    pub(crate) nodes: Vec<Arc<Node>>,
    /// Those that have values in space, by the bits of their means.
    alike: HashMap<u32, Vec<TextureId>>,
    pub(crate) images: HashMap<ImageKey, Arc<Picture>>,
}

impl TextureTable {
    /// An empty set.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a texture. Of equal ones that have values in space there is one, so that media are equal that are the same.
    pub fn add(&mut self, texture: Texture) -> TextureId {
        let id = TextureId(self.textures.len() as u32);
        if texture.instead_in_space().is_none() {
            let near = (self.alike.entry(texture.mean(self).to_bits())).or_default();
            let known = near
                .iter()
                .find(|id| self.textures[id.0 as usize] == texture);
            if let Some(known) = known {
                return *known;
            }
            near.push(id);
        }
        self.in_lanes.push(LaneTexture::from(&texture));
        self.textures.push(texture);
        id
    }

    /// Number of textures.
    pub fn len(&self) -> usize {
        self.textures.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.textures.is_empty()
    }

    /// Number of images, and the memory of their pixels (bytes).
    pub fn pictures(&self) -> (usize, usize) {
        let bytes = self.images.values().map(|image| image.bytes()).sum();
        (self.images.len(), bytes)
    }

    /// Adds a spectrum that is the same everywhere.
    pub fn add_spectrum(&mut self, spectrum: Spectrum) -> TextureId {
        self.add(Texture::Constant(Constant::new(spectrum)))
    }

    /// Stores the source position of a mesh attribute.
    pub(crate) fn note_attribute(&mut self, texture: TextureId, span: Span) {
        self.attributes.push((texture, span));
    }

    /// The mesh attributes that textures ask for, with the places that do, so that the scene can
    /// make sure that the shapes have them.
    pub fn attributes(&self) -> impl Iterator<Item = (TextureId, &str, Span)> {
        self.attributes
            .iter()
            .filter_map(|&(id, span)| match self.get(id) {
                Texture::MeshAttribute(attribute) => Some((id, attribute.name.as_str(), span)),
                _ => None,
            })
    }

    /// The textures that an object was read as: one for each role in which it is used.
    pub fn read_as(&self, node: &Arc<Node>) -> impl Iterator<Item = TextureId> {
        let address = Arc::as_ptr(node) as usize;
        let roles = [
            SpectrumKind::Reflectance,
            SpectrumKind::Emission,
            SpectrumKind::Unbounded,
            SpectrumKind::Index,
            SpectrumKind::Raw(0),
        ];
        roles
            .into_iter()
            .filter_map(move |role| self.read.get(&(address, role)).copied())
    }

    /// Whether `texture` is `other` or refers to it.
    pub fn uses(&self, texture: TextureId, other: TextureId) -> bool {
        texture == other
            || (self.get(texture).nested().iter()).any(|&nested| self.uses(nested, other))
    }

    /// Forgets what was needed only while reading (which nodes and files were read already).
    pub fn finish_reading(&mut self) {
        self.read = HashMap::new();
        self.nodes = Vec::new();
        self.images = HashMap::new();
        self.alike = HashMap::new();
    }

    /// A texture.
    #[inline]
    pub fn get(&self, id: TextureId) -> &Texture {
        &self.textures[id.0 as usize]
    }

    /// The spectrum at a point, for the four wavelengths `lambda` (nm).
    #[inline(always)] // What is the same everywhere takes no call of what may be anything.
    pub fn spectrum(
        &self,
        id: TextureId,
        shapes: &impl Shapes,
        at: &TexturePoint,
        lambda: Vec4,
    ) -> Vec4 {
        self.spectrum_at(id, shapes, || *at, lambda)
    }

    /// The same at a point that is found when it is needed.
    #[inline(always)] // As above.
    pub(crate) fn spectrum_at(
        &self,
        id: TextureId,
        shapes: &impl Shapes,
        at: impl FnOnce() -> TexturePoint,
        lambda: Vec4,
    ) -> Vec4 {
        match self.get(id) {
            Texture::Constant(constant) => constant.spectrum.eval(lambda),
            texture => self.varying_spectrum(texture, shapes, &at(), lambda),
        }
    }

    #[inline(never)]
    fn varying_spectrum(
        &self,
        texture: &Texture,
        shapes: &impl Shapes,
        at: &TexturePoint,
        lambda: Vec4,
    ) -> Vec4 {
        texture.spectrum(self, shapes, at, lambda)
    }

    /// A number at a point: the luminance of colours.
    #[inline]
    pub fn number(&self, id: TextureId, shapes: &impl Shapes, at: &TexturePoint) -> f32 {
        self.get(id).number(self, shapes, at)
    }

    /// (∂/∂u, ∂/∂v) of a number at a point, which moves by `moved` with u and v.
    pub fn gradient(
        &self,
        id: TextureId,
        shapes: &impl Shapes,
        at: &TexturePoint,
        moved: [Vec3; 2],
    ) -> Vec2 {
        self.get(id).gradient(self, shapes, at, moved)
    }

    /// Three raw channels at a point.
    #[inline]
    pub fn colour(&self, id: TextureId, shapes: &impl Shapes, at: &TexturePoint) -> Vec3 {
        self.get(id).colour(self, shapes, at)
    }

    /// The mean over the texture, for choosing among lobes and lights.
    pub fn mean(&self, id: TextureId) -> f32 {
        self.get(id).mean(self)
    }

    /// Whether the texture is the same everywhere.
    pub fn is_constant(&self, id: TextureId) -> bool {
        self.get(id).is_constant(self)
    }
}
