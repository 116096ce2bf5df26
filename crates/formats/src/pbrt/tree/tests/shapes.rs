//! Shapes, objects and media.

use super::evaluated::Evaluated;
use super::*;
use etalon_transport::SpectrumKind;
use glam::{Vec2, Vec3, Vec4};

/// The default material.
const MATTE: &str = r#"<bsdf type="twosided"><bsdf type="diffuse"><float name="reflectance" value="0.5"/></bsdf></bsdf>"#;
const FLIP: &str = r#"<boolean name="flip_normals" value="true"/>"#;
const FLAT: &str = r#"<boolean name="face_normals" value="true"/>"#;

#[track_caller]
fn assert_shape(pbrt: &str, plugin: &str, own: &str) {
    assert_same_world(
        pbrt,
        &format!("<shape type=\"{plugin}\">{own}{MATTE}</shape>"),
    );
}

const SPHERE: &str = r#"Shape "sphere" "float radius" 2"#;
const RADIUS: &str = r#"<float name="radius" value="2"/>"#;
const MIRRORED: &str = r#"<transform name="to_world"><scale x="-1"/></transform>"#;

#[test]
fn spheres_turn_by_themselves() {
    assert_shape(SPHERE, "sphere", RADIUS);
    let mirrored = format!("Scale -1 1 1 {SPHERE}");
    assert_shape(&mirrored, "sphere", &format!("{RADIUS}{MIRRORED}"));
    let both = format!("ReverseOrientation {mirrored}");
    assert_shape(&both, "sphere", &format!("{RADIUS}{MIRRORED}{FLIP}"));
}

#[test]
fn disks_and_cylinders_are_turned() {
    let raised = r#"<transform name="to_world"><scale x="2" y="2"/><translate z="3"/></transform>"#;
    let disk = r#"Shape "disk" "float radius" 2 "float height" 3"#;
    assert_shape(disk, "disk", raised);
    let mirrored = r#"<transform name="to_world"><scale x="2" y="2"/><translate z="3"/><scale x="-1"/></transform>"#;
    assert_shape(
        &format!("Scale -1 1 1 {disk}"),
        "disk",
        &format!("{mirrored}{FLIP}"),
    );
    let both = format!("ReverseOrientation Scale -1 1 1 {disk}");
    assert_shape(&both, "disk", mirrored);
    let cylinder = r#"<point name="p0" x="0" y="0" z="-1"/><point name="p1" x="0" y="0" z="4"/>"#;
    let text = r#"ReverseOrientation Shape "cylinder" "float zmax" 4 "float radius" 2"#;
    assert_shape(text, "cylinder", &format!("{cylinder}{RADIUS}{FLIP}"));
}

