//! Connections with photons: what merging adds at a vertex of the camera's subpath.

use super::connect::Connector;
use super::merge::FACING;
use super::path_vertex::Corner;
use super::pdf_ratios::{EndPdfs, more};
use etalon_transport::{Bsdf, TransportMode, World};
use glam::Vec4;

impl<'w, W: World> Connector<'_, 'w, W> {
    /// n π r², zero if nothing is merged.
    pub(super) fn area(&self) -> f32 {
        self.merging.map_or(0.0, |merging| merging.terms.area())
    }

    /// 1 if there are techniques that connect, 0 if there is only merging.
    pub(super) fn connections(&self) -> f32 {
        (self.merging).map_or(1.0, |merging| merging.terms.connections())
    }

    /// Merges the camera subpath's vertex with the photons around it.
    pub(super) fn merge(&mut self, corner: &Corner<'w, W>, eye: &[Corner<'w, W>]) {
        let Some(merging) = self.merging.filter(|_| corner.merges()) else {
            return;
        };
        let (place, max_depth) = (corner.vertex.position, self.settings.max_depth);
        let (camera_end, theirs) = (self.camera_end(), corner.prefix.r_u);
        let mut radiance = Vec4::ZERO;
        let radius = merging.terms.radius;
        merging.tree.within(place, radius * radius, |found| {
            let photon = &merging.photons[found.place];
            if corner.segments.saturating_add(photon.segments) > max_depth
                || photon.normal.dot(corner.vertex.normal) < FACING
            {
                return;
            }
            let (value, density) =
                (corner.bsdf).eval_and_density(corner.wo, photon.from, TransportMode::Radiance);
            let value = photon.value * value * corner.prefix.beta;
            if value == Vec4::ZERO {
                return;
            }
            // Relative to technique i, whose density merging multiplies by aᵢ n π r²: divided out
            // below, it leaves aᵢ.
            let mut total = (photon.connected * theirs).element_sum();
            total += (photon.fewer * density.lanes() * theirs).element_sum();
            let ends = EndPdfs {
                here: photon.r_u * photon.arrival,
                before: self.beyond(corner, eye, photon.from),
            };
            total += more(Some(corner), eye, Vec4::ONE, ends, true, camera_end);
            radiance += value * (photon.arrival / total);
        });
        self.radiance += radiance;
    }
}
