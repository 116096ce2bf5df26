//! Shapes, and the media that fill the space between them.

use crate::media::SceneMedia;
use crate::rays;
use crate::scene_tables::SceneTables;
use etalon_bsdf::Material;
use etalon_transport::{Hit, LaneKind, Ray, SurfaceInteraction};

/// Shapes with their tables, and the media that they bound.
pub(crate) struct Space {
    pub(crate) lookup: SceneTables,
    pub(crate) media: SceneMedia,
    /// Whether there are media, so that rays must track theirs.
    pub(crate) has_media: bool,
}

impl Space {
    pub(crate) fn new(lookup: SceneTables, media: SceneMedia) -> Self {
        Self {
            has_media: media.exist(),
            lookup,
            media,
        }
    }

    /// The kinds of the points of each shape; none where it bounds a medium.
    pub(crate) fn lane_kinds(&self, materials: &[Material]) -> Vec<Option<LaneKind>> {
        let kind = |shape| match self.media.bounds_medium(shape) {
            true => None,
            false => {
                let material = self.lookup.geometry.material_of(shape)?;
                materials[material.0 as usize].lane_kind()
            }
        };
        self.lookup.geometry.shapes().map(kind).collect()
    }

    /// The nearest surface along a ray.
    #[inline]
    pub(crate) fn intersect(&self, ray: &Ray) -> Option<Hit> {
        rays::count();
        self.lookup.geometry.intersect(ray)
    }

    /// The nearest surfaces along many rays: as many `hits` as `rays`.
    #[inline]
    pub(crate) fn intersect_batch(&self, rays: &[Ray], hits: &mut [Option<Hit>]) {
        rays::count_many(rays.len());
        self.lookup.geometry.intersect_batch(rays, hits);
    }

    /// The surface that was hit, with the media on both sides.
    #[inline]
    pub(crate) fn vertex(&self, ray: &Ray, hit: &Hit) -> SurfaceInteraction {
        let mut vertex = self.lookup.geometry.vertex(ray, hit);
        if self.has_media {
            let outside = ray.direction.dot(vertex.normal) < 0.0;
            vertex.media = self.media.around(hit.shape, ray.medium, outside);
        }
        vertex
    }
}
