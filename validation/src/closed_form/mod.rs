//! Pictures that are known without rendering them, computed in double precision.
//!
//! Every file holds one formula with its source. The numbers of a scene come from its claim's
//! `defines`, so that scene and formula cannot disagree.

pub mod ambient_corner;
pub mod blackbody;
pub mod blend;
pub mod colour_checker;
pub mod delta_lights;
pub mod directional_lobes;
pub mod field_of_view;
pub mod filter_shape;
pub mod form_factors;
pub mod furnace;
pub mod glass;
pub mod integrating_sphere;
pub mod irradiance;
pub mod light;
pub mod mesh_light;
pub mod metamers;
pub mod mirror_room;
pub mod narrow_sky;
pub mod out_of_focus;
pub mod pile_of_plates;
pub mod prism;
pub mod rgb_patches;
pub mod slab;
pub mod spectra;
pub mod wrapped_bitmap;

use crate::claim::{Claim, Estimator};
use etalon_render::judge::ExactImage;

/// The picture that a formula gives for a claim's scene, as one of its estimators sees it, at `size` pixels.
///
/// # Errors
/// If there is no such formula, or a number that it needs is missing.
pub fn picture(
    formula: &str,
    claim: &Claim,
    estimator: &Estimator,
    size: [u32; 2],
) -> Result<ExactImage, String> {
    let claim = &Claim {
        defines: claim.defines_of(Some(estimator)),
        ..claim.clone()
    };
    match formula {
        "furnace" => furnace::picture(claim, size),
        "white furnace" => furnace::white(claim, size),
        "integrating sphere" => integrating_sphere::picture(claim, size),
        "exposure to a moving sphere" => {
            irradiance::picture(claim, size, irradiance::moving_sphere)
        }
        "irradiance of a sphere" => irradiance::picture(claim, size, irradiance::sphere),
        "irradiance of a disk" => irradiance::picture(claim, size, irradiance::disk),
        "irradiance of a rectangle" => irradiance::picture(claim, size, irradiance::rectangle),
        "irradiance beside a sphere" => irradiance::beside(claim, size, irradiance::sphere),
        "irradiance beside a disk" => irradiance::beside(claim, size, irradiance::disk),
        "irradiance beside a rectangle" => irradiance::beside(claim, size, irradiance::rectangle),
        "irradiance of a mesh" => irradiance::picture(claim, size, mesh_light::mesh),
        "irradiance of a point light" => delta_lights::point(claim, size),
        "irradiance of a spot light" => delta_lights::spot(claim, size),
        "irradiance of a directional light" => delta_lights::directional(claim, size),
        "form factor of parallel rectangles" => form_factors::parallel_picture(claim, size),
        "form factor of perpendicular rectangles" => {
            form_factors::perpendicular_picture(claim, size)
        }
        "pile of plates" => pile_of_plates::picture(claim, size),
        "mirror room" => mirror_room::picture(claim, size),
        "black body" => blackbody::picture(claim, size),
        "colours as given" => rgb_patches::picture(claim, size),
        "metamers that match" => metamers::matching(claim, size),
        "metamers" => metamers::picture(claim, size),
        "prism" => prism::picture(claim, size),
        "blend" => blend::picture(claim, size),
        "window between two media" => glass::window(claim, size),
        "furnace within glass" => glass::furnace(claim, size),
        "directional lobes" => directional_lobes::picture(claim, size),
        "coat under parallel light" => directional_lobes::coat(claim, size),
        "disk out of focus" => out_of_focus::picture(claim, size),
        "narrow sky" => narrow_sky::picture(claim, size),
        "wrapped bitmap" => wrapped_bitmap::picture(claim, size),
        "ambient corner" => ambient_corner::picture(claim, size),
        "rectangle in a field of view" => field_of_view::picture(claim, size),
        "corner under a filter" => filter_shape::picture(claim, size),
        "light from a half-space" => slab::half_space(claim, size),
        "light from a slab" => slab::layer(claim, size),
        "light scattered once by a slab" => slab::once(claim, size),
        "colour checker" => colour_checker::picture(claim, size),
        other => Err(format!("there is no closed form called `{other}`")),
    }
}
