//! Lights that depend on scene time count from a frame's moment.

use etalon_formats::mitsuba;
use etalon_render::pipeline::{LoadOptions, assets, compile};
use etalon_spectrum::Wavelengths;
use etalon_transport::{Lights, World};
use glam::{Vec3, Vec4};
use std::path::Path;
use std::time::Instant;

/// The sky overhead of a frame, through a shutter that opens at the moment `open` of it.
fn sky(open: f64, time: f64) -> Vec4 {
    let text = format!(
        "<scene version=\"3.0.0\"><shape type=\"sphere\"/><emitter type=\"timed_sunsky\"/>\
         <sensor type=\"perspective\"><float name=\"shutter_open\" value=\"{open}\"/>\
         <float name=\"shutter_close\" value=\"{}\"/></sensor></scene>",
        open + 0.001
    );
    let options = LoadOptions {
        time,
        ..LoadOptions::default()
    };
    let read = mitsuba::read_text(&text, &options.reading());
    let (files, path) = (assets(&read), Path::new(mitsuba::TEXT));
    let loaded = compile(read, &files, path, &options, Instant::now());
    let loaded = loaded.unwrap_or_else(|error| panic!("{:?}", error.diagnostics));
    let at = Wavelengths {
        lambda: Vec4::new(420.0, 500.0, 580.0, 660.0),
        density: Vec4::ONE,
    };
    let scene = &loaded.compiled.scene;
    (scene.lights()).background(Vec3::new(0.0, 0.6, 0.8), 0.0, &at)
}

/// The mutant that forgets the frame sees the first sky in every one.
#[test]
fn the_sky_of_a_frame_is_that_of_its_moment() {
    let later = sky(0.35, 0.0);
    assert_eq!(sky(0.1, 0.25), later);
    assert_ne!(sky(0.1, 0.0), later);
}
