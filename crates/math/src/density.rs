//! Probability densities that know their measure.
//!
//! Dividing by a density per unit area where a density per unit solid angle was meant is the classic fault
//! of a renderer, so densities of different measures are different types wherever contracts pass them on:
//!
//! ```text
//! p_A = p_ω · |cos θ| / r²
//! ```
//!
//! ([`Density::<SolidAngle>::to_area`], [`Density::<Area>::to_solid_angle`]). Lights, and the weights of `bdpt`,
//! which carry quotients of densities rather than densities, multiply by that factor in place.
//!
//! Every density has one value per wavelength lane: the density that the sampling technique
//! would have had, had that lane been the one that chose (see ARCHITECTURE.md, "Wavelengths").
//! A discrete probability (a perfect mirror's only direction) is a [`DeltaProbability`], never "pdf = 1".

use core::marker::PhantomData;
use core::ops::{Add, Mul};
use glam::Vec4;

/// A measure that a density may refer to.
pub trait Measure: Copy {}

/// Solid angle (sr).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolidAngle;
/// Surface area (m²).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Area;
/// Length along a ray (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Length;

impl Measure for SolidAngle {}
impl Measure for Area {}
impl Measure for Length {}

/// A probability density with respect to the measure `M`, one value per wavelength lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Density<M: Measure> {
    lanes: Vec4,
    measure: PhantomData<M>,
}

impl<M: Measure> Density<M> {
    /// The density of an event that cannot happen.
    pub const ZERO: Self = Self {
        lanes: Vec4::ZERO,
        measure: PhantomData,
    };

    /// A density with one value per lane.
    #[inline]
    pub fn per_lane(lanes: Vec4) -> Self {
        Self {
            lanes,
            measure: PhantomData,
        }
    }

    /// A density that does not depend on wavelength.
    #[inline]
    pub fn uniform(value: f32) -> Self {
        Self::per_lane(Vec4::splat(value))
    }

    /// The values of the four lanes.
    #[inline]
    pub fn lanes(self) -> Vec4 {
        self.lanes
    }

    /// The density had lane 0 (the lane that chooses) been the only one.
    #[inline]
    pub fn hero(self) -> f32 {
        self.lanes.x
    }
}

impl<M: Measure> Add for Density<M> {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self::per_lane(self.lanes + other.lanes)
    }
}

/// Scaling by a probability (choosing this technique among several).
impl<M: Measure> Mul<f32> for Density<M> {
    type Output = Self;
    #[inline]
    fn mul(self, probability: f32) -> Self {
        Self::per_lane(self.lanes * probability)
    }
}

/// Scaling by a probability per lane.
impl<M: Measure> Mul<Vec4> for Density<M> {
    type Output = Self;
    #[inline]
    fn mul(self, probability: Vec4) -> Self {
        Self::per_lane(self.lanes * probability)
    }
}

impl Density<SolidAngle> {
    /// The density per unit area of the point seen at squared distance `distance_squared` (m²)
    /// on a surface whose normal makes an angle with the connecting line whose |cosine| is
    /// `cos_at_surface`.
    #[inline]
    pub fn to_area(self, distance_squared: f32, cos_at_surface: f32) -> Density<Area> {
        Density::per_lane(self.lanes * (cos_at_surface.abs() / distance_squared))
    }
}

impl Density<Area> {
    /// The density per unit solid angle at the observer; the inverse of
    /// [`Density::<SolidAngle>::to_area`]. Infinite (and so never sampled) edge-on.
    #[inline]
    pub fn to_solid_angle(self, distance_squared: f32, cos_at_surface: f32) -> Density<SolidAngle> {
        Density::per_lane(self.lanes * (distance_squared / cos_at_surface.abs()))
    }
}

/// The probability of a discrete event, per wavelength lane (dimensionless, at most 1).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeltaProbability(pub Vec4);

impl DeltaProbability {
    /// A probability that does not depend on wavelength.
    #[inline]
    pub fn uniform(probability: f32) -> Self {
        Self(Vec4::splat(probability))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conversion_and_its_inverse_cancel() {
        let p = Density::<SolidAngle>::per_lane(Vec4::new(0.1, 0.2, 0.3, 0.4));
        let back = p.to_area(9.0, -0.25).to_solid_angle(9.0, 0.25);
        assert!((back.lanes() - p.lanes()).abs().max_element() < 1e-7);
    }

    #[test]
    fn uniform_area_of_a_small_patch_matches_its_solid_angle() {
        // A patch of 1 cm² seen face-on from 10 m subtends A/r² = 1e-6 sr.
        let per_area = Density::<Area>::uniform(1.0 / 1e-4);
        assert!((per_area.to_solid_angle(100.0, 1.0).hero() * 1e-6 - 1.0).abs() < 1e-5);
    }
}
