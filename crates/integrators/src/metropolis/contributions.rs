//! The contributions of a primary sample, and their places.

use super::film_region::FilmRegion;
use super::importance_map::ImportanceMap;
use glam::{Vec2, Vec3};

/// A contribution to the film.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Contribution {
    /// Film position (pixels of the whole film).
    pub(crate) raster: Vec2,
    /// Its colour: the integral over the primary samples of colour times a pixel's filter is the
    /// pixel.
    pub(crate) rgb: Vec3,
}

impl Contribution {
    /// Its part of the scalar I.
    pub(super) fn brightness(&self) -> f32 {
        self.rgb.abs().element_sum() * (1.0 / 3.0)
    }
}

/// All contributions of a primary sample.
#[derive(Clone, Debug, Default)]
pub(crate) struct Contributions {
    contributions: Vec<Contribution>,
    brightness: f32,
    /// The kind of its path, from 0, as the integrand defines them.
    pub(crate) kind: usize,
}

impl Contributions {
    /// Forgets all.
    pub(crate) fn clear(&mut self) {
        self.contributions.clear();
        self.brightness = 0.0;
        self.kind = 0;
    }

    /// Adds a contribution.
    pub(crate) fn add(&mut self, raster: Vec2, rgb: Vec3) {
        if rgb != Vec3::ZERO {
            self.contributions.push(Contribution { raster, rgb });
        }
    }

    /// Adds up I, where places count as `emphasis` says.
    pub(super) fn measure(&mut self, field: &FilmRegion, emphasis: &ImportanceMap) {
        let each = self.contributions.iter();
        self.brightness = each
            .map(|one| one.brightness() * emphasis.at(field, one.raster))
            .sum();
    }

    /// The contributions.
    pub(super) fn contributions(&self) -> &[Contribution] {
        &self.contributions
    }

    /// I: zero where a contribution is not a finite number, so that no chain goes there.
    pub(crate) fn brightness(&self) -> f64 {
        if self.is_sound() {
            f64::from(self.brightness)
        } else {
            0.0
        }
    }

    /// Whether all contributions are finite.
    pub(crate) fn is_sound(&self) -> bool {
        self.brightness.is_finite()
    }

    /// The contributions times `weight`; non-finite ones are returned unchanged, to be reported.
    pub(crate) fn weighted(&self, weight: f64) -> impl Iterator<Item = Contribution> + '_ {
        let weight = if self.is_sound() { weight } else { 1.0 };
        let kept = if weight > 0.0 {
            &self.contributions[..]
        } else {
            &[]
        };
        kept.iter().map(move |found| Contribution {
            raster: found.raster,
            rgb: found.rgb * weight as f32,
        })
    }
}
