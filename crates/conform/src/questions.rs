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
mod references;
mod rooms;
mod rough_metals;
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
    delta_lights::SPOT_LINEAR,
    delta_lights::SPOT_SMOOTH,
    delta_lights::SPOT_QUARTIC,
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
    rough_metals::HIGHLIGHT,
    rough_metals::HIGHLIGHT_CORRELATED,
    rough_metals::SKY,
    rough_metals::SKY_CORRELATED,
    media::ABSORBER,
    media::SLANTED,
    media::BALL,
    media::SCATTERER,
    cameras::PARALLEL,
    cameras::PINHOLE,
    cameras::WIDE,
    cameras::DEFOCUS,
    cameras::DEFOCUS_EDGE,
    references::CORNELL_BOX,
    references::NEXT_ROOM,
    references::CAUSTIC,
    references::CLOUD,
];

/// Twelve hexadecimal digits that change when a scene, a truth or the samples of one of these questions do.
pub fn fingerprint<'a>(questions: impl Iterator<Item = &'a Question>) -> String {
    let mut hash = blake3::Hasher::new();
    for question in questions {
        let (scene, truth) = (question.ask)();
        hash.update(question.name.as_bytes());
        hash.update(scene.to_json().as_bytes());
        hash.update(&question.samples.to_le_bytes());
        for mean in truth.means {
            // In single precision: a truth may be computed another way.
            hash.update(&(mean as f32).to_le_bytes());
        }
    }
    hash.finalize().to_hex()[..12].to_owned()
}

/// The question of this name.
pub fn by_name(name: &str) -> Option<&'static Question> {
    ALL.iter().find(|question| question.name == name)
}

#[cfg(test)]
mod tests {
    use super::{ALL, fingerprint};
    use crate::question::Question;

    #[test]
    fn fingerprints_are_of_all_that_is_asked() {
        let [first, second, ..] = ALL else {
            panic!("there are questions");
        };
        let of = |questions: &[Question]| fingerprint(questions.iter());
        assert_eq!(of(ALL), of(ALL));
        assert_eq!(of(ALL).len(), 12);
        let more_samples = Question {
            samples: first.samples + 1,
            ..*first
        };
        let all = [of(&[*first]), of(&[*second]), of(&[more_samples]), of(&[])];
        let mut distinct = all.to_vec();
        distinct.sort_unstable();
        distinct.dedup();
        assert_eq!(distinct.len(), all.len(), "{all:?}");
    }
}
