//! Positions, normals, texture coordinates and derivatives of every shape agree with Mitsuba's.

mod cases;

use etalon_geometry::shapes::{
    cylinder::Cylinder,
    disk::Disk,
    mesh::{Mesh, MeshOptions},
    rectangle::Rectangle,
    sphere::Sphere,
};
use etalon_geometry::{AcceleratorKind, GeometryBuilder, Placement, Shape};
use etalon_params::DMat4;
use etalon_transport::{LightId, MaterialId, MeshData, Ray};
use glam::{DVec3, Vec2, Vec3};

/// The transforms used.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Map {
    None,
    Stretched,
    Mirrored,
    Similar,
    SimilarMirrored,
    Sheared,
}

impl Map {
    fn placement(self) -> Placement {
        let turned = |scale: DVec3| {
            DMat4::from_translation(DVec3::new(1.0, 2.0, 3.0))
                * DMat4::from_axis_angle(
                    DVec3::new(1.0, 2.0, 3.0).normalize(),
                    core::f64::consts::PI * 40.0 / 180.0,
                )
                * DMat4::from_scale(scale)
        };
        let matrix = match self {
            Self::None => DMat4::IDENTITY,
            Self::Stretched => turned(DVec3::new(2.0, 0.5, 1.5)),
            Self::Mirrored => turned(DVec3::new(-2.0, 0.5, 1.5)),
            Self::Similar => turned(DVec3::splat(2.0)),
            Self::SimilarMirrored => turned(DVec3::new(-2.0, 2.0, 2.0)),
            Self::Sheared => DMat4::from_cols_array(&[
                1.0, 0.2, 0.0, 0.0, 0.5, 1.0, 0.3, 0.0, 0.0, 0.1, 1.2, 0.0, 0.3, 0.0, 0.0, 1.0,
            ]),
        };
        Placement::from_matrix(&matrix).expect("invertible")
    }
}

pub(crate) struct Case {
    name: &'static str,
    shape: fn() -> Shape,
    instance: Map,
    origin: [f32; 3],
    direction: [f32; 3],
    t: f32,
    position: [f32; 3],
    normal: [f32; 3],
    shading: [f32; 3],
    tangent: [f32; 3],
    uv: [f32; 2],
    dp_du: [f32; 3],
    dp_dv: [f32; 3],
    primitive: u32,
}

fn rectangle(map: Map, flip: bool) -> Shape {
    Shape::Rectangle(Rectangle::new(&map.placement(), flip).expect("finite"))
}

fn cube(map: Map, flip: bool) -> Shape {
    Shape::Mesh(etalon_geometry::shapes::cube::cube(&map.placement(), flip).expect("finite"))
}

fn disk(map: Map, flip: bool) -> Shape {
    Shape::Disk(Disk::new(&map.placement(), flip).expect("finite"))
}

fn sphere(map: Map, center: [f64; 3], radius: f64, flip: bool) -> Shape {
    Shape::Sphere(Sphere::new(&map.placement(), center.into(), radius, flip).expect("round"))
}

fn cylinder(map: Map, p0: [f64; 3], p1: [f64; 3], radius: f64, flip: bool) -> Shape {
    let ends = [p0.into(), p1.into()];
    Shape::Cylinder(Cylinder::new(&map.placement(), ends, radius, flip).expect("round"))
}

/// A bent quadrilateral; options are face normals, flipped normals, flipped v.
fn quad(uvs: bool, normals: bool, map: Map, options: [bool; 3]) -> Shape {
    let mut data = MeshData {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.5), Vec3::Y],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..MeshData::default()
    };
    if uvs {
        data.uvs = vec![
            Vec2::ZERO,
            Vec2::X,
            Vec2::new(1.0, 0.8),
            Vec2::new(0.1, 1.0),
        ];
    }
    if normals {
        data.normals = vec![
            Vec3::new(0.0, 0.1, 1.0),
            Vec3::new(0.3, 0.0, 1.0),
            Vec3::Z,
            Vec3::new(-0.2, 0.0, 1.0),
        ];
    }
    let [face_normals, flip_normals, flip_tex_coords] = options;
    let options = MeshOptions {
        placement: map.placement(),
        face_normals,
        flip_normals,
        flip_tex_coords,
    };
    Shape::Mesh(Mesh::new(data, &options).expect("valid"))
}

/// A triangle whose texture coordinates are all the same.
fn flat_uv() -> Shape {
    let data = MeshData {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.5)],
        uvs: vec![Vec2::new(0.2, 0.3); 3],
        triangles: vec![[0, 1, 2]],
        ..MeshData::default()
    };
    let options = MeshOptions {
        flip_tex_coords: true,
        ..MeshOptions::default()
    };
    Shape::Mesh(Mesh::new(data, &options).expect("valid"))
}

fn check(case: &Case, kind: AcceleratorKind) {
    let mut builder = GeometryBuilder::new();
    let material = MaterialId(7);
    if case.instance == Map::None {
        builder.add_shape((case.shape)(), material, LightId::NONE);
    } else {
        let group = builder.add_group([((case.shape)(), material)]);
        builder.add_instance(group, case.instance.placement());
    }
    let geometry = builder.build_with(kind);
    let ray = Ray::new(case.origin.into(), case.direction.into(), 0.25);
    let hit = geometry.intersect(&ray).expect(case.name);
    let vertex = geometry.vertex(&ray, &hit);
    let name = case.name;
    // Mitsuba computes in single precision throughout; lengths here are a few units.
    let near = |what: &str, ours: Vec3, theirs: [f32; 3], scale: f32| {
        let theirs = Vec3::from(theirs);
        let tolerance = 3e-6 * scale.max(theirs.abs().max_element());
        let off = (ours - theirs).abs().max_element();
        assert!(
            off <= tolerance,
            "{name}: {what} {ours} differs from {theirs}"
        );
    };
    near("distance", Vec3::splat(vertex.t), [case.t; 3], 1.0);
    near("position", vertex.position, case.position, 1.0);
    near("normal", vertex.normal, case.normal, 1.0);
    near("shading normal", vertex.shading.n, case.shading, 1.0);
    near("tangent", vertex.shading.s, case.tangent, 1.0);
    near(
        "texture coordinates",
        vertex.uv.extend(0.0),
        [case.uv[0], case.uv[1], 0.0],
        1.0,
    );
    near("dp_du", vertex.dp_du, case.dp_du, 2.0);
    near("dp_dv", vertex.dp_dv, case.dp_dv, 2.0);
    assert_eq!(vertex.primitive, case.primitive, "{name}");
    assert_eq!(vertex.material, material, "{name}");
    assert_eq!(vertex.time, 0.25, "{name}");
    assert_eq!(
        vertex.instance.is_some(),
        case.instance != Map::None,
        "{name}"
    );
}

#[test]
fn every_shape_agrees_with_mitsuba() {
    for case in cases::CASES {
        for kind in AcceleratorKind::ALL {
            check(case, kind);
        }
    }
}

#[test]
fn shapes_that_would_not_stay_round_are_refused() {
    let stretched = Map::Stretched.placement();
    assert!(Sphere::new(&stretched, DVec3::ZERO, 1.0, false).is_none());
    assert!(Cylinder::new(&stretched, [DVec3::ZERO, DVec3::Z], 1.0, false).is_none());
    // Stretched along its axis only, a cylinder stays one.
    let matrix = DMat4::from_scale(DVec3::new(1.0, 1.0, 3.0));
    let along = Placement::from_matrix(&matrix).expect("invertible");
    assert!(Cylinder::new(&along, [DVec3::ZERO, DVec3::Z], 1.0, false).is_some());
}
