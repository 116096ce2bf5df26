//! What textures find on meshes: values that their use allows, and messages where they do not find
//! what they ask for.

use crate::reading::{LANES, Read, document, down, meet, read_with};
use etalon_transport::{Bsdf, Surfaces, World};
use glam::{Vec3, Vec4};

/// A large triangle across the z axis, with the same values at all vertices.
fn mesh(properties: &str, values: &str) -> String {
    let mut text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n\
         property float y\nproperty float z\n"
        .to_owned();
    for property in properties.split(',') {
        text += &format!("property {property}\n");
    }
    text += "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    for corner in ["-9 -9 0", "9 -9 0", "0 9 0"] {
        text += &format!("{corner} {values}\n");
    }
    text + "3 0 1 2\n"
}

fn texture(name: &str, parameter: &str, scale: f64) -> String {
    format!(
        "<texture type=\"mesh_attribute\" name=\"{parameter}\">\
         <string name=\"name\" value=\"{name}\"/><float name=\"scale\" value=\"{scale}\"/></texture>"
    )
}

/// A scene of a mesh with `content` on it.
fn on(mesh: &str, content: &str) -> Read {
    let shape = "<shape type=\"ply\"><string name=\"filename\" value=\"t.ply\"/>";
    let scene = document(&format!("{shape}\n{content}</shape>"));
    read_with(&scene, &[("t.ply", mesh)])
}

/// The albedo of a diffuse mesh with this reflectance, and the notes.
fn albedo(mesh: &str, name: &str, scale: f64) -> (Vec4, Vec<String>) {
    let texture = texture(name, "reflectance", scale);
    let read = on(mesh, &format!("<bsdf type=\"diffuse\">{texture}</bsdf>"));
    assert_eq!(read.errors, Vec::<String>::new());
    let scene = read.compiled.expect("a scene without mistakes").scene;
    let (_, vertex) = meet(&scene, &down(0.0, 0.0)).expect("a surface");
    let bsdf = scene.surfaces().bsdf(&vertex, Vec3::Z, &LANES);
    (bsdf.albedo(Vec3::Z), read.notes)
}

const BYTES: &str = "uchar red,uchar green,uchar blue";
const FLOATS: &str = "float red,float green,float blue";

#[test]
fn reflectances_are_held_to_0_and_1_and_a_note_says_so() {
    for (properties, values, name, expected) in [
        (BYTES, "128 128 128", "vertex_color", 1.0),
        (FLOATS, "-.5 -.5 -.5", "vertex_color", 0.0),
        ("float quality", "50", "vertex_quality", 1.0),
        (FLOATS, "7 7 7", "vertex_color", 1.0),
    ] {
        let (found, notes) = albedo(&mesh(properties, values), name, 1.0);
        assert_eq!(found, Vec4::splat(expected), "{values}");
        assert_eq!(notes.len(), 1, "{notes:?}");
        assert!(
            notes[0].starts_with("3:") && notes[0].contains("outside of [0, 1]"),
            "{notes:?}"
        );
    }
    // Colours of three values are held one by one, whatever order they are stored in.
    let (held, _) = albedo(&mesh(FLOATS, "9 .25 -3"), "vertex_color", 1.0);
    let (plain, notes) = albedo(&mesh(FLOATS, "1 .25 0"), "vertex_color", 1.0);
    assert_eq!(held, plain);
    assert_eq!(notes, Vec::<String>::new());
    let other = mesh(
        "float blue,float quality,float green,float red",
        "0 8 .25 1",
    );
    assert_eq!(albedo(&other, "vertex_color", 1.0).0, plain);
    // The scale that the note proposes for bytes is taken without a word.
    let (grey, notes) = albedo(&mesh(BYTES, "255 255 255"), "vertex_color", 0.003921569);
    assert!((grey - Vec4::ONE).abs().max_element() < 1e-6);
    assert_eq!(notes, Vec::<String>::new());
}

#[test]
fn light_has_no_upper_bound() {
    let glow = |values: &str| {
        let texture = texture("vertex_color", "radiance", 1.0);
        let content = format!("<emitter type=\"area\">{texture}</emitter>");
        on(&mesh(FLOATS, values), &content).notes
    };
    assert_eq!(glow("5 2 1"), Vec::<String>::new());
    let notes = glow("-1 -1 2");
    assert!(
        notes.len() == 1 && notes[0].contains("below 0 count as 0"),
        "{notes:?}"
    );
}