#[test]
fn meshes_stand_in_the_document() {
    let mesh = r#"Shape "trianglemesh" "point3 P" [ 0 0 0  1 0 0  0 1 0 ]"#;
    let index = r#"<string name="filename" value="mesh 0 of the scene file"/>"#;
    assert_shape(mesh, "ply", &format!("{index}{FLAT}"));
    let mirrored = format!("Scale -1 1 1 {mesh}");
    assert_shape(&mirrored, "ply", &format!("{index}{FLAT}{FLIP}{MIRRORED}"));
    let normals = format!("{mirrored} \"normal N\" [ 0 0 1  0 0 1  0 0 1 ]");
    assert_shape(&normals, "ply", &format!("{index}{MIRRORED}"));
    let reversed = format!("ReverseOrientation {normals}");
    assert_shape(&reversed, "ply", &format!("{index}{MIRRORED}{FLIP}"));

    let document = sound(&format!(
        "WorldBegin {normals} \"point2 uv\" [ 0 0 1 0 1 1 ]"
    ));
    let [data] = document.meshes.as_slice() else {
        panic!("{} meshes", document.meshes.len());
    };
    assert_eq!(
        data.positions,
        [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(glam::Vec3::from)
    );
    assert_eq!(data.triangles, [[0, 1, 2]]);
    assert_eq!(data.normals, [glam::Vec3::Z; 3]);
    assert_eq!(data.uvs[2], glam::Vec2::ONE);
}

#[test]
fn texture_coordinates_that_pbrt_adds() {
    let text = r#"WorldBegin Texture "t" "spectrum" "checkerboard"
        Material "diffuse" "texture reflectance" "t"
        Shape "trianglemesh" "point3 P" [ 0 0 0  1 0 0  0 1 0  1 1 0 ] "integer indices" [ 0 1 2  2 1 3 ]"#;
    let document = sound(text);
    let [zero, right, one] = [glam::Vec2::ZERO, glam::Vec2::X, glam::Vec2::ONE];
    assert_eq!(document.meshes[0].uvs, [zero, right, one, zero, right, one]);
    assert_eq!(document.meshes[0].triangles, [[0, 1, 2], [3, 4, 5]]);
}

#[test]
fn parallelograms_are_two_triangles() {
    let mesh = r#"Shape "bilinearmesh" "point3 P" [ 0 0 0  2 0 0  0 1 0  2 1 0 ]"#;
    let index = r#"<string name="filename" value="mesh 0 of the scene file"/>"#;
    assert_shape(mesh, "ply", &format!("{index}{FLAT}"));
    let document = sound(&format!("WorldBegin {mesh}"));
    assert_eq!(document.meshes[0].triangles, [[0, 1, 3], [0, 3, 2]]);
    let curved = r#"Shape "bilinearmesh" "point3 P" [ 0 0 0  2 0 0  0 1 0  2 1 1 ]"#;
    let corners = r#"<point name="p00" x="0" y="0" z="0"/><point name="p10" x="2" y="0" z="0"/>
        <point name="p01" x="0" y="1" z="0"/><point name="p11" x="2" y="1" z="1"/>"#;
    assert_shape(curved, "bilinear", corners);
}

#[test]
fn spheres_with_images_are_mirrored() {
    let text = r#"Texture "t" "spectrum" "imagemap" "string filename" "a.png"
        Material "diffuse" "texture reflectance" "t" Shape "sphere""#;
    assert_same_world(
        text,
        r#"<shape type="sphere"><float name="radius" value="1"/>
            <transform name="to_world"><scale z="-1"/></transform> <boolean name="flip_normals" value="true"/>
            <bsdf type="twosided"><bsdf type="diffuse"><texture type="bitmap" name="reflectance">
                <string name="filename" value="a.png"/>
                <transform name="to_uv"><scale y="-1"/><translate y="1"/></transform>
            </texture></bsdf></bsdf></shape>"#,
    );
}

#[test]
fn alpha_is_a_mask() {
    assert_same_world(
        r#"Shape "sphere" "float alpha" 0.25"#,
        &format!(
            r#"<shape type="sphere"><float name="radius" value="1"/>
                <bsdf type="mask"><float name="opacity" value="0.25"/>{MATTE}</bsdf></shape>"#
        ),
    );
}

#[test]
fn moving_shapes() {
    let moved = r#"<animation name="to_world">
        <transform time="0"><translate x="1"/></transform>
        <transform time="1"><rotate z="1" angle="90"/><translate x="3"/></transform></animation>"#;
    let text = r#"Camera "perspective" "float shutterclose" 1 WorldBegin
        ActiveTransform StartTime Translate 1 0 0 ActiveTransform EndTime Translate 3 0 0 Rotate 90 0 0 1
        Shape "sphere""#;
    let document = sound(text);
    let shape = children(&document.root)
        .into_iter()
        .find(|n| n.plugin.value == "sphere");
    let expected = xml(&format!("<shape type=\"sphere\">{moved}</shape>"));
    let at = |node: &Node, end: f64| {
        node.properties.iter().find_map(|p| match &p.value {
            Value::Animation { motion, .. } => Some(numbers(&motion.at(end).to_cols_array())),
            _ => None,
        })
    };
    let (found, expected) = (shape.expect("a shape"), children(&expected.root).remove(0));
    for time in [0.0, 0.4, 1.0] {
        assert_eq!(at(&found, time), at(&expected, time));
        assert!(at(&found, time).is_some());
    }
}

#[test]
fn objects_are_groups() {
    let sphere =
        format!("<shape type=\"sphere\"><float name=\"radius\" value=\"1\"/>{MATTE}</shape>");
    assert_same_world(
        r#"ObjectBegin "a" Shape "sphere" ObjectEnd
           ObjectBegin "unused" Shape "loopsubdiv" ObjectEnd
           Translate 1 2 3 ObjectInstance "a""#,
        &format!(
            r#"<shape type="shapegroup" id="a">{sphere}</shape>
               <shape type="instance"><ref id="a"/><transform name="to_world"><translate x="1" y="2" z="3"/></transform></shape>"#
        ),
    );
}

#[test]
fn media_are_on_the_sides_of_surfaces() {
    assert_same_world(
        r#"MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ 1 2 3 ] "rgb sigma_s" [ 3 2 1 ]
               "float scale" 2 "float g" 0.5 "rgb Le" [ 1 1 2 ] "float Lescale" 3
           MediumInterface "fog" "" Material "interface" Shape "sphere""#,
        r#"<shape type="sphere"><float name="radius" value="1"/><bsdf type="null"/>
            <medium type="homogeneous" name="interior">
                <rgb name="sigma_a" value="1 2 3"/><rgb name="sigma_s" value="3 2 1"/><float name="scale" value="2"/>
                <rgb name="emission" value="3 3 6"/><phase type="hg"><float name="g" value="0.5"/></phase>
            </medium></shape>"#,
    );
}

#[test]
fn media_by_default_and_by_name() {
    let medium = |parameters: &str| {
        let text = format!(
            "WorldBegin MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" {parameters} MediumInterface \"\" \"fog\" Shape \"sphere\""
        );
        let shape = children(&sound(&text).root).pop().expect("a shape");
        shown(&children(&shape).pop().expect("a medium"))
    };
    let plain = medium("");
    for part in ["sigma_a: float 1.0", "sigma_s: float 1.0", "g: float 0.0"] {
        assert!(plain.contains(part), "{plain}");
    }
    let named = medium("\"string preset\" \"Ketchup\" \"float scale\" 3");
    assert!(named.contains("material: string Ketchup"), "{named}");
    assert!(named.contains("scale: float 3.0"), "{named}");
}

#[test]
fn files_of_meshes() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let write = |name: &str, normals: &str, ends: &str| {
        let header = format!(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n{normals}element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        );
        let text = format!("{header}0 0 0{ends}\n1 0 0{ends}\n0 1 0{ends}\n3 0 1 2\n");
        std::fs::write(folder.path().join(name), text).expect("written");
    };
    write("flat.ply", "", "");
    let normals = "property float nx\nproperty float ny\nproperty float nz\n";
    write("round.ply", normals, " 0 0 1");
    let text = r#"WorldBegin Scale -1 1 1 Shape "plymesh" "string filename" "flat.ply"
        Shape "plymesh" "string filename" "round.ply""#;
    let path = folder.path().join("a.pbrt");
    std::fs::write(&path, text).expect("written");
    let outcome = pbrt::read(&path, &ReadOptions::default());
    assert_eq!(outcome.lines(), "");
    let shape = |name: &str, more: &str| {
        format!(
            "<shape type=\"ply\"><string name=\"filename\" value=\"{name}\"/>{MIRRORED}{more}{MATTE}</shape>"
        )
    };
    let expected = shape("flat.ply", &format!("{FLAT}{FLIP}")) + &shape("round.ply", "");
    assert_alike(&outcome.document.expect("a document"), &xml(&expected));
}

