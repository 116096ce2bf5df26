//! Scenes in which light goes ways that no formula sums up. Their pictures are references, by two estimators of Etalon.

use super::stage::{BLACK, GREY, floor, leaning, scene, sphere};
use crate::pose::Freedom;
use crate::question::Question;
use crate::scene::{Camera, Light, Material, Medium, Projection, Scene, Shape, Triple};
use crate::truth::{Picture, reference};
use etalon_math::float64::{cos, sin};

pub(super) const CORNELL_BOX: Question = Question {
    name: "cornell-box",
    title: "Two boxes in a grey Cornell box: direct light, its shadows, and all that is reflected between diffuse walls",
    formula: "none: a reference by path tracing and by bidirectional path tracing",
    source: "the scene after Goral, Torrance, Greenberg and Battaile, Modeling the interaction of light between diffuse surfaces, 1984",
    freedom: Freedom::Any,
    samples: 512,
    ask: || referred("cornell-box", cornell_box()),
};

pub(super) const NEXT_ROOM: Question = Question {
    name: "next-room",
    title: "A room that is lit from the next one, through a gap in the wall",
    source: "the scene after Veach and Guibas, Metropolis light transport, 1997: a door ajar",
    samples: 1024,
    ask: || referred("next-room", next_room()),
    ..CORNELL_BOX
};

pub(super) const CAUSTIC: Question = Question {
    name: "caustic",
    title: "A floor under a ball of glass that focuses the light of a square",
    source: "the scene after Arvo, Backward ray tracing, 1986",
    samples: 4096,
    ask: || referred("caustic", caustic()),
    ..CORNELL_BOX
};

pub(super) const CLOUD: Question = Question {
    name: "cloud",
    title: "A box of matter that scatters and absorbs, beside a point light",
    source: "the scene after Kajiya and Von Herzen, Ray tracing volume densities, 1984",
    ask: || referred("cloud", cloud()),
    ..CORNELL_BOX
};

fn referred(name: &str, scene: Scene) -> (Scene, Picture) {
    let truth = reference::picture(name, scene.pixels);
    (scene, truth)
}

fn diffuse(reflectance: f64) -> Material {
    Material::Diffuse { reflectance }
}

/// A rectangle about a point with these half sides; its outer side is that of u × v.
fn quad(center_m: Triple, half_u_m: Triple, half_v_m: Triple) -> Shape {
    Shape::Quad {
        center_m,
        half_u_m,
        half_v_m,
    }
}

/// A box that stands on z = `floor`, turned about the vertical.
fn standing([x, y]: [f64; 2], floor: f64, half: Triple, degrees: f64) -> Shape {
    let angle = degrees.to_radians();
    let (sine, cosine) = (sin(angle), cos(angle));
    let [a, b, c] = half;
    Shape::Box {
        center_m: [x, y, floor + c],
        half_axes_m: [
            [a * cosine, a * sine, 0.0],
            [-b * sine, b * cosine, 0.0],
            [0.0, 0.0, c],
        ],
    }
}

/// 2 m wide, about the origin, and open toward −y, where the camera is. It does not see the light, which would be most of the
/// picture's mean.
fn cornell_box() -> Scene {
    let camera = Camera {
        origin_m: [0.0, -3.9, 0.0],
        target_m: [0.0, 0.0, -0.2],
        up: [0.0, 0.0, 1.0],
        projection: Projection::Pinhole {
            field_of_view_degrees: 30.0,
        },
    };
    let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    scene(camera)
        .with(quad([0.0, 0.0, -1.0], x, y), diffuse(0.7))
        .with(quad([0.0, 0.0, 1.0], y, x), diffuse(0.7))
        .with(quad([0.0, 1.0, 0.0], x, z), diffuse(0.7))
        .with(quad([-1.0, 0.0, 0.0], y, z), diffuse(0.2))
        .with(quad([1.0, 0.0, 0.0], z, y), diffuse(0.4))
        .with(
            standing([-0.35, 0.3], -1.0, [0.3, 0.3, 0.6], 18.0),
            diffuse(0.7),
        )
        .with(
            standing([0.35, -0.3], -1.0, [0.3, 0.3, 0.3], -17.0),
            diffuse(0.7),
        )
        .glowing(
            quad([0.0, 0.0, 0.99], [0.0, 0.25, 0.0], [0.25, 0.0, 0.0]),
            BLACK,
            15.0,
        )
}

/// Two rooms of 2 m side by side, from x = −2 to 2, with a wall between them that ends 0.3 m before the far side. The light is at
/// the ceiling of the left one, the camera within the right one.
fn next_room() -> Scene {
    let camera = Camera {
        origin_m: [1.6, -0.8, 0.3],
        target_m: [0.4, 0.6, -0.1],
        up: [0.0, 0.0, 1.0],
        projection: Projection::Pinhole {
            field_of_view_degrees: 60.0,
        },
    };
    let (x, y, z) = ([2.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    let walls = diffuse(0.7);
    scene(camera)
        .with(quad([0.0, 0.0, -1.0], x, y), walls)
        .with(quad([0.0, 0.0, 1.0], y, x), walls)
        .with(quad([0.0, 1.0, 0.0], x, z), walls)
        .with(quad([0.0, -1.0, 0.0], z, x), walls)
        .with(quad([-2.0, 0.0, 0.0], y, z), walls)
        .with(quad([2.0, 0.0, 0.0], z, y), walls)
        .with(standing([0.0, -0.15], -1.0, [0.02, 0.85, 1.0], 0.0), walls)
        .glowing(
            quad([-1.0, 0.0, 0.99], [0.0, 0.5, 0.0], [0.5, 0.0, 0.0]),
            BLACK,
            10.0,
        )
}

/// The camera looks below the ball.
fn caustic() -> Scene {
    scene(leaning(50.0, 0.7))
        .with(floor(0.0), GREY)
        .with(sphere([0.0, 0.0, 1.0], 0.4), Material::Glass { n: 1.5 })
        .glowing(
            quad([0.0, 0.0, 3.0], [0.0, 0.5, 0.0], [0.5, 0.0, 0.0]),
            BLACK,
            10.0,
        )
}

/// The box fills the picture.
fn cloud() -> Scene {
    let camera = Camera {
        origin_m: [-1.2, -2.0, 0.8],
        target_m: [0.0; 3],
        up: [0.0, 0.0, 1.0],
        projection: Projection::Orthographic { width_m: 0.9 },
    };
    let medium = Medium {
        absorption_per_m: 0.4,
        scattering_per_m: 3.6,
    };
    scene(camera)
        .filled(standing([0.0; 2], -0.5, [0.5; 3], 0.0), medium)
        .lit(Light::Point {
            position_m: [0.4, -1.2, 0.9],
            intensity: 10.0,
        })
}
