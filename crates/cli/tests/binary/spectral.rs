//! Films with bands, cameras with curves of their own, and filters in front of them.

use crate::workshop::{Workshop, mean_of};
use etalon_film::RenderedImage;
use etalon_spectrum::sensor::response;
use glam::Vec4;

/// A scene that is the same radiance everywhere, seen by this film and with this in the sensor.
fn sky(radiance: &str, film: &str, further: &str) -> String {
    let size = "<integer name=\"width\" value=\"16\"/><integer name=\"height\" value=\"12\"/>";
    format!(
        "<scene version=\"3.0.0\">
    <sensor type=\"perspective\">{further}
        <film {film}{size}<rfilter type=\"box\"/></film>
        <sampler type=\"independent\"><integer name=\"sample_count\" value=\"64\"/></sampler>
    </sensor>
    <emitter type=\"constant\"><spectrum name=\"radiance\" {radiance}/></emitter>
</scene>"
    )
}

const UNIT: &str = "value=\"2\"";

/// Five bands, two groups; their areas are 100, 50, 40, 60 and 390.
const BANDS: &str = "type=\"specfilm\">
    <spectrum name=\"z\" value=\"400:1, 500:1\"/>
    <spectrum name=\"a\" value=\"500:0, 550:1, 600:0\"/>
    <spectrum name=\"m\" value=\"600:1, 640:1\"/>
    <spectrum name=\"nir\" value=\"700:0, 760:1, 820:0\"/>
    <spectrum name=\"all\" value=\"400:1, 790:1\"/>";

/// A channel's mean over the picture is this, within four standard errors (α = 10⁻⁴ each; pixels are independent) and a
/// part in a thousand for what curves lose between nanometres.
#[track_caller]
fn shows(image: &RenderedImage, name: &str, expected: f64) {
    let (mean, error) = mean_of(image, name);
    assert!(error < 0.02 * expected, "{name}: too noisy, {error}");
    let off = (mean - expected).abs();
    assert!(
        off < 4.0 * error + 1e-3 * expected,
        "{name}: {mean} ± {error}, not {expected}"
    );
}

#[test]
fn a_spectral_film_has_a_channel_for_each_band() {
    for integrator in ["path", "bdpt"] {
        let workshop = Workshop::new();
        workshop.write("s.xml", sky(UNIT, BANDS, ""));
        let further = ["-o", "a.exr", "-q", "--integrator", integrator];
        workshop
            .run(&[&["render", "s.xml"], &further[..]].concat())
            .fine();
        let image = workshop.image("a.exr");
        let metadata = image.metadata.as_ref().expect("ours");
        assert_eq!(metadata.colours(), ["z", "a", "m", "nir", "all"]);
        assert_eq!(metadata.film.pixel_format, "bands");
        // The mutant that draws bands of one group for another is off by half and more.
        for (name, area) in [
            ("z", 100.0),
            ("a", 50.0),
            ("m", 40.0),
            ("nir", 60.0),
            ("all", 390.0),
        ] {
            shows(&image, name, 2.0 * area);
        }
    }
}

#[test]
fn parts_of_spectral_images_make_up_the_whole() {
    let workshop = Workshop::new();
    workshop.write("s.xml", sky(UNIT, BANDS, ""));
    let render = |output: &str, further: &[&str]| {
        let common = [
            "render",
            "s.xml",
            "-q",
            "--integrator",
            "bdpt",
            "-o",
            output,
        ];
        workshop.run(&[&common, further].concat()).fine();
    };
    render("whole.exr", &[]);
    render("a.exr", &["--part", "1/2"]);
    render("b.exr", &["--part", "2/2"]);
    workshop
        .run(&["merge", "-o", "m.exr", "a.exr", "b.exr"])
        .fine();
    assert!(workshop.read("m.exr") == workshop.read("whole.exr"));
    render("other.exr", &["--seed", "1"]);
    let ran = workshop.run(&["compare", "m.exr", "other.exr", "--json"]);
    assert!(ran.stdout.contains("\"nir\""), "{}", ran.stdout);
    workshop
        .run(&["convert", "m.exr", "m.png", "--channels", "nir"])
        .fine();
    render("aimed.exr", &["--error", "0.05"]);
}

