//! `subsurface` is a medium in a boundary, and gives back what it says it does.

use crate::workshop::{Workshop, ball_scene, luminance};

/// A ball under an even sky.
fn scene(ball: &str) -> String {
    let sky = "<emitter type=\"constant\"><spectrum name=\"radiance\" type=\"d65\"/></emitter>";
    let albedo = "<default name=\"albedo\" value=\"0.5\"/>";
    ball_scene(ball, &format!("{sky}{albedo}"))
}

const COEFFICIENTS: &str = "<spectrum name=\"sigma_a\" value=\"400:2, 700:1\"/>
    <spectrum name=\"sigma_s\" value=\"400:9, 700:7\"/><phase type=\"hg\"><float name=\"g\" value=\"0.3\"/></phase>";

#[test]
fn a_medium_in_the_same_boundary_is_the_same() {
    let index = "<float name=\"int_ior\" value=\"1.3\"/>";
    for (boundary, own, bsdf, further) in [
        (
            "diffuse",
            "",
            "difftrans",
            "<float name=\"transmittance\" value=\"1\"/>",
        ),
        ("smooth", index, "dielectric", index),
        ("rough", index, "roughdielectric", index),
    ] {
        let workshop = Workshop::new();
        let walk = format!(
            "<subsurface type=\"randomwalk\"><string name=\"boundary\" value=\"{boundary}\"/>{own}{COEFFICIENTS}</subsurface>"
        );
        let explicit = format!(
            "<bsdf type=\"{bsdf}\">{further}</bsdf><medium name=\"interior\" type=\"homogeneous\">{COEFFICIENTS}</medium>"
        );
        for (name, ball) in [("a", walk), ("b", explicit)] {
            workshop.write("s.xml", scene(&ball));
            let output = format!("{name}.exr");
            workshop
                .run(&["render", "s.xml", "-q", "-o", &output])
                .fine();
        }
        let [a, b] = ["a.exr", "b.exr"].map(|name| workshop.image(name).image);
        assert!(a == b, "{boundary}");
    }
}

/// The share of an even sky that a thick ball gives back is its `albedo`; to 1.5 %, as the ball is round and the fit is one,
/// and four standard errors (α = 10⁻⁴). The mutant that takes it for the albedo of single scattering is off by half.
#[test]
fn a_thick_piece_shows_its_albedo() {
    let workshop = Workshop::new();
    let ball = "<subsurface type=\"randomwalk\"><spectrum name=\"albedo\" value=\"$albedo\"/>
        <spectrum name=\"mean_free_path\" value=\"0.004\"/></subsurface>";
    workshop.write("s.xml", scene(ball));
    for albedo in [0.2, 0.5, 0.8, 1.0] {
        let define = format!("albedo={albedo}");
        let further = ["-D", &define, "--spp", "256", "-o", "a.exr", "-q"];
        workshop
            .run(&[&["render", "s.xml"], &further[..]].concat())
            .fine();
        let image = workshop.image("a.exr");
        let (mean, error) = luminance(&image);
        assert!(error < 0.01, "too noisy: {error}");
        let off = (mean - albedo).abs();
        assert!(
            off < 4.0 * error + 0.015 * albedo,
            "{albedo}: {mean} ± {error}"
        );
    }
}

/// A walk has the coefficients of where it enters: below a texture of one value it is the walk of that value, to the bit, and below
/// black and grey squares, far larger than the walk, it shows their mean (to four standard errors, α = 10⁻⁴). The mutant that keeps those
/// of the texture's first corner shows black or grey.
#[test]
fn a_walk_below_a_texture_has_the_matter_of_where_it_enters() {
    let workshop = Workshop::new();
    let squares = |name: &str, dark: f64, light: f64| {
        format!(
            "<texture name=\"{name}\" type=\"checkerboard\"><spectrum name=\"color0\" value=\"{dark}\"/>
            <spectrum name=\"color1\" value=\"{light}\"/><transform name=\"to_uv\"><scale value=\"200\"/></transform></texture>"
        )
    };
    let number = |name: &str, x: f64| format!("<spectrum name=\"{name}\" value=\"{x}\"/>");
    let picture = |albedo: &str, length: &str| {
        let ball = format!("<subsurface type=\"randomwalk\">{albedo}{length}</subsurface>");
        workshop.write("s.xml", scene(&ball));
        workshop
            .run(&["render", "s.xml", "--spp", "256", "-o", "a.exr", "-q"])
            .fine();
        workshop.image("a.exr")
    };
    let [even, length] = [number("albedo", 0.6), number("mean_free_path", 0.2)];
    let expected = picture(&even, &length).image;
    assert!(picture(&squares("albedo", 0.6, 0.6), &length).image == expected);
    assert!(picture(&even, &squares("mean_free_path", 0.2, 0.2)).image == expected);
    let short = number("mean_free_path", 0.0001);
    let (mean, error) = luminance(&picture(&squares("albedo", 0.0, 0.8), &short));
    assert!(error < 0.01, "too noisy: {error}");
    assert!((mean - 0.4).abs() < 4.0 * error + 0.01, "{mean} ± {error}");
    let ran = workshop.run(&["render", "s.xml", "-o", "b.exr", "--integrator", "bdpt"]);
    assert!(
        ran.code == Some(2) && ran.stderr.contains("where they begin"),
        "{}",
        ran.stderr
    );
}

