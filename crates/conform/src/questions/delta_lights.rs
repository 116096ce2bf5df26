//! A diffuse floor under lights without extent.
//!
//! L = ρ E/π, with E = I h/d³ or E = E⊥ cos θ.

use super::stage::{GREY, PIXELS, down, floor, scene};
use crate::pose::Freedom;
use crate::question::Question;
use crate::scene::{Falloff, Light, Scene, Triple};
use crate::truth::Picture;
use crate::truth::delta_lights::{fall_off, inverse_square, parallel};
use etalon_math::float64::{cos, sin, tan};
use std::f64::consts::PI;

pub(super) const POINT: Question = Question {
    name: "point-light",
    title: "A floor aside of a point light",
    formula: "ρ/π I h/d³",
    source: "Lambert, Photometria, 1760",
    freedom: Freedom::Any,
    samples: 16,
    ask: point,
};

pub(super) const SPOT: Question = Question {
    name: "spot-light",
    title: "A floor on the axis of a spot light",
    ask: || spot([0.1, 0.0, 0.0], [20.0, 30.0]),
    ..POINT
};

pub(super) const SPOT_ASIDE: Question = Question {
    name: "spot-light-off-axis",
    title: "A floor within the even cone of a spot light, 40 degrees off its axis",
    ask: || spot([-0.676, 0.0, 0.0], [60.0, 75.0]),
    ..POINT
};

pub(super) const SPOT_LINEAR: Question = Question {
    name: "spot-falloff-linear",
    title: "A floor under a spot light that falls off linearly in the angle",
    formula: "ρ/π I t h/d³, t = (c − θ)/(c − b)",
    source: "Jakob, Mitsuba renderer, 2010",
    ask: || fading(Falloff::LinearInAngle),
    ..POINT
};

pub(super) const SPOT_SMOOTH: Question = Question {
    name: "spot-falloff-smooth",
    title: "The same, with a smooth step in the angle's cosine",
    formula: "ρ/π I t²(3 − 2t) h/d³, t = (cos θ − cos c)/(cos b − cos c)",
    source: "Pharr, Jakob and Humphreys, Physically Based Rendering, 2023, section 12.2.1",
    ask: || fading(Falloff::SmoothInCosine),
    ..POINT
};

pub(super) const SPOT_QUARTIC: Question = Question {
    name: "spot-falloff-quartic",
    title: "The same, with the fourth power in the angle's cosine",
    formula: "ρ/π I t⁴ h/d³, t = (cos θ − cos c)/(cos b − cos c)",
    source: "Pharr, Jakob and Humphreys, Physically Based Rendering, 2016, section 12.3.2",
    ask: || fading(Falloff::QuarticInCosine),
    ..POINT
};

pub(super) const SUN: Question = Question {
    name: "sun",
    title: "A floor under a sun 40 degrees from the zenith",
    formula: "ρ/π E cos θ",
    ask: sun,
    ..POINT
};

/// The lights stand here, and the windows about (0.1, 0).
const LIGHT: Triple = [0.0, 0.0, 1.0];

fn point() -> (Scene, Picture) {
    let scene = scene(down([0.7, -0.4, 0.0], 0.4))
        .with(floor(0.0), GREY)
        .lit(Light::Point {
            position_m: LIGHT,
            intensity: 2.0,
        });
    let truth = Picture::of(PIXELS, |u, v| {
        0.5 * 2.0 / PI * inverse_square(LIGHT, [0.7 + 0.2 * u, 0.2 * v - 0.4])
    });
    (scene, truth)
}

/// The window lies within the first of the two angles, where the light is that of a point.
fn spot(target: Triple, [even, dark]: [f64; 2]) -> (Scene, Picture) {
    let scene = scene(down([0.1, 0.0, 0.0], 0.2))
        .with(floor(0.0), GREY)
        .lit(Light::Spot {
            position_m: LIGHT,
            target_m: target,
            intensity: 1.0,
            even_to_degrees: even,
            dark_from_degrees: dark,
            falloff: None,
        });
    let truth = Picture::of(PIXELS, |u, v| {
        0.5 / PI * inverse_square(LIGHT, [0.1 + 0.1 * u, 0.1 * v])
    });
    (scene, truth)
}

/// The axis leans by 20 degrees. All of the window, which is 0.2 m wide, lies between the two angles.
fn fading(falloff: Falloff) -> (Scene, Picture) {
    let (axis, angles) = ([tan(20f64.to_radians()), 0.0], [10.0, 40.0]);
    let place = |u: f64, v: f64| [0.1 * u, 0.1 * v];
    let scene = scene(down([0.0; 3], 0.2))
        .with(floor(0.0), GREY)
        .lit(Light::Spot {
            position_m: LIGHT,
            target_m: [axis[0], axis[1], 0.0],
            intensity: 1.0,
            even_to_degrees: angles[0],
            dark_from_degrees: angles[1],
            falloff: Some(falloff),
        });
    let truth = Picture::of(PIXELS, |u, v| {
        let share = fall_off(falloff, LIGHT, axis, angles, place(u, v));
        0.5 / PI * share * inverse_square(LIGHT, place(u, v))
    });
    (scene, truth)
}

fn sun() -> (Scene, Picture) {
    let angle = 40f64.to_radians();
    let direction = [sin(angle), 0.0, -cos(angle)];
    let scene = scene(down([0.0; 3], 0.2))
        .with(floor(0.0), GREY)
        .lit(Light::Sun {
            direction,
            irradiance: 1.0,
        });
    (scene, Picture::even(PIXELS, 0.5 / PI * parallel(direction)))
}
