//! Cameras, films, filters, samplers and integrators.

use super::*;

/// What every camera here has: the film of 40 × 20 pixels, and as good as no clipping planes.
const COMMON: &str = r#"
    <float name="near_clip" value="1e-4"/> <float name="far_clip" value="1e12"/>
    <film type="hdrfilm">
        <integer name="width" value="40"/> <integer name="height" value="20"/>
        <rfilter type="gaussian"><float name="stddev" value="0.5"/><float name="radius" value="1.5"/></rfilter>
    </film>
    <sampler type="sobol"><integer name="sample_count" value="16"/></sampler>"#;

const FILM: &str = r#"Film "rgb" "integer xresolution" 40 "integer yresolution" 20
"#;

#[track_caller]
fn assert_camera(pbrt: &str, own: &str, plugin: &str) {
    let sensor = format!("<sensor type=\"{plugin}\">{own}{COMMON}</sensor>");
    assert_same(&format!("{FILM}{pbrt}\nWorldBegin"), &sensor);
}

#[test]
fn the_camera_space_is_mirrored() {
    assert_camera(
        r#"LookAt 3 4 1.5  0.5 0.5 0  0 0 1 Camera "perspective" "float fov" 45"#,
        r#"<float name="fov" value="45"/> <string name="fov_axis" value="smaller"/>
           <transform name="to_world"> <!-- `lookat` has +x to the left in a right-handed world -->
               <scale x="-1"/> <lookat origin="3, 4, 1.5" target="0.5, 0.5, 0" up="0, 0, 1"/>
           </transform>"#,
        "perspective",
    );
}

#[test]
fn a_lens_and_a_window() {
    assert_camera(
        r#"Camera "perspective" "float fov" 60 "float lensradius" 0.1 "float focaldistance" 3
           "float screenwindow" [ -1 3 0 2 ]"#,
        r#"<float name="aperture_radius" value="0.1"/> <float name="focus_distance" value="3"/>
           <float name="fov" value="98.213210701738"/> <string name="fov_axis" value="x"/>
           <float name="principal_point_offset_x" value="0.25"/>
           <float name="principal_point_offset_y" value="-0.5"/>
           <transform name="to_world"><scale x="-1"/></transform>"#,
        "thinlens",
    );
}

#[test]
fn the_scale_of_a_camera_is_that_of_its_lens() {
    assert_camera(
        r#"Scale -0.5 0.5 0.5 Camera "perspective" "float fov" 60 "float lensradius" 0.1 "float focaldistance" 3"#,
        r#"<float name="aperture_radius" value="0.2"/> <float name="focus_distance" value="6"/>
           <float name="fov" value="60"/> <string name="fov_axis" value="smaller"/>"#,
        "thinlens",
    );
}

#[test]
fn an_orthographic_window_is_part_of_the_pose() {
    assert_camera(
        r#"Translate 0 0 -2 Camera "orthographic" "float screenwindow" [ -1 3 0 2 ]"#,
        r#"<transform name="to_world">
               <scale x="2" y="2"/> <translate x="-1" y="1"/> <scale x="-1"/> <translate z="2"/>
           </transform>"#,
        "orthographic",
    );
}

/// pbrt sends its rays from the lens through the window at the distance that is sharp: ±1 of x is there at ±½.
#[test]
fn a_lens_of_an_orthographic_camera_sees_its_window_in_perspective() {
    assert_camera(
        r#"Camera "orthographic" "float lensradius" 0.1 "float focaldistance" 2
           "float screenwindow" [ -1 3 0 2 ]"#,
        r#"<float name="aperture_radius" value="0.1"/> <float name="focus_distance" value="2"/>
           <float name="fov" value="90"/> <string name="fov_axis" value="x"/>
           <float name="principal_point_offset_x" value="0.25"/>
           <float name="principal_point_offset_y" value="-0.5"/>
           <transform name="to_world"><scale x="-1"/></transform>"#,
        "thinlens",
    );
}

#[test]
fn exposure_is_a_response() {
    let text = r#"Film "rgb" "float iso" 200 Camera "perspective" "float shutterclose" 0.25
        WorldBegin"#;
    let document = sound(text);
    let sensor = children(&document.root)
        .into_iter()
        .find(|n| n.plugin.value == "perspective");
    let shown = shown(&sensor.expect("a sensor"));
    assert!(shown.contains("srf: spectrum 5.000000e-1"), "{shown}");
}

