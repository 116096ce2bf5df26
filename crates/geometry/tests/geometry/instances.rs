//! Instances show what a flattened copy of their group shows.

use crate::things::{Random, convex_shapes, geometry_of, icosphere, moved};
use etalon_geometry::shapes::mesh::{Mesh, MeshOptions};
use etalon_geometry::{GeometryBuilder, Placement, Shape};
use etalon_transport::{MaterialId, MeshData, Ray};
use glam::{DMat4, DVec4, Vec2, Vec3};

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

/// Groups in groups, three deep, mirrored and sheared: the same hits as every way down placed by itself, also where
/// an outer group is placed twice and one holds both shapes and groups.
#[test]
fn nested_groups_are_what_their_placements_say() {
    let shear = Placement::from_matrix(&DMat4::from_cols(
        DVec4::new(1.0, 0.3, 0.0, 0.0),
        DVec4::new(0.0, 0.8, 0.2, 0.0),
        DVec4::new(0.1, 0.0, -1.2, 0.0),
        DVec4::new(0.5, -1.0, 2.0, 1.0),
    ))
    .expect("invertible");
    let at = |x: f32, angle: f64, scale: Vec3| moved(Vec3::new(x, 0.5 * x, -x), angle, scale);
    let leaf_at = [
        at(1.5, 0.4, Vec3::new(0.5, 0.7, 0.4)),
        at(-1.5, 1.1, Vec3::new(0.4, -0.3, 0.6)),
    ];
    let middle_at = [shear, at(3.0, 0.2, Vec3::new(-1.0, 1.0, 1.0))];
    let outer_at = [
        at(0.0, 0.0, Vec3::ONE),
        at(8.0, 2.0, Vec3::new(1.0, 1.5, 0.5)),
    ];
    let ball = || {
        let mut shapes = convex_shapes(Vec3::new(0.6, 0.0, 0.0), 0.3, 0.8).into_iter();
        let sphere = shapes.find(|(name, _)| *name == "sphere");
        sphere.expect("a sphere is convex").1
    };
    let things = || {
        let (positions, triangles) = icosphere(1);
        [
            (crate::things::mesh_of(positions, triangles), MaterialId(1)),
            (ball(), MaterialId(2)),
        ]
    };
    let mut builder = GeometryBuilder::new();
    let leaf = builder.add_group(things());
    let leaves = leaf_at.map(|at| builder.add_nested_instance(leaf, at));
    let own = builder.add_member(ball(), MaterialId(3));
    let middle = builder.add_members(vec![own], leaves.to_vec());
    let middles = middle_at.map(|at| builder.add_nested_instance(middle, at));
    let outer = builder.add_members(Vec::new(), middles.to_vec());
    for at in outer_at {
        builder.add_instance(outer, at).expect("few");
    }
    let nested = builder.build();

    let mut builder = GeometryBuilder::new();
    let leaf = builder.add_group(things());
    let own = builder.add_group([(ball(), MaterialId(3))]);
    for outer in outer_at {
        for middle in middle_at.map(|middle| outer.after(&middle)) {
            builder.add_instance(own, middle).expect("few");
            for leaf_at in leaf_at {
                builder
                    .add_instance(leaf, middle.after(&leaf_at))
                    .expect("few");
            }
        }
    }
    let flat = builder.build();
    let count = |g: &etalon_geometry::Geometry| g.statistics().instanced_triangles;
    assert_eq!(count(&nested), count(&flat));

    let mut random = Random(77);
    let (mut hits, mut instances) = (0, std::collections::BTreeSet::new());
    for _ in 0..20_000 {
        let (from, to) = (random.point() * 20.0, random.point() * 8.0);
        let ray = Ray::new(from, (to - from).normalize(), 0.0);
        let (a, b) = (nested.intersect(&ray), flat.intersect(&ray));
        assert_eq!(nested.occluded(&ray), a.is_some());
        let (Some(a), Some(b)) = (a, b) else {
            // Rounding may decide at an outline only: another ray a little aside settles it.
            let aside = Ray::new(from + Vec3::splat(1e-4), ray.direction, 0.0);
            let settled = nested.intersect(&aside).is_some() == flat.intersect(&aside).is_some();
            assert!(a.is_some() == b.is_some() || settled, "{ray:?}");
            continue;
        };
        hits += 1;
        instances.insert(a.instance.0);
        let (a, b) = (nested.vertex(&ray, &a), flat.vertex(&ray, &b));
        if (a.t - b.t).abs() > 1e-3 * (1.0 + b.t) {
            continue;
        }
        assert_eq!(a.material, b.material);
        assert!((a.position - b.position).length() < 1e-3, "{ray:?}");
        let on = nested.vertex(&ray, &nested.intersect(&ray).expect("as above"));
        assert!((on.normal.length() - 1.0).abs() < 1e-4);
        if a.primitive == b.primitive {
            assert!(a.normal.dot(b.normal) > 0.999, "{} {}", a.normal, b.normal);
        }
    }
    // Six ways down in each outer group: two middles, each of which holds a shape and two leaves.
    assert!(hits > 800 && instances.len() == 12, "{hits} {instances:?}");
}
