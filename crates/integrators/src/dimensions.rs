//! Which coordinate of a sample decides what.
//!
//! The layout is fixed, so that what one bounce happens to use never shifts the next, and a
//! low-discrepancy sampler spends its best dimensions on the choices that matter most. Pairs
//! begin at even dimensions.

/// Film position (pair).
pub const FILM: u32 = 0;
/// Aperture position (pair).
pub const LENS: u32 = 2;
/// Wavelengths.
pub const WAVELENGTHS: u32 = 4;
/// Moment within the shutter interval.
pub const TIME: u32 = 5;
/// First dimension of the first scattering event.
pub const SCATTERING: u32 = 6;
/// Dimensions per scattering event.
pub const PER_SCATTERING: u32 = 8;

/// Within a scattering event: the direction toward a light (pair), or for a light path the
/// aperture position to connect with.
pub const LIGHT: u32 = 0;
/// Within a scattering event: the scattered direction (pair).
pub const DIRECTION: u32 = 2;
/// Within a scattering event: which light.
pub const LIGHT_CHOICE: u32 = 4;
/// Within a scattering event: which lobe.
pub const LOBE: u32 = 5;
/// Within a scattering event: Russian roulette.
pub const ROULETTE: u32 = 6;

/// The first dimension of the scattering event with index `event` (from 0).
#[inline]
pub fn scattering(event: u32) -> u32 {
    SCATTERING.wrapping_add(event.wrapping_mul(PER_SCATTERING))
}
