//! Where things are in the picture, and how sharp.
//!
//! A glowing rectangle whose edges fall within pixels shows flips, shifts by a pixel and wrong fields of view; one before the
//! plane in focus shows the lens.

use super::stage::{BLACK, PIXELS, along_y, scene};
use crate::pose::Freedom;
use crate::question::Question;
use crate::scene::{Camera, Projection, Scene, Shape};
use crate::truth::Picture;
use crate::truth::coverage::rectangle;
use crate::truth::thin_lens::{beyond_edge, confusion};
use etalon_math::float64::tan;
use std::f64::consts::PI;

pub(super) const PARALLEL: Question = Question {
    name: "registration",
    title: "A rectangle off the middle in parallel rays",
    formula: "the share of each pixel that it covers",
    source: "the definition of a box filter",
    freedom: Freedom::Any,
    samples: 512,
    ask: parallel,
};

pub(super) const PINHOLE: Question = Question {
    name: "perspective",
    title: "A rectangle off the axis of a pinhole of 60 degrees",
    samples: 256,
    ask: || pinhole(60.0, [0.3, 0.2], [0.5, 0.5]),
    ..PARALLEL
};

pub(super) const WIDE: Question = Question {
    name: "perspective-wide",
    title: "A rectangle off the axis of a pinhole of 100 degrees",
    ask: || pinhole(100.0, [0.9, -0.7], [1.2, 0.9]),
    ..PINHOLE
};

pub(super) const DEFOCUS: Question = Question {
    name: "defocus",
    title: "The middle of a small square that is out of focus",
    formula: "L 4h²/(π c²), c = R |1 − D/F|",
    source: "Potmesil and Chakravarty, A lens and aperture camera model, 1981",
    samples: 1024,
    ask: defocus,
    ..PARALLEL
};

pub(super) const DEFOCUS_EDGE: Question = Question {
    name: "defocus-edge",
    title: "A straight edge that is out of focus",
    formula: "L (acos s − s √(1 − s²))/π at the distance s c from the edge, c = R |1 − D/F|",
    samples: 512,
    ask: defocus_edge,
    ..DEFOCUS
};

/// In the plane y = 0, toward the camera.
fn upright([x, z]: [f64; 2], [half_x, half_z]: [f64; 2]) -> Shape {
    Shape::Quad {
        center_m: [x, 0.0, z],
        half_u_m: [half_x, 0.0, 0.0],
        half_v_m: [0.0, 0.0, half_z],
    }
}

/// Two metres before that plane.
fn toward_it(projection: Projection) -> Camera {
    Camera {
        origin_m: [0.0, -2.0, 0.0],
        target_m: [0.0; 3],
        up: [0.0, 0.0, 1.0],
        projection,
    }
}

/// The ends of a form, over half the width of what is seen.
fn ends(middle: f64, half: f64, half_width: f64) -> [f64; 2] {
    [(middle - half) / half_width, (middle + half) / half_width]
}

fn parallel() -> (Scene, Picture) {
    let ([x, z], [half_x, half_z]) = ([0.31, 0.17], [0.43, 0.29]);
    let form = upright([x, z], [half_x, half_z]);
    let scene = scene(along_y(2.0)).glowing(form, BLACK, 1.0);
    let truth = rectangle(PIXELS, ends(x, half_x, 1.0), ends(z, half_z, 1.0));
    (scene, truth)
}

fn pinhole(degrees: f64, [x, z]: [f64; 2], half: [f64; 2]) -> (Scene, Picture) {
    let camera = toward_it(Projection::Pinhole {
        field_of_view_degrees: degrees,
    });
    let scene = scene(camera).glowing(upright([x, z], half), BLACK, 1.0);
    let width = 2.0 * tan(0.5 * degrees.to_radians());
    let truth = rectangle(PIXELS, ends(x, half[0], width), ends(z, half[1], width));
    (scene, truth)
}

/// Radius of the lens, and the distance of its focus; things are at 2 m.
const LENS: [f64; 2] = [0.1, 4.0];

fn lens(degrees: f64) -> Camera {
    toward_it(Projection::ThinLens {
        field_of_view_degrees: degrees,
        lens_radius_m: LENS[0],
        focus_distance_m: LENS[1],
    })
}

/// Every pixel's circle holds all of the square: its corners are at 35 mm, the circle's radius is 50 mm, and its middle goes to
/// 12 mm in the corners of the picture.
fn defocus() -> (Scene, Picture) {
    let (half, radiance) = (0.025, 1.0);
    let scene = scene(lens(0.5)).glowing(upright([0.0; 2], [half; 2]), BLACK, radiance);
    let circle = confusion(LENS[0], 2.0, LENS[1]);
    let share = 4.0 * half * half / (PI * circle * circle);
    (scene, Picture::even(PIXELS, share * radiance))
}

/// All to the right of x = 13 mm glows.
fn defocus_edge() -> (Scene, Picture) {
    let (edge, degrees) = (0.013, 5.0);
    let form = upright([edge + 1.0, 0.0], [1.0; 2]);
    let scene = scene(lens(degrees)).glowing(form, BLACK, 1.0);
    let circle = confusion(LENS[0], 2.0, LENS[1]);
    let half_width = 2.0 * tan(0.5 * f64::to_radians(degrees));
    let truth = Picture::of_parts(PIXELS, 16, |u, _| {
        beyond_edge((edge - half_width * u) / circle)
    });
    (scene, truth)
}
