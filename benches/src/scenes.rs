//! The scenes on which accelerators are compared, made here, so that they need no files.

use crate::random::Random;
use etalon_geometry::shapes::mesh::{Mesh, MeshOptions};
use etalon_geometry::shapes::sphere::Sphere;
use etalon_geometry::{AcceleratorKind, Geometry, GeometryBuilder, Placement, Shape};
use etalon_math::{Mat4, Vec2, Vec3, float};
use etalon_transport::{LightId, MaterialId, MeshData};

/// What is in a scene, as every program understands it.
#[derive(Debug)]
pub enum Object {
    /// Triangles.
    Mesh(MeshData),
    /// Balls: centre and radius.
    Balls(Vec<(Vec3, f32)>),
    /// Placed copies of a mesh.
    Instances(MeshData, Vec<Mat4>),
}

/// A scene, and from where it is seen.
#[derive(Debug)]
pub struct Scene {
    /// A word for files and filters.
    pub name: &'static str,
    /// What is in it.
    pub objects: Vec<Object>,
    /// Where the camera is, …
    pub eye: Vec3,
    /// … what it looks at, …
    pub target: Vec3,
    /// … and half of the width of its picture at a distance of 1.
    pub half_width: f32,
    /// Where shadow rays end: a cube of this half width, …
    pub lamp: f32,
    /// … around here.
    pub lamp_at: Vec3,
}

impl Scene {
    /// The scenes of the comparison.
    pub const NAMES: [&str; 5] = ["sphere", "balls", "forest", "slivers", "teapot"];

    /// The scene of that name.
    pub fn named(name: &str) -> Option<Self> {
        Some(match name {
            "sphere" => Self::sphere(1_310_000),
            "balls" => Self::balls(),
            "forest" => Self::forest(2500),
            "slivers" => Self::slivers(),
            "teapot" => Self::teapot_in_a_stadium(),
            _ => return None,
        })
    }

    /// A sphere pushed in and out by waves, of about so many triangles.
    pub fn sphere(triangles: usize) -> Self {
        Self {
            objects: vec![Object::Mesh(displaced_sphere(triangles))],
            ..Self::empty("sphere")
        }
    }

    /// Ten thousand balls in a cube.
    fn balls() -> Self {
        let mut random = Random(3);
        let balls = (0..10_000).map(|_| (random.point() * 0.8, 0.01 + 0.03 * random.number()));
        Self {
            objects: vec![Object::Balls(balls.collect())],
            ..Self::empty("balls")
        }
    }

    /// Trees of 5000 leaves, of which one is stored, on a plain.
    pub fn forest(trees: usize) -> Self {
        let mut random = Random(5);
        let side = (trees as f32).sqrt();
        let placements = (0..trees).map(|_| {
            let at = Vec3::new(random.number() - 0.5, 0.0, random.number() - 0.5) * side;
            Mat4::from_translation(at)
                * Mat4::from_rotation_y(random.number() * core::f32::consts::TAU)
                * Mat4::from_scale(Vec3::splat(0.7 + 0.6 * random.number()))
        });
        let half = side;
        let corner = |x: f32, z: f32| Vec3::new(x, 0.0, z) * half;
        let plain = MeshData {
            positions: vec![
                corner(-1.0, -1.0),
                corner(1.0, -1.0),
                corner(1.0, 1.0),
                corner(-1.0, 1.0),
            ],
            triangles: vec![[0, 2, 1], [0, 3, 2]],
            ..MeshData::default()
        };
        Self {
            objects: vec![
                Object::Mesh(plain),
                Object::Instances(tree(), placements.collect()),
            ],
            eye: Vec3::new(0.0, 6.0, 0.55 * side),
            target: Vec3::new(0.0, 1.0, 0.2 * side),
            half_width: 0.6,
            lamp: 0.1 * side,
            lamp_at: Vec3::new(0.0, side, 0.0),
            ..Self::empty("forest")
        }
    }

