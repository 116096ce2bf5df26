//! Scenes in pbrt's language: Etalon reads all of them, and where a picture has no noise it is the truth.

use etalon_conform::mode::Mode;
use etalon_conform::pbrt_scene;
use etalon_conform::questions::ALL;
use etalon_render::pipeline::{self, LoadOptions, Loaded, RenderOptions};
use std::fs;

fn loaded(text: &str) -> Loaded {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scene.pbrt");
    fs::write(&path, text).expect("written");
    match pipeline::load(&path, &LoadOptions::default()) {
        Ok(loaded) => loaded,
        Err(refusal) => panic!("{:?}\n{text}", refusal.diagnostics),
    }
}

#[test]
fn scenes_for_pbrt_are_read() {
    let mut without = Vec::new();
    for question in ALL {
        let (scene, _) = question.posed(5, 1);
        match pbrt_scene::write(&scene, Mode::Measure) {
            Ok(text) => drop(loaded(&text)),
            Err(why) => without.push((question.name, why)),
        }
    }
    // Mirrors (3), maps of the sky (3), other rules of spots (2) and of facets (2).
    assert_eq!(without.len(), 10, "{without:?}");
}

/// Mutants rejected: a picture that is not mirrored, a spot's cone for its half, and a sun that shines the other way.
#[test]
fn pictures_without_noise_are_the_truth() {
    let names = [
        "wall",
        "point-light",
        "spot-light-off-axis",
        "spot-falloff-smooth",
        "sun",
        "conductor-weak",
    ];
    for question in ALL.iter().filter(|question| names.contains(&question.name)) {
        let (scene, truth) = question.posed(5, 1);
        let text = pbrt_scene::write(&scene, Mode::Measure).expect("it can be said");
        let loaded = loaded(&text);
        let options = RenderOptions {
            spp: Some(64),
            ..RenderOptions::default()
        };
        let plan = pipeline::plan(&loaded, &options);
        let rendered = pipeline::render(&loaded, &plan, &()).expect("rendered");
        let green = rendered.developed.image.channel("G").expect("green");
        for (pixel, (found, known)) in green.iter().zip(&truth.means).enumerate() {
            let off = (f64::from(*found) / known - 1.0).abs();
            assert!(
                off < 0.02,
                "{}, pixel {pixel}: {found}, {known}",
                question.name
            );
        }
    }
}
