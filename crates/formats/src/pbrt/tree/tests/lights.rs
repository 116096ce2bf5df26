//! Lights.

use super::evaluated::Evaluated;
use super::*;
use etalon_transport::SpectrumKind;
use glam::{Vec3, Vec4};

#[track_caller]
fn assert_light(pbrt: &str, xml: &str) {
    assert_same_world(pbrt, xml);
}

#[test]
fn points_and_spots() {
    assert_light(
        r#"Translate 1 0 0 LightSource "point" "rgb I" [ 1 2 3 ] "float scale" 2 "point3 from" [ 0 5 0 ]"#,
        r#"<emitter type="point"><point name="position" x="1" y="5" z="0"/><rgb name="intensity" value="2 4 6"/></emitter>"#,
    );
    // 4π lumens make an intensity of 1.
    assert_light(
        r#"LightSource "point" "float power" 12.566370614359172"#,
        r#"<emitter type="point"><point name="position" x="0" y="0" z="0"/><float name="intensity" value="1"/></emitter>"#,
    );
    assert_light(
        r#"LightSource "spot" "point3 from" [ 0 0 2 ] "point3 to" [ 0 0 5 ] "float coneangle" 40 "float conedeltaangle" 10"#,
        r#"<emitter type="spot"><transform name="to_world"><rotate z="1" angle="0"/><translate z="2"/></transform>
            <float name="intensity" value="1"/><float name="cutoff_angle" value="40"/><float name="beam_width" value="30"/>
            <string name="falloff" value="smooth_in_cosine"/></emitter>"#,
    );
}

#[test]
fn light_from_far_away() {
    assert_light(
        r#"LightSource "distant" "point3 from" [ 0 3 4 ] "point3 to" [ 0 0 0 ] "float illuminance" 7"#,
        r#"<emitter type="directional"><vector name="direction" x="0" y="-0.6" z="-0.8"/><float name="irradiance" value="7"/></emitter>"#,
    );
    assert_light(
        r#"LightSource "infinite" "rgb L" [ 1 2 3 ] "float illuminance" 3.141592653589793"#,
        r#"<emitter type="constant"><rgb name="radiance" value="1 2 3"/></emitter>"#,
    );
}

#[test]
fn spectra_are_divided_by_their_luminance() {
    let constant = 2.0 / etalon_spectrum::cie::luminance(|_| 1.0);
    assert_light(
        r#"LightSource "infinite" "spectrum L" [ 300 5 900 5 ] "float scale" 2"#,
        &format!(
            r#"<emitter type="constant"><spectrum name="radiance" value="300:{constant}, 900:{constant}"/></emitter>"#
        ),
    );
    assert_light(
        r#"LightSource "infinite" "spectrum L" "stdillum-F11" "float scale" 2"#,
        r#"<emitter type="constant"><spectrum type="illuminant" name="radiance"><string name="name" value="F11"/>
            <float name="scale" value="2"/></spectrum></emitter>"#,
    );
    let document =
        sound("WorldBegin LightSource \"infinite\" \"blackbody L\" 3000 \"float scale\" 4");
    let light = children(&document.root).pop().expect("a light");
    let Some(Value::Spectrum(SpectrumText::Samples(pairs))) =
        light.properties.first().map(|p| &p.value)
    else {
        panic!("{}", shown(&light));
    };
    let (nm, values): (Vec<f64>, Vec<f64>) = pairs.iter().copied().unzip();
    let spectrum = etalon_spectrum::Spectrum::tabulated(&nm, &values).expect("a spectrum");
    assert!(
        (spectrum.luminance() - 4.0).abs() < 1e-3,
        "{}",
        spectrum.luminance()
    );
}

#[test]
fn other_colour_spaces() {
    let document =
        sound("WorldBegin ColorSpace \"rec2020\" LightSource \"infinite\" \"rgb L\" [ 2 2 2 ]");
    let light = children(&document.root).pop().expect("a light");
    assert!(shown(&light).contains("radiance: rgb 2.000000e0 2.000000e0 2.000000e0"));
    // Its white has a name.
    let document = sound("WorldBegin LightSource \"infinite\" \"spectrum L\" \"illum-acesD60\"");
    let radiance = Evaluated::of(&document, "radiance", SpectrumKind::Emission);
    let [x, y, z] = etalon_spectrum::cie::xyz(|nm| {
        radiance
            .spectrum(Vec3::ZERO, Vec4::splat(nm as f32))
            .x
            .into()
    });
    let sum = x + y + z;
    assert!(
        (x / sum - 0.3217).abs() < 1e-3 && (y / sum - 0.3377).abs() < 1e-3,
        "{x} {y} {z}"
    );
    // A white reflectance of ACES is white; its light has the colour of its own white.
    assert_same_world(
        r#"ColorSpace "aces2065-1" Material "diffuse" "rgb reflectance" [ 1 1 1 ] Shape "sphere""#,
        r#"<shape type="sphere"><float name="radius" value="1"/>
            <bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="1 1 1"/></bsdf></bsdf></shape>"#,
    );
}

