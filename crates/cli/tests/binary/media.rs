//! Matter that shines, and matter made of patterns.

use crate::workshop::Workshop;

/// A ball of matter before nothing, seen through its middle.
fn scene(medium: &str, further: &str) -> String {
    format!(
        "<scene version=\"3.0.0\">
    <integrator type=\"volpath\"><integer name=\"max_depth\" value=\"-1\"/></integrator>
    <sensor type=\"perspective\">
        <float name=\"fov\" value=\"0.5\"/>
        <transform name=\"to_world\"><lookat origin=\"0, -4, 0\" target=\"0, 0, 0\" up=\"0, 0, 1\"/></transform>
        <film type=\"hdrfilm\">
            <integer name=\"width\" value=\"8\"/><integer name=\"height\" value=\"8\"/><rfilter type=\"box\"/>
            <string name=\"pixel_format\" value=\"luminance\"/>
        </film>
        <sampler type=\"independent\"><integer name=\"sample_count\" value=\"256\"/></sampler>
    </sensor>{further}
    <shape type=\"sphere\"><bsdf type=\"null\"/>{medium}</shape>
</scene>"
    )
}

/// The mean of a picture's luminance, and its standard error.
#[track_caller]
fn luminance(scene: &str) -> (f64, f64) {
    let workshop = Workshop::new();
    workshop.write("s.xml", scene);
    let ran = workshop
        .run(&["render", "s.xml", "-q", "-o", "a.exr"])
        .fine();
    assert!(
        !ran.stderr.contains("nothing in this scene emits"),
        "{}",
        ran.stderr
    );
    let image = workshop.image("a.exr");
    let plane = image.image.channel("Y").expect("luminance");
    let errors = image.standard_error("Y").expect("errors");
    let count = plane.len() as f64;
    let mean = plane.iter().map(|&x| f64::from(x)).sum::<f64>() / count;
    let variance: f64 = errors.iter().map(|&s| f64::from(s).powi(2)).sum();
    (mean, variance.sqrt() / count)
}

/// Matter that only absorbs and emits has the radiance Lₑ (1 − exp(−2 σ R)) through the middle of a ball, whether it is flown
/// through in closed form or by tentative collisions: within four standard errors (α = 10⁻⁴). The mutant that emits σt Lₑ
/// where light is also scattered is found out by the third: half of it is scattered into nothing that comes back as much.
#[test]
fn matter_shines_as_much_as_it_absorbs() {
    let light = "<spectrum name=\"emission\" type=\"d65\"/>";
    let density = "<float name=\"sigma_t\" value=\"0.7\"/><float name=\"albedo\" value=\"0\"/>";
    let expected = 1.0 - (-2.0 * 0.7_f64).exp();
    for kind in ["homogeneous", "heterogeneous"] {
        let medium = format!("<medium type=\"{kind}\" name=\"interior\">{density}{light}</medium>");
        let (mean, error) = luminance(&scene(&medium, ""));
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
        let (mean, error) = luminance(&scene(&medium, sky));
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
    let (mean, error) = luminance(&scene(&medium, sky));
    let expected = (-2.0 * 2.0 * 0.3_f64).exp();
    assert!(
        error < 0.01 && (mean - expected).abs() < 4.0 * error,
        "{mean} ± {error}"
    );
}
