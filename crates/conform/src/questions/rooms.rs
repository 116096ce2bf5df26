//! Diffuse bodies under an even sky, and closed rooms of light.
//!
//! A convex body under a sky of radiance L shows ρ L; a closed room that emits L everywhere shows L/(1 − ρ).

use super::stage::{BLACK, GREY, PIXELS, along_y, cube, inward_sphere, scene, sphere};
use crate::pose::Freedom;
use crate::question::Question;
use crate::scene::{Camera, Light, Material, Projection, Scene, Triple};
use crate::truth::Picture;
use crate::truth::furnace::closed;
use crate::truth::integrating_sphere::{about_ball, indirect, per_square, wall};
use etalon_math::float64::tan;
use std::f64::consts::PI;

pub(super) const FURNACE: Question = Question {
    name: "furnace",
    title: "A grey sphere under an even sky",
    formula: "ρ L",
    source: "Kirchhoff's law, 1860",
    freedom: Freedom::Any,
    samples: 256,
    ask: || under_sky(GREY, 0.5),
};

pub(super) const WHITE_FURNACE: Question = Question {
    name: "white-furnace",
    title: "A white sphere under an even sky cannot be seen",
    ask: || under_sky(Material::Diffuse { reflectance: 1.0 }, 1.0),
    ..FURNACE
};

pub(super) const DARK_ROOM: Question = Question {
    name: "glowing-room-0.2",
    title: "Inside a glowing sphere of reflectance 0.2",
    formula: "L/(1 − ρ)",
    ask: || round_room(0.2),
    ..FURNACE
};

pub(super) const GREY_ROOM: Question = Question {
    name: "glowing-room-0.5",
    title: "Inside a glowing sphere of reflectance 0.5",
    ask: || round_room(0.5),
    ..DARK_ROOM
};

pub(super) const ROOM_SIZES: Question = Question {
    name: "glowing-room-sizes",
    title: "Inside glowing spheres of many sizes, of reflectance 0.5",
    freedom: Freedom::EachAnew,
    ask: || round_room(0.5),
    ..DARK_ROOM
};

pub(super) const BRIGHT_ROOM: Question = Question {
    name: "glowing-room-0.8",
    title: "Inside a glowing sphere of reflectance 0.8",
    samples: 512,
    ask: || round_room(0.8),
    ..DARK_ROOM
};

pub(super) const CUBE_ROOM: Question = Question {
    name: "glowing-cube",
    title: "Inside a glowing cube of six squares",
    ask: || cube_room(0.5),
    ..DARK_ROOM
};

pub(super) const BRIGHT_CUBE_ROOM: Question = Question {
    name: "glowing-cube-0.8",
    title: "The same, and the squares reflect 0.8",
    ask: || cube_room(0.8),
    ..CUBE_ROOM
};

pub(super) const POINT_IN_SPHERE: Question = Question {
    name: "integrating-sphere-point",
    title: "A point light inside a white sphere, off its middle",
    formula: "ρ/π [I cos θ/d² + ρ/(1 − ρ) I/R²]",
    source: "Jacquez and Kuppenheim, Theory of the integrating sphere, 1955",
    samples: 256,
    ask: point_in_sphere,
    ..FURNACE
};

pub(super) const BALL_IN_SPHERE: Question = Question {
    name: "integrating-sphere-ball",
    title: "A black glowing ball in the middle of a white sphere",
    formula: "ρ L (r/R)²/(1 − ρ (1 − (r/R)²))",
    ask: ball_in_sphere,
    ..POINT_IN_SPHERE
};

/// The picture shows the sphere alone.
fn under_sky(material: Material, truth: f64) -> (Scene, Picture) {
    let scene = scene(along_y(1.0))
        .with(sphere([0.0; 3], 1.0), material)
        .under(1.0);
    (scene, Picture::even(PIXELS, truth))
}

/// From a place inside, off the middle, which the rooms have at the origin.
fn inside(origin: Triple) -> Camera {
    Camera {
        origin_m: origin,
        target_m: [origin[0], origin[1] + 1.0, origin[2]],
        up: [0.0, 0.0, 1.0],
        projection: Projection::Pinhole {
            field_of_view_degrees: 40.0,
        },
    }
}

fn round_room(reflectance: f64) -> (Scene, Picture) {
    let scene = scene(inside([0.1, -0.2, 0.05])).glowing(
        inward_sphere(1.0),
        Material::Diffuse { reflectance },
        1.0,
    );
    (scene, Picture::even(PIXELS, closed(1.0, reflectance)))
}

fn cube_room(reflectance: f64) -> (Scene, Picture) {
    let mut scene = scene(inside([0.1, -0.2, 0.05]));
    for (_, _, square) in cube() {
        scene = scene.glowing(square, Material::Diffuse { reflectance }, 1.0);
    }
    (scene, Picture::even(PIXELS, closed(1.0, reflectance)))
}

fn point_in_sphere() -> (Scene, Picture) {
    let (reflectance, intensity) = (0.8, 2.0);
    let (camera, lamp) = ([0.0, -0.5, 0.0], [0.3, 0.2, 0.4]);
    let scene = scene(inside(camera))
        .with(inward_sphere(1.0), Material::Diffuse { reflectance })
        .lit(Light::Point {
            position_m: lamp,
            intensity,
        });
    let slope = tan(20f64.to_radians());
    let truth = Picture::of(PIXELS, |u, v| {
        let point = wall(camera, [slope * u, 1.0, slope * v], 1.0);
        let direct = reflectance / PI * intensity * per_square(point, lamp, 1.0);
        direct + indirect(reflectance, intensity, 1.0)
    });
    (scene, truth)
}

fn ball_in_sphere() -> (Scene, Picture) {
    let (reflectance, ratio, radiance) = (0.9, 0.2, 25.0);
    let scene = scene(inside([0.0, 0.5, 0.0]))
        .with(inward_sphere(1.0), Material::Diffuse { reflectance })
        .glowing(sphere([0.0; 3], ratio), BLACK, radiance);
    let truth = radiance * about_ball(reflectance, ratio);
    (scene, Picture::even(PIXELS, truth))
}