/// What shines through holes: the radiance is there where the shape is.
#[test]
fn shapes_with_holes_may_shine() {
    assert_same_world(
        r#"AreaLightSource "diffuse" "rgb L" [ 2 4 6 ] Shape "sphere" "float alpha" 0.25"#,
        &format!(
            r#"<shape type="sphere"><float name="radius" value="1"/>
                <bsdf type="mask"><float name="opacity" value="0.25"/>{MATTE}</bsdf>
                <emitter type="area"><rgb name="radiance" value="0.5 1 1.5"/></emitter></shape>"#
        ),
    );
    let document = sound(
        r#"WorldBegin Texture "holes" "float" "checkerboard" "integer dimension" 3 "float tex1" 0.25
            AreaLightSource "diffuse" "rgb L" [ 2 4 6 ] Shape "sphere" "texture alpha" "holes""#,
    );
    let lambda = Vec4::new(420.0, 500.0, 580.0, 660.0);
    let whole = etalon_spectrum::Spectrum::emission([2.0, 4.0, 6.0]).expect("light");
    let radiance = Evaluated::of(&document, "radiance", SpectrumKind::Emission);
    for (place, share) in [(0.5, 0.25), (1.5, 0.0)] {
        let found = radiance.spectrum(Vec3::new(place, 0.5, 0.5), lambda);
        let expected = share * whole.eval(lambda);
        let off = (found - expected).abs() / whole.eval(lambda);
        assert!(off.max_element() < 1e-5, "{found} {expected}");
    }
    let unseen =
        world(r#"AreaLightSource "diffuse" "rgb L" [ 2 4 6 ] Shape "sphere" "float alpha" 0"#);
    assert!(
        unseen.lines().contains("lights that are not seen"),
        "{}",
        unseen.lines()
    );
}

/// Two triangles with texture coordinates, in a folder of their own.
fn square(text: &str) -> ReadOutcome {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let vertices = "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n";
    let ply = format!(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float u\nproperty float v\n\
         element face 2\nproperty list uchar int vertex_indices\nend_header\n{vertices}3 0 1 2\n3 0 2 3\n"
    );
    std::fs::write(folder.path().join("square.ply"), ply).expect("written");
    let path = folder.path().join("a.pbrt");
    std::fs::write(&path, format!("WorldBegin {text}")).expect("written");
    pbrt::read(&path, &ReadOptions::default())
}

#[test]
fn meshes_are_displaced_as_etalon_does() {
    let texture = r#"Texture "h" "float" "bilerp" "float v10" 0.5 "float v11" 0.5 "float v01" 0"#;
    let mesh = r#"Shape "plymesh" "string filename" "square.ply" "texture displacement" "h" "float edgelength" 0.25"#;
    let outcome = square(&format!("{texture} Rotate 90 0 0 1 Scale 2 2 2 {mesh}"));
    assert_eq!(outcome.lines(), "");
    let shape = children(&outcome.document.expect("a document").root).pop();
    let shape = shape.expect("a shape");
    assert_eq!(shape.plugin.value, "displacement");
    let text = shown(&shape);
    for part in [
        "edge_length: float 2.500000e-1",
        "scale: float 2.000000e0",
        "shape ply",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    for (before, expected) in [
        ("Scale 1 2 1", "stretched, mirrored or turned inside out"),
        ("Scale -1 1 1", "stretched, mirrored or turned inside out"),
        (
            "ReverseOrientation",
            "stretched, mirrored or turned inside out",
        ),
    ] {
        let said = square(&format!("{texture} {before} {mesh}")).lines();
        assert!(said.contains(expected), "{before}: {said}");
    }
    let cubes = r#"Texture "h" "float" "checkerboard" "integer dimension" 3"#;
    let said = square(&format!("{cubes} Translate 1 0 0 {mesh}")).lines();
    assert!(said.contains("by a texture in space"), "{said}");
    assert_eq!(square(&format!("{cubes} {mesh}")).lines(), "");
}

/// An image on a mesh from a file without coordinates lies on each triangle as pbrt puts it there; without an image the file is
/// left to be read with the scene.
#[test]
fn files_without_coordinates_get_pbrts() {
    let options = ReadOptions {
        search: vec![concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/pbrt").into()],
        ..ReadOptions::default()
    };
    let mesh = r#"Shape "plymesh" "string filename" "octahedron.ply""#;
    let read = |text: &str| {
        let outcome = pbrt::read_text("a.pbrt", &format!("WorldBegin {text}"), &options);
        assert_eq!(outcome.lines(), "");
        outcome.document.expect("a document").meshes
    };
    assert!(read(mesh).is_empty());
    let image = r#"Texture "t" "spectrum" "imagemap" "string filename" "tiles.png"
        Material "diffuse" "texture reflectance" "t""#;
    let meshes = read(&format!("{image} {mesh}"));
    assert_eq!(meshes[0].triangles.len(), 8);
    assert_eq!(meshes[0].uvs, [Vec2::ZERO, Vec2::X, Vec2::ONE].repeat(8));
}