    /// Long thin triangles in all directions, whose boxes are large and mostly empty.
    fn slivers() -> Self {
        let mut random = Random(7);
        let mut positions = Vec::new();
        for _ in 0..50_000 {
            let (at, along) = (random.point() * 0.8, random.point() * 0.15);
            let across = random.point() * 0.002;
            positions.extend([at - along, at + along, at + along + across]);
        }
        Self {
            objects: vec![Object::Mesh(MeshData {
                triangles: (0..positions.len() as u32 / 3)
                    .map(|i| [3 * i, 3 * i + 1, 3 * i + 2])
                    .collect(),
                positions,
                ..MeshData::default()
            })],
            ..Self::empty("slivers")
        }
    }

    /// Something small and fine in the middle of something large and coarse.
    fn teapot_in_a_stadium() -> Self {
        let (mut positions, mut triangles) = (Vec::new(), Vec::new());
        const SIDES: u32 = 96;
        const ROWS: u32 = 20;
        for row in 0..=2 * ROWS {
            // Steps: a tread, then a riser.
            let (out, up) = (row.div_ceil(2) as f32, (row / 2) as f32);
            for side in 0..SIDES {
                let (sin, cos) =
                    float::sin_cos(side as f32 / SIDES as f32 * core::f32::consts::TAU);
                let radius = 50.0 + 2.0 * out;
                positions.push(Vec3::new(1.5 * radius * cos, up - 1.0, radius * sin));
                if row > 0 {
                    let here = row * SIDES;
                    let next = (side + 1) % SIDES;
                    let [a, b] = [here - SIDES + side, here - SIDES + next];
                    let [c, d] = [here + side, here + next];
                    triangles.extend([[a, b, c], [b, d, c]]);
                }
            }
        }
        let middle = positions.len() as u32;
        positions.push(Vec3::NEG_Y);
        triangles.extend((0..SIDES).map(|side| [middle, (side + 1) % SIDES, side]));
        Self {
            objects: vec![
                Object::Mesh(MeshData {
                    positions,
                    triangles,
                    ..MeshData::default()
                }),
                Object::Mesh(displaced_sphere(100_000)),
            ],
            eye: Vec3::new(0.0, 1.5, 6.0),
            lamp: 10.0,
            lamp_at: Vec3::new(0.0, 60.0, 0.0),
            ..Self::empty("teapot")
        }
    }

    /// Nothing yet: a camera that sees the ball of radius 1 around the origin.
    fn empty(name: &'static str) -> Self {
        Self {
            name,
            objects: Vec::new(),
            eye: Vec3::new(0.0, 0.0, 3.2),
            target: Vec3::ZERO,
            half_width: 0.45,
            lamp: 0.3,
            lamp_at: Vec3::new(1.0, 3.0, 2.0),
        }
    }

    /// Number of primitives stored.
    pub fn primitives(&self) -> usize {
        let count = |object: &Object| match object {
            Object::Mesh(mesh) => mesh.triangles.len(),
            Object::Balls(balls) => balls.len(),
            Object::Instances(mesh, placements) => mesh.triangles.len() + placements.len(),
        };
        self.objects.iter().map(count).sum()
    }

    /// Number of primitives that a ray meets which is tested against everything: those of all instances.
    pub fn placed_primitives(&self) -> usize {
        let count = |object: &Object| match object {
            Object::Instances(mesh, placements) => mesh.triangles.len() * placements.len(),
            Object::Mesh(mesh) => mesh.triangles.len(),
            Object::Balls(balls) => balls.len(),
        };
        self.objects.iter().map(count).sum()
    }

