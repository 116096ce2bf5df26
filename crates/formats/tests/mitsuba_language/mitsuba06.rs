//! What became of the parameters and defaults of Mitsuba 0.6.

use super::old_files::{file, old, refused};
use super::{children, document, outcome, property};
use etalon_formats::ReadOptions;
use etalon_params::{Class, DVec3, Value};

/// What a file of Mitsuba 0.6 says, in today's words; the value of a float or integer as a number.
fn numbers(body: &str) -> Vec<(String, f64)> {
    let node = children(&old(body).root)[0].clone();
    let number = |value: &Value| match value {
        Value::Float(x) => *x,
        Value::Integer(i) => *i as f64,
        Value::Boolean(b) => f64::from(u8::from(*b)),
        _ => f64::NAN,
    };
    let named = node.properties.iter();
    let named = named.map(|p| (p.name.clone(), number(&p.value)));
    named.filter(|(_, number)| number.is_finite()).collect()
}

#[test]
fn parameters_of_mitsuba_06_have_todays_names() {
    let is = |body: &str, expected: &[(&str, f64)]| {
        let expected: Vec<_> = expected
            .iter()
            .map(|(n, x)| ((*n).to_owned(), *x))
            .collect();
        assert_eq!(numbers(body), expected, "{body}");
    };
    is(
        "<emitter type='sunsky'><float name='scale' value='10'/><float name='skyScale' value='3'/>
         <float name='sunRadiusScale' value='2'/></emitter>",
        &[
            ("sky_scale", 3.0),
            ("sun_aperture", 1.0716),
            ("sun_scale", 10.0),
            ("albedo", 0.15),
        ],
    );
    // Alone they are what is left of it without the other.
    is(
        "<emitter type='sky'><float name='scale' value='10'/><float name='turbidity' value='4'/></emitter>",
        &[
            ("turbidity", 4.0),
            ("sun_scale", 0.0),
            ("sky_scale", 10.0),
            ("albedo", 0.15),
        ],
    );
    is(
        "<emitter type='sun'><float name='scale' value='10'/></emitter>",
        &[("sky_scale", 0.0), ("sun_scale", 10.0), ("albedo", 0.15)],
    );
    is(
        "<integrator type='sppm'><integer name='photonCount' value='9'/>
         <float name='initialRadius' value='0'/></integrator>",
        &[("photons", 9.0)],
    );
    is(
        "<integrator type='ppm'><float name='initialRadius' value='2'/><float name='alpha' value='.5'/></integrator>",
        &[("radius", 2.0), ("alpha", 0.5)],
    );
    is(
        "<integrator type='pssmlt'><float name='pLarge' value='.4'/><integer name='directSamples' value='-1'/>
         <float name='mutationSizeLow' value='.01'/></integrator>",
        &[
            ("large_step", 0.4),
            ("separate_direct", 0.0),
            ("smallest_step", 0.01),
        ],
    );
    is(
        "<integrator type='ao'><float name='rayLength' value='3'/></integrator>",
        &[("distance", 3.0)],
    );
    is(
        "<shape type='heightfield'><float name='scale' value='2'/><integer name='width' value='9'/>
         <integer name='height' value='9'/><boolean name='shadingNormals' value='true'/></shape>",
        &[("height", 2.0), ("face_normals", 0.0), ("raw", 0.0)],
    );
    // Where rays ended by themselves they do not here, which is said.
    let outcome = file("<scene version='0.6.0'><integrator type='ao'/></scene>");
    assert!(outcome.lines().contains("half the radius of the scene's"));
}

#[test]
fn defaults_of_mitsuba_06_are_kept() {
    let word = |body: &str, name: &str| {
        let node = children(&old(body).root)[0].clone();
        let found = node.properties.iter().find(|p| p.name == name);
        match found.map(|p| &p.value) {
            Some(Value::String(word)) => word.clone(),
            _ => String::new(),
        }
    };
    assert_eq!(word("<bsdf type='conductor'/>", "material"), "Cu");
    let mirror = "<bsdf type='conductor'><spectrum name='k' value='1'/></bsdf>";
    assert_eq!(word(mirror, "material"), "");
    assert_eq!(word("<medium type='homogeneous'/>", "material"), "skin1");
    // A shape that bounds a medium has no surface unless it is given one.
    let materials = |body: &str| {
        let shape = children(&old(body).root).pop().expect("a shape");
        let parts = children(&shape);
        let materials = parts.iter().filter(|part| part.class == Class::Bsdf);
        materials
            .map(|part| part.plugin.value.clone())
            .collect::<Vec<_>>()
    };
    let medium = "<medium type='homogeneous' id='m'/>";
    let bounds = "<ref name='interior' id='m'/>";
    let shape = |rest: &str| {
        materials(&format!(
            "{medium}<shape type='sphere'>{bounds}{rest}</shape>"
        ))
    };
    assert_eq!(shape(""), ["null"]);
    assert_eq!(shape("<bsdf type='dielectric'/>"), ["dielectric"]);
    assert!(shape("<emitter type='area'/>").is_empty());
    assert!(materials("<shape type='sphere'/>").is_empty());
}

