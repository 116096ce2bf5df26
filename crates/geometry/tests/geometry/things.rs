//! Meshes, shapes and random numbers for the tests.

use etalon_geometry::shapes::{
    cube::cube,
    cylinder::Cylinder,
    disk::Disk,
    mesh::{Mesh, MeshOptions},
    rectangle::Rectangle,
    sphere::Sphere,
};
use etalon_geometry::{Geometry, GeometryBuilder, Placement, Shape};
use etalon_params::DMat4;
use etalon_sampling::warps::square_to_uniform_sphere;
use etalon_transport::{LightId, MaterialId, MeshData};
use glam::{DVec3, Vec2, Vec3};
use std::collections::HashMap;

/// SplitMix64: uniform numbers with a fixed seed.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn number(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 40) as f32 / (1u64 << 24) as f32
    }

    pub(crate) fn square(&mut self) -> Vec2 {
        Vec2::new(self.number(), self.number())
    }

    /// In the cube [−1, 1]³.
    pub(crate) fn point(&mut self) -> Vec3 {
        Vec3::new(self.number(), self.number(), self.number()) * 2.0 - 1.0
    }

    pub(crate) fn direction(&mut self) -> Vec3 {
        square_to_uniform_sphere(self.square())
    }
}

pub(crate) fn place(matrix: DMat4) -> Placement {
    Placement::from_matrix(&matrix).expect("invertible")
}

/// Translation by `shift` after a rotation after a scale.
pub(crate) fn moved(shift: Vec3, angle: f64, scale: Vec3) -> Placement {
    let axis = DVec3::new(0.3, -0.7, 0.65).normalize();
    place(
        DMat4::from_translation(shift.as_dvec3())
            * DMat4::from_axis_angle(axis, angle)
            * DMat4::from_scale(scale.as_dvec3()),
    )
}

pub(crate) fn mesh_of(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Shape {
    let data = MeshData {
        positions,
        triangles,
        ..MeshData::default()
    };
    let options = MeshOptions {
        face_normals: true,
        ..MeshOptions::default()
    };
    Shape::Mesh(Mesh::new(data, &options).expect("valid"))
}

/// A unit icosphere with 20·4^level triangles, wound outward.
pub(crate) fn icosphere(level: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let golden = 0.5 * (1.0 + 5f32.sqrt());
    let signs = [
        (-1.0, golden),
        (1.0, golden),
        (-1.0, -golden),
        (1.0, -golden),
    ];
    let mut positions: Vec<Vec3> = signs.iter().map(|&(a, b)| Vec3::new(a, b, 0.0)).collect();
    positions.extend(signs.iter().map(|&(a, b)| Vec3::new(0.0, a, b)));
    positions.extend(signs.iter().map(|&(a, b)| Vec3::new(b, 0.0, a)));
    positions.iter_mut().for_each(|p| *p = p.normalize());
    // The twenty faces are the triples at the edge's distance from one another.
    let near = |a: Vec3, b: Vec3| (a - b).length() < 1.1;
    let mut triangles = Vec::new();
    for a in 0..12u32 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                let [p, q, r] = [a, b, c].map(|i| positions[i as usize]);
                if near(p, q) && near(q, r) && near(r, p) {
                    let outward = (q - p).cross(r - p).dot(p) > 0.0;
                    triangles.push(if outward { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    for _ in 0..level {
        let mut middles = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                positions.push((positions[a as usize] + positions[b as usize]).normalize());
                positions.len() as u32 - 1
            })
        };
        triangles = triangles
            .into_iter()
            .flat_map(|[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
            })
            .collect();
    }
    (positions, triangles)
}

/// Convex shapes of every kind under a similarity (spheres and cylinders must stay round).
pub(crate) fn convex_shapes(shift: Vec3, angle: f64, scale: f32) -> Vec<(&'static str, Shape)> {
    let p = moved(shift, angle, Vec3::splat(scale));
    let m =
        DMat4::from_translation(shift.as_dvec3()) * DMat4::from_scale(DVec3::splat(scale.into()));
    let (positions, triangles) = icosphere(2);
    let positions = positions
        .into_iter()
        .map(|v| place(m).point(v.as_dvec3()).as_vec3())
        .collect();
    vec![
        (
            "sphere",
            Shape::Sphere(Sphere::new(&p, DVec3::ZERO, 1.0, false).expect("round")),
        ),
        (
            "cylinder",
            Shape::Cylinder(
                Cylinder::new(&p, [DVec3::ZERO, DVec3::new(0.2, 0.1, 1.5)], 0.6, false)
                    .expect("round"),
            ),
        ),
        ("disk", Shape::Disk(Disk::new(&p, false).expect("finite"))),
        (
            "rectangle",
            Shape::Rectangle(Rectangle::new(&p, false).expect("finite")),
        ),
        ("cube", Shape::Mesh(cube(&p, false).expect("finite"))),
        ("icosphere", mesh_of(positions, triangles)),
    ]
}

pub(crate) fn geometry_of(shapes: impl IntoIterator<Item = Shape>) -> Geometry {
    let mut builder = GeometryBuilder::new();
    for shape in shapes {
        builder.add_shape(shape, MaterialId(0), LightId::NONE);
    }
    builder.build()
}
