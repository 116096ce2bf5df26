//! Matter that shines, and matter made of patterns.

use crate::workshop::{Workshop, ball_scene, luminance};
use etalon_math::float64::exp;

/// The picture's luminance, and its standard error.
#[track_caller]
fn shown(scene: &str) -> (f64, f64) {
    let workshop = Workshop::new();
    workshop.write("s.xml", scene);
    let ran = workshop
        .run(&["render", "s.xml", "-q", "-o", "a.exr"])
        .fine();
    let unlit = ran.stderr.contains("nothing in this scene emits");
    assert!(!unlit, "{}", ran.stderr);
    luminance(&workshop.image("a.exr"))
}

/// A ball of matter.
fn matter(medium: &str, further: &str) -> String {
    ball_scene(&format!("<bsdf type=\"null\"/>{medium}"), further)
}

/// Matter that only absorbs and emits has the radiance Lₑ (1 − exp(−2 σ R)) through the middle of a ball, whether it is flown
/// through in closed form or by tentative collisions: within four standard errors (α = 10⁻⁴). The mutant that emits σt Lₑ
/// where light is also scattered is found out by the third: half of it is scattered into nothing that comes back as much.
#[test]
fn matter_shines_as_much_as_it_absorbs() {
    let light = "<spectrum name=\"emission\" type=\"d65\"/>";
    let density = "<float name=\"sigma_t\" value=\"0.7\"/><float name=\"albedo\" value=\"0\"/>";
    let expected = 1.0 - exp(-2.0 * 0.7);
    for kind in ["homogeneous", "heterogeneous"] {
        let medium = format!("<medium type=\"{kind}\" name=\"interior\">{density}{light}</medium>");
        let (mean, error) = shown(&matter(&medium, ""));
        assert!(
            error < 0.01 && (mean - expected).abs() < 4.0 * error,
            "{kind}: {mean} ± {error}"
        );
    }
    // An even sky of the same radiance around it: matter in it, whatever it does, cannot be seen.
    let sky = "<emitter type=\"constant\"><spectrum name=\"radiance\" type=\"d65\"/></emitter>";
    for kind in ["homogeneous", "heterogeneous"] {
        let both = "<float name=\"sigma_t\" value=\"1.5\"/><float name=\"albedo\" value=\"0.5\"/>";
        let medium = format!("<medium type=\"{kind}\" name=\"interior\">{both}{light}</medium>");
        let (mean, error) = shown(&matter(&medium, sky));
        assert!(
            error < 0.01 && (mean - 1.0).abs() < 4.0 * error,
            "{kind}: {mean} ± {error}"
        );
    }
}

/// Light through a pattern is attenuated by its optical depth: that of a `mix` of two numbers in equal parts, twice as thick at the
/// second, through 2 m.
#[test]
fn densities_are_computed_from_others() {
    let sky = "<emitter type=\"constant\"><spectrum name=\"radiance\" type=\"d65\"/></emitter>";
    let density = "<texture name=\"sigma_t\" type=\"multiply\"><float name=\"a\" value=\"2\"/>
        <texture name=\"b\" type=\"mix\"><float name=\"a\" value=\"0.2\"/><float name=\"b\" value=\"0.4\"/></texture></texture>";
    let medium = format!(
        "<medium type=\"heterogeneous\" name=\"interior\">{density}<float name=\"albedo\" value=\"0\"/></medium>"
    );
    let (mean, error) = shown(&matter(&medium, sky));
    let expected = exp(-2.0 * 2.0 * 0.3);
    assert!(
        error < 0.01 && (mean - expected).abs() < 4.0 * error,
        "{mean} ± {error}"
    );
}
