//! Reading parameters as code does that understands entities.

use super::super::{
    ColorSpace, FloatOrSpectrum, FloatOrTexture, Parameters, SpectrumOrTexture, SpectrumValue,
};
use super::world;
use etalon_params::{DVec3, Diagnostics};

/// The messages about a scene whose first shape is read so; the shape stands in line 2.
fn messages(text: &str, read: impl Fn(&Parameters<'_>)) -> String {
    let parsed = world(text);
    assert_eq!(parsed.lines(), "");
    let scene = parsed.scene.as_ref().expect("a scene");
    let diagnostics = Diagnostics::new();
    let shape = scene.parameters(&scene.shapes[0].entity, &diagnostics);
    read(&shape);
    shape.finish();
    scene.report_unused_attributes(&diagnostics);
    let sorted = diagnostics.into_sorted();
    let lines = sorted.iter().map(|d| d.one_line(&parsed.sources));
    lines.collect::<Vec<String>>().join("\n")
}

#[test]
fn values_and_defaults() {
    let text = r#"Shape "sphere" "float radius" 2 "integer levels" [ 3 ] "bool b" false
        "string basis" "bezier" "point3 from" [ 1 2 3 ] "vector3 to" [ 0 0 1 ] "float width" [ 1 2 ]
        "point2 uv" [ 0 1 2 3 ] "integer indices" [ 0 1 2 ] "normal N" [ 0 0 1 ] "string names" [ "a" "b" ]"#;
    let read = |shape: &Parameters<'_>| {
        assert_eq!(
            (shape.float("radius", 1.0), shape.float("zmin", -1.0)),
            (2.0, -1.0)
        );
        assert_eq!(
            (shape.integer("levels", 1), shape.integer("degree", 3)),
            (3, 3)
        );
        assert!(!shape.boolean("b", true) && shape.boolean("c", true));
        assert_eq!(
            shape.choice("basis", "bspline", &["bezier", "bspline"]),
            "bezier"
        );
        assert_eq!(shape.choice("type", "flat", &["flat", "ribbon"]), "flat");
        assert_eq!(shape.point3("from", DVec3::ZERO), DVec3::new(1.0, 2.0, 3.0));
        assert_eq!(shape.vector3("to", DVec3::ZERO), DVec3::Z);
        assert_eq!(shape.floats("width"), Some(&[1.0, 2.0][..]));
        assert_eq!(shape.floats_of::<2>("width"), Some(&[1.0, 2.0]));
        assert_eq!(shape.points2("uv"), Some(&[[0.0, 1.0], [2.0, 3.0]][..]));
        assert_eq!(shape.integers("indices"), Some(&[0, 1, 2][..]));
        assert_eq!(shape.normals("N"), Some(&[[0.0, 0.0, 1.0]][..]));
        let names = shape.strings("names").expect("strings");
        assert_eq!(names[1].value, "b");
        assert_eq!(shape.points3("P"), None);
    };
    assert_eq!(messages(text, read), "");
}

#[test]
fn spectra_and_textures() {
    let text = r#"Shape "sphere" "spectrum a" "metal-Cu-eta" "spectrum b" [ 400 1 700 2 ] "blackbody c" 5000
        "rgb d" [ 1 2 3 ] "float e" 1.5 "texture f" "t" "float g" 2 "texture h" "t"
        "rgb i" [ 1 2 3 4 5 6 ]
        Texture "t" "float" "constant" Texture "t" "spectrum" "constant""#;
    let read = |shape: &Parameters<'_>| {
        let rgb = SpectrumValue::Rgb([1.0, 2.0, 3.0], ColorSpace::Srgb);
        assert_eq!(
            shape.spectrum("a"),
            Some(SpectrumValue::Named("metal-Cu-eta"))
        );
        let samples = [[400.0, 1.0], [700.0, 2.0]];
        assert_eq!(shape.spectrum("b"), Some(SpectrumValue::Samples(&samples)));
        assert_eq!(shape.spectrum("c"), Some(SpectrumValue::Blackbody(5000.0)));
        assert_eq!(
            shape.spectrum_texture("d"),
            Some(SpectrumOrTexture::Value(rgb))
        );
        assert_eq!(
            shape.float_or_spectrum("e"),
            Some(FloatOrSpectrum::Float(1.5))
        );
        assert_eq!(
            shape.float_or_spectrum("d"),
            Some(FloatOrSpectrum::Spectrum(rgb))
        );
        assert_eq!(
            shape.spectrum_texture("f"),
            Some(SpectrumOrTexture::Texture(1))
        );
        assert_eq!(shape.float_texture("g"), Some(FloatOrTexture::Value(2.0)));
        assert_eq!(shape.float_texture("h"), Some(FloatOrTexture::Texture(0)));
        let (colours, _) = shape.rgbs("i").expect("two colours");
        assert_eq!(colours, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
        assert_eq!(shape.spectrum("none"), None);
    };
    assert_eq!(messages(text, read), "");
}

