//! The media of a scene, and which of them lie on the two sides of a surface.

use etalon_subsurface::{MediumAtWavelengths, MediumDescription};
use etalon_transport::{MediumId, MediumInterface, ShapeId, Textures};
use glam::Vec4;

/// Media by id.
#[derive(Debug)]
pub struct SceneMedia {
    media: Vec<MediumDescription>,
    /// By shape, as far as any shape has media.
    interfaces: Vec<Option<MediumInterface>>,
    /// That of the camera.
    pub camera: MediumId,
}

impl SceneMedia {
    /// Media with the shapes that bound them.
    pub fn new(
        media: Vec<MediumDescription>,
        bounded: &[(ShapeId, MediumInterface)],
        camera: MediumId,
    ) -> Self {
        let mut interfaces = Vec::new();
        for (shape, interface) in bounded {
            let index = shape.0 as usize;
            if interfaces.len() <= index {
                interfaces.resize(index + 1, None);
            }
            interfaces[index] = Some(*interface);
        }
        Self {
            media,
            interfaces,
            camera,
        }
    }

    /// Whether a ray may ever be in one.
    pub fn exist(&self) -> bool {
        !self.interfaces.is_empty() || self.camera.is_some()
    }

    /// The media on both sides of a shape; that of the ray that arrives there if the shape bounds none.
    #[inline]
    pub fn around(&self, shape: ShapeId, arriving: MediumId) -> MediumInterface {
        let own = self.interfaces.get(shape.0 as usize).copied().flatten();
        own.unwrap_or(MediumInterface::within(arriving))
    }

    /// A medium at four wavelengths (nm).
    #[inline]
    pub fn at(
        &self,
        medium: MediumId,
        textures: &impl Textures,
        lambda: Vec4,
    ) -> Option<MediumAtWavelengths> {
        let medium = self.media.get(medium.0 as usize)?;
        Some(medium.resolve(textures, lambda))
    }
}
