//! What is read of pbrt and written as XML is read again as the same scene.

use super::*;
use crate::mitsuba;

fn round_trip(text: &str) {
    let document = sound(text);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let written = mitsuba::write(&document, "a", &|name| format!("elsewhere/{name}"));
    for (name, bytes) in &written.files {
        std::fs::write(folder.path().join(name), bytes).expect("written");
    }
    let path = folder.path().join("a.xml");
    std::fs::write(&path, &written.xml).expect("written");
    let outcome = mitsuba::read(&path, &ReadOptions::default());
    assert_eq!(outcome.lines(), "", "{}", written.xml);
    let again = outcome.document.expect("a document");
    // Under their new names, files are the same ones.
    let names = |node: &Node| {
        let mut text = shown(node);
        for index in 0..document.meshes.len() {
            text = text.replace(&crate::mesh_name(index), &format!("a-mesh-{index}.ply"));
        }
        for (index, (name, _)) in written.files.iter().skip(document.meshes.len()).enumerate() {
            text = text.replace(&crate::embedded_name(index), name);
        }
        text.replace("string sky.exr", "string elsewhere/sky.exr")
    };
    assert_eq!(shown(&again.root), names(&document.root));
    for (index, mesh) in document.meshes.iter().enumerate() {
        let bytes = &written.files[index].1;
        assert_eq!(crate::ply::parse(bytes).as_ref(), Ok(&**mesh));
    }
}

#[test]
fn scenes_are_the_same_again() {
    round_trip(
        r#"Camera "perspective" "float shutterclose" 1 WorldBegin
        LightSource "infinite" "string filename" "sky.exr" "float scale" 1e-7
        MakeNamedMedium "g" "string type" "uniformgrid" "float density" [ 1 2 ] "integer nx" 2
        LightSource "point" "blackbody I" 3000
        MakeNamedMaterial "m & <n>" "string type" "conductor" "float roughness" 0.3
        ObjectBegin "o" NamedMaterial "m & <n>" Shape "sphere" Shape "sphere" "float radius" 0.1 ObjectEnd
        ObjectInstance "o" Translate 1 0 0 ObjectInstance "o"
        ActiveTransform EndTime Translate 0.1 0.2 0.3 Rotate 20 0 0 1 ActiveTransform All
        Shape "trianglemesh" "point3 P" [ 0 0 0 1 0 0 0 1 0.1 ] "normal N" [ 0 0 1 0 0 1 0 0 1 ] "point2 uv" [ 0 0 1 0 0 1 ]
        Shape "curve" "string type" "cylinder" "point3 P" [ 0 0 0  1 0 0  1 1 0  1 1 1 ]
        MediumInterface "g" "" Material "interface" Shape "sphere""#,
    );
}