/// The sky of 0.6 has y above, the north behind the viewer of +z, and the east to the side of +x.
#[test]
fn skies_of_mitsuba_06_stand_upright() {
    let to_world = |body: &str| match property(&children(&old(body).root)[0], "to_world").value {
        Value::Transform(m) => m,
        ref other => panic!("{other:?}"),
    };
    let sky = to_world("<emitter type='sunsky'/>");
    let [south, west, up] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| sky.transform_vector3(axis));
    assert_eq!([south, west, up], [DVec3::Z, DVec3::NEG_X, DVec3::Y]);
    let turned = to_world(
        "<emitter type='sunsky'><transform name='toWorld'><rotate x='1' angle='90'/></transform></emitter>",
    );
    assert!(
        turned
            .transform_vector3(DVec3::Z)
            .abs_diff_eq(DVec3::Z, 1e-12)
    );
    let grid = to_world(
        "<volume type='gridvolume'><point name='min' x='1' y='2' z='3'/><point name='max' x='2' y='4' z='6'/>
         <transform name='toWorld'><translate z='10'/></transform></volume>",
    );
    assert_eq!(
        grid.transform_point3(DVec3::ONE),
        DVec3::new(2.0, 4.0, 16.0)
    );
}

#[test]
fn axes_of_rotations_are_normalised_in_old_files_only() {
    let turned = |version: &str| {
        let body = "<shape type='x'><transform name='t'><rotate x='1' y='1' angle='45'/></transform></shape>";
        let outcome = file(&format!("<scene version='{version}'>{body}</scene>"));
        let said = outcome.lines();
        match property(&children(&document(outcome).root)[0], "t").value {
            Value::Transform(m) => (m.determinant(), said),
            ref other => panic!("{other:?}"),
        }
    };
    let (volume, said) = turned("0.6.0");
    assert!(
        (volume - 1.0).abs() < 1e-12 && said.is_empty(),
        "{volume} {said}"
    );
    let (volume, said) = turned("3.0.0");
    assert!(
        (volume - 1.0).abs() > 0.1 && said.contains("this shears"),
        "{volume} {said}"
    );
}

#[test]
fn a_multiple_of_a_matrix_is_the_same_map() {
    let m = super::matrix("<matrix value='2 0 0 4 0 2 0 0 0 0 2 0 0 0 0 2'/>");
    assert_eq!(
        m,
        etalon_params::DMat4::from_translation(DVec3::new(2.0, 0.0, 0.0))
    );
    let text = "<scene version='3.0.0'><shape type='x'><transform name='t'>
<matrix value='2 0 0 0  0 2 0 0  0 0 2 0  0 0 1 2'/></transform></shape></scene>";
    refused(text, "this is no affine map, but one with a perspective");
    let flat = text.replace("1 2'", "0 0'");
    refused(&flat, "this is no affine map");
}

#[test]
fn what_a_stand_in_does_without_is_judged() {
    let said = |body: &str| file(&format!("<scene version='3.0.0'>{body}</scene>")).lines();
    let mlt = |rest: &str| said(&format!("<integrator type='mlt'>{rest}</integrator>"));
    let fine = mlt("<float name='lambda' value='50'/>");
    assert!(!fine.contains("error"), "{fine}");
    assert!(mlt("<float name='lamda' value='50'/>").contains("`mlt` has no parameter `lamda`"));
    let hidden = mlt("<integer name='direct_samples' value='0'/>");
    assert!(
        hidden.contains("`direct_samples` must be not 0"),
        "{hidden}"
    );
    // What no Mitsuba has is not known here.
    let other =
        said("<integrator type='guided_path'><integer name='budget' value='9'/></integrator>");
    assert!(
        other.contains("it does without `budget`") && !other.contains("error"),
        "{other}"
    );
}

#[test]
fn an_integrator_of_the_command_line_may_be_stood_in_for() {
    let options = ReadOptions {
        integrator: Some("prb".into()),
        ..ReadOptions::default()
    };
    let text = "<scene version='3.0.0'><integrator type='volpath'/></scene>";
    let outcome = outcome(&[("main.xml", text)], &options);
    assert!(outcome.lines().contains("`path` stands in for it"));
    assert_eq!(children(&document(outcome).root)[0].plugin.value, "path");
}

/// The pictures of `multichannel` are those of integrators that an `aov` nests, under the names that the film lists.
#[test]
fn several_pictures_are_those_of_an_aov() {
    let scene = |names: &str| {
        format!(
            "<scene version='0.6.0'><integrator type='multichannel'><integrator type='path'/>
             <integrator type='field'><string name='field' value='shNormal'/></integrator></integrator>
             <sensor type='perspective'><film type='hdrfilm'>{names}</film></sensor></scene>"
        )
    };
    let names = |text: &str| format!("<string name='channelNames' value='{text}'/>");
    let aov = |scene: &str| {
        let root = document(file(scene)).root;
        let aov = children(&root)[0].clone();
        assert_eq!(aov.plugin.value, "aov");
        assert!(matches!(&property(&aov, "aovs").value, Value::String(list) if list.is_empty()));
        let parts = aov.properties.iter();
        let parts = parts.filter_map(|p| match &p.value {
            Value::Object(part) => Some((p.name.clone(), part.plugin.value.clone())),
            _ => None,
        });
        parts.collect::<Vec<_>>()
    };
    let pair = |name: &str, plugin: &str| (name.to_owned(), plugin.to_owned());
    assert_eq!(
        aov(&scene(&names("color, normal"))),
        [pair("color", "path"), pair("normal", "field")]
    );
    assert_eq!(aov(&scene("")), [pair("", "path"), pair("", "field")]);
    refused(
        &scene(&names("color")),
        "`channelNames` has 1 names for the 2 integrators",
    );
    refused(
        "<scene version='0.6.0'><integrator type='multichannel'/></scene>",
        "`multichannel` needs integrators",
    );
    // Another integrator stands in for that which follows light.
    let options = ReadOptions {
        integrator: Some("bdpt".into()),
        ..ReadOptions::default()
    };
    let root = document(outcome(&[("main.xml", &scene(""))], &options)).root;
    let plugins: Vec<_> = (children(&children(&root)[0]).iter())
        .map(|part| part.plugin.value.clone())
        .collect();
    assert_eq!(plugins, ["bdpt", "field"]);
}
