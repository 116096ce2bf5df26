//! A diffuse floor under a glowing sphere, near or far, large or tiny.
//!
//! L = ρ E/π with E = π L (r/d)² h/d. The sphere is at the origin, where single precision holds small coordinates, and the floor
//! below it.

use super::stage::{BLACK, GREY, PIXELS, down, floor, scene, sphere};
use crate::pose::Freedom;
use crate::question::Question;
use crate::scene::Scene;
use crate::truth::{Picture, irradiance};
use std::f64::consts::PI;

const FORMULA: &str = "ρ L (r/d)² h/d";
const SOURCE: &str =
    "Howell, Catalog of Radiation Heat Transfer Configuration Factors, configuration B-38";

pub(super) const LARGE: Question = Question {
    name: "sphere-light-large",
    title: "A floor under a sphere light of half its distance",
    formula: FORMULA,
    source: SOURCE,
    freedom: Freedom::Any,
    samples: 256,
    ask: || under(0.5, 1.0),
};

pub(super) const SMALL: Question = Question {
    name: "sphere-light-small",
    title: "A floor under a sphere light of a twentieth of its distance",
    samples: 64,
    ask: || under(0.05, 1.0),
    ..LARGE
};

pub(super) const TINY: Question = Question {
    name: "sphere-light-1e-4",
    title: "A floor under a sphere light of a ten thousandth of its distance",
    freedom: Freedom::AboutOrigin,
    samples: 64,
    ask: || under(1e-4, 1.0),
    ..LARGE
};

pub(super) const TINIEST: Question = Question {
    name: "sphere-light-1e-6",
    title: "A floor under a sphere light of a millionth of its distance",
    ask: || under(1e-6, 1.0),
    ..TINY
};

pub(super) const FAR: Question = Question {
    name: "sphere-light-far",
    title: "A floor ten kilometres below a sphere light of one metre",
    samples: 64,
    ask: far,
    ..LARGE
};

pub(super) const CUT: Question = Question {
    name: "sphere-light-cut",
    title: "A floor beside a sphere light that is half buried in it",
    formula: "ρ/π L [(cos ω acos y − x z) sin² σ + atan(z/x)]",
    source: "Snyder, Area light sources for real-time graphics, 1996",
    ask: cut,
    ..LARGE
};

/// The camera's window is by the origin, so that its place is exact.
fn far() -> (Scene, Picture) {
    let (r, h) = (1.0, 1e4);
    let radiance = h * h / (r * r);
    let scene = scene(down([0.0; 3], 0.2)).with(floor(0.0), GREY).glowing(
        sphere([0.3 * h, 0.0, h], r),
        BLACK,
        radiance,
    );
    let truth = Picture::of(PIXELS, |u, v| {
        0.5 * radiance / PI * irradiance::sphere(h, r, [0.1 * u - 0.3 * h, 0.1 * v])
    });
    (scene, truth)
}

fn cut() -> (Scene, Picture) {
    let (r, h, x) = (0.3, 0.1, 0.8);
    let scene = scene(down([x, 0.0, 0.0], 0.4))
        .with(floor(0.0), GREY)
        .glowing(sphere([0.0, 0.0, h], r), BLACK, 10.0);
    let truth = Picture::of(PIXELS, |u, v| {
        0.5 * 10.0 / PI * irradiance::sphere(h, r, [x + 0.2 * u, 0.2 * v])
    });
    (scene, truth)
}

/// Under a sphere of radius `r` at the height `h`, whose radiance makes up for its size.
fn under(r: f64, h: f64) -> (Scene, Picture) {
    let radiance = h * h / (r * r);
    let (x, half_width) = (0.3 * h, 0.1 * h);
    let scene = scene(down([x, 0.0, -h], 2.0 * half_width))
        .with(floor(-h), GREY)
        .glowing(sphere([0.0; 3], r), BLACK, radiance);
    let truth = Picture::of(PIXELS, |u, v| {
        let at = [x + half_width * u, half_width * v];
        0.5 * radiance / PI * irradiance::sphere(h, r, at)
    });
    (scene, truth)
}
