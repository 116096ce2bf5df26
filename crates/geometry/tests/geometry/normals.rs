//! Normals that a file lacks: not finite, or of vertices that were split for their texture.

use crate::things::{geometry_of, place};
use etalon_geometry::Shape;
use etalon_geometry::shapes::mesh::{Mesh, MeshOptions};
use etalon_transport::{MeshData, Ray};
use glam::{DMat4, DVec3, Vec2, Vec3};

/// Two triangles that meet at an angle along the y axis, the outside up.
fn roof() -> MeshData {
    MeshData {
        positions: vec![
            Vec3::ZERO,
            Vec3::Y,
            Vec3::new(1.0, 0.0, -1.0),
            Vec3::new(-1.0, 0.0, -1.0),
        ],
        triangles: vec![[0, 2, 1], [0, 1, 3]],
        ..MeshData::default()
    }
}

/// The shading normal at a corner of a triangle.
fn normal(data: MeshData, options: &MeshOptions, triangle: u32, b: Vec2) -> Vec3 {
    let mesh = Mesh::new(data, options).expect("valid");
    let centre = mesh.corners(triangle).iter().sum::<Vec3>() / 3.0;
    let geometry = geometry_of([Shape::Mesh(mesh)]);
    let ray = Ray::new(centre + 5.0 * Vec3::Z, -Vec3::Z, 0.0);
    let mut hit = geometry.intersect(&ray).expect("it is below");
    assert_eq!(hit.primitive, triangle);
    hit.parameters = b;
    geometry.vertex(&ray, &hit).shading.n
}

fn close(a: Vec3, b: Vec3) -> bool {
    (a - b).length() < 1e-6
}

#[test]
fn normals_that_are_not_finite_are_computed() {
    let tilted = Vec3::new(0.6, 0.0, 0.8);
    let mut data = roof();
    data.normals = vec![Vec3::NAN, tilted, tilted, tilted];
    let options = MeshOptions::default();
    // Corner 0 belongs to both triangles; the one that is given stays.
    assert!(close(
        normal(data.clone(), &options, 0, Vec2::ZERO),
        Vec3::Z
    ));
    assert!(close(normal(data.clone(), &options, 0, Vec2::Y), tilted));
    // In a mirror, where windings turn, on the side of the others.
    let mirror = DMat4::from_scale(DVec3::new(1.0, -1.0, 1.0));
    let mirrored = MeshOptions {
        placement: place(mirror),
        ..options
    };
    assert!(close(
        normal(data.clone(), &mirrored, 0, Vec2::ZERO),
        Vec3::Z
    ));
    // Without any, as if the file had none.
    data.normals = vec![Vec3::NAN; 4];
    assert!(close(normal(data, &options, 0, Vec2::ZERO), Vec3::Z));
}

/// A seam of the texture is none of the shading; without `copies` each side has its own normal.
#[test]
fn copies_share_a_computed_normal() {
    let mut data = roof();
    data.positions.extend([Vec3::ZERO, Vec3::Y]);
    data.triangles[1] = [4, 5, 3];
    let options = MeshOptions::default();
    let apart = normal(data.clone(), &options, 1, Vec2::ZERO);
    assert!(!close(apart, Vec3::Z));
    data.copies = vec![0, 1];
    for triangle in 0..2 {
        let together = normal(data.clone(), &options, triangle, Vec2::ZERO);
        assert!(close(together, Vec3::Z), "{triangle}: {together}");
    }
    data.copies = vec![0, 4];
    assert!(Mesh::new(data, &options).is_err());
}
