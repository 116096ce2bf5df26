//! PLY files of all three formats, broken ones, and agreement with the crate `ply-rs-bw`.

use super::*;
use glam::Vec3;
use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::{DefaultElement, Property as TheirProperty};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

mod elements;

/// A text file with these properties of vertices (besides `x y z`), vertices and faces.
fn text(properties: &str, vertices: &[&str], face_properties: &str, faces: &[&str]) -> String {
    let mut file = format!("ply\nformat ascii 1.0\nelement vertex {}\n", vertices.len());
    for name in ["float x", "float y", "double z"] {
        file.push_str(&format!("property {name}\n"));
    }
    for property in properties.split(',').filter(|p| !p.is_empty()) {
        file.push_str(&format!("property {}\n", property.trim()));
    }
    file.push_str(&format!("element face {}\n", faces.len()));
    file.push_str("property list uchar int vertex_indices\n");
    for property in face_properties.split(',').filter(|p| !p.is_empty()) {
        file.push_str(&format!("property {}\n", property.trim()));
    }
    file.push_str("end_header\n");
    for line in vertices.iter().chain(faces) {
        file.push_str(line);
        file.push('\n');
    }
    file
}

fn read(file: &str) -> MeshData {
    parse(file.as_bytes()).expect("well-formed")
}

fn message(file: &str) -> String {
    parse(file.as_bytes())
        .expect_err("malformed on purpose")
        .to_string()
}

const SQUARE: [&str; 4] = ["0 0 0", "1 0 0", "1 1 0", "0 1 0"];

#[test]
fn polygons_are_cut_and_hand_on_their_attributes() {
    let faces = ["4 0 1 2 3 .5 1 2", "3 0 2 3 .25 3 4"];
    let mesh = read(&text("", &SQUARE, "float q, float r, float g", &faces));
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 2, 3]]);
    assert_eq!(mesh.attributes.len(), 2);
    assert_eq!(mesh.attributes[0].name, "face_q");
    assert_eq!(mesh.attributes[0].values, [0.5, 0.5, 0.25]);
    assert_eq!(mesh.attributes[1].name, "face_color");
    assert_eq!(mesh.attributes[1].values, [1.0, 2.0, 1.0, 2.0, 3.0, 4.0]);
}

#[test]
fn normals_texture_coordinates_and_attributes() {
    let vertices = [
        "0 0 0 0 0 1 .1 .2 9 255",
        "1 0 0 0 0 1 .3 .4 9 128",
        "0 1 0 0 0 1 0 0 9 0",
    ];
    for names in UV_NAMES {
        let properties = format!(
            "float nx, float ny, float nz, float {}, float {}, float heat_x, uchar red",
            names[0], names[1]
        );
        let mesh = read(&text(&properties, &vertices, "", &["3 0 1 2"]));
        assert_eq!(mesh.normals, [Vec3::Z; 3]);
        assert_eq!(mesh.uvs[1], Vec2::new(0.3, 0.4));
        assert_eq!(mesh.attributes[0].name, "vertex_heat");
        assert_eq!(mesh.attributes[1].name, "vertex_color");
        assert_eq!(mesh.attributes[1].values, [255.0, 128.0, 0.0]);
    }
}

#[test]
fn other_elements_and_lists_are_skipped() {
    let file = "ply\r\nformat ascii 1.0\r\ncomment by hand\r\nelement camera 2\r\nproperty float f\r\n\
        property list int int l\r\nelement vertex 3\r\nproperty float x\r\nproperty float y\r\n\
        property float z\r\nproperty list uchar float tags\r\nelement face 1\r\n\
        property list uchar uint vertex_index\r\nproperty list uchar float texcoord\r\n\
        end_header\r\n1 2 7 8\r\n1 0\r\n0 0 0 1 5\r\n1 0 0 0\r\n0 1 0 2 6 7\r\n3 0 1 2 6 0 0 0 0 0 0\r\n";
    let mesh = read(file);
    assert_eq!(mesh.triangles, [[0, 1, 2]]);
    assert_eq!(mesh.positions[2], Vec3::Y);
}

