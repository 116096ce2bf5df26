//! Media in which no light is sampled: only where none enters straight.

use crate::reading::{LANES, scene};
use etalon_scene::Scene;
use etalon_transport::{Media, Medium, MediumId, World};

const SKY: &str = "<emitter type=\"constant\"/>";
const WALK: &str = "<subsurface type=\"randomwalk\"/>";
const MATTER: &str = "<medium type=\"homogeneous\" name=\"interior\"/>";

/// Whether the first medium of a scene is dark.
fn medium_is_dark(world: &Scene) -> bool {
    let medium = world.media().enter(MediumId(0), None, &LANES);
    medium.expect("a medium").is_dark()
}

/// Whether the medium of a ball of radius 1 is dark.
fn is_dark(shape: &str, below: &str, further: &str) -> bool {
    let world = scene(&format!("<shape type=\"{shape}\">{below}</shape>{further}"));
    medium_is_dark(&world)
}

#[test]
fn a_closed_shape_that_nothing_passes_straight_is_dark() {
    assert!(is_dark("sphere", WALK, SKY));
    assert!(is_dark(
        "cube",
        &format!("<bsdf type=\"dielectric\"/>{MATTER}"),
        SKY
    ));
    let beside =
        "<emitter type=\"point\"><point name=\"position\" value=\"0, 1.01, 0\"/></emitter>";
    assert!(is_dark("sphere", WALK, beside));
}

#[test]
fn what_light_may_enter_or_holds_a_lamp_is_not() {
    for bsdf in [
        "<bsdf type=\"null\"/>",
        "<bsdf type=\"thindielectric\"/>",
        "<bsdf type=\"mask\"><bsdf type=\"diffuse\"/></bsdf>",
    ] {
        assert!(
            !is_dark("sphere", &format!("{bsdf}{MATTER}"), SKY),
            "{bsdf}"
        );
    }
    assert!(!is_dark("rectangle", WALK, SKY), "open");
    for lamp in [
        "<emitter type=\"point\"><point name=\"position\" value=\"0, 0.5, 0\"/></emitter>",
        "<shape type=\"sphere\"><float name=\"radius\" value=\"0.1\"/><emitter type=\"area\"/></shape>",
        // It is around the ball as well as in it.
        "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"9\"/></transform><emitter type=\"area\"/></shape>",
    ] {
        assert!(!is_dark("sphere", WALK, lamp), "{lamp}");
    }
    let shared = "<medium type=\"homogeneous\" id=\"m\"/>";
    let beyond =
        "<shape type=\"sphere\"><bsdf type=\"null\"/><ref id=\"m\" name=\"exterior\"/></shape>";
    let ball =
        "<shape type=\"cube\"><bsdf type=\"dielectric\"/><ref id=\"m\" name=\"interior\"/></shape>";
    let world = scene(&format!("{shared}{ball}{beyond}{SKY}"));
    assert!(!medium_is_dark(&world), "also outside of another shape");
}
