//! What mirrors and metals show: each ray has one path, so that no picture has noise but by what ends paths at random.

use super::stage::{BLACK, PIXELS, along_y, cube, facing, scene};
use crate::pose::Freedom;
use crate::question::Question;
use crate::scene::{Camera, Material, Projection, Scene, Shape};
use crate::truth::Picture;
use crate::truth::coverage::part;
use crate::truth::interfaces::conductor;
use crate::truth::mirror_room::seen;
use etalon_math::float64::{cos, sin};

pub(super) const MIRROR: Question = Question {
    name: "mirror",
    title: "A wall in a mirror at 45 degrees",
    formula: "R L",
    source: "the definition of reflectance",
    freedom: Freedom::Any,
    samples: 16,
    ask: || wall_in(Material::Mirror { reflectance: 0.8 }, 45.0, 0.8),
};

pub(super) const CONDUCTOR: Question = Question {
    name: "conductor-45",
    title: "A wall in a metal at 45 degrees",
    formula: "½ (R_s + R_p) L of the index 0.2 + 3i",
    source: "Born and Wolf, Principles of Optics, 1959, section 13.2",
    ask: || metal(45.0, 0.2, 3.0),
    ..MIRROR
};

pub(super) const CONDUCTOR_GRAZING: Question = Question {
    name: "conductor-75",
    title: "A wall in a metal at 75 degrees",
    ask: || metal(75.0, 0.2, 3.0),
    ..CONDUCTOR
};

pub(super) const CONDUCTOR_WEAK: Question = Question {
    name: "conductor-weak",
    title: "A wall in a metal that absorbs little, at 57 degrees: common approximations are off by a tenth",
    formula: "½ (R_s + R_p) L of the index 1.1 + 0.5i",
    ask: || metal(57.0, 1.1, 0.5),
    ..CONDUCTOR
};

pub(super) const CORRIDOR: Question = Question {
    name: "mirror-corridor",
    title: "A wall at the end of a corridor of two parallel mirrors, after three or four reflections",
    formula: "Rᵏ L with k = ⌊X/w⌋ at the place X of the unfolded wall",
    source: "Euclid, Catoptrics: the angles of the ways in and out are equal",
    ask: corridor,
    ..MIRROR
};

pub(super) const ROOM: Question = Question {
    name: "mirror-room",
    title: "Down into a room of mirrors whose ceiling glows",
    formula: "f L/(1 − f c)",
    source: "Stokes, On the intensity of the light reflected from or transmitted through a pile of plates, 1862",
    samples: 256,
    ask: room,
    ..MIRROR
};

fn metal(degrees: f64, n: f64, k: f64) -> (Scene, Picture) {
    let truth = conductor(cos(degrees.to_radians()), n, k);
    wall_in(Material::Conductor { n, k }, degrees, truth)
}

/// The mirror's normal is (0, −cos, sin); its light comes from a wall of 2 m that no ray meets otherwise.
fn wall_in(material: Material, degrees: f64, truth: f64) -> (Scene, Picture) {
    let angle = degrees.to_radians();
    let (sine, cosine) = (sin(angle), cos(angle));
    let (y, z) = (1.0 - 2.0 * cosine * cosine, 2.0 * sine * cosine);
    let scene = scene(along_y(0.2))
        .with(facing([0.0; 3], [0.0, -cosine, sine], 1.0), material)
        .glowing(
            facing([0.0, 4.0 * y, 4.0 * z], [0.0, -y, -z], 1.0),
            BLACK,
            1.0,
        );
    (scene, Picture::even(PIXELS, truth))
}

/// The corridor is 1 m wide, from y = 0 to 4.8 m, and seen along (0.6, 0.8, 0). The ray through the film's column u enters it at
/// x = 0.37 + 0.25 u and so meets the unfolded end at 3.97 + 0.25 u.
fn corridor() -> (Scene, Picture) {
    let reflectance = 0.9;
    let material = Material::Mirror { reflectance };
    let side = |x: f64, half_y: f64| Shape::Quad {
        center_m: [x, 2.4, 0.0],
        half_u_m: [0.0, half_y, 0.0],
        half_v_m: [0.0, 0.0, 1.0],
    };
    let end = Shape::Quad {
        center_m: [0.5, 4.8, 0.0],
        half_u_m: [0.5, 0.0, 0.0],
        half_v_m: [0.0, 0.0, 1.0],
    };
    let camera = Camera {
        origin_m: [0.37 - 1.8, -2.4, 0.0],
        target_m: [0.37, 0.0, 0.0],
        up: [0.0, 0.0, 1.0],
        projection: Projection::Orthographic { width_m: 0.4 },
    };
    let scene = scene(camera)
        .with(side(0.0, 2.4), material)
        .with(side(1.0, -2.4), material)
        .glowing(end, BLACK, 1.0);
    // The fourth reflection begins at the column u = 0.12.
    let thrice = [0.0, 0.5 * 1.12 * f64::from(PIXELS)];
    let at = |i: u32| {
        let share = part(i % PIXELS, thrice);
        reflectance.powi(3) * (share + (1.0 - share) * reflectance)
    };
    let truth = Picture::exact(PIXELS, (0..PIXELS * PIXELS).map(at).collect());
    (scene, truth)
}

/// A cube of 2 m. Every ray of the camera falls.
fn room() -> (Scene, Picture) {
    let (floor, ceiling) = (0.7, 0.8);
    let camera = Camera {
        origin_m: [0.1, -0.3, 0.2],
        target_m: [0.3, 0.2, -0.3],
        up: [0.0, 0.0, 1.0],
        projection: Projection::Pinhole {
            field_of_view_degrees: 40.0,
        },
    };
    let mut scene = scene(camera);
    for (axis, side, square) in cube() {
        let (reflectance, radiance) = match (axis, side > 0.0) {
            (2, true) => (ceiling, 1.0),
            (2, false) => (floor, 0.0),
            _ => (1.0, 0.0),
        };
        scene = scene.glowing(square, Material::Mirror { reflectance }, radiance);
    }
    (scene, Picture::even(PIXELS, seen(floor, ceiling, true)))
}