#[test]
fn shapes_that_shine() {
    let area = |shape: &str| {
        let text =
            format!("AreaLightSource \"diffuse\" \"rgb L\" [ 1 2 3 ] \"float scale\" 2 {shape}");
        let outcome = world(&text);
        assert_eq!(outcome.lines(), "");
        let document = outcome.document.expect("a document");
        let shape = children(&document.root).pop().expect("a shape");
        shown(&children(&shape).pop().expect("an emitter")).replace("\n    ", " ")
    };
    assert_eq!(
        area("Shape \"sphere\""),
        "emitter area { radiance: rgb 2.000000e0 4.000000e0 6.000000e0\n}"
    );
    let text = r#"AreaLightSource "diffuse" "float power" 9.869604401089358
        Shape "trianglemesh" "point3 P" [ 0 0 0  1 0 0  0 2 0 ]"#;
    // A power of π² on an area of 1.
    let outcome = world(text);
    assert_eq!(outcome.lines(), "");
    let root = outcome.document.expect("a document").root;
    let shape = children(&root).pop().expect("a shape");
    let light = shown(&children(&shape).pop().expect("an emitter"));
    assert!(light.contains("radiance: float 3.141593e0"), "{light}");
    let image = world(r#"AreaLightSource "diffuse" "string filename" "a.png" Shape "cylinder""#);
    assert_eq!(image.lines(), "");
    let root = image.document.expect("a document").root;
    let light = shown(
        &children(&children(&root).pop().expect("a shape"))
            .pop()
            .expect("an emitter"),
    );
    assert!(light.contains("radiance: texture d65 {"), "{light}");
}

#[test]
fn lights_of_two_sides() {
    // Φ / (2π A) of a disk of the area π.
    let text = r#"AreaLightSource "diffuse" "bool twosided" true "float power" 19.739208802178716 Shape "disk""#;
    let root = sound(&format!("WorldBegin {text}")).root;
    let shape = children(&root).pop().expect("a shape");
    let light = shown(&children(&shape).pop().expect("an emitter"));
    assert_eq!(
        light,
        "emitter area {\n    radiance: float 1.000000e0\n    twosided: boolean true\n}"
    );
}

#[test]
fn images_at_infinity() {
    assert_light(
        r#"Rotate 90 1 0 0 LightSource "infinite" "string filename" "a.exr" "float scale" 3"#,
        r#"<emitter type="envmap"><string name="filename" value="a.exr"/><string name="mapping" value="equalarea"/>
            <float name="scale" value="3"/><transform name="to_world"><rotate x="1" angle="90"/></transform></emitter>"#,
    );
    let folder = tempfile::tempdir().expect("a temporary folder");
    // 4 × 4 pixels of 4: pbrt takes Σ Y cos θ 2π/16. Those in the corners are below the horizon.
    let header = b"PF\n4 4\n-1.0\n".to_vec();
    let pixels = [4.0_f32; 48].iter().flat_map(|x| x.to_le_bytes());
    let bytes: Vec<u8> = header.into_iter().chain(pixels).collect();
    std::fs::write(folder.path().join("sky.pfm"), bytes).expect("written");
    let path = folder.path().join("a.pbrt");
    let text =
        r#"WorldBegin LightSource "infinite" "string filename" "sky.pfm" "float illuminance" 10"#;
    std::fs::write(&path, text).expect("written");
    let outcome = pbrt::read(&path, &ReadOptions::default());
    assert_eq!(outcome.lines(), "");
    let light = children(&outcome.document.expect("a document").root)
        .pop()
        .expect("a light");
    let scale = light
        .properties
        .iter()
        .find(|p| p.name == "scale")
        .map(|p| p.value.clone());
    let Some(Value::Float(scale)) = scale else {
        panic!("{}", shown(&light))
    };
    let up = |x: f32, y: f32| {
        f64::from(
            etalon_math::equal_area::to_direction::<f32>([x, y])
                .z
                .max(0.0),
        )
    };
    let cosines: f64 = (0..16)
        .map(|i| up((i % 4) as f32 * 0.25 + 0.125, (i / 4) as f32 * 0.25 + 0.125))
        .sum();
    let expected = 10.0 / (4.0 * cosines * std::f64::consts::TAU / 16.0);
    assert!((scale / expected - 1.0).abs() < 1e-5, "{scale} {expected}");
}

/// A picture that is white everywhere throws its power evenly over the solid angle of a cube's side.
#[test]
fn thrown_pictures() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let pixels = [1.0_f32; 3 * 32 * 32].iter().flat_map(|x| x.to_le_bytes());
    let bytes: Vec<u8> = b"PF\n32 32\n-1.0\n".iter().copied().chain(pixels).collect();
    std::fs::write(folder.path().join("white.pfm"), bytes).expect("written");
    let path = folder.path().join("a.pbrt");
    let text =
        r#"WorldBegin LightSource "projection" "string filename" "white.pfm" "float power" 7"#;
    std::fs::write(&path, text).expect("written");
    let outcome = pbrt::read(&path, &ReadOptions::default());
    assert_eq!(outcome.lines(), "");
    let root = outcome.document.expect("a document").root;
    let light = children(&root).pop().expect("a light");
    assert_eq!(light.plugin.value, "projector");
    let picture = children(&light).pop().expect("a picture");
    let scale = picture.properties.iter().find_map(|p| match p.value {
        Value::Float(x) => Some(x),
        _ => None,
    });
    let expected = 7.0 / (4.0 * std::f64::consts::PI / 6.0);
    assert!(
        (scale.expect("a factor") / expected - 1.0).abs() < 2e-3,
        "{scale:?} {expected}"
    );
}