#[test]
fn mistakes_have_a_place() {
    let mesh = |vertices: &[&str], faces: &[&str]| message(&text("", vertices, "", faces));
    assert_eq!(
        mesh(&SQUARE, &["3 0 1 4"]),
        "line 14: the face refers to vertex 4, but there are 4"
    );
    assert_eq!(
        mesh(&["0 0 0", "1 x 0"], &[]),
        "line 11: `x` is not a number"
    );
    assert_eq!(
        mesh(&["0 0 0", "1 nan 0"], &["3 0 0 1"]),
        "line 11: the position of element 1 is not finite"
    );
    assert_eq!(
        mesh(&SQUARE, &["3 0 1"]),
        "line 15: the file ends before all its elements have come"
    );
    assert_eq!(
        mesh(&SQUARE, &["3 0 1.5 2"]),
        "line 14: 1.5 is not a whole number"
    );
    assert_eq!(
        mesh(&SQUARE, &["-3 0 1 2"]),
        "line 14: a list of -3 numbers"
    );
    assert_eq!(
        mesh(&SQUARE, &["2 0 1"]),
        "the file contains no faces of three or more corners; it holds 4 `vertex`, 1 `face`"
    );
    for (file, said) in [
        ("", "line 1: the file does not begin with a line `ply`"),
        ("obj\n", "line 1: the file does not begin with a line `ply`"),
        (
            "ply\nformat ascii 1.0\n",
            "line 3: the header has no `end_header`",
        ),
        (
            "ply\nend_header\n",
            "line 2: the header declares no `format`",
        ),
        (
            "ply\nformat ascii 2.0\n",
            "line 2: unknown version `2.0`, expected 1.0",
        ),
        ("ply\nformat utf8 1.0\n", "line 2: unknown format `utf8`"),
        ("ply\nelement vertex -1\n", "line 2: `-1` is not a count"),
        (
            "ply\nproperty float x\n",
            "line 2: a property stands before any element",
        ),
        (
            "ply\nelement a 1\nproperty quad x\n",
            "line 3: unknown type `quad`",
        ),
        (
            "ply\nelement a 1\nproperty list float int x\n",
            "line 3: the count of a list must be an integer",
        ),
        (
            "ply\nhello there\n",
            "line 2: `hello there` is not a line of a PLY header",
        ),
        (
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n",
            "line 3: the element `vertex` needs the properties `x`, `y` and `z`",
        ),
        (
            "ply\nformat binary_little_endian 1.0\nelement vertex 99999999999\nproperty float x\n\
          property float y\nproperty float z\nend_header\n0",
            "line 3: 99999999999 vertices are more than 32 bits can count",
        ),
        (
            "ply\nformat binary_big_endian 1.0\nelement vertex 9\nproperty float x\n\
          property float y\nproperty float z\nend_header\n0",
            "byte 112: 9 elements `vertex` of 12 bytes are announced, but 1 bytes are left",
        ),
    ] {
        assert_eq!(message(file), said);
    }
}

/// Vertices with a normal and a tag, and triangles or quads over them.
#[derive(Clone, Debug)]
struct Model {
    vertices: Vec<([f32; 3], i16)>,
    faces: Vec<Vec<u8>>,
}

fn model() -> impl Strategy<Value = Model> {
    let vertex = (prop::array::uniform3(-1e3f32..1e3), any::<i16>());
    (3usize..20)
        .prop_flat_map(move |count| {
            let face = prop::collection::vec(0..count as u8, 3..=3);
            (
                prop::collection::vec(vertex.clone(), count),
                prop::collection::vec(face, 1..12),
            )
        })
        .prop_map(|(vertices, faces)| Model { vertices, faces })
}

impl Model {
    /// The bytes of the model in one of the three formats.
    fn bytes(&self, format: Format) -> Vec<u8> {
        let name = match format {
            Format::Ascii => "ascii",
            Format::LittleEndian => "binary_little_endian",
            Format::BigEndian => "binary_big_endian",
        };
        let mut out = format!(
            "ply\nformat {name} 1.0\nelement vertex {}\nproperty float x\nproperty double y\n\
             property float z\nproperty short tag\nelement face {}\n\
             property list uchar ushort vertex_index\nend_header\n",
            self.vertices.len(),
            self.faces.len()
        )
        .into_bytes();
        fn put<const N: usize>(out: &mut Vec<u8>, little: [u8; N], format: Format) {
            let mut bytes = little;
            if format == Format::BigEndian {
                bytes.reverse();
            }
            out.extend(bytes);
        }
        for ([x, y, z], tag) in &self.vertices {
            if format == Format::Ascii {
                out.extend(format!("{x} {y} {z} {tag}\n").bytes());
                continue;
            }
            put(&mut out, x.to_le_bytes(), format);
            put(&mut out, f64::from(*y).to_le_bytes(), format);
            put(&mut out, z.to_le_bytes(), format);
            put(&mut out, tag.to_le_bytes(), format);
        }
        for face in &self.faces {
            if format == Format::Ascii {
                let corners: Vec<String> = face.iter().map(u8::to_string).collect();
                out.extend(format!("{} {}\n", face.len(), corners.join(" ")).bytes());
                continue;
            }
            out.push(face.len() as u8);
            for &corner in face {
                put(&mut out, u16::from(corner).to_le_bytes(), format);
            }
        }
        out
    }
}

use header::Format;

