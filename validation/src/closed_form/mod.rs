//! Pictures that are known without rendering them, computed in double precision.
//!
//! Every file holds one formula with its source. The numbers of a scene come from its claim's
//! `defines`, so that scene and formula cannot disagree.

pub mod colour_checker;
pub mod furnace;
pub mod integrating_sphere;
pub mod irradiance;
pub mod light;
pub mod pixels;
pub mod prism;

use crate::claim::Claim;
use etalon::judge::Known;

/// The picture that a formula gives for a claim's scene at `size` pixels.
///
/// # Errors
/// If there is no such formula, or a number that it needs is missing.
pub fn picture(formula: &str, claim: &Claim, size: [u32; 2]) -> Result<Known, String> {
    match formula {
        "furnace" => furnace::picture(claim, size),
        "white furnace" => furnace::white(claim, size),
        "integrating sphere" => integrating_sphere::picture(claim, size),
        "irradiance of a sphere" => irradiance::picture(claim, size, irradiance::sphere),
        "irradiance of a disk" => irradiance::picture(claim, size, irradiance::disk),
        "irradiance of a rectangle" => irradiance::picture(claim, size, irradiance::rectangle),
        "prism" => prism::picture(claim, size),
        "colour checker" => colour_checker::picture(claim, size),
        other => Err(format!("there is no closed form called `{other}`")),
    }
}
