//! Serialized files of both versions and precisions, agreement with the same meshes as PLY and OBJ, and
//! broken files.

use super::*;
use flate2::{Compression, write::ZlibEncoder};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::io::{Cursor, Write};

/// One shape, as a file may hold it. Mitsuba 3.9.1 reads what is made of it to the same numbers.
#[derive(Clone, Debug, Default)]
struct Model {
    positions: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    colours: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    name: String,
    face_normals: bool,
    double: bool,
}

fn square() -> Model {
    Model {
        positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.5], [0.0, 1.0, 0.1]],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Model::default()
    }
}

impl Model {
    /// The bytes before they are folded, with these counts.
    fn unfolded(&self, version: u16, vertices: u64, triangles: u64) -> Vec<u8> {
        let flag = |set: bool, flag: u32| if set { flag } else { 0 };
        let flags = flag(!self.normals.is_empty(), 1)
            | flag(!self.uvs.is_empty(), 2)
            | flag(!self.colours.is_empty(), 8)
            | flag(self.face_normals, 0x10)
            | if self.double { 0x2000 } else { 0x1000 };
        let mut out = flags.to_le_bytes().to_vec();
        if version >= 4 {
            out.extend(self.name.bytes());
            out.push(0);
        }
        out.extend(vertices.to_le_bytes());
        out.extend(triangles.to_le_bytes());
        let numbers = (self.positions.iter().flatten())
            .chain(self.normals.iter().flatten())
            .chain(self.uvs.iter().flatten())
            .chain(self.colours.iter().flatten());
        for &x in numbers {
            match self.double {
                true => out.extend(f64::from(x).to_le_bytes()),
                false => out.extend(x.to_le_bytes()),
            }
        }
        out.extend(
            self.triangles
                .iter()
                .flatten()
                .flat_map(|i| i.to_le_bytes()),
        );
        out
    }

    fn bytes(&self, version: u16) -> Vec<u8> {
        let counts = (self.positions.len() as u64, self.triangles.len() as u64);
        folded(version, &self.unfolded(version, counts.0, counts.1))
    }
}

fn folded(version: u16, unfolded: &[u8]) -> Vec<u8> {
    let mut out = [MAGIC.to_le_bytes(), version.to_le_bytes()].concat();
    let mut encoder = ZlibEncoder::new(&mut out, Compression::default());
    encoder.write_all(unfolded).expect("memory");
    encoder.finish().expect("memory");
    out
}

/// A file of these shapes, with a dictionary of entries of `width` bytes.
fn file(shapes: &[Vec<u8>], width: usize) -> Vec<u8> {
    let mut offset = 0u64;
    let mut dictionary = Vec::new();
    for shape in shapes {
        dictionary.extend(&offset.to_le_bytes()[..width]);
        offset += shape.len() as u64;
    }
    let count = (shapes.len() as u32).to_le_bytes();
    [shapes.concat(), dictionary, count.to_vec()].concat()
}

fn parse(bytes: &[u8], index: u32) -> Result<MeshData, MeshError> {
    read(&mut Cursor::new(bytes), index)
}

fn message(bytes: &[u8], index: u32) -> String {
    parse(bytes, index)
        .expect_err("broken on purpose")
        .to_string()
}

/// Three shapes that can be told apart by their first vertex.
fn three(version: u16, width: usize) -> Vec<u8> {
    let shape = |x: f32| {
        let mut model = square();
        model.positions[0][0] = -x;
        model.name = "é".repeat(x as usize);
        model.bytes(version)
    };
    file(&[shape(0.0), shape(1.0), shape(2.0)], width)
}

#[test]
fn shapes_are_found_by_their_number() {
    for (version, width) in [(3, 4), (4, 8)] {
        let bytes = three(version, width);
        for index in 0..3 {
            let mesh = parse(&bytes, index).expect("well-formed");
            assert_eq!(mesh.positions[0].x, -(index as f32));
            assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
            assert!(mesh.notes.is_empty());
        }
        let said = "byte 0: there is no shape 3: the file has 3 shapes, 0 to 2";
        assert_eq!(message(&bytes, 3), said);
        assert_eq!(
            message(&bytes, u32::MAX),
            said.replace("shape 3:", "shape 4294967295:")
        );
        let one = message(&file(&[square().bytes(version)], width), 1);
        assert!(one.ends_with("there is no shape 1: the file has 1 shape, 0"));
    }
}