#[test]
fn what_is_not_there_is_said() {
    let diffuse = |name: &str| {
        let texture = texture(name, "reflectance", 1.0);
        format!("<bsdf type=\"diffuse\">{texture}</bsdf>")
    };
    let stored = mesh("float heat,float q_x,float q_y", "nan 0 0");
    let read = on(&stored, &diffuse("vertex_colour"));
    assert_eq!(read.errors.len(), 1, "{:?}", read.errors);
    let said = "no mesh attribute `vertex_colour`: the shape stores `vertex_heat`, `vertex_q`";
    assert!(read.errors[0].ends_with(said), "{:?}", read.errors);
    // Not finite: no harm until somebody asks for it.
    assert_eq!(
        on(&stored, &diffuse("vertex_q")).errors,
        Vec::<String>::new()
    );
    let errors = on(&stored, &diffuse("vertex_heat")).errors;
    assert!(
        errors.len() == 1 && errors[0].contains("3 of the 3 numbers"),
        "{errors:?}"
    );
}

#[test]
fn a_texture_without_coordinates_is_noted() {
    let board = "<bsdf type=\"twosided\"><bsdf type=\"diffuse\">\
         <texture type=\"checkerboard\" name=\"reflectance\"/></bsdf></bsdf>";
    let notes = on(&mesh("float heat", "0"), board).notes;
    assert!(
        notes.len() == 1 && notes[0].contains("without texture coordinates"),
        "{notes:?}"
    );
    assert_eq!(
        on(&mesh("float u,float v", "0 0"), board).notes,
        Vec::<String>::new()
    );
    // Once, however many meshes wear it.
    let shape =
        "<shape type=\"ply\"><string name=\"filename\" value=\"t.ply\"/><ref id=\"m\"/></shape>\n";
    let shared = board.replacen("<bsdf ", "<bsdf id=\"m\" ", 1) + "\n" + &shape.repeat(5);
    let read = read_with(&document(&shared), &[("t.ply", &mesh("float heat", "0"))]);
    assert_eq!(read.notes.len(), 1, "{:?}", read.notes);
}

/// Clouds of ellipsoids are like meshes; their ellipsoids cannot be lights, their shells can.
#[test]
fn clouds_have_attributes() {
    let names = "x y z scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3 heat";
    let properties: String = (names.split(' '))
        .map(|name| format!("property float {name}\n"))
        .collect();
    let file = format!(
        "ply\nformat ascii 1.0\nelement vertex 2\n{properties}end_header\n\
         9 0 0 0 0 0 1 0 0 0 0.25\n0 0 0 0 0 0 1 0 0 0 0.75\n"
    );
    for (plugin, lights) in [("ellipsoids", false), ("ellipsoidsmesh", true)] {
        let on = |content: &str| {
            let name = "<string name=\"filename\" value=\"t.ply\"/>";
            let scene = document(&format!(
                "<shape type=\"{plugin}\">{name}\n{content}</shape>"
            ));
            read_with(&scene, &[("t.ply", file.as_str())])
        };
        let heat = texture("vertex_heat", "reflectance", 1.0);
        let read = on(&format!("<bsdf type=\"diffuse\">{heat}</bsdf>"));
        assert_eq!(read.errors, Vec::<String>::new());
        let scene = read.compiled.expect("a scene without mistakes").scene;
        let (_, vertex) = meet(&scene, &down(0.1, 0.1)).expect("a surface");
        let bsdf = scene.surfaces().bsdf(&vertex, Vec3::Z, &LANES);
        let albedo = bsdf.albedo(Vec3::Z);
        assert!(
            (albedo - 0.75).abs().max_element() < 1e-5,
            "{plugin}: {albedo}"
        );
        let cold = texture("vertex_cold", "reflectance", 1.0);
        let errors = on(&format!("<bsdf type=\"diffuse\">{cold}</bsdf>")).errors;
        assert!(
            matches!(errors.as_slice(), [only] if only.contains("the shape stores `vertex_heat`")),
            "{errors:?}"
        );
        let errors = on("<emitter type=\"area\"/>").errors;
        assert_eq!(errors.is_empty(), lights, "{errors:?}");
    }
}
