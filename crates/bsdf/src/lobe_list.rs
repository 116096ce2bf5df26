//! How a material with textures becomes lobes at a point.

use crate::{AnyBxdf, BsdfAtPoint, Lobe, MAX_LOBES};
use etalon_math::Frame;
use etalon_spectrum::Wavelengths;
use etalon_transport::{SurfaceInteraction, TextureId, TexturePoint, Textures};
use glam::{Vec3, Vec4};

/// Where a material is resolved: its textures at that point, for the path's wavelengths.
#[derive(Clone, Copy, Debug)]
pub struct ShadingContext<'t, T> {
    /// The textures of the scene.
    pub textures: &'t T,
    /// The point.
    pub at: TexturePoint,
    /// The wavelengths (nm).
    pub lambda: Vec4,
    /// The known direction (world).
    pub wo: Vec3,
}

impl<'t, T: Textures> ShadingContext<'t, T> {
    /// A point of a surface.
    #[inline]
    pub fn new(
        textures: &'t T,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        wavelengths: &Wavelengths,
    ) -> Self {
        Self {
            textures,
            at: TexturePoint::from(vertex),
            lambda: wavelengths.lambda,
            wo,
        }
    }

    /// A spectrum here.
    #[inline]
    pub fn spectrum(&self, texture: TextureId) -> Vec4 {
        self.textures.spectrum(texture, &self.at, self.lambda)
    }

    /// A number here.
    #[inline]
    pub fn number(&self, texture: TextureId) -> f32 {
        self.textures.number(texture, &self.at)
    }

    /// A number here that is a share of the light: brought into [0, 1], as bitmaps may exceed it.
    #[inline]
    pub fn share(&self, texture: TextureId) -> f32 {
        self.number(texture).clamp(0.0, 1.0)
    }
}

/// Lobes being collected from a tree of materials.
#[derive(Clone, Copy, Debug, Default)]
pub struct LobeList<'a> {
    lobes: [Option<Lobe<'a>>; MAX_LOBES],
    count: usize,
    null: Vec4,
    null_probability: f32,
}

impl<'a> LobeList<'a> {
    /// Adds a lobe that has the share `weight` of the light and is chosen with `probability`.
    pub fn push(&mut self, scatter: AnyBxdf<'a>, frame: Frame, weight: f32, probability: f32) {
        if weight > 0.0 && self.count < MAX_LOBES {
            self.lobes[self.count] = Some(Lobe {
                scatter,
                frame,
                weight,
                probability,
            });
            self.count += 1;
        }
    }

    /// Adds light that passes straight on.
    pub fn pass(&mut self, energy: Vec4, probability: f32) {
        self.null += energy;
        self.null_probability += probability;
    }

    /// What was collected.
    pub fn resolved(&self, normal: Vec3) -> BsdfAtPoint<'a> {
        let several = |lobes: &[Lobe<'a>]| {
            BsdfAtPoint::several(normal, self.null, self.null_probability, lobes)
        };
        match (self.lobes[0], self.count) {
            (None, _) => several(&[]),
            (Some(only), 1) => several(&[only]),
            (Some(first), count) => {
                let list = self.lobes.map(|lobe| lobe.unwrap_or(first));
                several(&list[..count])
            }
        }
    }
}
