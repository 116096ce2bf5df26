//! What only older files, and files written for more lenient readers, contain.

use super::{children, document, outcome, property, scene};
use etalon_formats::{Document, ReadOptions, ReadOutcome};
use etalon_params::{DVec3, Severity, SpectrumText, Value};

pub(crate) fn file(text: &str) -> ReadOutcome {
    outcome(&[("main.xml", text)], &ReadOptions::default())
}

pub(crate) fn old(body: &str) -> Document {
    document(file(&format!("<scene version='0.5.0'>{body}</scene>")))
}

#[track_caller]
pub(crate) fn refused(text: &str, words: &str) {
    let outcome = file(text);
    assert!(
        outcome.has_errors() && outcome.lines().contains(words),
        "{}",
        outcome.lines()
    );
}

#[test]
fn comments_declarations_and_document_types_that_others_accept_are_accepted() {
    let text = "\n<?xml version='1.0'?><!DOCTYPE scene>\n<scene version='3.0.0'
        xmlns:xsi='http://www.w3.org/2001/XMLSchema-instance' xsi:schemaLocation='x'>
        <!-- a -- b ---><shape type='x'><float name='y' value='z'/></shape></scene>";
    let outcome = file(text);
    // What was taken out moved nothing.
    assert_eq!(outcome.diagnostics.len(), 1, "{}", outcome.lines());
    assert!(
        outcome.lines().contains("main.xml:5:64: error: `z`"),
        "{}",
        outcome.lines()
    );
}

#[test]
fn entities_are_refused_where_they_are_declared() {
    let ten = "&a;".repeat(10);
    let text = format!(
        "<!DOCTYPE scene [\n <!ENTITY a 'aaaaaaaaaa'>\n <!ENTITY b '{ten}'>\n]>
        <scene version='3.0.0'><string name='&b;' value='&b;'/></scene>"
    );
    refused(
        &text,
        "main.xml:2:2: error: a scene cannot declare entities",
    );
}

#[test]
fn defaults_that_double_without_end_are_refused_with_the_place() {
    let mut text =
        String::from("<scene version='3.0.0'>\n<default name='v0' value='1234567890'/>\n");
    for i in 1..40 {
        let value = format!("$v{}", i - 1).repeat(10);
        text += &format!("<default name='v{i}' value='{value}'/>\n");
    }
    text += "</scene>";
    // 10 · 10⁴ bytes are more than 2¹⁶: the fourth that multiplies, at its seventh name.
    refused(
        &text,
        "main.xml:6:45: error: with `$v3` this value would be longer than 65536 bytes",
    );
    // What follows from the first is not said.
    assert_eq!(file(&text).lines().lines().count(), 1);
    // Each value is short enough, but there are very many.
    let mut text = String::from("<scene version='3.0.0'>\n");
    text += &format!("<default name='v' value='{}'/>\n", "x".repeat(60_000));
    text += &"<string name='s' value='$v'/>\n".repeat(1200);
    text += "</scene>";
    refused(&text, "would stand for more than 67108864 bytes");
}

#[test]
fn plugins_are_found_in_any_case() {
    let scene = scene("<shape type='Rectangle'/><bsdf type='TwoSided'/><shape type=' sphere '/>");
    let plugins: Vec<_> = children(&scene.root)
        .iter()
        .map(|node| node.plugin.value.clone())
        .collect();
    assert_eq!(plugins, ["rectangle", "twosided", "sphere"]);
}