#[test]
fn a_filter_in_front_of_the_sensor_takes_its_share() {
    let workshop = Workshop::new();
    let hdrfilm = "type=\"hdrfilm\">";
    let filter = "<spectrum name=\"srf\" value=\"400:1, 449.9:1, 450:0.25, 830:0.25\"/>";
    for (name, film, filter) in [
        ("a", BANDS, filter),
        ("b", hdrfilm, filter),
        ("c", hdrfilm, ""),
    ] {
        workshop.write("s.xml", sky(UNIT, film, filter));
        let output = format!("{name}.exr");
        workshop
            .run(&["render", "s.xml", "-q", "-o", &output])
            .fine();
    }
    let bands = workshop.image("a.exr");
    // Half of the band lies below 450 nm.
    shows(&bands, "z", 2.0 * (50.0 + 12.5));
    shows(&bands, "nir", 2.0 * 60.0 * 0.25);
    // Of green, by its curve; which is below zero in blue.
    let mean = |file: &str| {
        let image = workshop.image(file);
        let plane = image.image.channel("G").expect("green").to_vec();
        plane.iter().map(|&x| f64::from(x)).sum::<f64>() / plane.len() as f64
    };
    let share = mean("b.exr") / mean("c.exr");
    let (passed, all) = (360..=830).fold((0.0, 0.0), |(passed, all), nm| {
        let green = f64::from(response(Vec4::splat(nm as f32))[1].x);
        let filter = match nm {
            400..450 => 1.0,
            450.. => 0.25,
            _ => 0.0,
        };
        (passed + filter * green, all + green)
    });
    assert!((share / (passed / all) - 1.0).abs() < 0.01, "{share}");
}

#[test]
fn daylight_is_white_to_every_camera() {
    let workshop = Workshop::new();
    let curves = "type=\"hdrfilm\">
        <spectrum name=\"response_red\" value=\"560:0, 600:0.8, 690:0\"/>
        <spectrum name=\"response_green\" value=\"470:0, 530:1, 610:0\"/>
        <spectrum name=\"response_blue\" value=\"400:0, 450:0.6, 520:0\"/>";
    for (name, light) in [("day", "type=\"d65\""), ("flat", UNIT)] {
        workshop.write("s.xml", sky(light, curves, ""));
        let output = format!("{name}.exr");
        workshop
            .run(&["render", "s.xml", "-q", "-o", &output])
            .fine();
    }
    for name in ["R", "G", "B"] {
        shows(&workshop.image("day.exr"), name, 1.0);
    }
    // ∫ 2 c dλ over ∫ D65 c dλ, D65 with luminance 1, by the trapezoid rule over whole nanometres.
    let flat = workshop.image("flat.exr");
    let d65 = etalon_spectrum::Spectrum::d65(1.0).expect("daylight");
    let curve = |[begin, top, end]: [f64; 3], x: f64| {
        ((x - begin) / (top - begin))
            .min((end - x) / (end - top))
            .max(0.0)
    };
    for (name, at) in [
        ("R", [560.0, 600.0, 690.0]),
        ("G", [470.0, 530.0, 610.0]),
        ("B", [400.0, 450.0, 520.0]),
    ] {
        let nanometres = (360..=830).map(f64::from);
        let (flat_sum, day_sum) = nanometres.fold((0.0, 0.0), |(flat, day), x| {
            (
                flat + 2.0 * curve(at, x),
                day + d65.eval_at(x) * curve(at, x),
            )
        });
        shows(&flat, name, flat_sum / day_sum);
    }
}

#[test]
fn the_integrators_own_channels_have_no_place_in_bands() {
    let workshop = Workshop::new();
    let aov = "<integrator type=\"aov\"><string name=\"aovs\" value=\"d:depth\"/></integrator>";
    let scene = sky(UNIT, BANDS, "").replacen("<sensor", &format!("{aov}<sensor"), 1);
    workshop.write("s.xml", scene);
    let ran = workshop.run(&["render", "s.xml", "-o", "a.exr"]).refused();
    assert!(
        ran.stderr.contains("a channel for each band"),
        "{}",
        ran.stderr
    );
}