const FORMATS: [Format; 3] = [Format::Ascii, Format::LittleEndian, Format::BigEndian];

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(11),
        ..ProptestConfig::with_cases(150)
    })]

    #[test]
    fn what_was_written_is_read(model in model()) {
        for format in FORMATS {
            let mesh = parse(&model.bytes(format)).expect("well-formed");
            let positions: Vec<[f32; 3]> = mesh.positions.iter().map(|p| p.to_array()).collect();
            let written: Vec<[f32; 3]> = model.vertices.iter().map(|v| v.0).collect();
            prop_assert_eq!(positions, written);
            let tags: Vec<f32> = model.vertices.iter().map(|v| f32::from(v.1)).collect();
            prop_assert_eq!(&mesh.attributes[0].name, "vertex_tag");
            prop_assert_eq!(&mesh.attributes[0].values, &tags);
            let corners: Vec<u8> = mesh.triangles.iter().flatten().map(|&i| i as u8).collect();
            prop_assert_eq!(corners, model.faces.concat());
        }
    }

    #[test]
    fn agrees_with_ply_rs(model in model()) {
        for format in FORMATS {
            let bytes = model.bytes(format);
            let ours = parse(&bytes).expect("well-formed");
            let theirs = Parser::<DefaultElement>::new()
                .read_ply(&mut &bytes[..])
                .expect("well-formed");
            for (position, vertex) in ours.positions.iter().zip(&theirs.payload["vertex"]) {
                let x = match vertex["x"] {
                    TheirProperty::Float(x) => x,
                    ref other => panic!("{other:?}"),
                };
                prop_assert_eq!(position.x, x);
            }
            for (triangle, face) in ours.triangles.iter().zip(&theirs.payload["face"]) {
                let list = face["vertex_index"].to_u32_list().expect("a list of integers");
                prop_assert_eq!(&triangle[..], &list[..]);
            }
        }
    }

    #[test]
    fn broken_files_are_refused_quietly(
        model in model(),
        format in prop::sample::select(&FORMATS[..]),
        cut in any::<prop::sample::Index>(),
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
    ) {
        let mut bytes = model.bytes(format);
        for (place, byte) in edits {
            let place = place.index(bytes.len());
            bytes[place] = byte;
        }
        bytes.truncate(cut.index(bytes.len() + 1));
        if let Ok(mesh) = parse(&bytes) {
            prop_assert!(mesh.positions.iter().all(|p| p.is_finite()));
            prop_assert!(
                mesh.triangles.iter().flatten().all(|&i| (i as usize) < mesh.positions.len())
            );
        }
    }
}

/// Files of points need no faces; text and binary ones name the place of a mistake.
#[test]
fn points_need_no_faces() {
    let file = |rows: &str, count: usize| {
        format!(
            "ply\nformat ascii 1.0\nelement camera 1\nproperty float fov\nelement vertex {count}\n\
             property float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float scale_0\n\
             property float scale_1\nproperty float scale_2\nproperty float opacity\nend_header\n40\n{rows}"
        )
    };
    let text = file("1 2 3 9 4 5 6 7\n8 9 10 9 11 12 13 14\n", 2);
    let points = parse_points(text.as_bytes()).expect("points");
    assert_eq!(
        points.positions,
        [Vec3::new(1.0, 2.0, 3.0), Vec3::new(8.0, 9.0, 10.0)]
    );
    let of = |name: &str| {
        let found = points.attributes.iter().find(|a| a.name == name);
        found.map(|a| (a.channels, a.values.clone()))
    };
    assert_eq!(
        of("vertex_scale"),
        Some((3, vec![4.0, 5.0, 6.0, 11.0, 12.0, 13.0]))
    );
    assert_eq!(of("vertex_opacity"), Some((1, vec![7.0, 14.0])));
    let said = |text: &[u8]| match parse_points(text) {
        Ok(_) => panic!("malformed on purpose"),
        Err(error) => error.to_string(),
    };
    let row = "1 2 3 9 4 5 6 7\n";
    assert_eq!(
        said(file(&format!("{row}1 nan 3 9 4 5 6 7\n"), 2).as_bytes()),
        "line 17: the position of element 1 is not finite"
    );
    assert!(said(file(row, 2).as_bytes()).contains("the file ends before"));
    assert!(said(file("1 2 x", 1).as_bytes()).starts_with("line 16: `x` is not a number"));
    assert_eq!(said(file("", 0).as_bytes()), "the file has no vertices");
    let mut binary = b"ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\n\
        property float y\nproperty float z\nend_header\n"
        .to_vec();
    let start = binary.len();
    for number in [0.0, 1.0, 2.0, 3.0, f32::INFINITY, 5.0] {
        binary.extend(number.to_le_bytes());
    }
    assert_eq!(
        said(&binary),
        format!(
            "byte {}: the position of element 1 is not finite",
            start + 12
        )
    );
}
