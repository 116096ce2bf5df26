//! OBJ files, well-formed and not, and agreement with the vertices that `tobj` itself would make.

use super::*;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn square(rest: &str) -> Result<MeshData, MeshError> {
    parse(format!("{SQUARE}{rest}").as_bytes())
}

fn message(rest: &str) -> String {
    square(rest).expect_err("malformed on purpose").to_string()
}

#[test]
fn polygons_groups_and_comments() {
    let mesh = square("g a\nusemtl q # x\nf 1 2 3 4 # quad\r\n\no b\ns 1\nl 1 2\n").expect("read");
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh.positions.len(), 4);
    assert!(mesh.normals.is_empty() && mesh.uvs.is_empty() && mesh.attributes.is_empty());
}

#[test]
fn vertices_are_shared_by_all_three_indices() {
    // As Mitsuba 3.9.1 numbers them.
    let mesh = square("vt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 1/2 3/1 4/1\n").expect("read");
    assert_eq!(mesh.triangles, [[0, 1, 2], [3, 2, 4]]);
    assert_eq!(mesh.uvs[3], Vec2::ONE);
}

#[test]
fn negative_indices_and_continuations() {
    let mesh = square("f -4 \\\n -3 \\\r\n-2\n").expect("read");
    assert_eq!(mesh.triangles, [[0, 1, 2]]);
    assert_eq!(mesh.positions[2], Vec3::new(1.0, 1.0, 0.0));
}

#[test]
fn mixed_corners_keep_what_is_given() {
    let mesh = square("vt .5 .25\nvn 0 0 -1\nf 1/1 2 3\nf 1/1/1 3 4\n").expect("read");
    assert_eq!(mesh.uvs[0], Vec2::new(0.5, 0.25));
    assert_eq!(mesh.uvs[1], Vec2::ZERO);
    assert_eq!(mesh.normals[3], -Vec3::Z);
    assert_eq!(mesh.normals[1], Vec3::Z);
}

#[test]
fn colours_of_vertices() {
    let mesh = parse(b"v 0 0 0 1 .5 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3").expect("read");
    assert_eq!(mesh.attributes[0].name, "vertex_color");
    assert_eq!(mesh.attributes[0].values[..3], [1.0, 0.5, 0.0]);
}

#[test]
fn mistakes_have_a_line() {
    assert_eq!(
        message("f 1 2 9\n"),
        "line 5: the face refers to position 9, but 4 are given so far"
    );
    assert_eq!(
        message("\nf 1 2 0\n"),
        "line 6: the face refers to position 0, but 4 are given so far"
    );
    assert_eq!(message("v 1 x 0\n"), "line 5: `x` is not a number");
    assert_eq!(
        message("v 1 nan 0\n"),
        "line 5: `nan` in this position is not finite"
    );
    assert_eq!(
        message("v 1 1e39 0\n"),
        "line 5: `1e39` in this position is not finite"
    );
    assert_eq!(
        message("v 1 2\n"),
        "line 5: a number of this position is missing"
    );
    assert_eq!(
        message("f 1 2 3/4/5/6\n"),
        "line 5: `3/4/5/6` is not a corner of a face"
    );
    assert_eq!(
        message("f 1 2 /1\n"),
        "line 5: `/1` is not a corner of a face"
    );
    assert_eq!(message("f 1 2 a\n"), "line 5: `a` is not an index");
    assert_eq!(
        message(""),
        "the file contains no faces of three or more corners"
    );
    assert_eq!(
        message("f 1 2\n"),
        "the file contains no faces of three or more corners"
    );
}

