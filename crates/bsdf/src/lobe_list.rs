//! Flattening of a material with textures into lobes at a point.

use crate::tilt::Tilt;
use crate::{AnyBxdf, BsdfAtPoint, Bxdf, Lobe, MAX_LOBES};
use etalon_math::Frame;
use etalon_spectrum::Wavelengths;
use etalon_transport::{SurfaceInteraction, TextureId, TexturePoint, Textures};
use glam::{Vec3, Vec4};

/// The context in which a material is resolved: point, textures and wavelengths.
#[derive(Debug)]
pub struct ShadingContext<'t, T> {
    /// The textures of the scene.
    pub textures: &'t T,
    /// The point.
    pub vertex: &'t SurfaceInteraction,
    /// The wavelengths (nm).
    pub lambda: Vec4,
    /// The known direction (world).
    pub wo: Vec3,
}

impl<T> Clone for ShadingContext<'_, T> {
    #[inline]
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for ShadingContext<'_, T> {}

impl<'t, T: Textures> ShadingContext<'t, T> {
    /// A point of a surface.
    #[inline]
    pub fn new(
        textures: &'t T,
        vertex: &'t SurfaceInteraction,
        wo: Vec3,
        wavelengths: &Wavelengths,
    ) -> Self {
        Self {
            textures,
            vertex,
            lambda: wavelengths.lambda,
            wo,
        }
    }

    /// The point, for textures.
    #[inline]
    pub fn at(&self) -> TexturePoint {
        TexturePoint::from(self.vertex)
    }

    /// A spectrum here.
    #[inline]
    pub fn spectrum(&self, texture: TextureId) -> Vec4 {
        self.textures.spectrum(texture, &self.at(), self.lambda)
    }

    /// A number here.
    #[inline]
    pub fn number(&self, texture: TextureId) -> f32 {
        self.textures.number(texture, &self.at())
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
                tilt: None,
            });
            self.count += 1;
        }
    }

    /// Tilts the normals of the lobes that `add` adds: by one relief, given in `frame`, whose back is seen by lobes of the
    /// other side.
    pub(crate) fn tilted(&mut self, tilt: Tilt, frame: Frame, add: impl FnOnce(&mut Self)) {
        let first = self.count;
        add(self);
        for lobe in self.lobes[first..self.count].iter_mut().flatten() {
            // Of a varnish, light paths could not tell which viewer will see the normal.
            let mixed = lobe.scatter.has_discrete() && lobe.scatter.has_continuous();
            let flips = tilt.flips && !mixed;
            let normal = if lobe.frame == frame {
                tilt.normal
            } else {
                let side = 1.0_f32.copysign(lobe.frame.n.dot(frame.n));
                side * lobe.frame.to_local(frame.to_world(tilt.normal))
            };
            lobe.tilt = Some(Tilt {
                normal,
                flips,
                ..tilt
            });
        }
    }

    /// Adds light that passes straight on.
    pub fn pass(&mut self, energy: Vec4, probability: f32) {
        self.null += energy;
        self.null_probability += probability;
    }

    /// The collected lobes.
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
