//! Kernels: how much a photon counts by its distance.

use super::kdtree::Neighbour;
use super::shoot::{Photon, PlacedPhotons};
use core::f32::consts::PI;
use glam::Vec3;

/// The parameters of a look-up in a photon map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct KernelLookup {
    /// Radius (m).
    pub(crate) radius: f32,
    /// At most so many of the nearest photons, whose distance then is the radius; all within it
    /// if zero.
    pub(crate) nearest: usize,
    /// The shape of the kernel.
    pub(crate) kernel: Kernel,
}

impl KernelLookup {
    /// Visits the photons around a point, each with its kernel (m⁻², in a medium m⁻³).
    pub(crate) fn visit(
        &self,
        placed: &PlacedPhotons,
        centre: Vec3,
        in_space: bool,
        found: &mut Vec<Neighbour>,
        mut visit: impl FnMut(&Photon, f32),
    ) {
        let radius_squared = self.radius * self.radius;
        if self.nearest == 0 {
            let (weight, among) = placed.around(centre, radius_squared, found);
            for found in found.iter() {
                let kernel = (self.kernel).value(found.distance_squared, radius_squared, in_space);
                visit(&among.photons[found.place], kernel * weight);
            }
            return;
        }
        (placed.tree).nearest(centre, self.nearest, radius_squared, found);
        // The farthest defines the radius only.
        let Some((last, inside)) = found.split_last() else {
            return;
        };
        let full = found.len() == self.nearest;
        let (reach, inside) = if full {
            (last.distance_squared, inside)
        } else {
            (radius_squared, &found[..])
        };
        for found in inside {
            let kernel = (self.kernel).value(found.distance_squared, reach, in_space);
            visit(&placed.photons[found.place], kernel);
        }
    }
}

/// A kernel on a disc, or in a ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Kernel {
    /// The same everywhere: 1 / (π r²).
    Box,
    /// Falling with distance d: (1 − d/(k r)) / ((1 − 2/(3k)) π r²), Jensen 1996; in a ball 3/(4k) and 4/3 π r³.
    Cone(f32),
}

impl Kernel {
    /// Its value on a disc (m⁻²), or in a ball (m⁻³), over which its integral is one.
    #[inline]
    pub(crate) fn value(self, distance_squared: f32, radius_squared: f32, in_space: bool) -> f32 {
        // The disc or ball, and the integral of the cone's slope over it, k d/r, over that of one.
        let (size, slope) = match in_space {
            false => (PI * radius_squared, 2.0 / 3.0),
            true => (
                4.0 / 3.0 * PI * radius_squared * radius_squared.sqrt(),
                0.75,
            ),
        };
        match self {
            Self::Box => 1.0 / size,
            Self::Cone(k) => {
                let at = (distance_squared / radius_squared).sqrt();
                let height = 1.0 / ((1.0 - slope / k) * size);
                (1.0 - at / k).max(0.0) * height
            }
        }
    }
}
