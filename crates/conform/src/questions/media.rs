//! Matter without a surface: what it absorbs of a wall's or a sky's light, and that it loses nothing if it only scatters.

use super::stage::{BLACK, PIXELS, along_y, facing, scene, sphere};
use crate::pose::Freedom;
use crate::question::Question;
use crate::scene::{Camera, Medium, Projection, Scene, Shape};
use crate::truth::{Picture, absorption};
use etalon_math::float64::{cos, sin};

pub(super) const ABSORBER: Question = Question {
    name: "absorber",
    title: "A wall through a metre of matter that absorbs",
    formula: "exp(−σ d/cos θ) L",
    source: "Bouguer, Essai d'optique, 1729",
    freedom: Freedom::Any,
    samples: 1024,
    ask: || before_wall(0.0),
};

pub(super) const SLANTED: Question = Question {
    name: "absorber-slanted",
    title: "A wall through a slab that absorbs, seen at 40 degrees",
    ask: || before_wall(40.0),
    ..ABSORBER
};

pub(super) const BALL: Question = Question {
    name: "absorbing-ball",
    title: "A ball of matter that absorbs, under an even sky",
    formula: "exp(−2σ √(r² − a²)) L",
    ask: ball,
    ..ABSORBER
};

pub(super) const SCATTERER: Question = Question {
    name: "scattering-box",
    title: "A box of matter that only scatters, under an even sky, cannot be seen",
    formula: "L",
    source: "Kirchhoff's law, 1860",
    samples: 256,
    ask: scatterer,
    ..ABSORBER
};

/// A slab of 1 m, as wide and high as its ways need.
fn slab() -> Shape {
    Shape::Box {
        center_m: [0.0; 3],
        half_axes_m: [[1.0, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 1.0]],
    }
}

fn before_wall(degrees: f64) -> (Scene, Picture) {
    let angle = degrees.to_radians();
    let (sine, cosine) = (sin(angle), cos(angle));
    let camera = Camera {
        origin_m: [0.0, -3.0 * cosine, 3.0 * sine],
        target_m: [0.0; 3],
        up: [0.0, 0.0, 1.0],
        projection: Projection::Orthographic { width_m: 0.2 },
    };
    let behind = facing([0.0, 4.0 * cosine, -4.0 * sine], [0.0, -cosine, sine], 1.0);
    let medium = Medium {
        absorption_per_m: 1.0,
        scattering_per_m: 0.0,
    };
    let scene = scene(camera)
        .filled(slab(), medium)
        .glowing(behind, BLACK, 1.0);
    let truth = absorption::slab(1.0, 1.0, cosine);
    (scene, Picture::even(PIXELS, truth))
}

/// The picture lies within the ball, so that it has no edges.
fn ball() -> (Scene, Picture) {
    let medium = Medium {
        absorption_per_m: 0.5,
        scattering_per_m: 0.0,
    };
    let scene = scene(along_y(1.2))
        .filled(sphere([0.0; 3], 1.0), medium)
        .under(1.0);
    let truth = Picture::of(PIXELS, |u, v| {
        absorption::ball(0.5, 1.0, 0.6 * (u * u + v * v).sqrt())
    });
    (scene, truth)
}

fn scatterer() -> (Scene, Picture) {
    let medium = Medium {
        absorption_per_m: 0.0,
        scattering_per_m: 3.0,
    };
    let scene = scene(along_y(1.0)).filled(slab(), medium).under(1.0);
    (scene, Picture::even(PIXELS, 1.0))
}
