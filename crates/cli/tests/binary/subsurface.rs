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

/// What is open cannot hold what is below its surface: said, but not refused, as other shapes may close it.
#[test]
fn an_open_shape_with_something_below_its_surface_is_pointed_out() {
    let workshop = Workshop::new();
    let scene = |shape: &str| {
        let ball = "<subsurface type=\"randomwalk\"/>";
        ball_scene(ball, "<emitter type=\"constant\"/>").replace("\"sphere\"", shape)
    };
    for (shape, open) in [("\"rectangle\"", true), ("\"cube\"", false)] {
        workshop.write("s.xml", &scene(shape));
        let ran = workshop.run(&["info", "s.xml"]).fine();
        let said =
            ran.stdout.contains("this shape is open") || ran.stderr.contains("this shape is open");
        assert_eq!(said, open, "{shape}: {}", ran.stderr);
    }
}
