//! The throughput of a path and its densities, for all four wavelengths.
//!
//! The estimator of the whole renderer is
//!
//! ```text
//! C = Σⱼ [ fⱼ(x) / p(λⱼ) ] / Σₜ Σₖ pₜ,ₖ(x)
//! ```
//!
//! where fⱼ is the path's contribution at wavelength λⱼ, and pₜ,ₖ its whole density under
//! technique t had lane k been the one that chose (Wilkie, Nawaz, Droske, Weidlich, Hanika 2014,
//! "Hero Wavelength Spectral Sampling", eq. 7, with the balance heuristic over lanes *and*
//! techniques at once). Neither f nor p is ever formed: both can leave the range of f32 on a
//! long path. What is carried are their quotients by the density p₀ of the hero wavelength; pbrt-v4 has the
//! same two numbers under the same names:
//!
//! ```text
//! beta = f / p₀            r_u = pₖ / p₀
//! ```
//!
//! The density p(λⱼ) with which wavelengths were drawn is divided out once, at the sensor
//! ([`etalon_transport::Sensor::weights`]), and appears nowhere else.

use etalon_math::lane::{Lane, Spectral};
use glam::Vec4;

/// No path survives roulette more surely: an endless one would not end.
pub const MOST: f32 = 0.95;

/// The most that a path survives with at a point of a medium: it makes ten thousand steps, in the mean, if nothing is lost.
const MOST_IN_MEDIUM: f32 = 0.9999;

/// A path up to some vertex, or several in lanes.
#[derive(Clone, Copy, Debug)]
pub struct PathThroughput<F: Lane = f32> {
    /// fⱼ / p₀.
    pub beta: F::Spectrum,
    /// pₖ / p₀.
    pub r_u: F::Spectrum,
}

impl PathThroughput {
    /// The empty path of a camera, whose densities do not depend on wavelength.
    pub const START: Self = Self {
        beta: Vec4::ONE,
        r_u: Vec4::ONE,
    };

    /// Whether the path survives Russian roulette with the probability `survival`, for the random number `u`; if so, it is
    /// scaled.
    #[inline]
    pub fn survives(&mut self, survival: f32, u: f32) -> bool {
        if !(u < survival) {
            return false;
        }
        self.roulette(survival);
        true
    }

    /// The probability of survival between two points of a medium. A walk of many steps below a surface must not be ended by
    /// their number alone, as each makes the rest count more; but one without loss or end must end.
    #[inline]
    pub fn survival_in_medium(&self, eta: f32) -> f32 {
        (self.magnitude() * eta * eta).min(MOST_IN_MEDIUM)
    }

    /// The same with which a path from a light survives, whose throughput was `before` when it left where it was
    /// scattered before, at a point of a medium (`in_space`) or a surface: emitted flux has no natural scale.
    #[inline]
    pub fn survival_of_flux(&self, before: f32, in_space: bool) -> f32 {
        let most = if in_space { MOST_IN_MEDIUM } else { MOST };
        (self.magnitude() / before).min(most)
    }
}

impl<F: Lane> PathThroughput<F> {
    /// `path(i)` in lane i.
    #[inline(always)]
    pub fn of_lanes<'p>(path: impl Fn(usize) -> &'p PathThroughput) -> Self {
        let [beta, r_u] = F::Spectrum::pairs_of_lanes(|i| [path(i).beta, path(i).r_u]);
        Self { beta, r_u }
    }

    /// The path in any lane.
    #[inline(always)]
    pub fn lanes(self) -> impl Fn(usize) -> PathThroughput {
        let pairs = F::Spectrum::pairs([self.beta, self.r_u]);
        move |i| {
            let [beta, r_u] = pairs(i);
            PathThroughput { beta, r_u }
        }
    }

    /// Extends the path by an event with contribution `factor` and densities `chance` (that of the first wavelength
    /// is the one that chose).
    #[inline]
    pub fn scatter(&mut self, factor: F::Spectrum, chance: F::Spectrum) {
        let inverse = F::ONE / chance.hero();
        self.beta = self.beta * (factor * inverse);
        self.r_u = self.r_u * (chance * inverse);
    }

    /// The probability with which a path from the camera survives Russian roulette, which has passed indices of refraction
    /// with the product `eta`.
    #[inline]
    pub fn survival(&self, eta: F) -> F {
        (self.magnitude() * eta * eta).min(F::splat(MOST))
    }

    /// Survives Russian roulette of probability `q`, a rule symmetric in the lanes: it scales
    /// every lane's density alike.
    #[inline]
    pub fn roulette(&mut self, q: F) {
        self.beta = self.beta / q;
    }

    /// What decides Russian roulette: the largest fⱼ over the mean of pₖ, symmetric in the wavelengths
    /// and equal to the throughput of an ordinary path tracer where they agree.
    #[inline]
    pub fn magnitude(&self) -> F {
        self.beta.greatest() * 4.0 / self.r_u.sum()
    }

    /// The estimate of a complete path that adds `radiance` at its end, when another technique
    /// could have found the same path with density ratio `other` (pₜ,ₖ / p₀; zero if none).
    #[inline]
    pub fn contribution(&self, radiance: F::Spectrum, other: F::Spectrum) -> F::Spectrum {
        self.beta * radiance / (self.r_u + other).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_technique_with_equal_lanes_is_plain_monte_carlo() {
        let mut throughput = PathThroughput::START;
        throughput.scatter(Vec4::new(0.1, 0.2, 0.3, 0.4), Vec4::splat(0.5));
        let estimate = throughput.contribution(Vec4::ONE, Vec4::ZERO);
        // Each lane: f / p / 4.
        assert!(
            (estimate - Vec4::new(0.05, 0.1, 0.15, 0.2))
                .abs()
                .max_element()
                < 1e-7
        );
    }

    #[test]
    fn weights_over_lanes_and_techniques_sum_to_one() {
        // Two techniques, four choosers: the eight ways to find one path. For f = 1 and any
        // densities, Σ over ways of p·(estimate) must be Σ over ways of p / Σ p = 1 per lane.
        let a = Vec4::new(0.2, 0.7, 0.0, 1.3);
        let b = Vec4::new(0.5, 0.1, 0.9, 0.0);
        let mut total = Vec4::ZERO;
        for k in 0..4 {
            for (own, other) in [(a, b), (b, a)] {
                if own[k] == 0.0 {
                    continue;
                }
                // Lane k chooses: rotate it to the front.
                let rotate = |v: Vec4| Vec4::from_array([0, 1, 2, 3].map(|i| v[(i + k) % 4]));
                let mut throughput = PathThroughput::START;
                throughput.scatter(Vec4::ONE, rotate(own));
                let estimate = throughput.contribution(Vec4::ONE, rotate(other) / own[k]);
                let back = Vec4::from_array([0, 1, 2, 3].map(|i| estimate[(i + 4 - k) % 4]));
                total += own[k] * back;
            }
        }
        assert!((total - Vec4::ONE).abs().max_element() < 1e-6);
    }

    #[test]
    fn a_lane_that_could_not_have_chosen_leaves_the_sum() {
        let mut throughput = PathThroughput::START;
        throughput.scatter(Vec4::new(0.9, 0.0, 0.0, 0.0), Vec4::new(0.9, 0.0, 0.0, 0.0));
        assert_eq!(throughput.contribution(Vec4::ONE, Vec4::ZERO), Vec4::X);
    }
}