#[test]
fn a_dictionary_that_leads_nowhere_is_done_without() {
    // Entries of the other version's width are told from the right ones.
    for (version, width) in [(3, 8), (4, 4)] {
        let bytes = three(version, width);
        for index in 0..3 {
            let mesh = parse(&bytes, index).expect("found");
            assert_eq!(mesh.positions[0].x, -(index as f32));
            assert!(mesh.notes.is_empty());
        }
        assert!(message(&bytes, 3).ends_with("the file has 3 shapes, 0 to 2"));
    }
    // With something behind it, or without it, shapes are counted from the beginning.
    let whole = three(4, 8);
    for bytes in [
        [&whole[..], b"garbage"].concat(),
        whole[..whole.len() - 28].to_vec(),
    ] {
        for index in 1..3 {
            let mesh = parse(&bytes, index).expect("found");
            assert_eq!(mesh.positions[0].x, -(index as f32));
            assert_eq!(mesh.notes.len(), 1);
        }
        assert!(parse(&bytes, 0).expect("found").notes.is_empty());
        assert!(message(&bytes, 9).ends_with("there is no shape 9: the file has 3 shapes, 0 to 2"));
    }
}

#[test]
fn everything_a_shape_can_have() {
    for version in [3, 4] {
        for double in [false, true] {
            let model = Model {
                normals: vec![[0.0, 0.0, 2.0]; 4],
                uvs: vec![[0.1, 0.2], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
                colours: vec![[0.5, 0.25, 1.0]; 4],
                name: "plate №1".into(),
                face_normals: true,
                double,
                ..square()
            };
            let mesh = parse(&model.bytes(version), 0).expect("well-formed");
            assert_eq!(mesh.normals, [Vec3::new(0.0, 0.0, 2.0); 4]);
            assert_eq!(mesh.uvs[0], Vec2::new(0.1, 0.2));
            assert_eq!(mesh.attributes[0].name, "vertex_color");
            assert_eq!(mesh.attributes[0].values[..4], [0.5, 0.25, 1.0, 0.5]);
            assert!(mesh.face_normals);
            let plain = parse(&square().bytes(version), 0).expect("well-formed");
            assert!(!plain.face_normals && plain.normals.is_empty() && plain.uvs.is_empty());
        }
    }
}

#[test]
fn shapes_may_be_empty() {
    let mut model = square();
    model.triangles.clear();
    assert!(
        parse(&model.bytes(4), 0)
            .expect("read")
            .triangles
            .is_empty()
    );
    assert!(
        parse(&Model::default().bytes(3), 0)
            .expect("read")
            .positions
            .is_empty()
    );
}

#[test]
fn positions_must_be_finite_where_they_are_used() {
    let mut model = square();
    model.positions.push([f32::NAN; 3]);
    let mesh = parse(&model.bytes(4), 0).expect("nobody uses it");
    assert_eq!(mesh.positions[4], Vec3::ZERO);
    model.triangles.push([0, 4, 1]);
    assert_eq!(
        message(&model.bytes(4), 0),
        "byte 0: the position of vertex 4 is not finite"
    );
}

#[test]
fn what_is_wrong_is_said() {
    assert_eq!(message(b"\x1c", 0), "byte 0: the file ends too early");
    assert_eq!(
        message(b"ply\nformat", 0),
        "byte 0: this is no serialized mesh: it begins with 0x6c70, not 0x041c"
    );
    assert_eq!(
        message(&square().bytes(5), 0),
        "byte 0: version 5 of serialized meshes is not known, only 3 and 4 are"
    );
    let bytes = square().bytes(4);
    assert_eq!(
        message(&bytes[..4], 0),
        "byte 0: the data end before all flags have come"
    );
    let damaged = message(b"\x1c\x04\x04\0\0\0\0\0", 0);
    assert!(damaged.starts_with("byte 0: the flags are damaged: "));
    assert!(message(&bytes[..bytes.len() / 2], 0).contains("the data end before all "));
    let mut model = square();
    model.triangles[1][2] = 4;
    assert_eq!(
        message(&model.bytes(4), 0),
        "byte 0: triangle 1 refers to vertex 4, but there are 4"
    );
    model.name = "n".repeat(LONGEST_NAME);
    assert_eq!(
        message(&model.bytes(4), 0),
        "byte 0: the name of the shape does not end"
    );
}

#[test]
fn counts_are_not_believed() {
    let lie = |vertices, triangles| folded(4, &square().unfolded(4, vertices, triangles));
    assert_eq!(
        message(&lie(5, 2), 0),
        "byte 0: the data end before all triangles have come"
    );
    assert_eq!(
        message(&lie(1 << 20, 2), 0),
        "byte 0: the data end before all positions have come"
    );
    assert!(message(&lie(4_000_000_000, 2), 0).contains("vertices and 2 triangles are announced"));
    assert!(message(&lie(4, 4_000_000_000), 0).contains("bytes are left of the file"));
    for (vertices, triangles) in [(1 << 32, 2), (4, 1 << 32), (u64::MAX, u64::MAX)] {
        assert!(message(&lie(vertices, triangles), 0).contains("more than 32 bits can count"));
    }
}

fn model() -> impl Strategy<Value = Model> {
    let triple = || prop::array::uniform3(-1e3f32..1e3);
    (3usize..20, any::<[bool; 5]>())
        .prop_flat_map(move |(count, has)| {
            let times = |has: bool| if has { count } else { 0 };
            (
                prop::collection::vec(triple(), count),
                prop::collection::vec(triple(), times(has[0])),
                prop::collection::vec([0f32..1.0, 0f32..1.0], times(has[1])),
                prop::collection::vec(triple(), times(has[2])),
                prop::collection::vec(prop::array::uniform3(0..count as u32), 1..12),
                Just(has),
            )
        })
        .prop_map(|(positions, normals, uvs, colours, triangles, has)| Model {
            positions,
            normals,
            uvs,
            colours,
            triangles,
            name: "a".into(),
            face_normals: has[3],
            double: has[4],
        })
}

impl Model {
    /// The same mesh as a PLY file.
    fn ply(&self) -> Vec<u8> {
        let mut text = format!(
            "ply\nformat ascii 1.0\nelement vertex {}\n",
            self.positions.len()
        );
        let mut names = vec!["x", "y", "z"];
        for (given, more) in [
            (!self.normals.is_empty(), &["nx", "ny", "nz"][..]),
            (!self.uvs.is_empty(), &["u", "v"]),
            (!self.colours.is_empty(), &["red", "green", "blue"]),
        ] {
            names.extend(more.iter().filter(|_| given));
        }
        names
            .iter()
            .for_each(|n| text += &format!("property float {n}\n"));
        text += &format!("element face {}\n", self.triangles.len());
        text += "property list uchar int vertex_indices\nend_header\n";
        for (i, p) in self.positions.iter().enumerate() {
            let row = (p.iter())
                .chain(self.normals.get(i).into_iter().flatten())
                .chain(self.uvs.get(i).into_iter().flatten())
                .chain(self.colours.get(i).into_iter().flatten());
            row.for_each(|x| text += &format!("{x} "));
            text += "\n";
        }
        for [a, b, c] in &self.triangles {
            text += &format!("3 {a} {b} {c}\n");
        }
        text.into_bytes()
    }

    /// Positions and triangles as an OBJ file.
    fn obj(&self) -> Vec<u8> {
        let mut text = String::new();
        for [x, y, z] in &self.positions {
            text += &format!("v {x} {y} {z}\n");
        }
        for t in &self.triangles {
            let [a, b, c] = t.map(|i| i + 1);
            text += &format!("f {a} {b} {c}\n");
        }
        text.into_bytes()
    }
}

/// The corners of all triangles.
fn soup(mesh: &MeshData) -> Vec<[Vec3; 3]> {
    let corners = |t: &[u32; 3]| t.map(|i| mesh.positions[i as usize]);
    mesh.triangles.iter().map(corners).collect()
}

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(34),
        ..ProptestConfig::with_cases(150)
    })]

    #[test]
    fn the_same_mesh_as_ply_and_obj(model in model(), version in 3u16..=4) {
        let mut ours = parse(&model.bytes(version), 0).expect("well-formed");
        prop_assert_eq!(ours.face_normals, model.face_normals);
        ours.face_normals = false;
        prop_assert_eq!(&ours, &crate::ply::parse(&model.ply()).expect("well-formed"));
        let obj = crate::obj::parse(&model.obj()).expect("well-formed");
        prop_assert_eq!(soup(&ours), soup(&obj));
    }

    #[test]
    fn broken_files_are_refused_quietly(
        models in prop::collection::vec(model(), 1..3),
        version in 3u16..=4,
        index in 0u32..3,
        cut in any::<prop::sample::Index>(),
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
        folded_edits in any::<bool>(),
    ) {
        let mut unfolded: Vec<Vec<u8>> = models.iter()
            .map(|m| m.unfolded(version, m.positions.len() as u64, m.triangles.len() as u64))
            .collect();
        let edit = |bytes: &mut Vec<u8>| {
            for (place, byte) in &edits {
                let place = place.index(bytes.len());
                bytes[place] = *byte;
            }
        };
        if !folded_edits {
            edit(&mut unfolded[0]);
        }
        let shapes: Vec<Vec<u8>> = unfolded.iter().map(|u| folded(version, u)).collect();
        let mut bytes = file(&shapes, if version == 3 { 4 } else { 8 });
        if folded_edits {
            edit(&mut bytes);
            bytes.truncate(cut.index(bytes.len() + 1));
        }
        if let Ok(mesh) = parse(&bytes, index) {
            prop_assert!(mesh.positions.iter().all(|p| p.is_finite()));
            prop_assert!(
                mesh.triangles.iter().flatten().all(|&i| (i as usize) < mesh.positions.len())
            );
        }
    }
}
