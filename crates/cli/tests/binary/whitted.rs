//! The course's ray tracer: caustics by photons, lenses that are looked through, and what is said of them.

use crate::workshop::{Workshop, mean_of};
use etalon_math::float64::cos;

/// A spot whose cone lies within a ball, over a floor that an orthographic camera sees between both, 4 m wide.
fn lamp_through_ball(integrator: &str, ball: &str, floor: &str) -> String {
    format!(
        "<scene version=\"3.0.0\">{integrator}\
         <sensor type=\"orthographic\"><transform name=\"to_world\"><scale x=\"2\" y=\"2\"/>\
         <lookat origin=\"0,0,0.9\" target=\"0,0,0\" up=\"0,1,0\"/></transform>\
         <float name=\"near_clip\" value=\"0.001\"/><film type=\"hdrfilm\"><integer name=\"width\" value=\"12\"/>\
         <integer name=\"height\" value=\"12\"/><rfilter type=\"box\"/></film></sensor>\
         <shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"2\"/></transform>{floor}</shape>\
         <shape type=\"sphere\"><point name=\"center\" x=\"0\" y=\"0\" z=\"2\"/><float name=\"radius\" value=\"0.5\"/>{ball}</shape>\
         <emitter type=\"spot\"><transform name=\"to_world\"><lookat origin=\"0,0,4\" target=\"0,0,0\" up=\"0,1,0\"/></transform>\
         <float name=\"cutoff_angle\" value=\"10\"/><float name=\"beam_width\" value=\"9.999\"/>\
         <rgb name=\"intensity\" value=\"10\"/></emitter></scene>"
    )
}

const PHOTONS: &str = "<integrator type=\"whitted\"><integer name=\"photons\" value=\"4000\"/>\
    <float name=\"radius\" value=\"0.1\"/><integer name=\"wavelengths\" value=\"12\"/>\
    <integer name=\"supersampling\" value=\"6\"/></integrator>";

/// All of the cone's flux, I 2π (1 − cos 10°), passes a classic ball of glass that is all transparent, and arrives on 16 m² of floor: the picture's
/// mean is k_d times that per area. A per cent is told apart (α = 10⁻⁶; the standard error is below a thousandth); mutants rejected: a kernel that
/// is not one over its disc, light that is lost where it is refracted, lamps that are seen through the ball as well.
#[test]
fn a_caustic_has_the_flux_that_arrives() {
    let workshop = Workshop::new();
    let glass = "<bsdf type=\"classicphong\"><float name=\"transparency\" value=\"1\"/></bsdf>";
    let expected = |share: f64| {
        let cone = 2.0 * core::f64::consts::PI * (1.0 - cos(10.0_f64.to_radians()));
        share * 10.0 * cone / 16.0
    };
    for (name, floor, share) in [
        (
            "classic",
            "<bsdf type=\"classicphong\"><float name=\"diffuse\" value=\"0.25\"/></bsdf>",
            0.25,
        ),
        (
            "bsdf",
            "<bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0.7853982\"/></bsdf>",
            0.25,
        ),
    ] {
        let file = format!("{name}.exr");
        workshop.write("scene.xml", lamp_through_ball(PHOTONS, glass, floor));
        workshop
            .run(&[
                "render",
                "scene.xml",
                "-o",
                &file,
                "--spp",
                "2",
                "--replicates",
                "2",
            ])
            .fine();
        let found = mean_of(&workshop.image(&file), "G").0;
        assert!(
            (found / expected(share) - 1.0).abs() < 0.01,
            "{name}: {found} for {}",
            expected(share)
        );
    }
    // The k nearest within it are right under even light, and some per cent off at the caustic's edges.
    let nearest = PHOTONS.replace(
        "<float name=\"radius\" value=\"0.1\"/>",
        "<float name=\"radius\" value=\"0.1\"/><integer name=\"nearest\" value=\"50\"/>",
    );
    let floor = "<bsdf type=\"classicphong\"><float name=\"diffuse\" value=\"0.25\"/></bsdf>";
    workshop.write("scene.xml", lamp_through_ball(&nearest, glass, floor));
    workshop
        .run(&[
            "render",
            "scene.xml",
            "-o",
            "k.exr",
            "--spp",
            "2",
            "--replicates",
            "2",
        ])
        .fine();
    let found = mean_of(&workshop.image("k.exr"), "G").0;
    assert!((found / expected(0.25) - 1.0).abs() < 0.08, "{found}");
}

/// A floor seen by a lens is told to be in focus unless the lens is looked through; without photons their parameters are refused.
#[test]
fn what_a_lens_does_not_do_is_said() {
    let workshop = Workshop::new();
    let scene = |integrator: &str, sensor: &str| {
        format!(
            "<scene version=\"3.0.0\"><integrator type=\"whitted\">{integrator}</integrator><sensor type=\"{sensor}</sensor>\
             <shape type=\"sphere\"/><emitter type=\"point\"/></scene>"
        )
    };
    let lens = "thinlens\"><float name=\"aperture_radius\" value=\"0.1\"/><float name=\"focus_distance\" value=\"3\"/>";
    let looked = "<integer name=\"lens_samples\" value=\"2\"/>";
    for (integrator, sensor, words) in [
        ("", lens, Some("through the middle of the lens alone")),
        (looked, lens, None),
        (
            looked,
            "perspective\">",
            Some("`lens_samples` has no effect"),
        ),
    ] {
        workshop.write("scene.xml", scene(integrator, sensor));
        let ran = workshop
            .run(&["render", "scene.xml", "-o", "x.exr", "--spp", "1"])
            .fine();
        let said = ran.stderr.split_whitespace().collect::<Vec<_>>().join(" ");
        match words {
            Some(words) => assert!(said.contains(words), "{said}"),
            None => assert!(!said.contains("lens"), "{said}"),
        }
    }
    workshop.write(
        "scene.xml",
        scene("<float name=\"radius\" value=\"0.1\"/>", lens),
    );
    let ran = workshop
        .run(&["render", "scene.xml", "-o", "x.exr"])
        .refused();
    assert!(
        ran.stderr
            .contains("`radius` has no effect without `photons`"),
        "{}",
        ran.stderr
    );
}