#[test]
fn indices_that_the_parser_would_misunderstand() {
    let given = "vt 0 0\nvt 1 1\nvn 0 0 1\nvn 0 1 0\n";
    // Zero, one before the first, and numbers that overflow when doubled or tripled.
    for index in ["0", "-0", "+0", "-3", "-9223372036854775808", "4294967296"] {
        assert_eq!(
            message(&format!("{given}f 1/1 2/{index} 3/1\n"))
                .split(" to ")
                .next(),
            Some("line 9: the face refers"),
            "{index}"
        );
    }
    for index in ["0", "-3", "6148914691236517207", "9223372036854775807"] {
        assert_eq!(
            message(&format!("{given}f 1//1 2//{index} 3//1\n")),
            format!("line 9: the face refers to normal {index}, but 2 are given so far")
        );
    }
    assert_eq!(
        message("f 1/1 2/1 3/1\n"),
        "line 5: the face refers to texture coordinate 1, but 0 are given so far"
    );
    assert_eq!(
        message("f 1 2\u{a0}3 4\n"),
        "line 5: `2\\u{a0}3` is not an index"
    );
    let mesh = square("f 1/-1 2/01 3/+1\nvt 0 0\n");
    assert_eq!(
        mesh.expect_err("nothing before it").to_string(),
        "line 5: the face refers to texture coordinate -1, but 0 are given so far"
    );
    let mesh = square("vt 0 1\nf 1/-1 2/01 3/+1\n").expect("read");
    assert_eq!(mesh.uvs, [Vec2::Y; 3]);
}

#[test]
fn faces_before_what_they_refer_to() {
    let mesh = parse(b"f 1/1 2/1 3/1\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt .5 .5\n").expect("read");
    assert_eq!(mesh.uvs, [Vec2::splat(0.5); 3]);
    let error = parse(b"f 1 2 3\nf 1 2 4\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").expect_err("no fourth");
    assert_eq!(error.place, Place::Line(2));
}

#[test]
fn only_what_makes_a_mesh_is_read() {
    let mut text = SQUARE.replace("v 1 0 0", "v 1 0 0 2").into_bytes();
    text.extend_from_slice(b"g caf\xe9\nusemtl\nmtllib none.mtl\nvt .5\nvt 1 1 7\n");
    text.extend_from_slice(b"l 1 2 3\nf 1/1 2/2 3/2 # \xe9\no b\nf 1/1 3/2 4/1\np 1\n");
    let mesh = parse(&text).expect("read");
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh.positions[1], Vec3::X);
    assert_eq!(mesh.uvs[..2], [Vec2::new(0.5, 0.0), Vec2::ONE]);
}

#[test]
fn concave_faces_are_not_fanned() {
    let mesh = parse(b"v 2 0 0\nv .5 .5 0\nv 0 2 0\nv 0 0 0\nf 1 2 3 4\nf 1 2 4\n").expect("read");
    assert!(
        !mesh.triangles[..2].contains(&[0, 1, 2]),
        "{:?}",
        mesh.triangles
    );
    assert_eq!(mesh.triangles[2], [0, 1, 3]);
}

#[test]
fn lines_end_in_three_ways() {
    let file = format!("# by hand\n{SQUARE}vt 0 1\nf 1 2 \\\n3 # a\nf 1 3 4\n");
    let mesh = parse(file.as_bytes()).expect("read");
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    for ending in ["\r", "\r\n", "\r\r\n"] {
        let text = file.replace('\n', ending);
        assert_eq!(parse(text.as_bytes()).expect("read"), mesh, "{ending:?}");
        let broken = file.replace("f 1 3 4", "f 1 3 5").replace('\n', ending);
        let error = parse(broken.as_bytes()).expect_err("no fifth");
        assert_eq!(error.place, Place::Line(9), "{ending:?}");
    }
}

#[test]
fn numbers_that_are_none_harm_nobody_who_does_not_use_them() {
    let mesh = square("v nan 0 0\nvn nan nan nan\nvn -nan(ind) 0 1\nvn 0 0 1\nf 1//1 2//2 3//3\n");
    let mesh = mesh.expect("nobody uses the fifth");
    let finite: Vec<bool> = mesh.normals.iter().map(|n| n.is_finite()).collect();
    assert_eq!(finite, [false, false, true]);
    let error = square("vn nan 0 0\nv nan 0 0\nf 1//1 2//1 5//1\n").expect_err("the fifth is used");
    assert_eq!(
        error.to_string(),
        "line 6: `nan` in this position is not finite"
    );
}

