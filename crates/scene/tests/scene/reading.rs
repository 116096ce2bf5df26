//! Scenes written in the test.

use etalon_formats::FileAssets;
use etalon_formats::{ReadOptions, mitsuba};
use etalon_params::{Diagnostics, Severity};
use etalon_scene::{Compiled, Scene};
use etalon_spectrum::Wavelengths;
use etalon_transport::{Hit, Ray, SurfaceInteraction, Surfaces, World};
use glam::{Vec3, Vec4};

/// What came of reading a scene.
pub(crate) struct Read {
    pub(crate) compiled: Option<Compiled>,
    /// `line:column: message` of every mistake.
    pub(crate) errors: Vec<String>,
    /// The same for remarks.
    pub(crate) notes: Vec<String>,
}

/// Reads a scene file with the given files beside it.
pub(crate) fn read_with(scene: &str, files: &[(&str, &str)]) -> Read {
    let folder = tempfile::tempdir().expect("a folder for the test");
    for (name, text) in files {
        std::fs::write(folder.path().join(name), text).expect("a writable folder");
    }
    let path = folder.path().join("scene.xml");
    std::fs::write(&path, scene).expect("a writable folder");
    let read = mitsuba::read(&path, &ReadOptions::default());
    let diagnostics = Diagnostics::silent_about(&read.stand_ins);
    let sound = !read.has_errors();
    let mut messages = read.diagnostics.clone();
    let compiled = read.document.as_ref().and_then(|document| {
        let assets = FileAssets::of(document);
        etalon_scene::compile(&document.root, &assets, &diagnostics)
    });
    messages.extend(diagnostics.into_sorted());
    let (errors, notes): (Vec<_>, Vec<_>) =
        messages.iter().partition(|d| d.severity == Severity::Error);
    let lines = |list: Vec<&etalon_params::Diagnostic>| {
        let line = |d: &etalon_params::Diagnostic| match d.span {
            Some(span) => {
                let (line, column) = read.sources.position(span);
                format!("{line}:{column}: {}", d.message)
            }
            None => d.message.clone(),
        };
        list.into_iter().map(line).collect()
    };
    Read {
        compiled: compiled.filter(|_| sound),
        errors: lines(errors),
        notes: lines(notes),
    }
}

/// Reads the content of a `<scene>` that looks along −z from (0, 0, 10).
pub(crate) fn read(content: &str) -> Read {
    read_with(&document(content), &[])
}

/// A scene file around `content`, which begins on its second line.
pub(crate) fn document(content: &str) -> String {
    format!(
        "<scene version=\"3.0.0\">\n{content}\n<sensor type=\"perspective\">\
         <transform name=\"to_world\"><lookat origin=\"0,0,10\" target=\"0,0,0\" up=\"0,1,0\"/>\
         </transform></sensor></scene>"
    )
}

/// The scene itself, which must be free of mistakes.
pub(crate) fn scene(content: &str) -> Scene {
    let read = read(content);
    assert_eq!(read.errors, Vec::<String>::new());
    read.compiled.expect("a scene without mistakes").scene
}

/// Four wavelengths.
pub(crate) const LANES: Wavelengths = Wavelengths {
    lambda: Vec4::new(450.0, 520.0, 580.0, 640.0),
    density: Vec4::splat(0.002),
};

/// A ray down the z axis at (x, y).
pub(crate) fn down(x: f32, y: f32) -> Ray {
    Ray::new(Vec3::new(x, y, 10.0), -Vec3::Z, 0.0)
}

/// What a ray meets.
pub(crate) fn meet(scene: &Scene, ray: &Ray) -> Option<(Hit, SurfaceInteraction)> {
    let hit = scene.surfaces().intersect(ray)?;
    Some((hit, scene.surfaces().vertex(ray, &hit)))
}
