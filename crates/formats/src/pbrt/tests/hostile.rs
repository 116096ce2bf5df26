//! No text panics, and nothing takes more than its length deserves.

use super::super::{Parsed, Scene};
use super::{parsed, world};
use etalon_params::{Diagnostics, Span};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Words that scenes are made of, and some that they are not.
const WORDS: [&str; 44] = [
    "WorldBegin",
    "AttributeBegin",
    "AttributeEnd",
    "TransformBegin",
    "TransformEnd",
    "ObjectBegin",
    "ObjectEnd",
    "ObjectInstance",
    "Shape",
    "Material",
    "MakeNamedMaterial",
    "NamedMaterial",
    "Texture",
    "Attribute",
    "LightSource",
    "AreaLightSource",
    "MediumInterface",
    "MakeNamedMedium",
    "ActiveTransform",
    "All",
    "Transform",
    "LookAt",
    "Rotate",
    "Camera",
    "Include",
    "Import",
    "Option",
    "\"sphere\"",
    "\"a\"",
    "\"diffuse\"",
    "\"mix\"",
    "\"float\"",
    "\"float a\"",
    "\"string type\"",
    "\"string materials\"",
    "\"texture a\"",
    "\"point3 a\"",
    "\"é\\",
    "[",
    "]",
    "1",
    "-2.5e3",
    "true",
    "#",
];

/// All places in the result lie in its texts.
fn check(result: &Parsed) {
    let inside = |span: Span| {
        let length = result.sources.text(span.file).len();
        assert!(
            span.start <= span.end && span.end as usize <= length,
            "{span:?}"
        );
        result.sources.location(span);
    };
    for diagnostic in &result.diagnostics {
        diagnostic.span.into_iter().for_each(inside);
        diagnostic
            .related
            .iter()
            .for_each(|(span, _)| inside(*span));
    }
    result.lines();
    if let Some(scene) = &result.scene {
        check_scene(scene, inside);
    }
}

fn check_scene(scene: &Scene, inside: impl Fn(Span)) {
    let diagnostics = Diagnostics::new();
    for shape in &scene.shapes {
        inside(shape.entity.span);
        let read = scene.parameters(&shape.entity, &diagnostics);
        for parameter in shape.entity.params.iter() {
            inside(parameter.span);
            inside(parameter.declaration);
            read.float(&parameter.name, 1.0);
            read.points3(&parameter.name);
            read.spectrum_texture(&parameter.name);
            read.float_texture(&parameter.name);
        }
        read.finish();
        assert!(shape.material < scene.materials.len());
    }
    assert_eq!(scene.material_order.len(), scene.materials.len());
    assert_eq!(scene.object_order.len(), scene.objects.len());
    assert_eq!(scene.texture_order.len(), scene.textures.len());
}

proptest! {
    #![proptest_config(ProptestConfig {
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn any_text(text in "\\PC*") {
        check(&parsed(&text));
    }

    #[test]
    fn any_bytes_of_the_language(text in "[A-Za-z0-9 \\n\"\\[\\]#.+-]{0,200}") {
        check(&parsed(&text));
    }

    #[test]
    fn any_words(words in proptest::collection::vec(0..WORDS.len(), 0..60), blank in "[ \n]") {
        let text: Vec<&str> = words.iter().map(|&word| WORDS[word]).collect();
        check(&world(&text.join(&blank)));
    }
}

#[test]
fn depth_and_number_are_bounded() {
    let deep = world(&"AttributeBegin ".repeat(100_000));
    assert!(
        deep.lines()
            .starts_with("a.pbrt:2:15361: error: blocks are nested more than 1024 levels deep")
    );
    assert!(deep.scene.is_none());
    let wrong = world(&"Shape \"x\"\n".repeat(100_000));
    assert_eq!(wrong.diagnostics.len(), 51);
    assert!(
        wrong
            .lines()
            .ends_with("error: more than 50 mistakes; the rest of the scene was not looked at")
    );
    let many: String = (0..1000).map(|i| format!("\"float a{i}\" 1 ")).collect();
    let many = world(&format!("Shape \"sphere\" {many}"));
    assert!(many.lines().contains("there are more than 256 parameters"));
    let brackets = world(&format!(
        "Shape \"sphere\" \"float a\" {}",
        "[ ".repeat(100_000)
    ));
    assert_eq!(brackets.lines(), "a.pbrt:2:26: error: `[` is not closed");
}

#[test]
fn long_chains_of_references() {
    let chain: String = (0..20_000)
        .map(|i| {
            format!(
                "Texture \"{i}\" \"float\" \"scale\" \"texture tex\" \"{}\"\n",
                i + 1
            )
        })
        .collect();
    let result = world(&format!("{chain}Texture \"20000\" \"float\" \"constant\""));
    assert_eq!(
        result.lines(),
        "a.pbrt:19874:9: error: this texture contains others more than 128 levels deep"
    );
}

/// Comparing a long name with all that are known would take time and memory in proportion to its length, again and again.
#[test]
fn long_names() {
    let long = "x".repeat(1 << 22);
    let texts = [
        format!("Shape \"{long}\""),
        format!("{long} X{long}"),
        format!("Option \"{long}\" 1 ColorSpace \"{long}\" Attribute \"{long}\""),
        format!("Shape \"sphere\" \"{long} a\" 1 \"float {long}\" {long}"),
        format!(
            "NamedMaterial \"{long}\" MakeNamedMaterial \"y{long}\" \"string type\" \"diffuse\""
        ),
    ];
    for text in texts {
        let result = world(&text);
        check(&result);
        assert!(result.has_errors() && result.lines().len() < 2000);
    }
}
