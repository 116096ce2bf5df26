//! Shapes that are not as they stand: curves, subdivided meshes, parts of quadrics.

use super::*;
use etalon_params::DVec3;
use etalon_transport::MeshData;
use glam::Vec3;
use std::sync::Arc;

/// The only mesh of a world without mistakes.
#[track_caller]
fn mesh(text: &str) -> Arc<MeshData> {
    let outcome = world(text);
    assert_eq!(outcome.lines(), "");
    let document = outcome.document.expect("a document");
    assert_eq!(document.meshes.len(), 1);
    Arc::clone(&document.meshes[0])
}

/// The area of a mesh, and six times the volume between it and the origin.
fn area_and_volume(mesh: &MeshData) -> [f64; 2] {
    let corner = |i: u32| mesh.positions[i as usize].as_dvec3();
    let parts = mesh.triangles.iter().map(|&[a, b, c]| {
        let [a, b, c] = [a, b, c].map(corner);
        [0.5 * (b - a).cross(c - a).length(), a.dot(b.cross(c))]
    });
    parts.fold([0.0; 2], |[a, v], [b, w]| [a + b, v + w])
}

/// Closed forms; polygons of 512 to a turn lack some 10⁻⁵.
#[test]
fn parts_of_quadrics_have_their_areas() {
    for (text, expected) in [
        (
            r#"Shape "sphere" "float radius" 2 "float zmin" -1 "float zmax" 1.5 "float phimax" 270"#,
            1.5 * std::f64::consts::PI * 2.0 * 2.5,
        ),
        (r#"Shape "sphere" "float zmin" 0"#, std::f64::consts::TAU),
        (
            r#"Shape "disk" "float radius" 2 "float innerradius" 1 "float phimax" 90"#,
            0.25 * std::f64::consts::PI * 3.0,
        ),
        (
            r#"Shape "cylinder" "float radius" 0.5 "float zmin" 1 "float zmax" 3 "float phimax" 180"#,
            std::f64::consts::PI,
        ),
    ] {
        let mesh = mesh(text);
        let [area, _] = area_and_volume(&mesh);
        assert!(
            (area / expected - 1.0).abs() < 1e-4,
            "{text}: {area} {expected}"
        );
        assert_eq!(mesh.uvs.len(), mesh.positions.len());
        for (triangle, normals) in mesh
            .triangles
            .iter()
            .map(|t| (t, t.map(|i| mesh.normals[i as usize])))
        {
            let [a, b, c] = triangle.map(|i| mesh.positions[i as usize]);
            let own = (b - a).cross(c - a).normalize();
            assert!(normals.iter().all(|n| own.dot(*n).abs() > 0.999), "{text}");
        }
    }
}

/// pbrt's u is the share of the angle, v that of the profile: from the lower end of a sphere and a cylinder, from the rim of a disk.
#[test]
fn parts_of_quadrics_have_texture_coordinates_of_pbrt() {
    let sphere = mesh(r#"Shape "sphere" "float zmin" 0 "float phimax" 90"#);
    for (p, uv) in sphere.positions.iter().zip(&sphere.uvs) {
        let phi = etalon_math::float::atan2(p.y, p.x) / std::f32::consts::FRAC_PI_2;
        let theta = (1.0 - p.z.clamp(-1.0, 1.0).acos_turns()) * 1.0;
        assert!(
            p.truncate().length() < 1e-3 || (phi - uv.x).abs() < 1e-4,
            "{p} {uv}"
        );
        assert!((theta - uv.y).abs() < 1e-3, "{p} {uv}");
    }
    let disk = mesh(r#"Shape "disk" "float radius" 2 "float innerradius" 1"#);
    for (p, uv) in disk.positions.iter().zip(&disk.uvs) {
        assert!((2.0 - p.length() - uv.y).abs() < 1e-5, "{p} {uv}");
    }
}

trait Quarter {
    fn acos_turns(self) -> f32;
}

impl Quarter for f32 {
    /// The arc cosine as a share of a quarter turn.
    fn acos_turns(self) -> f32 {
        etalon_math::float::acos(self) / std::f32::consts::FRAC_PI_2
    }
}

/// The limit of a regular octahedron is between the cage and its inscribed sphere, has its symmetries, and outward normals; subdividing
/// once more changes nothing of the limit's vertices. Rejects a wrong β, a wrong limit, and normals that point in.
#[test]
fn octahedra_are_subdivided() {
    let cage = |levels: usize| {
        mesh(&format!(
            r#"Shape "loopsubdiv" "integer levels" {levels} "point3 P" [ 1 0 0 -1 0 0 0 1 0 0 -1 0 0 0 1 0 0 -1 ]
            "integer indices" [ 0 2 4  2 1 4  1 3 4  3 0 4  2 0 5  1 2 5  3 1 5  0 3 5 ]"#
        ))
    };
    let [coarse, fine] = [cage(0), cage(2)];
    assert_eq!([coarse.triangles.len(), fine.triangles.len()], [8, 128]);
    // n = 4: β = 3/32, γ = 1/8; the neighbours' sum is zero.
    assert!((coarse.positions[0] - 0.5 * Vec3::X).length() < 1e-6);
    for vertex in 0..6 {
        let moved = fine.positions[vertex] - coarse.positions[vertex];
        assert!(moved.length() < 1e-6, "{moved}");
    }
    for (p, n) in fine.positions.iter().zip(&fine.normals) {
        assert!(n.dot(p.normalize()) > 0.95, "{p} {n}");
    }
    let [_, volume] = area_and_volume(&fine);
    assert!(volume > 0.0);
}

/// A flat square with borders stays flat and a square's corners are cut as a B-spline's are.
#[test]
fn borders_are_splines() {
    let square = |levels: usize| {
        mesh(&format!(
            r#"Shape "loopsubdiv" "integer levels" {levels} "point3 P" [ 0 0 0  1 0 0  1 1 0  0 1 0 ] "integer indices" [ 0 1 2 0 2 3 ]"#
        ))
    };
    let [coarse, mesh] = [square(0), square(3)];
    assert!(mesh.positions.iter().all(|p| p.z == 0.0));
    assert!(mesh.normals.iter().all(|n| n.z > 0.999));
    // The corner goes to 3/5 of itself and 1/5 of either neighbour.
    let moved = coarse.positions[0].as_dvec3() - DVec3::new(0.2, 0.2, 0.0);
    assert!(moved.length() < 1e-6, "{moved}");
    // The border is a closed B-spline through the square's corners: its area is that of the spline.
    let [area, _] = area_and_volume(&mesh);
    assert!((0.6..0.72).contains(&area), "{area}");
}

/// Curves that follow each other are one shape, in the form of Bézier curves, thick as the CTM makes them.
#[test]
fn curves_are_gathered() {
    let text = r#"Material "hair" Scale 2 2 2
        Shape "curve" "point3 P" [ 0 0 0  1 0 0  1 1 0  1 1 1 ] "float width" 0.2
        Shape "curve" "point3 P" [ 0 0 1  1 0 1  2 0 1 ] "integer degree" 2 "float width0" 0.2 "float width1" 0
        Shape "curve" "string basis" "bspline" "point3 P" [ 0 0 0  0 0 0  6 0 0  6 0 0  6 0 0 ] "string type" "cylinder" "float width" 2
        Shape "sphere""#;
    let outcome = world(text);
    assert_eq!(outcome.lines(), "");
    let document = outcome.document.expect("a document");
    assert_eq!(
        children(&document.root)
            .iter()
            .filter(|n| n.plugin.value == "beziercurve")
            .count(),
        1
    );
    let file = String::from_utf8(document.embedded[&0].to_vec()).expect("a text");
    let curves: Vec<Vec<&str>> = file
        .trim()
        .split("\n\n")
        .map(|c| c.lines().collect())
        .collect();
    assert_eq!(
        curves[0],
        ["0 0 0 0.2", "1 0 0 0.2", "1 1 0 0.2", "1 1 1 0.2"]
    );
    assert_eq!(curves[1][0], "0 0 1 0.2");
    assert!(
        curves[1][1].starts_with("0.6666667 0 1 0.133"),
        "{}",
        curves[1][1]
    );
    assert_eq!(curves[1][3], "2 0 1 0");
    // (1 4 1 0)/6 of 0 0 6 6 is 1.
    assert!(curves[2][0].starts_with("1 0 0 2"), "{}", curves[2][0]);
    assert_eq!(curves[2].len(), 7);
    let flat = world(r#"Shape "curve" "point3 P" [ 0 0 0  1 0 0  1 1 0  1 1 1 ]"#);
    assert!(
        flat.lines()
            .contains("note: curves of the type `flat` are tubes"),
        "{}",
        flat.lines()
    );
}

/// A straight ribbon is a rectangle that faces its normal.
#[test]
fn ribbons_are_strips() {
    let mesh = mesh(
        r#"Shape "curve" "string type" "ribbon" "point3 P" [ 0 0 0  1 0 0  2 0 0  3 0 0 ] "normal N" [ 0 0 1  0 0 1 ] "float width" 0.5"#,
    );
    let [area, _] = area_and_volume(&mesh);
    assert!((area - 1.5).abs() < 1e-6, "{area}");
    assert!(mesh.normals.iter().all(|n| *n == Vec3::Z));
}