#[test]
fn windows_of_the_film_are_rounded_up() {
    let film = |parameters: &str| {
        let text = format!("{FILM} {parameters} WorldBegin");
        let document = sound(&text);
        let sensor = children(&document.root)
            .into_iter()
            .find(|n| n.plugin.value == "perspective");
        let film = children(&sensor.expect("a sensor"))
            .into_iter()
            .find(|n| n.plugin.value == "hdrfilm");
        shown(&film.expect("a film"))
    };
    let pixels = film(r#""integer pixelbounds" [ 5 50 2 3 ]"#);
    let parts = film(r#""float cropwindow" [ 0.11 1 0.1 0.15 ]"#);
    assert_eq!(pixels, parts);
    assert!(parts.contains("crop_offset_x: integer 5"), "{parts}");
    assert!(parts.contains("crop_width: integer 35"), "{parts}");
}

#[test]
fn filters() {
    let filter = |text: &str| {
        let document = sound(&format!("PixelFilter {text} WorldBegin"));
        let sensor = children(&document.root).remove(1);
        let film = children(&sensor).remove(0);
        shown(&children(&film).remove(0))
            .replace("\n    ", " ")
            .replace('\n', " ")
    };
    assert_eq!(filter("\"box\""), "rfilter box { }");
    assert_eq!(
        filter("\"triangle\""),
        "rfilter tent { radius: float 2.000000e0 }"
    );
    assert_eq!(
        filter("\"gaussian\" \"float xradius\" 2 \"float yradius\" 2"),
        "rfilter gaussian { stddev: float 5.000000e-1 }"
    );
    assert_eq!(
        filter("\"mitchell\" \"float B\" 0.5"),
        "rfilter mitchell { B: float 5.000000e-1 C: float 3.333333e-1 }"
    );
    let sinc = r#""sinc" "float xradius" 3 "float yradius" 3"#;
    assert_eq!(filter(sinc), "rfilter lanczos { lobes: integer 3 }");
    for (own, expected) in [
        (
            r#""sinc""#,
            "rfilter lanczos { lobes: integer 3 radius: float 4.000000e0 }",
        ),
        (
            r#""mitchell" "float xradius" 3 "float yradius" 3 "float B" 0.5 "float C" 0.25"#,
            "rfilter mitchell { B: float 5.000000e-1 C: float 2.500000e-1 radius: float 3.000000e0 }",
        ),
        (
            r#""box" "float xradius" 1 "float yradius" 1"#,
            "rfilter box { radius: float 1.000000e0 }",
        ),
    ] {
        assert_eq!(filter(own), expected);
    }
}

#[test]
fn samplers() {
    let sampler = |text: &str| {
        let document = sound(&format!("{text} WorldBegin"));
        let sensor = children(&document.root).remove(1);
        shown(&children(&sensor).remove(1))
            .replace("\n    ", " ")
            .replace('\n', " ")
    };
    assert_eq!(
        sampler(r#"Option "seed" 3 Sampler "halton" "integer pixelsamples" 8"#),
        "sampler sobol { sample_count: integer 8 seed: integer 3 }"
    );
    assert_eq!(
        sampler(r#"Sampler "stratified" "integer xsamples" 2 "bool jitter" false"#),
        "sampler stratified { jitter: boolean false sample_count: integer 8 }"
    );
    assert_eq!(
        sampler(r#"Sampler "independent""#),
        "sampler independent { sample_count: integer 4 }"
    );
    assert_eq!(
        sampler(r#"Integrator "mlt" "integer mutationsperpixel" 70"#),
        "sampler sobol { sample_count: integer 70 }"
    );
}

#[test]
fn integrators_count_segments() {
    let same = |pbrt: &str, xml: &str| assert_same(&format!("Integrator {pbrt} WorldBegin"), xml);
    let depth = |name: &str, more: &str| {
        format!(
            "<integrator type=\"{name}\"><integer name=\"max_depth\" value=\"4\"/>{more}</integrator>"
        )
    };
    let deep = |name: &str| format!("\"{name}\" \"integer maxdepth\" 3");
    for name in ["path", "volpath", "simplepath", "simplevolpath"] {
        same(&deep(name), &depth("path", ""));
    }
    same(&deep("lightpath"), &depth("ptracer", ""));
    same(&deep("bdpt"), &depth("bdpt", ""));
    let uniform = r#"<string name="directions" value="uniform"/>"#;
    same(&deep("randomwalk"), &depth("naive", uniform));
    same(
        &deep("mlt"),
        &depth("mmlt", r#"<float name="large_step" value="0.3"/>"#),
    );
    same(
        &deep("sppm"),
        &depth("sppm", r#"<float name="radius" value="1"/>"#),
    );
    same(
        r#""ambientocclusion" "bool cossample" false "float maxdistance" 2"#,
        r#"<integrator type="ao"><string name="sampling" value="uniform"/><float name="distance" value="2"/></integrator>"#,
    );
    same(
        r#""simplepath" "bool samplelights" false"#,
        r#"<integrator type="naive"><integer name="max_depth" value="6"/></integrator>"#,
    );
}

#[test]
fn the_command_line_replaces_the_integrator() {
    let options = ReadOptions {
        integrator: Some("bdpt".to_owned()),
        ..ReadOptions::default()
    };
    let outcome = pbrt::read_text("a.pbrt", "Integrator \"sppm\" WorldBegin", &options);
    assert_eq!(outcome.lines(), "");
    let expected =
        xml("<integrator type=\"bdpt\"><integer name=\"max_depth\" value=\"6\"/></integrator>");
    assert_alike(&outcome.document.expect("a document"), &expected);
}

#[test]
fn films_of_other_kinds() {
    let film_of = |text: &str| {
        let root = sound(&format!("{text} WorldBegin")).root;
        let sensor = children(&root)
            .into_iter()
            .find(|n| n.class.name() == "sensor");
        let parts = children(&sensor.expect("a sensor")).into_iter();
        parts
            .into_iter()
            .find(|n| n.class.name() == "film")
            .expect("a film")
    };
    let balanced = shown(&film_of(r#"Film "rgb" "float whitebalance" 3200"#));
    assert!(
        balanced.contains("white_balance: float 3.200000e3"),
        "{balanced}"
    );
    let film = film_of(
        r#"Film "spectral" "integer nbuckets" 2 "float lambdamin" 400 "float lambdamax" 500"#,
    );
    let bands: Vec<&str> = film
        .properties
        .iter()
        .map(|p| p.name.as_str())
        .filter(|n| n.starts_with("S0"))
        .collect();
    assert_eq!(bands, ["S0.425,000nm", "S0.475,000nm"]);
    let notes = |text: &str| read(&format!("{text} WorldBegin")).lines();
    assert!(
        notes(r#"Film "rgb" "string sensor" "nikon_d850""#)
            .contains("stands in for the sensor `nikon_d850`")
    );
    assert!(notes(r#"Film "gbuffer""#).contains("note: the film `gbuffer` is one of colours"));
}

/// pbrt looks forward at u = ¼ of an equirectangular picture, and to the right at its left edge.
#[test]
fn panoramas() {
    let pose = |text: &str| {
        let root = sound(&format!("{FILM}{text} WorldBegin")).root;
        let sensor = children(&root)
            .into_iter()
            .find(|n| n.plugin.value == "spherical")
            .expect("a camera");
        let to_world = sensor.properties.iter().find_map(|p| match &p.value {
            Value::Transform(matrix) => Some(*matrix),
            _ => None,
        });
        to_world.expect("a pose")
    };
    let latitudes = pose(r#"Camera "spherical" "string mapping" "equirectangular""#);
    // Etalon's directions at the left edge and at u = ¼.
    let [edge, quarter] = [-glam::DVec3::Z, glam::DVec3::X].map(|d| latitudes.transform_vector3(d));
    assert_eq!([edge, quarter], [glam::DVec3::X, glam::DVec3::Z]);
    let areas = pose(r#"Camera "spherical""#);
    assert_eq!(areas.transform_vector3(glam::DVec3::X), -glam::DVec3::X);
}
