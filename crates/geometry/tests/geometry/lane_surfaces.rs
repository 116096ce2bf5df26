//! Surfaces at hits in vector lanes: lane i has the bits of the vertex alone, whatever the other lanes hold.

use crate::accelerators::mixture;
use crate::things::{Random, icosphere, moved};
use etalon_geometry::shapes::mesh::MeshOptions;
use etalon_geometry::shapes::rectangle::Rectangle;
use etalon_geometry::{Geometry, GeometryBuilder, Shape};
use etalon_math::lane::{F32x8, F32x16, Lane, Vector};
use etalon_transport::{Hit, LightId, MaterialId, MeshData, Ray, TexturePoint};
use glam::{Vec2, Vec3};

/// Spheres of triangles: with or without normals, turned or not, with texture coordinates that are useful, vanish, or are not
/// there; one so small that squares of its edges leave the range of numbers. And rectangles, upright and sheared.
fn build() -> Geometry {
    let mut builder = GeometryBuilder::new();
    mixture(&mut builder);
    let mut random = Random(7);
    let (positions, triangles) = icosphere(2);
    for i in 0..24_u32 {
        let (shift, scale) = (random.point() * 4.0, 0.3 + random.number());
        let scale = if i == 9 { 1e-9 } else { scale };
        let placed = |p: &Vec3| *p * scale + shift;
        let uvs = |p: &Vec3| match i % 3 {
            0 => Vec2::new(p.x + p.z, p.y - 0.3 * p.z),
            _ => Vec2::ONE,
        };
        // Some do not have a length.
        let normals = |p: &Vec3| if p.x > 0.8 { Vec3::ZERO } else { *p };
        let data = MeshData {
            positions: positions.iter().map(placed).collect(),
            uvs: (positions.iter().map(uvs).filter(|_| i % 3 < 2)).collect(),
            normals: (positions.iter().map(normals).filter(|_| i % 4 < 2)).collect(),
            triangles: triangles.clone(),
            ..MeshData::default()
        };
        let options = MeshOptions {
            face_normals: i % 4 > 0,
            flip_normals: i % 5 == 0,
            ..MeshOptions::default()
        };
        let mesh = etalon_geometry::shapes::mesh::Mesh::new(data, &options).expect("a mesh");
        builder.add_shape(Shape::Mesh(mesh), MaterialId(0), LightId::NONE);
        let placement = moved(random.point() * 4.0, i.into(), Vec3::new(0.5, 1.0, 1.0));
        let rectangle = Rectangle::new(&placement, i % 2 == 0).expect("a rectangle");
        builder.add_shape(Shape::Rectangle(rectangle), MaterialId(0), LightId::NONE);
    }
    builder.build()
}

fn compare<F: Lane>(geometry: &Geometry, hits: &[(Ray, Hit)]) {
    let surface = geometry.surfaces::<F>(|i| &hits[i].0, |i| &hits[i].1);
    for (i, (ray, hit)) in hits.iter().enumerate() {
        let alone = geometry.vertex(ray, hit);
        let bits = |vectors: [Vec3; 6], depth: f32| {
            let numbers = vectors.into_iter().flat_map(|vector| vector.to_array());
            // No NaN is another.
            let bits = |x: f32| {
                if x.is_nan() {
                    f32::NAN.to_bits()
                } else {
                    x.to_bits()
                }
            };
            numbers.chain([depth]).map(bits).collect::<Vec<_>>()
        };
        let (point, frame) = (&surface.leaving, &surface.shading);
        let together = [
            point.position,
            point.error,
            point.normal,
            frame.s,
            frame.t,
            frame.n,
        ];
        let shading = alone.shading;
        let vectors = [
            alone.position,
            alone.error,
            alone.normal,
            shading.s,
            shading.t,
            shading.n,
        ];
        assert_eq!(
            bits(
                together.map(|vector| vector.at_lane(i)),
                point.depth.lane(i)
            ),
            bits(vectors, alone.depth),
            "{hit:?}"
        );
        assert_eq!(surface.primitives[i], alone.primitive, "{hit:?}");
        let texture = geometry.texture_point(ray, hit);
        let expected = TexturePoint::from(&alone);
        assert_eq!(
            (texture.position, texture.uv, texture.parameters),
            (expected.position, expected.uv, expected.parameters)
        );
        assert_eq!(
            (texture.shape, texture.primitive),
            (expected.shape, expected.primitive)
        );
    }
}

/// Mutants rejected: the corners of another lane, normals of lanes that have none, a tangent by texture coordinates that do not
/// give one, a rectangle's second triangle taken for its first, the outside of a mesh forgotten, an instance's surface in its own
/// space.
#[test]
fn surfaces_in_lanes_are_those_of_each_hit() {
    let geometry = build();
    let mut random = Random(3);
    let mut hits = Vec::new();
    while hits.len() < 4096 {
        let ray = Ray::new(random.point() * 5.0, random.direction(), random.number());
        hits.extend(geometry.intersect(&ray).map(|hit| (ray, hit)));
    }
    hits.chunks_exact(16)
        .for_each(|hits| compare::<F32x16>(&geometry, hits));
    hits.chunks_exact(8)
        .for_each(|hits| compare::<F32x8>(&geometry, hits));
    hits.chunks_exact(1)
        .for_each(|hits| compare::<f32>(&geometry, hits));
    // Of one shape each, so that some groups are all alike.
    hits.sort_by_key(|(_, hit)| (hit.instance.0, hit.shape.0));
    hits.chunks_exact(8)
        .for_each(|hits| compare::<F32x8>(&geometry, hits));
}
