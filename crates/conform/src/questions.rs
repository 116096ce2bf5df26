//! The questions: one file for each family.
//!
//! To add one, write its `Question` in a file here and add it to the list at the end.

mod area_lights;
mod cameras;
mod delta_lights;
mod form_factors;
mod glass;
mod media;
mod mirrors;
mod rooms;
mod skies;
mod sphere_lights;
mod stage;
mod units;

use crate::question::Question;

/// All questions.
pub const ALL: &[Question] = &[
    units::WALL,
    units::POINT,
    units::SUN,
    sphere_lights::LARGE,
    sphere_lights::SMALL,
    sphere_lights::TINY,
    sphere_lights::TINIEST,
    sphere_lights::FAR,
    sphere_lights::CUT,
    area_lights::RECTANGLE,
    area_lights::TILTED,
    area_lights::TRIANGLE,
    area_lights::OCTAHEDRON,
    area_lights::TWO,
    delta_lights::POINT,
    delta_lights::SPOT,
    delta_lights::SPOT_ASIDE,
    delta_lights::SUN,
    form_factors::PARALLEL,
    form_factors::PERPENDICULAR,
    skies::BLOCK,
    skies::BLOCK_LINEAR,
    skies::BLOCK_TO_POLES,
    skies::BESIDE_WALL,
    rooms::FURNACE,
    rooms::WHITE_FURNACE,
    rooms::DARK_ROOM,
    rooms::GREY_ROOM,
    rooms::ROOM_SIZES,
    rooms::BRIGHT_ROOM,
    rooms::CUBE_ROOM,
    rooms::BRIGHT_CUBE_ROOM,
    rooms::POINT_IN_SPHERE,
    rooms::BALL_IN_SPHERE,
    glass::UPRIGHT,
    glass::SLANTED,
    glass::GRAZING,
    glass::PILE,
    glass::BALL,
    mirrors::MIRROR,
    mirrors::CONDUCTOR,
    mirrors::CONDUCTOR_GRAZING,
    mirrors::CONDUCTOR_WEAK,
    mirrors::CORRIDOR,
    mirrors::ROOM,
    media::ABSORBER,
    media::SLANTED,
    media::BALL,
    media::SCATTERER,
    cameras::PARALLEL,
    cameras::PINHOLE,
    cameras::WIDE,
    cameras::DEFOCUS,
    cameras::DEFOCUS_EDGE,
];

/// The question of this name.
pub fn by_name(name: &str) -> Option<&'static Question> {
    ALL.iter().find(|question| question.name == name)
}