#[test]
fn wrong_types_counts_and_values() {
    let text = r#"Shape "sphere" "integer radius" 2 "float zmin" [ 1 2 ] "string basis" "bezer"
"point3 from" [ 1 2 3 4 5 6 ] "float width" [ ] "blackbody L" [ 6500 1 ] "spectrum s" [ 500 1 400 1 ]
"texture alpha" "t" "float zmax" -1 "integer levels" 0 "blackbody M" -1 "rgb I" [ ]
Texture "t" "spectrum" "constant""#;
    let read = |shape: &Parameters<'_>| {
        assert_eq!(shape.float("radius", 1.0), 1.0);
        assert_eq!(shape.float("zmin", 7.0), 7.0);
        assert_eq!(
            shape.choice("basis", "flat", &["bezier", "bspline"]),
            "flat"
        );
        assert_eq!(shape.point3("from", DVec3::ONE), DVec3::ONE);
        assert_eq!(shape.floats("width"), None);
        assert_eq!(shape.spectrum("L"), None);
        assert_eq!(shape.spectrum("s"), None);
        assert_eq!(shape.float_texture("alpha"), None);
        assert_eq!(
            shape.float_where("zmax", 1.0, "numbers from 0 on", |z| z >= 0.0),
            1.0
        );
        assert_eq!(shape.integer_from("levels", 3, 1), 3);
        assert_eq!(shape.spectrum("M"), None);
        assert_eq!(shape.rgbs("I"), None);
        shape.missing("string filename");
    };
    assert_eq!(
        messages(text, read),
        "a.pbrt:2:1: error: `sphere` needs the parameter `\"string filename\"`\n\
         a.pbrt:2:16: error: `radius` of `sphere` must be declared as float, not as integer (write `\"float radius\"`)\n\
         a.pbrt:2:48: error: `\"float zmin\"` has 2 values, and needs one value\n\
         a.pbrt:2:71: error: `bezer` is not a value of `basis` (did you mean `bezier`?)\n\
         a.pbrt:3:15: error: `\"point3 from\"` has 2 values, and needs one value\n\
         a.pbrt:3:45: error: `\"float width\"` has 0 values, and needs at least one\n\
         a.pbrt:3:63: error: a blackbody is one temperature (pbrt-v3 had a factor behind it; in pbrt-v4 lights have a `float scale`)\n\
         a.pbrt:3:87: error: wavelengths must ascend, but 400 nm follows 500 nm\n\
         a.pbrt:4:17: error: `alpha` of `sphere` needs a float texture, and `t` is a spectrum texture\n\
         a.pbrt:4:34: error: `zmax` of `sphere` cannot be -1 (accepted: numbers from 0 on)\n\
         a.pbrt:4:54: error: `levels` of `sphere` cannot be 0 (accepted: integers from 1 on)\n\
         a.pbrt:4:70: error: `M` of `sphere` cannot be -1 (accepted: temperatures above 0 kelvin)\n\
         a.pbrt:4:81: error: `\"rgb I\"` has 0 values, and needs at least one"
    );
}

#[test]
fn parameters_that_nobody_asked_for() {
    let text =
        "Attribute \"shape\" \"float alpha\" 1 \"float zmn\" 0\nShape \"sphere\" \"float radus\" 2";
    let read = |shape: &Parameters<'_>| {
        shape.float("radius", 1.0);
        shape.float("alpha", 1.0);
    };
    assert_eq!(
        messages(text, read),
        "a.pbrt:2:35: note: no entity took the attribute `zmn`\n\
         a.pbrt:3:16: error: `sphere` has no parameter `radus` (did you mean `radius`?)"
    );
}

#[test]
fn broken_parameters_are_neither_missing_nor_unused() {
    for value in ["[ x ]", "\"C:\\x\"", "[ \"a\" \"\\x\" ]", ""] {
        broken(&format!("Shape \"plymesh\" \"string filename\" {value}"));
    }
}

fn broken(text: &str) {
    let parsed = world(text);
    assert!(parsed.has_errors());
    let scene = parsed.scene.as_ref().expect("a scene");
    let diagnostics = Diagnostics::new();
    let shape = scene.parameters(&scene.shapes[0].entity, &diagnostics);
    assert_eq!(shape.string("filename"), None);
    shape.missing("string filename");
    shape.finish();
    assert!(!diagnostics.has_errors());
}