    /// The shapes, not yet in an accelerator.
    pub fn shapes(&self) -> GeometryBuilder {
        let mut builder = GeometryBuilder::new();
        let mesh_of = |data: &MeshData| {
            let options = MeshOptions {
                face_normals: true,
                ..MeshOptions::default()
            };
            Shape::Mesh(Mesh::new(data.clone(), &options).expect("valid"))
        };
        for object in &self.objects {
            match object {
                Object::Mesh(data) => {
                    builder.add_shape(mesh_of(data), MaterialId(0), LightId::NONE);
                }
                Object::Balls(balls) => {
                    for &(center, radius) in balls {
                        let center = center.as_dvec3();
                        let ball =
                            Sphere::new(&Placement::IDENTITY, center, f64::from(radius), false);
                        let ball = Shape::Sphere(ball.expect("a ball"));
                        builder.add_shape(ball, MaterialId(0), LightId::NONE);
                    }
                }
                Object::Instances(data, placements) => {
                    let group = builder.add_group([(mesh_of(data), MaterialId(0))]);
                    for placement in placements {
                        let placement = Placement::from_matrix(&placement.as_dmat4());
                        builder.add_instance(group, placement.expect("invertible"));
                    }
                }
            }
        }
        builder
    }

    /// The scene in an accelerator.
    pub fn build(&self, kind: AcceleratorKind) -> Geometry {
        self.shapes().build_with(kind)
    }
}

/// A unit sphere of about so many triangles, pushed in and out by waves of several lengths: a grid over the square,
/// folded to an octahedron (Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit
/// Vectors", section 3.8).
pub fn displaced_sphere(triangles: usize) -> MeshData {
    let cells = ((triangles as f64 / 2.0).sqrt().round() as u32).max(2);
    let place = |i: u32, j: u32| {
        let at = Vec2::new(i as f32, j as f32) / cells as f32 * 2.0 - 1.0;
        let height = 1.0 - at.x.abs() - at.y.abs();
        let folded = match height < 0.0 {
            true => (1.0 - Vec2::new(at.y, at.x).abs()).copysign(at),
            false => at,
        };
        displaced(Vec3::new(folded.x, folded.y, height).normalize())
    };
    let row = cells + 1;
    let corners = (0..row * row).map(|index| place(index % row, index / row));
    let mut faces = Vec::with_capacity(2 * (cells * cells) as usize);
    for (i, j) in (0..cells).flat_map(|j| (0..cells).map(move |i| (i, j))) {
        let a = j * row + i;
        let [b, c, d] = [a + 1, a + row, a + row + 1];
        // The diagonal that lies in the fold.
        let rising = (2 * i < cells) != (2 * j < cells);
        faces.extend(match rising {
            true => [[a, b, d], [a, d, c]],
            false => [[a, b, c], [b, d, c]],
        });
    }
    MeshData {
        positions: corners.collect(),
        triangles: faces,
        ..MeshData::default()
    }
}

/// A point of the unit sphere, moved by the waves.
fn displaced(p: Vec3) -> Vec3 {
    let mut height = 0.0;
    let (mut frequency, mut amplitude) = (3.0, 0.12);
    for _ in 0..6 {
        height += amplitude
            * float::sin(frequency * p.x + 1.3)
            * float::sin(frequency * p.y + 0.7)
            * float::sin(frequency * p.z + 2.1);
        frequency *= 2.1;
        amplitude *= 0.5;
    }
    p * (1.0 + height)
}

/// Leaves in a crown, half a metre wide and two high.
fn tree() -> MeshData {
    let mut random = Random(9);
    let mut positions = Vec::new();
    while positions.len() < 3 * 5000 {
        let at = random.point();
        if at.length_squared() < 1.0 {
            let at = at * Vec3::new(0.5, 0.7, 0.5) + Vec3::Y * 1.2;
            let leaf = [random.point(), random.point(), random.point()];
            positions.extend(leaf.map(|corner| at + corner * 0.02));
        }
    }
    MeshData {
        triangles: (0..positions.len() as u32 / 3)
            .map(|i| [3 * i, 3 * i + 1, 3 * i + 2])
            .collect(),
        positions,
        ..MeshData::default()
    }
}
