//! A diffuse floor lit by a whole rectangle: the radiance of a pixel is ρ L F, with F the form factor from the pixel to the
//! rectangle, so that no pixel needs a rule of integration.

use super::stage::{BLACK, GREY, PIXELS, down, floor, scene};
use crate::pose::Freedom;
use crate::question::Question;
use crate::scene::{Scene, Shape};
use crate::truth::Picture;
use crate::truth::form_factors::{Ends, parallel, perpendicular};

pub(super) const PARALLEL: Question = Question {
    name: "form-factor-parallel",
    title: "A square of a floor opposite to a glowing square of the same size",
    formula: "ρ L/A Σ (−1)^(i+j+k+l) G(xᵢ, yⱼ, η_k, ξ_l)",
    source: "Ehlert and Smith, View factors for perpendicular and parallel rectangular plates, 1993",
    freedom: Freedom::Any,
    samples: 256,
    ask: opposite,
};

pub(super) const PERPENDICULAR: Question = Question {
    name: "form-factor-perpendicular",
    title: "A square of a floor at the foot of a glowing square",
    samples: 512,
    ask: at_the_foot,
    ..PARALLEL
};

/// The squares are 2 m wide and 1 m apart; the camera stands between them.
fn opposite() -> (Scene, Picture) {
    let light = Shape::Quad {
        center_m: [0.0, 0.0, 1.0],
        half_u_m: [1.0, 0.0, 0.0],
        half_v_m: [0.0, -1.0, 0.0],
    };
    let scene = scene(down([0.0; 3], 2.0))
        .with(floor(0.0), GREY)
        .glowing(light, BLACK, 1.0);
    let ends = [-1.0, 1.0];
    let truth = by_pixel(|x, y| 0.5 * parallel(x, y, ends, ends, 1.0));
    (scene, truth)
}

/// The wall stands along the left edge of the picture, 2 m wide and high.
fn at_the_foot() -> (Scene, Picture) {
    let light = Shape::Quad {
        center_m: [-1.0, 0.0, 1.0],
        half_u_m: [0.0, 1.0, 0.0],
        half_v_m: [0.0, 0.0, 1.0],
    };
    let scene = scene(down([0.0; 3], 2.0))
        .with(floor(0.0), GREY)
        .glowing(light, BLACK, 1.0);
    let truth = by_pixel(|[left, right], y| {
        0.5 * perpendicular([left + 1.0, right + 1.0], y, [0.0, 2.0], [-1.0, 1.0])
    });
    (scene, truth)
}

/// The picture of 2 m about the origin from the ends of each pixel.
pub(super) fn by_pixel(mean: impl Fn(Ends, Ends) -> f64) -> Picture {
    let pixel = 2.0 / f64::from(PIXELS);
    let at = |i: u32| {
        let left = pixel * f64::from(i % PIXELS) - 1.0;
        let top = 1.0 - pixel * f64::from(i / PIXELS);
        mean([left, left + pixel], [top - pixel, top])
    };
    Picture::exact(PIXELS, (0..PIXELS * PIXELS).map(at).collect())
}
