//! What takes part in the comparison: Etalon's accelerators, and Embree.

use crate::embree::Embree;
use etalon_geometry::Geometry;
use etalon_transport::Ray;

/// Answers rays.
pub trait Contender: Sync {
    /// The distance of the nearest hit; infinite without one.
    fn nearest(&self, ray: &Ray) -> f32;
    /// Whether anything is hit.
    fn occluded(&self, ray: &Ray) -> bool;
}

impl Contender for Geometry {
    #[inline]
    fn nearest(&self, ray: &Ray) -> f32 {
        self.intersect(ray).map_or(f32::INFINITY, |hit| hit.t)
    }

    #[inline]
    fn occluded(&self, ray: &Ray) -> bool {
        Geometry::occluded(self, ray)
    }
}

impl Contender for Embree<'_> {
    #[inline]
    fn nearest(&self, ray: &Ray) -> f32 {
        self.intersect(ray)
    }

    #[inline]
    fn occluded(&self, ray: &Ray) -> bool {
        Embree::occluded(self, ray)
    }
}
