//! What a rough metal shows: microfacets of one distribution, by either of two rules of how they hide each other.

use super::stage::{PIXELS, floor, leaning, scene};
use crate::pose::Freedom;
use crate::question::Question;
use crate::scene::{Light, Masking, Material, Scene, Triple};
use crate::truth::Picture;
use crate::truth::rough_metal::RoughMetal;
use etalon_math::float64::{cos, sin};
use glam::DVec3;

pub(super) const HIGHLIGHT: Question = Question {
    name: "rough-metal-highlight",
    title: "A point light in a rough metal (GGX, α = 0.4), whose facets hide each other independently",
    formula: "F D I/(4 cos θo d² (1 + Λ(o)) (1 + Λ(i)))",
    source: "Walter, Marschner, Li and Torrance, Microfacet models for refraction through rough surfaces, 2007",
    freedom: Freedom::Any,
    samples: 64,
    ask: || highlight(Masking::Separable),
};

pub(super) const HIGHLIGHT_CORRELATED: Question = Question {
    name: "rough-metal-highlight-correlated",
    title: "The same, of facets that hide each other by their height",
    formula: "F D I/(4 cos θo d² (1 + Λ(o) + Λ(i)))",
    source: "Heitz, Understanding the masking-shadowing function in microfacet-based BRDFs, 2014, section 7.3",
    ask: || highlight(Masking::HeightCorrelated),
    ..HIGHLIGHT
};

pub(super) const SKY: Question = Question {
    name: "rough-metal-sky",
    title: "A rough metal (GGX, α = 0.5) under an even sky, seen at 60 degrees, whose facets hide each other independently",
    formula: "L ∫ F D/(4 cos θo (1 + Λ(o)) (1 + Λ(i))) dω",
    samples: 256,
    ask: || under_sky(Masking::Separable),
    ..HIGHLIGHT
};

pub(super) const SKY_CORRELATED: Question = Question {
    name: "rough-metal-sky-correlated",
    title: "The same, of facets that hide each other by their height",
    formula: "L ∫ F D/(4 cos θo (1 + Λ(o) + Λ(i))) dω",
    samples: 256,
    ask: || under_sky(Masking::HeightCorrelated),
    ..HIGHLIGHT_CORRELATED
};

/// The angle from the normal at which metals are seen (degrees).
const SEEN_AT: f64 = 60.0;

/// A weak one, whose reflectance changes so much with the angle that a wrong one is seen.
fn metal(alpha: f64, masking: Masking) -> RoughMetal {
    RoughMetal {
        n: 1.45,
        k: 0.75,
        alpha,
        masking,
    }
}

/// A floor of it.
fn on(metal: RoughMetal) -> Scene {
    let RoughMetal {
        n,
        k,
        alpha,
        masking,
    } = metal;
    let material = Material::RoughConductor {
        n,
        k,
        alpha,
        masking,
    };
    scene(leaning(SEEN_AT, 0.6)).with(floor(0.0), material)
}

/// The direction to the camera.
fn to_eye() -> DVec3 {
    let angle = SEEN_AT.to_radians();
    DVec3::new(sin(angle), 0.0, cos(angle))
}

/// The light stands 70 degrees off the normal, beyond the middle of the floor.
fn highlight(masking: Masking) -> (Scene, Picture) {
    const LIGHT: Triple = [-0.94, 0.05, 0.342];
    let metal = metal(0.4, masking);
    let scene = on(metal).lit(Light::Point {
        position_m: LIGHT,
        intensity: 1.0,
    });
    let truth = Picture::of(PIXELS, |u, v| {
        // Right in the picture is +y, and up is away from the camera.
        let place = DVec3::new(-0.3 * v / to_eye().z, 0.3 * u, 0.0);
        let to_light = DVec3::from(LIGHT) - place;
        metal.reflected(to_eye(), to_light.normalize()) / to_light.length_squared()
    });
    (scene, truth)
}

fn under_sky(masking: Masking) -> (Scene, Picture) {
    let metal = metal(0.5, masking);
    let seen = metal.under_even_sky(to_eye().z);
    (on(metal).under(1.0), Picture::even(PIXELS, seen))
}