/// What is open cannot hold what is below its surface: said, but not refused, as other shapes may close it.
#[test]
fn an_open_shape_with_something_below_its_surface_is_pointed_out() {
    let workshop = Workshop::new();
    let scene = |shape: &str| {
        let ball = "<subsurface type=\"randomwalk\"/>";
        ball_scene(ball, "<emitter type=\"constant\"/>").replace("\"sphere\"", shape)
    };
    for (shape, open) in [("\"rectangle\"", true), ("\"cube\"", false)] {
        workshop.write("s.xml", scene(shape));
        let ran = workshop.run(&["info", "s.xml"]).fine();
        let said =
            ran.stdout.contains("this shape is open") || ran.stderr.contains("this shape is open");
        assert_eq!(said, open, "{shape}: {}", ran.stderr);
    }
}

/// A thick ball of `burley` shows its `albedo`, which may vary over it: half the ball black and half 0.8 is half as bright, through glass
/// as below a diffuse boundary less what that mirrors; to 2.5 % and four standard errors (α = 10⁻⁴).
#[test]
fn a_diffusion_profile_shows_the_albedo_of_the_surface() {
    let halves = "<texture name=\"albedo\" type=\"checkerboard\"><spectrum name=\"color0\" value=\"0\"/>
        <spectrum name=\"color1\" value=\"0.8\"/><transform name=\"to_uv\"><scale value=\"200\"/></transform></texture>";
    let even = "<spectrum name=\"albedo\" value=\"0.6\"/>";
    let glass =
        "<string name=\"boundary\" value=\"rough\"/><float name=\"int_ior\" value=\"1.3\"/>";
    // Fₑ + A: a boundary of 1.3 mirrors 1.7 % of what arrives at a right angle, where the ball is seen.
    for (albedo, boundary, expected) in [(even, "", 0.6), (halves, "", 0.4), (even, glass, 0.643)] {
        let ball = format!(
            "<subsurface type=\"burley\">{albedo}{boundary}<spectrum name=\"mean_free_path\" value=\"0.0001\"/></subsurface>"
        );
        let workshop = Workshop::new();
        workshop.write("s.xml", scene(&ball));
        workshop
            .run(&["render", "s.xml", "--spp", "256", "-o", "a.exr", "-q"])
            .fine();
        let (mean, error) = luminance(&workshop.image("a.exr"));
        assert!(error < 0.01, "too noisy: {error}");
        let off = (mean - expected).abs();
        assert!(
            off < 4.0 * error + 0.025 * expected,
            "{albedo} {boundary}: {mean} ± {error}"
        );
    }
}

#[test]
fn diffusion_profiles_are_for_paths_from_the_camera_and_say_how_biased_they_are() {
    let workshop = Workshop::new();
    workshop.write("s.xml", scene("<subsurface type=\"dipole\"/>"));
    let ran = workshop
        .run(&["render", "s.xml", "-o", "a.exr", "--spp", "1"])
        .fine();
    assert!(
        ran.stderr.contains("a diffusion profile is biased"),
        "{}",
        ran.stderr
    );
    for integrator in ["bdpt", "guided", "photonmap"] {
        let ran = workshop.run(&["render", "s.xml", "-o", "b.exr", "--integrator", integrator]);
        assert_eq!(ran.code, Some(2));
        assert!(
            ran.stderr.contains("`randomwalk`") || ran.stderr.contains("randomwalk"),
            "{}",
            ran.stderr
        );
    }
}

/// Through a sheet that is lit from one side, `multidipole` lets within 25 % as much light as a walk does, and gives back as much on the lit
/// side; `dipole`, which knows of no other side, lets less than half through (four standard errors, α = 10⁻⁴).
#[test]
fn a_slab_lets_light_through() {
    let workshop = Workshop::new();
    let lit = |kind: &str, from: f32| {
        let scene = format!(
            "<scene version=\"3.0.0\"><integrator type=\"volpath\"><integer name=\"max_depth\" value=\"2000\"/></integrator>
            <sensor type=\"orthographic\"><transform name=\"to_world\"><lookat origin=\"0, 0, {from}\" target=\"0, 0, 0\" up=\"0, 1, 0\"/></transform>
            <film type=\"hdrfilm\"><string name=\"pixel_format\" value=\"luminance\"/><integer name=\"width\" value=\"16\"/><integer name=\"height\" value=\"16\"/><rfilter type=\"box\"/></film></sensor>
            <emitter type=\"directional\"><vector name=\"direction\" x=\"0\" y=\"0\" z=\"-1\"/></emitter>
            <shape type=\"cube\"><transform name=\"to_world\"><scale x=\"60\" y=\"60\" z=\"2.5\"/></transform>
            <subsurface {kind}<float name=\"sigma_a\" value=\"0.1\"/><float name=\"sigma_s\" value=\"1\"/></subsurface></shape></scene>"
        );
        workshop.write("s.xml", scene);
        workshop
            .run(&["render", "s.xml", "--spp", "256", "-o", "a.exr", "-q"])
            .fine();
        let (mean, error) = luminance(&workshop.image("a.exr"));
        assert!(error < 0.03 * mean, "too noisy: {error} of {mean}");
        (mean, error)
    };
    let walk = [20.0, -20.0].map(|from| lit("type=\"randomwalk\">", from));
    let slab = "type=\"multidipole\"><float name=\"thickness\" value=\"5\"/>";
    for ((walk, e), from) in walk.into_iter().zip([20.0, -20.0]) {
        let (mean, error) = lit(slab, from);
        let tolerance = 0.25 * walk + 4.0 * (e + error);
        assert!((mean - walk).abs() < tolerance, "{from}: {mean} {walk}");
    }
    let (mean, _) = lit("type=\"dipole\">", -20.0);
    assert!(mean < 0.5 * walk[1].0, "{mean}");
}
