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

/// Phong's equation under a lamp of one square metre, at one place of a floor, against its integral over the lamp on 400 x 400 cells:
///
/// ```text
/// ∫ L cos θ′ / r² (k_d cos θ + kₛ cosⁿ ρ) dA
/// ```
///
/// Grids and cells of 24 x 24 points are within 3 parts in a thousand; points by chance within five standard errors, which is
/// a false alarm in a million. Mutants rejected: a lamp taken at its middle (16 % off), cos θ′ left out, the highlight without its exponent.
#[test]
fn an_area_lamp_over_phong_is_its_integral() {
    let workshop = Workshop::new();
    let eye = [-1.6, -0.4, 1.1_f64];
    let (diffuse, specular, exponent) = (0.3, 0.5, 20.0_f64);
    let mut expected = 0.0;
    let cells = 400;
    for (i, j) in (0..cells).flat_map(|i| (0..cells).map(move |j| (i, j))) {
        let along = |k: i32| (f64::from(k) + 0.5) / f64::from(cells);
        let to = [1.0 + along(i), along(j) - 0.3, 1.5_f64];
        let squared: f64 = to.iter().map(|x| x * x).sum();
        let cos_lamp = to[2] / squared.sqrt();
        // The lamp's mirror image about the normal z, against the direction to the eye.
        let length = eye.iter().map(|x| x * x).sum::<f64>().sqrt();
        let mirrored = [-to[0], -to[1], to[2]];
        let dot: f64 = mirrored.iter().zip(eye).map(|(a, b)| a * b).sum();
        let highlight =
            etalon_math::float64::pow((dot / (length * squared.sqrt())).max(0.0), exponent);
        let shown = diffuse * cos_lamp + specular * highlight;
        expected += 3.0 * cos_lamp / squared * shown / f64::from(cells * cells);
    }
    let scene = |points: &str| {
        format!(
            "<scene version=\"3.0.0\"><integrator type=\"whitted\">{points}<integer name=\"wavelengths\" value=\"8\"/></integrator>\
             <sensor type=\"perspective\"><float name=\"fov\" value=\"0.01\"/><transform name=\"to_world\">\
             <lookat origin=\"{}, {}, {}\" target=\"0,0,0\" up=\"0,0,1\"/></transform>\
             <film type=\"hdrfilm\"><integer name=\"width\" value=\"1\"/><integer name=\"height\" value=\"1\"/>\
             <rfilter type=\"box\"/></film></sensor>\
             <shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"4\"/></transform><bsdf type=\"classicphong\">\
             <float name=\"diffuse\" value=\"{diffuse}\"/><float name=\"specular\" value=\"{specular}\"/>\
             <float name=\"exponent\" value=\"{exponent}\"/></bsdf></shape>\
             <shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"0.5\"/><rotate x=\"1\" angle=\"180\"/>\
             <translate x=\"1.5\" y=\"0.2\" z=\"1.5\"/></transform>\
             <emitter type=\"area\"><rgb name=\"radiance\" value=\"3\"/></emitter></shape></scene>",
            eye[0], eye[1], eye[2]
        )
    };
    for (placement, side, spp) in [
        ("grid", 24, "2"),
        ("stratified", 24, "8"),
        ("random", 4, "1024"),
    ] {
        let points = format!(
            "<integer name=\"light_samples\" value=\"{side}\"/><string name=\"light_sampling\" value=\"{placement}\"/>"
        );
        workshop.write("scene.xml", scene(&points));
        let file = format!("{placement}.exr");
        (workshop.run(&["render", "scene.xml", "-o", &file, "--spp", spp])).fine();
        let (found, error) = mean_of(&workshop.image(&file), "G");
        let allowed = if placement == "random" {
            5.0 * error
        } else {
            3e-3 * expected
        };
        assert!(
            (found - expected).abs() < allowed
                && (placement != "random" || error < 0.01 * expected),
            "{placement}: {found} +- {error} for {expected}"
        );
    }
}
