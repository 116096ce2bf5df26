//! Scenes with a few words changed are scenes or have messages; nothing panics, and nothing takes long.

use super::*;
use crate::changed_files::{Numbers, changed_files};
use std::time::{Duration, Instant};

/// Scenes that have most of what there is.
const SCENES: [&str; 5] = [
    include_str!("../../../../../../scenes/pbrt/lights.pbrt"),
    include_str!("../../../../../../scenes/pbrt/media.pbrt"),
    include_str!("../../../../../../scenes/pbrt/shapes.pbrt"),
    include_str!("../../../../../../scenes/pbrt/surfaces.pbrt"),
    r#"Camera "orthographic" "float lensradius" 0.02 "float focaldistance" 2.5
        PixelFilter "mitchell" "float xradius" 1.5 "float yradius" 1.5
        WorldBegin
        Texture "c" "spectrum" "checkerboard" "integer dimension" 3 "rgb tex1" [ .7 .7 .7 ]
        Texture "d" "spectrum" "dots" "float uscale" 12 "rgb inside" [ .8 .8 .7 ] "texture outside" "c"
        Texture "m" "spectrum" "marble" "float scale" 4 "integer octaves" 3
        Texture "s" "float" "imagemap" "string filename" "tiles.png" "string mapping" "spherical"
            "string wrap" "black" "bool invert" true
        Texture "b" "float" "fbm"
        Shape "plymesh" "string filename" "octahedron.ply"
        Material "conductor" "texture reflectance" "d" "texture roughness" "s"
        Shape "disk"
        MakeNamedMedium "cloud" "string type" "cloud" "float density" 2 "spectrum sigma_s" [ 360 20 830 20 ]
        MakeNamedMedium "fire" "string type" "uniformgrid" "integer nz" 2 "float density" [ 1 1 ]
            "float temperature" [ 2200 900 ] "float Lescale" 0.05
        AttributeBegin
            MediumInterface "cloud" "fire"
            ColorSpace "aces2065-1"
            AreaLightSource "diffuse" "rgb L" [ 2 1.5 1 ] "bool twosided" true
            Material "interface"
            Shape "sphere" "float radius" 0.9 "texture alpha" "s"
            Shape "curve" "point3 P" [ 0 0 0 1 0 0 1 1 0 0 1 1 ] "string type" "ribbon" "normal N" [ 0 0 1 0 1 0 ]
        AttributeEnd"#,
];

/// What words are replaced by, beside words of the scenes.
const OTHERS: [&str; 12] = [
    "nan",
    "-1",
    "0",
    "1e39",
    "1e-40",
    "99999999999",
    "[",
    "]",
    "\"",
    "\"float\"",
    "é",
    "#",
];

/// The words of a scene without its comments; a string is one.
fn words(scene: &'static str) -> Vec<&'static str> {
    let mut words = Vec::new();
    for line in scene.lines() {
        let mut rest = line.split('#').next().unwrap_or_default().trim_start();
        while !rest.is_empty() {
            let end = match rest.strip_prefix('"') {
                Some(string) => string.find('"').map(|end| end + 2),
                None => rest.find(char::is_whitespace),
            };
            let (word, after) = rest.split_at(end.unwrap_or(rest.len()));
            words.push(word);
            rest = after.trim_start();
        }
    }
    words
}

/// A scene with one to four changes of its words.
fn changed(numbers: &mut Numbers, words: &[Vec<&str>]) -> String {
    let mut scene = words[numbers.below(words.len())].clone();
    for _ in 0..=numbers.below(4) {
        let place = numbers.below(scene.len());
        let other = &words[numbers.below(words.len())];
        let other = other[numbers.below(other.len())];
        match numbers.below(6) {
            0 => drop(scene.remove(place)),
            1 => scene.insert(place, other),
            2 => scene[place] = OTHERS[numbers.below(OTHERS.len())],
            3 => {
                let with = numbers.below(scene.len());
                scene.swap(place, with);
            }
            4 if numbers.below(8) == 0 => scene.truncate(place.max(1)),
            _ => scene[place] = other,
        }
        if scene.is_empty() {
            scene.push("#");
        }
    }
    scene.join("\n")
}

/// `ETALON_CHANGED_FILES=100000` asks for more of them.
#[test]
fn changed_scenes_are_survived() {
    let count = changed_files(2000);
    let words = SCENES.map(words);
    let options = ReadOptions {
        search: vec![concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/pbrt").into()],
        ..ReadOptions::default()
    };
    let read = |text: &str| pbrt::read_text("changed.pbrt", text, &options);
    for scene in &words {
        let text = scene.join("\n");
        let outcome = read(&text);
        assert!(!outcome.has_errors(), "{}", outcome.lines());
    }
    let mut numbers = Numbers(20_261_130);
    let mut sound = 0;
    for _ in 0..count {
        let text = changed(&mut numbers, &words);
        let start = Instant::now();
        let outcome = read(&text);
        assert!(start.elapsed() < Duration::from_secs(5), "{text}");
        for diagnostic in &outcome.diagnostics {
            if let Some(span) = diagnostic.span {
                let length = outcome.sources.text(span.file).len();
                assert!(
                    span.start <= span.end && span.end as usize <= length,
                    "{text}"
                );
            }
        }
        assert_eq!(outcome.document.is_some(), !outcome.has_errors(), "{text}");
        sound += u32::from(outcome.document.is_some());
    }
    assert!(
        sound > count / 40 && sound < count,
        "{sound} were still scenes"
    );
}
