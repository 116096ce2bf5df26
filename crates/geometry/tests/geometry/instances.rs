//! Instances show what a flattened copy of their group shows.

use crate::things::{Random, geometry_of, icosphere, moved};
use etalon_geometry::shapes::mesh::{Mesh, MeshOptions};
use etalon_geometry::{GeometryBuilder, Shape};
use etalon_transport::{MaterialId, MeshData, Ray};
use glam::{Vec2, Vec3};

fn data() -> MeshData {
    let (positions, triangles) = icosphere(2);
    MeshData {
        normals: positions.clone(),
        uvs: positions
            .iter()
            .map(|p| Vec2::new(p.x + 0.3 * p.z, p.y - 0.2 * p.z))
            .collect(),
        positions,
        triangles,
        ..MeshData::default()
    }
}

#[test]
fn an_instance_is_its_flattened_copy() {
    let mut random = Random(31);
    for scale in [
        Vec3::ONE,
        Vec3::new(0.5, 2.0, 1.2),
        Vec3::new(-1.0, 1.0, 0.7),
    ] {
        let placement = moved(Vec3::new(3.0, -20.0, 7.0), 0.9, scale);
        let mut builder = GeometryBuilder::new();
        let mesh = Mesh::new(data(), &MeshOptions::default()).expect("valid");
        let group = builder.add_group([(Shape::Mesh(mesh), MaterialId(3))]);
        builder.add_instance(group, placement);
        let instanced = builder.build();
        let options = MeshOptions {
            placement,
            ..MeshOptions::default()
        };
        let flat = geometry_of([Shape::Mesh(Mesh::new(data(), &options).expect("valid"))]);
        assert!(instanced.bounds().min.cmple(flat.bounds().min).all());
        assert!(instanced.bounds().max.cmpge(flat.bounds().max).all());
        let mut hits = 0;
        for _ in 0..3000 {
            let from = placement
                .point(random.direction().as_dvec3() * 3.0)
                .as_vec3();
            let to = placement.point(random.point().as_dvec3()).as_vec3();
            let ray = Ray::new(from, (to - from).normalize(), 0.5);
            let (a, b) = (instanced.intersect(&ray), flat.intersect(&ray));
            let (Some(a), Some(b)) = (a, b) else {
                assert_eq!(a.is_some(), b.is_some(), "{ray:?}");
                continue;
            };
            hits += 1;
            let (a, b) = (instanced.vertex(&ray, &a), flat.vertex(&ray, &b));
            if a.primitive != b.primitive {
                // Rounding chose the neighbour: then the point lies on the edge between them.
                assert!((a.position - b.position).length() < 1e-4, "{ray:?}");
                continue;
            }
            let near = |x: Vec3, y: Vec3| (x - y).length() < 2e-4 * (1.0 + y.length());
            assert!((a.t - b.t).abs() < 1e-4 && near(a.position, b.position));
            assert!(near(a.normal, b.normal), "{} {}", a.normal, b.normal);
            // Interpolated before or after the map, normals differ by the map's stretch over a
            // triangle (edge 0.3).
            assert!(a.shading.n.dot(b.shading.n) > 0.98);
            assert!(near(a.dp_du, b.dp_du) && near(a.dp_dv, b.dp_dv));
            assert!((a.uv - b.uv).length() < 1e-4);
            assert_eq!(a.material, MaterialId(3));
        }
        assert!(hits > 1000, "{hits}");
    }
}

#[test]
fn a_million_instanced_triangles_cost_one_mesh() {
    let (positions, triangles) = icosphere(5);
    let mut builder = GeometryBuilder::new();
    let group = builder.add_group([(crate::things::mesh_of(positions, triangles), MaterialId(0))]);
    let mut random = Random(32);
    for i in 0..1000 {
        builder.add_instance(group, moved(random.point() * 50.0, f64::from(i), Vec3::ONE));
    }
    let geometry = builder.build();
    let statistics = geometry.statistics();
    assert_eq!(statistics.instanced_triangles, 1000 * 20 * 1024);
    assert!(statistics.bytes < 8_000_000, "{statistics:?}");
    let hits = (0..10_000)
        .filter(|_| {
            let (from, to) = (random.point() * 60.0, random.point() * 50.0);
            geometry.occluded(&Ray::new(from, (to - from).normalize(), 0.0))
        })
        .count();
    assert!(hits > 1000, "{hits}");
}
