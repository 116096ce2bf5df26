//! What programs write besides plain faces: texture coordinates at corners, strips, any order of
//! elements, three line endings, numbers that are none.

use super::*;

#[test]
fn texture_coordinates_at_corners_split_vertices() {
    // The triangles agree at vertex 0 and differ at vertex 2; the quadrilateral comes first.
    let vertices = ["0 0 0 7", "1 0 0 8", "1 1 0 9", "0 1 0 10"];
    let faces = [
        "4 0 1 2 3 8 0 0 1 0 1 1 0 1 5",
        "3 0 1 2 6 0 0 1 0 .5 .25 6",
        "3 0 2 3 6 0 0 .5 .25 0 1 7",
        "3 0 2 3 0 8",
    ];
    let list = "list uchar float texcoord, int texnumber";
    let mesh = read(&text("float tag", &vertices, list, &faces));
    let expected = [[0, 1, 2], [0, 2, 3], [0, 1, 4], [0, 4, 3], [0, 5, 6]];
    assert_eq!(mesh.triangles, expected);
    assert_eq!(mesh.copies, [2, 2, 3]);
    let uvs = [
        [0.0, 0.0],
        [1.0, 0.0],
        [1.0, 1.0],
        [0.0, 1.0],
        [0.5, 0.25],
        [0.0; 2],
        [0.0; 2],
    ];
    assert_eq!(mesh.uvs, uvs.map(Vec2::from));
    assert_eq!(mesh.positions[4..], [2, 2, 3].map(|i| mesh.positions[i]));
    assert_eq!(
        mesh.attributes[0].values,
        [7.0, 8.0, 9.0, 10.0, 9.0, 9.0, 10.0]
    );
    assert_eq!(mesh.attributes[1].name, "face_texnumber");
    assert!(mesh.notes[0].contains("several images"), "{:?}", mesh.notes);

    // They may stand before the corners, go before coordinates of vertices, and be absent.
    let file = text(
        "float u, float v",
        &["0 0 0 9 9", "1 0 0 9 9", "0 1 0 9 9"],
        "",
        &[],
    )
    .replace("face 0", "face 1")
    .replace(
        "property list",
        "property list int double texcoord\nproperty list",
    );
    let mesh = read(&(file.clone() + "6 .1 .2 .3 .4 .5 .6 3 0 1 2\n"));
    assert_eq!(mesh.uvs[1], Vec2::new(0.3, 0.4));
    assert!(mesh.copies.is_empty());
    assert_eq!(
        read(&(file.clone() + "0 3 0 1 2\n")).uvs,
        [Vec2::splat(9.0); 3]
    );
    assert_eq!(
        message(&(file + "4 0 0 0 0 3 0 1 2\n")),
        "line 16: a face of 3 corners has 4 numbers of texture coordinates, not 6"
    );
}

#[test]
fn strips_turn_left_and_right() {
    let file = |strip: &str| {
        text("", &["0 0 0", "1 0 0", "0 1 0", "1 1 0", "0 2 0"], "", &[])
            .replace("element face 0", "element tristrips 1")
            .replace("list uchar", "list int")
            + strip
    };
    // A new strip begins to the left again; the triangles without area glue.
    let mesh = read(&file("13 0 1 2 -1 1 2 3 4 4 -1 0 1 2\n"));
    assert_eq!(mesh.triangles, [[0, 1, 2], [1, 2, 3], [3, 2, 4], [0, 1, 2]]);
    assert_eq!(
        read(&file("6 0 1 1 2 3 4\n")).triangles,
        [[1, 2, 3], [3, 2, 4]]
    );
    assert_eq!(
        message(&file("3 0 1 5\n")),
        "line 15: the face refers to vertex 5, but there are 5"
    );
    assert!(message(&file("99 0 1 2\n")).ends_with("before all its elements have come"));
    let said = message(&file("3 0 1 -1\n"));
    assert!(
        said.ends_with("it holds 5 `vertex`, 1 `tristrips`"),
        "{said}"
    );
    // Beside faces, whose attributes strips have not.
    let both = text("", &SQUARE, "float q", &["3 0 1 2 5"]).replace(
        "end_header",
        "element tristrips 1\nproperty list int int vertex_indices\nend_header",
    ) + "3 0 2 3\n";
    let mesh = read(&both);
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert!(mesh.attributes.is_empty() && mesh.notes[0].starts_with("`face_q` is left out"));
}

#[test]
fn elements_come_in_any_order() {
    let ordered = read(&text("", &SQUARE, "float q", &["3 0 1 2 5", "3 0 2 3 6"]));
    let file = "ply\nformat ascii 1.0\nelement face 2\nproperty list uchar int vertex_index\n\
        property float q\nelement edge 1\nproperty int a\nelement vertex 4\nproperty float x\n\
        property float y\nproperty float z\nend_header\n3 0 1 2 5\n3 0 2 3 6\n0\n";
    assert_eq!(read(&(file.to_owned() + &SQUARE.join("\n"))), ordered);
    let wrong = file.replace("3 0 2 3 6", "3 0 2 4 6") + &SQUARE.join("\n");
    assert_eq!(
        message(&wrong),
        "line 14: the face refers to vertex 4, but there are 4"
    );
}

#[test]
fn lines_end_in_three_ways() {
    let file = text(
        "float q",
        &["0 0 0 1", "1 0 0 1", "0 1 0 1"],
        "",
        &["3 0 1 2"],
    );
    let mesh = read(&file);
    for ending in ["\r", "\r\n"] {
        assert_eq!(read(&file.replace('\n', ending)), mesh);
        let broken = file.replace("3 0 1 2", "3 0 1 x").replace('\n', ending);
        assert_eq!(message(&broken), "line 14: `x` is not a number");
    }
    // In binary files the data begin right behind the ending, whatever their first byte is.
    let header = "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty uchar x\n\
        property uchar y\nproperty uchar z\nelement face 1\n\
        property list uchar uchar vertex_indices\nend_header\n";
    for ending in ["\n", "\r", "\r\n"] {
        let mut bytes = header.replace('\n', ending).into_bytes();
        bytes.extend(b"\r\n\t\n\r\r\0\0\0\x03\0\x01\x02");
        let mesh = parse(&bytes).expect("well-formed");
        assert_eq!(mesh.positions[0], Vec3::new(13.0, 10.0, 9.0));
    }
}

#[test]
fn numbers_that_are_none_harm_nobody_who_does_not_use_them() {
    let vertices = [
        "0 0 0 nan 0 0 1 nan",
        "1 0 0 0 0 1 -nan(ind) nan",
        "0 1 0 0 0 1 1.#QNAN nan",
        "nan inf nan 0 0 1 1 1",
    ];
    let properties = "float nx, float ny, float nz, float heat, float u";
    let file = |faces: &[&str]| text(properties, &vertices, "", faces);
    let mesh = read(&file(&["3 0 1 2"]));
    assert_eq!(mesh.positions[3], Vec3::ZERO);
    assert!(!mesh.normals[0].is_finite() && mesh.normals[1] == Vec3::Z);
    assert_eq!(mesh.attributes[0].name, "vertex_heat");
    assert!(mesh.attributes[0].values[1].is_nan());
    assert_eq!(
        message(&file(&["3 0 1 2", "3 0 1 3"])),
        "line 18: the position of element 3 is not finite"
    );
}
