//! Matter that shines, and matter made of patterns.

use crate::workshop::{Workshop, ball_scene, luminance, mean_of};
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

/// A hidden lamp in the middle of matter that shines hides none of it, in closed form or by tentative collisions: within four standard
/// errors (α = 10⁻⁴). The mutant that begins to fly behind the lamp shows 1 − exp(−0.7).
#[test]
fn matter_before_a_hidden_lamp_is_seen() {
    let hide = "<boolean name=\"hide_emitters\" value=\"true\"/>";
    let lamp = "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"0.1\"/><rotate x=\"1\" angle=\"90\"/></transform>
        <emitter type=\"area\"><spectrum name=\"radiance\" value=\"1e-9\"/></emitter></shape>";
    let expected = 1.0 - exp(-2.0 * 0.7);
    for kind in ["homogeneous", "heterogeneous"] {
        let medium = format!(
            "<medium type=\"{kind}\" name=\"interior\"><float name=\"sigma_t\" value=\"0.7\"/><float name=\"albedo\" value=\"0\"/>
            <spectrum name=\"emission\" type=\"d65\"/></medium>"
        );
        let scene = matter(&medium, lamp).replace("</integrator>", &format!("{hide}</integrator>"));
        let (mean, error) = shown(&scene);
        assert!(
            error < 0.01 && (mean - expected).abs() < 4.0 * error,
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

/// A frosted glass ball of coloured matter, a ball of smoke with a fire in it, and a lamp, in fog around the camera.
fn foggy(integrator: &str, samples: u32) -> String {
    let fog =
        "<float name=\"sigma_t\" value=\"0.08\"/><rgb name=\"albedo\" value=\"0.9, 0.8, 0.6\"/>";
    let matter =
        "<rgb name=\"sigma_t\" value=\"1, 3, 8\"/><rgb name=\"albedo\" value=\"0.9, 0.8, 0.6\"/>
        <phase type=\"hg\"><float name=\"g\" value=\"0.7\"/></phase>";
    let smoke = "<texture name=\"sigma_t\" type=\"fbm\"/><float name=\"scale\" value=\"3\"/>
        <rgb name=\"albedo\" value=\"0.7, 0.7, 0.5\"/><rgb name=\"emission\" value=\"2, 1, 0.3\"/>";
    format!(
        "<scene version=\"3.0.0\">
    <integrator type=\"{integrator}\"><integer name=\"max_depth\" value=\"40\"/></integrator>
    <medium type=\"homogeneous\" id=\"fog\">{fog}</medium>
    <sensor type=\"thinlens\">
        <ref id=\"fog\"/>
        <float name=\"fov\" value=\"30\"/><float name=\"aperture_radius\" value=\"1\"/><float name=\"focus_distance\" value=\"6\"/>
        <transform name=\"to_world\"><lookat origin=\"0, -6, 2\" target=\"0, 0, 0.8\" up=\"0, 0, 1\"/></transform>
        <film type=\"hdrfilm\">
            <integer name=\"width\" value=\"12\"/><integer name=\"height\" value=\"8\"/><rfilter type=\"box\"/>
        </film>
        <sampler type=\"independent\"><integer name=\"sample_count\" value=\"{samples}\"/></sampler>
    </sensor>
    <shape type=\"rectangle\">
        <transform name=\"to_world\"><rotate x=\"1\" angle=\"110\"/><translate x=\"-1\" y=\"2\" z=\"3.5\"/></transform>
        <emitter type=\"area\"><rgb name=\"radiance\" value=\"4, 4, 5\"/></emitter>
    </shape>
    <shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"6\"/></transform></shape>
    <shape type=\"sphere\">
        <point name=\"center\" value=\"0.9, 0, 0.81\"/><float name=\"radius\" value=\"0.8\"/>
        <ref id=\"fog\" name=\"exterior\"/><medium type=\"homogeneous\" name=\"interior\">{matter}</medium>
        <bsdf type=\"roughdielectric\"><float name=\"alpha\" value=\"0.4\"/></bsdf>
    </shape>
    <shape type=\"sphere\">
        <point name=\"center\" value=\"-0.9, 0, 0.81\"/><float name=\"radius\" value=\"0.8\"/>
        <ref id=\"fog\" name=\"exterior\"/><medium type=\"heterogeneous\" name=\"interior\">{smoke}</medium>
        <bsdf type=\"null\"/>
    </shape>
</scene>"
    )
}

/// Mean and standard error of a band of the picture.
#[track_caller]
fn bands(integrator: &str, samples: u32) -> [(f64, f64); 3] {
    let workshop = Workshop::new();
    workshop.write("s.xml", foggy(integrator, samples));
    let ran = workshop
        .run(&["render", "s.xml", "-q", "--replicates", "16", "-o", "a.exr"])
        .fine();
    assert!(!ran.stderr.contains("not finite"), "{}", ran.stderr);
    let image = workshop.image("a.exr");
    ["R", "G", "B"].map(|band| mean_of(&image, band))
}

/// Whatever finds light in media finds the same: paths from the camera, particles, both joined, chains of either, learned
/// directions. Each band's mean is that of `path` within 4.5 standard errors of both (α = 10⁻⁵ each), and known to 4 %. Weights
/// without the density of stopping (σt), or particles that leave a lamp into empty space, are off by more than 15 %.
#[test]
fn all_estimators_find_the_same_light_in_media() {
    let expected = bands("path", 4096);
    for (integrator, samples) in [
        ("bdpt", 1024),
        ("ptracer", 8192),
        ("vcm", 1024),
        ("guided", 1024),
        ("pssmlt", 1024),
        ("mmlt", 2048),
    ] {
        let found = bands(integrator, samples);
        for (band, ((mean, error), (other, uncertain))) in
            found.into_iter().zip(expected).enumerate()
        {
            let sigma = (error * error + uncertain * uncertain).sqrt();
            assert!(
                sigma < 0.04 * other && (mean - other).abs() < 4.5 * sigma,
                "{integrator}, band {band}: {mean} against {other}, ± {sigma}"
            );
        }
    }
}

/// A shell of glass with matter in it, by surfaces between each two of air, glass and matter, or by `priority` of bodies that
/// overlap: both ways the same light, within four standard errors (α = 10⁻⁴) for `path` and `bdpt`. With the priorities the other
/// way round they are more than ten apart.
#[test]
fn overlapping_bodies_are_surfaces_between_each_two() {
    let glass = |inside: f64, outside: f64| {
        format!(
            "<bsdf type=\"dielectric\"><float name=\"int_ior\" value=\"{inside}\"/>
            <float name=\"ext_ior\" value=\"{outside}\"/></bsdf>"
        )
    };
    let sphere = |radius: f64, further: &str| {
        format!(
            "<shape type=\"sphere\"><float name=\"radius\" value=\"{radius}\"/>{further}</shape>"
        )
    };
    let priority = |number: i32| format!("<integer name=\"priority\" value=\"{number}\"/>");
    let matter = "<medium name=\"interior\" type=\"homogeneous\"><float name=\"sigma_t\" value=\"1.5\"/></medium>";
    let lit = |bodies: &str, integrator: &str| {
        let sky = "<emitter type=\"constant\"><spectrum name=\"radiance\" type=\"d65\"/></emitter>";
        let floor = "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"3\"/><translate z=\"-1.2\"/></transform></shape>";
        let tiny = ball_scene(
            "<float name=\"radius\" value=\"0.01\"/>",
            &format!("{sky}{floor}{bodies}"),
        );
        shown(
            &tiny
                .replace("\"volpath\"", &format!("\"{integrator}\""))
                .replace(
                    "value=\"0.5\"/>\n        <transform",
                    "value=\"25\"/>\n        <transform",
                ),
        )
    };
    let told = sphere(1.0, &glass(1.5, 1.0)) + &sphere(0.8, &(glass(1.33, 1.5) + matter));
    let hollow = format!(
        "<shape type=\"difference\">{}{}{}{}</shape>",
        sphere(1.0, ""),
        sphere(0.8, ""),
        glass(1.5, 1.0),
        priority(2)
    );
    let overlapping = hollow + &sphere(0.9, &(glass(1.33, 1.0) + matter + &priority(1)));
    let nested = sphere(1.0, &(glass(1.5, 1.0) + &priority(-1)))
        + &sphere(0.8, &(glass(1.33, 1.0) + matter + &priority(1)));
    let (expected, error) = lit(&told, "volpath");
    for (bodies, integrator) in [
        (&overlapping, "volpath"),
        (&nested, "volpath"),
        (&overlapping, "bdpt"),
    ] {
        let (mean, own) = lit(bodies, integrator);
        let both = (error * error + own * own).sqrt();
        assert!(
            both < 0.01 && (mean - expected).abs() < 4.0 * both,
            "{mean} ± {own}, {expected} ± {error}"
        );
    }
    let (mean, own) = lit(
        &overlapping.replace(
            "integer name=\"priority\" value=\"1\"",
            "integer name=\"priority\" value=\"3\"",
        ),
        "volpath",
    );
    assert!(
        (mean - expected).abs() > 10.0 * own,
        "{mean} ± {own}, {expected}"
    );
}

/// A lamp in thin matter shines on the way of a ray past it: looked for along the ray, its light is the same within four
/// standard errors (α = 10⁻⁴), and no noisier with a 64th of the samples. The mutant that weighs free flight without the other way is found
/// out by its noise, that which weighs the other way without free flight by 6.8 standard errors.
#[test]
fn light_looked_for_along_a_ray_is_the_same_with_less_noise() {
    let lamp = "<shape type=\"sphere\"><float name=\"radius\" value=\"0.03\"/><point name=\"center\" value=\"0.1, 0, 0\"/>
        <emitter type=\"area\"><spectrum name=\"radiance\" type=\"d65\"/></emitter></shape>";
    let kinds = [
        ("homogeneous", "<float name=\"sigma_t\" value=\"0.05\"/>"),
        (
            "heterogeneous",
            "<texture type=\"fbm\" name=\"sigma_t\"/><float name=\"scale\" value=\"0.1\"/>",
        ),
    ];
    for (kind, density) in kinds {
        let medium = format!("<medium type=\"{kind}\" name=\"interior\">{density}</medium>");
        let plain = matter(&medium, lamp);
        let looked_for = plain.replace(
            "<integrator type=\"volpath\">",
            "<integrator type=\"volpath\"><boolean name=\"equiangular\" value=\"true\"/>",
        );
        let [(mean, error), (expected, most)] = [shown(&looked_for), shown(&plain)];
        assert!(
            error < most / 3.0,
            "{kind}: {mean} ± {error}, {expected} ± {most}"
        );
        assert!(
            (mean - expected).abs() < 4.0 * (error * error + most * most).sqrt(),
            "{kind}: {mean} ± {error}, {expected} ± {most}"
        );
    }
}

/// Flakes that absorb nothing cannot be seen in an even sky, from whichever side, nor when paths are joined from both ends: within four
/// standard errors (α = 10⁻⁴).
#[test]
fn flakes_that_absorb_nothing_are_not_seen_in_an_even_sky() {
    let sky = "<emitter type=\"constant\"><spectrum name=\"radiance\" type=\"d65\"/></emitter>";
    for (kind, matrix) in [
        ("homogeneous", "1, 1, 0.02, 0, 0, 0"),
        ("homogeneous", "0.5, 0.02, 0.9, 0.05, 0, 0.1"),
        ("heterogeneous", "0.02, 1, 1, 0, 0, 0"),
    ] {
        let medium = format!(
            "<medium type=\"{kind}\" name=\"interior\"><float name=\"sigma_t\" value=\"1.5\"/><float name=\"albedo\" value=\"1\"/>
            <phase type=\"sggx\"><string name=\"S\" value=\"{matrix}\"/></phase></medium>"
        );
        for integrator in ["volpath", "bdpt"] {
            let scene = matter(&medium, sky).replace("\"volpath\"", &format!("\"{integrator}\""));
            let (mean, error) = shown(&scene);
            assert!(
                error < 0.01 && (mean - 1.0).abs() < 4.0 * error + 1e-4,
                "{kind}, {integrator}: {mean} ± {error}"
            );
        }
    }
}

/// Of a density k x² by a formula exp(−k/3) passes a unit cube along x, with whichever tracking: within four standard errors (α = 10⁻⁴). The
/// mutants that measure x from elsewhere, or take k for 2 π, are off by 20 and more.
#[test]
fn a_density_by_a_formula_has_its_integral() {
    let (k, workshop) = (2.0 * core::f64::consts::PI / 3.0, Workshop::new());
    for tracking in ["ratio", "raymarch"] {
        let step = if tracking == "raymarch" {
            "<float name=\"step\" value=\"0.02\"/>"
        } else {
            ""
        };
        workshop.write("s.xml", format!(
            "<scene version=\"3.0.0\"><default name=\"n\" value=\"8\"/><integrator type=\"volpath\"/>\
             <sensor type=\"orthographic\"><transform name=\"to_world\"><scale value=\"1/10\"/>\
             <lookat origin=\"-1,0,0\" target=\"0,0,0\" up=\"0,0,1\"/></transform><film type=\"hdrfilm\">\
             <integer name=\"width\" value=\"$n/2\"/><integer name=\"height\" value=\"2^2\"/><rfilter type=\"box\"/></film></sensor>\
             <shape type=\"cube\"><transform name=\"to_world\"><scale value=\"1/2\"/><translate x=\"0.5\"/></transform><bsdf type=\"null\"/>\
             <medium type=\"heterogeneous\" name=\"interior\"><string name=\"tracking\" value=\"{tracking}\"/>{step}\
             <volume type=\"expression\" name=\"sigma_t\"><float name=\"k\" value=\"2*pi/3\"/><string name=\"value\" value=\"k*x^2\"/></volume>\
             <float name=\"albedo\" value=\"0\"/></medium></shape><emitter type=\"constant\"/></scene>"
        ));
        workshop
            .run(&["render", "s.xml", "-q", "-o", "a.exr", "--spp", "4096"])
            .fine();
        let (mean, error) = mean_of(&workshop.image("a.exr"), "G");
        let expected = exp(-k / 3.0);
        assert!(
            (mean - expected).abs() < 4.0 * error + 1e-3 && error < 0.005,
            "{tracking}: {mean} ± {error} for {expected}"
        );
    }
}