#[test]
fn colours_of_old_files_have_their_values() {
    let scene = old("<bsdf type='x'>
        <srgb name='grey' value='#808080'/><srgb name='low' value='0.04 1 0'/>
        <rgb name='hex' value='#ff8000'/><spectrum name='three' value='0.1, 0.2, 0.3'/>
        <spectrum name='lamp' value='2' intent='illuminant'/>
        <rgb name='meant' value='1' intent='illuminant'/>
        <blackbody name='body' temperature='5000K' scale='2'/></bsdf>");
    let node = &children(&scene.root)[0];
    let rgb = |name| match property(node, name).value {
        Value::Rgb(rgb) => rgb,
        ref other => panic!("{other:?}"),
    };
    // ((128/255 + 0.055)/1.055)^2.4.
    assert!(
        (rgb("grey") - DVec3::splat(0.215_860_5))
            .abs()
            .max_element()
            < 1e-6
    );
    assert!(
        (rgb("low") - DVec3::new(0.04 / 12.92, 1.0, 0.0))
            .abs()
            .max_element()
            < 1e-12
    );
    assert_eq!(rgb("hex"), DVec3::new(1.0, 128.0 / 255.0, 0.0));
    assert_eq!(rgb("three"), DVec3::new(0.1, 0.2, 0.3));
    assert_eq!(rgb("meant"), DVec3::ONE);
    assert!(matches!(property(node, "lamp").value, Value::Float(2.0)));
    let Value::Spectrum(SpectrumText::Samples(body)) = &property(node, "body").value else {
        panic!("a table");
    };
    // Planck's law at 500 nm and 5000 K: 1.2107e4 W·m⁻²·sr⁻¹·nm⁻¹.
    let at_500 = body
        .iter()
        .find(|(nm, _)| *nm == 500.0)
        .expect("whole nanometres");
    assert!(
        (at_500.1 / (2.0 * 1.2107e4) - 1.0).abs() < 1e-3,
        "{at_500:?}"
    );
    refused(
        "<scene version='0.5.0'><bsdf type='x'><blackbody name='b' temperature='hot'/></bsdf></scene>",
        "`hot` is not a temperature",
    );
    // Mitsuba 3 knows no spectrum of three numbers, and no hexadecimal ones.
    refused(
        "<scene version='3.0.0'><bsdf type='x'><rgb name='b' value='#ff8000'/></bsdf></scene>",
        "`#ff8000` is not a number",
    );
    refused(
        "<scene version='3.0.0'><bsdf type='x'><spectrum name='b' value='1 2 3'/></bsdf></scene>",
        "`1` is not a pair",
    );
}

#[test]
fn wavelengths_in_other_units_are_refused() {
    let text = "<scene version='3.0.0'><bsdf type='x'>
        <spectrum name='a' value='0.4:0.5, 0.7:0.5'/></bsdf></scene>";
    refused(text, "the wavelengths go from 0.4 to 0.7 nm");
    let text = "<scene version='3.0.0'><bsdf type='x'>
        <spectrum name='a' value='4000:0.5, 7000:0.5'/></bsdf></scene>";
    refused(text, "not in ångström");
    let text = "<scene version='3.0.0'><bsdf type='x'><spectrum name='a' filename='a.spd'/></bsdf></scene>";
    let files = [("main.xml", text), ("a.spd", "0.4 0.5\n0.7 0.5\n")];
    let lines = outcome(&files, &ReadOptions::default()).lines();
    assert!(
        lines.contains("a.spd:2:1: error: the wavelengths go from 0.4 to 0.7 nm"),
        "{lines}"
    );
}

#[test]
fn a_matrix_that_is_no_affine_map_is_refused_at_its_last_row() {
    let text = "<scene version='3.0.0'>\n<shape type='x'><transform name='t'>
<matrix value='1 0 0 0  0 1 0 0  0 0 1 0  0 0 1 1'/></transform></shape></scene>";
    refused(
        text,
        "main.xml:3:43: error: the last row of the matrix is `0 0 1 1`",
    );
    // Rounding is none.
    let m = super::matrix("<matrix value='1 0 0 0 0 1 0 0 0 0 1 0 0 0 1e-9 0.9999999'/>");
    assert_eq!(m, etalon_params::DMat4::IDENTITY);
}

#[test]
fn files_before_0_4_are_upgraded_as_mitsuba_0_6_did() {
    let scene = document(file(
        "<scene><camera type='perspective'><boolean name='mapSmallerSide' value='true'/>
        <transform name='toWorld'><translate x='5'/></transform>
        <film type='pngfilm'><boolean name='alpha' value='false'/></film></camera>
        <luminaire type='constant'><spectrum name='intensity' value='2'/></luminaire>
        <luminaire type='envmap'><float name='intensityScale' value='3'/></luminaire>
        <bsdf type='lambertian'/></scene>",
    ));
    let nodes = children(&scene.root);
    let words = |value: &Value| match value {
        Value::String(text) => text.clone(),
        other => panic!("{other:?}"),
    };
    assert_eq!(words(&property(&nodes[0], "fov_axis").value), "smaller");
    let Value::Transform(to_world) = property(&nodes[0], "to_world").value else {
        panic!("a transform");
    };
    // The mirror is applied first.
    assert_eq!(
        to_world.transform_point3(DVec3::X),
        DVec3::new(4.0, 0.0, 0.0)
    );
    let film = &children(&nodes[0])[0];
    assert_eq!(film.plugin.value, "ldrfilm");
    assert_eq!(words(&property(film, "pixel_format").value), "rgb");
    property(&nodes[1], "radiance");
    property(&nodes[2], "scale");
    assert_eq!(nodes[3].plugin.value, "diffuse");
    // In later files these tags are mistakes.
    refused(
        "<scene version='0.5.0'><camera type='x'/></scene>",
        "unknown element `<camera>`",
    );
}

#[test]
fn integrators_that_agree_stand_in_for_others() {
    let integrator = |body: &str| {
        let outcome = file(&format!("<scene version='3.0.0'>{body}</scene>"));
        let notes = outcome
            .diagnostics
            .iter()
            .filter(|d| d.severity == Severity::Note);
        assert_eq!(notes.count(), 1, "{}", outcome.lines());
        children(&document(outcome).root)[0].clone()
    };
    let path = integrator(
        "<integrator type='volpath_simple'><integer name='max_depth' value='7'/>
         <boolean name='strict_normals' value='false'/></integrator>",
    );
    assert_eq!(
        (path.plugin.value.as_str(), path.properties.len()),
        ("volpath", 1)
    );
    // Mitsuba's own default, which is not that of `path`.
    let prb = integrator("<integrator type='prb'/>");
    assert!(matches!(
        property(&prb, "max_depth").value,
        Value::Integer(6)
    ));
    let inner = integrator("<integrator type='adaptive'><integrator type='bdpt'/></integrator>");
    assert_eq!(inner.plugin.value, "bdpt");
}
