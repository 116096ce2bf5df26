//! Photon maps, the common part of the estimators that merge paths with photons.
//!
//! Light that is scattered at x toward ωₒ is an integral over the light arriving there. Let photons
//! arrive at yᵢ along −ωᵢ with the flux Φᵢ; with a kernel K that integrates to one over a disc,
//!
//! ```text
//! L(x, ωₒ) ≈ Σᵢ K(|yᵢ − x|) · f(x, ωᵢ, ωₒ) · Φᵢ
//! ```
//!
//! (Jensen 1996, "Global Illumination using Photon Maps"). Φ is per wavelength: M photons, each
//! traced with four wavelengths of one of the pass's sets (`sets`), estimate with the camera path z
//! up to x
//!
//! ```text
//! C = 1/M Σᵢ ¼ Σⱼ s(λᵢⱼ)/p(λᵢⱼ) · fⱼ(z) / (¼ Σₖ pₖ(z)) · K f(x, ωᵢ, ωₒ)ⱼ · Φᵢⱼ
//! ```
//!
//! The camera path has its own wavelengths, which define its density p(z); its value fⱼ(z) is evaluated
//! again at those of the photon (`elsewhere`). Beyond a smooth dispersive interface a path exists at one
//! wavelength only. Therefore every camera path takes its wavelengths from the pass's sets: some photons
//! have the same, on average M over the number of sets, and such a path merges with these alone.
//!
//! Photons are not used for all light. Directions from x in which the density of scattering is above
//! `SHARP` are followed by the camera path, as are mirrors and glass, since few photons would contribute
//! there. Direct light is sampled, unless `sppm` is configured to use photons for it.

pub(crate) mod camera_path;
pub(crate) mod gather;
pub mod kdtree;
pub(crate) mod kernel;
pub mod photonmap;
pub mod radius;
pub(crate) mod sets;
pub(crate) mod shoot;
pub mod sppm;

use etalon_math::{Density, SolidAngle};
use etalon_params::Params;

/// Density (sr⁻¹) of scattering above which a direction is followed instead of being left to
/// photons. Diffuse surfaces have 1/π at most; a rough metal of α = 0.3 has about 0.9 in the
/// middle of its lobe.
pub(crate) const SHARP: f32 = 1.0;

/// Whether a direction is followed, which must not depend on the lane.
#[inline]
pub(crate) fn is_sharp(density: Density<SolidAngle>) -> bool {
    0.25 * density.lanes().element_sum() > SHARP
}

/// The most photons of a pass.
const MOST: i64 = 1 << 26;

/// Reads `photons`, the number of photons per pass, rounded up to a power of two that the sets
/// divide; `None` for as many as the film has pixels.
pub(crate) fn read_count(params: &Params<'_>) -> Option<u32> {
    let count = params.integer("photons")?;
    if !(1..=MOST).contains(&count) {
        params.refuse("photons", count, "1, 2, … 67108864");
    }
    u32::try_from(count).ok()
}

/// The most photons that may be looked for.
const MOST_NEAREST: i64 = 1 << 16;

/// Reads a number of nearest photons; 0, all within the radius, if it is not given.
pub(crate) fn read_nearest(params: &Params<'_>, name: &str) -> usize {
    let count = params.integer_or(name, 0);
    // The farthest photon only says how far away it is: of one alone nothing would be left.
    if count == 1 || !(0..=MOST_NEAREST).contains(&count) {
        params.refuse(name, count, "0 (all within the radius), 2, 3, … 65536");
    }
    usize::try_from(count).unwrap_or(0)
}

/// The number of photons to shoot: a power of two, and a multiple of four times the sets.
pub(crate) fn rounded(count: u32, sets: u32) -> u32 {
    count.clamp(4 * sets, MOST as u32).next_power_of_two()
}

/// Reads `wavelength_sets`.
pub(crate) fn read_sets(params: &Params<'_>, default: u32) -> u32 {
    let sets = params.integer_or("wavelength_sets", i64::from(default));
    let read = u32::try_from(sets).unwrap_or(0);
    if read.is_power_of_two() && read <= 256 {
        read
    } else {
        params.refuse("wavelength_sets", sets, "a power of two from 1 to 256");
        default
    }
}