#[test]
fn colours_of_some_vertices_only() {
    for text in [
        "v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        "v 0 0 0\nv 1 0 0 1 0 0\nv 0 1 0\nf 1 2 3\n",
    ] {
        let mesh = parse(text.as_bytes()).expect("read");
        assert!(mesh.attributes.is_empty());
        assert_eq!(mesh.positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
    }
    let error = parse(b"v 0 0 0\nv 1 0 0 1 x 0\nv 0 1 0\nf 1 2 3\n").expect_err("no number");
    assert_eq!(error.to_string(), "line 2: `x` is not a number");
}

#[test]
fn many_corners_of_one_position_stay_fast() {
    let mut text = String::from(SQUARE);
    for i in 0..60_000 {
        text.push_str(&format!("vt {i} 0\nf 1/-1 2/-1 3/-1\n"));
    }
    let start = std::time::Instant::now();
    let mesh = parse(text.as_bytes()).expect("read");
    assert_eq!(mesh.positions.len(), 180_000);
    assert!(start.elapsed() < std::time::Duration::from_secs(2));
}

/// A well-formed file: vertices, texture coordinates, normals and triangles over them.
fn file() -> impl Strategy<Value = String> {
    let number = -100.0f32..100.0;
    let triple = prop::array::uniform3(number.clone());
    (
        prop::collection::vec(triple.clone(), 3..12),
        prop::collection::vec([number.clone(), number], 1..6),
        prop::collection::vec(triple, 1..6),
        prop::collection::vec(any::<[[u8; 3]; 3]>(), 1..20),
    )
        .prop_map(|(v, vt, vn, faces)| {
            let mut text = String::new();
            for [x, y, z] in &v {
                text.push_str(&format!("v {x} {y} {z}\n"));
            }
            for [x, y] in &vt {
                text.push_str(&format!("vt {x} {y}\n"));
            }
            for [x, y, z] in &vn {
                text.push_str(&format!("vn {x} {y} {z}\n"));
            }
            for face in faces {
                text.push('f');
                for [a, b, c] in face {
                    let index = |i: u8, n: usize| usize::from(i) % n + 1;
                    let (a, b, c) = (index(a, v.len()), index(b, vt.len()), index(c, vn.len()));
                    text.push_str(&format!(" {a}/{b}/{c}"));
                }
                text.push('\n');
            }
            text
        })
}

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(7),
        ..ProptestConfig::with_cases(200)
    })]

    #[test]
    fn vertices_are_those_of_tobj(text in file()) {
        let ours = parse(text.as_bytes()).expect("well-formed");
        let (models, _) = tobj::load_obj_buf(
            &mut text.as_bytes(),
            &tobj::GPU_LOAD_OPTIONS,
            |_| Err(tobj::LoadError::GenericFailure),
        ).expect("well-formed");
        let theirs = &models[0].mesh;
        let triangles: Vec<u32> = ours.triangles.iter().flatten().copied().collect();
        let positions: Vec<f32> = ours.positions.iter().flat_map(|p| p.to_array()).collect();
        let normals: Vec<f32> = ours.normals.iter().flat_map(|p| p.to_array()).collect();
        let uvs: Vec<f32> = ours.uvs.iter().flat_map(|p| p.to_array()).collect();
        prop_assert_eq!(&triangles, &theirs.indices);
        prop_assert_eq!(&positions, &theirs.positions);
        prop_assert_eq!(&normals, &theirs.normals);
        prop_assert_eq!(&uvs, &theirs.texcoords);
    }

    #[test]
    fn broken_files_are_refused_quietly(
        text in file(), cut in any::<prop::sample::Index>(), edits in prop::collection::vec(
            (any::<prop::sample::Index>(), any::<u8>()), 0..8),
    ) {
        let mut bytes = text.into_bytes();
        for (place, byte) in edits {
            let place = place.index(bytes.len());
            bytes[place] = byte;
        }
        bytes.truncate(cut.index(bytes.len() + 1));
        if let Ok(mesh) = parse(&bytes) {
            prop_assert!(mesh.positions.iter().all(|p| p.is_finite()));
            prop_assert!(mesh.triangles.iter().flatten().all(|&i| (i as usize) < mesh.positions.len()));
        }
    }
}
