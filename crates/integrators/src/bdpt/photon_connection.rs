//! Connections with photons: what merging adds at a vertex of the camera's subpath.

use super::connect::Connector;
use super::merging::FACING;
use super::path_vertex::SubpathVertex;
use super::pdf_ratios::{EndPdfs, pdf_ratios_more};
use etalon_transport::{Bsdf, TransportMode, World};
use glam::Vec4;

impl<'w, W: World> Connector<'_, 'w, W> {
    /// n π r², zero if nothing is merged.
    pub(super) fn area(&self) -> f32 {
        self.merging
            .map_or(0.0, |merging| merging.parameters.area())
    }

    /// 1 if there are techniques that connect, 0 if there is only merging.
    pub(super) fn connections(&self) -> f32 {
        (self.merging).map_or(1.0, |merging| merging.parameters.connections())
    }

    /// Merges the camera subpath's vertex with the photons around it.
    pub(super) fn merge(&mut self, vertex: &SubpathVertex<'w, W>, camera: &[SubpathVertex<'w, W>]) {
        let Some(merging) = self.merging.filter(|_| vertex.merges()) else {
            return;
        };
        let (place, max_depth) = (vertex.point.position, self.settings.max_depth);
        let (camera_end, theirs) = (self.camera_end(), vertex.throughput.r_u);
        let mut radiance = Vec4::ZERO;
        let radius = merging.parameters.radius;
        merging.tree.within(place, radius * radius, |found| {
            let photon = &merging.photons[found.place];
            if vertex.segments.saturating_add(photon.segments) > max_depth
                || photon.normal.dot(vertex.point.normal) < FACING
            {
                return;
            }
            let (value, density) =
                (vertex.bsdf).eval_and_density(vertex.wo, photon.from, TransportMode::Radiance);
            let value = photon.value * value * vertex.throughput.beta;
            if value == Vec4::ZERO {
                return;
            }
            // Relative to technique i, whose density merging multiplies by aᵢ n π r²: divided out
            // below, it leaves aᵢ.
            let mut total = (photon.connected * theirs).element_sum();
            total += (photon.pdf_ratios_fewer * density.lanes() * theirs).element_sum();
            let ends = EndPdfs {
                here: photon.r_u * photon.arrival,
                before: self.camera_reverse_pdf(vertex, camera, photon.from),
            };
            total += pdf_ratios_more(Some(vertex), camera, Vec4::ONE, ends, true, camera_end);
            radiance += value * (photon.arrival / total);
        });
        self.radiance += radiance;
    }
}
