//! Flattening of a material with textures into lobes at a point.

use crate::texture_site::{Place, TextureSite};
use crate::tilt::Tilt;
use crate::{AnyBxdf, BsdfAtPoint, Bxdf, Lobe, MAX_LOBES};
use core::ops::Deref;
use etalon_math::Frame;
use etalon_spectrum::Wavelengths;
use etalon_transport::{SurfaceInteraction, Textures};
use glam::{Vec3, Vec4};

/// The context in which a material is resolved.
#[derive(Debug)]
pub struct ShadingContext<'t, T> {
    /// What textures are asked.
    pub textured: TextureSite<'t, T>,
    /// The point.
    pub vertex: &'t SurfaceInteraction,
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
            textured: TextureSite::new(textures, Place::Vertex(vertex), wavelengths),
            vertex,
            wo,
        }
    }
}

impl<'t, T> Deref for ShadingContext<'t, T> {
    type Target = TextureSite<'t, T>;

    #[inline]
    fn deref(&self) -> &Self::Target {
        &self.textured
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
