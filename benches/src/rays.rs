//! The rays on which accelerators are compared: those that a path tracer asks for.

use crate::random::Random;
use crate::scenes::Scene;
use etalon_geometry::Geometry;
use etalon_math::{Frame, Vec2, Vec3};
use etalon_sampling::warps::square_to_cosine_hemisphere;
use etalon_transport::{Ray, SurfaceInteraction};

/// Pixels along a side of the picture that primary rays make, in tiles of 32².
pub const SIDE: usize = 512;

/// A kind of ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// From the camera, tile by tile.
    Primary,
    /// From what those hit, in cosine-distributed directions.
    Bounce,
    /// The same in random order.
    Shuffled,
    /// From what the primary rays hit to points of a lamp: whether anything is in between.
    Shadow,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Primary, Self::Bounce, Self::Shuffled, Self::Shadow];

    /// A word for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Primary => "primary",
            Self::Bounce => "bounce",
            Self::Shuffled => "shuffled",
            Self::Shadow => "shadow",
        }
    }
}

/// The rays of every kind, in the order of [`Kind::ALL`].
pub fn rays_of_every_kind(scene: &Scene, geometry: &Geometry) -> [Vec<Ray>; 4] {
    let mut random = Random(1);
    let primary = primary(scene);
    let hits = primary.iter().filter_map(|ray| {
        let vertex = geometry.vertex(ray, &geometry.intersect(ray)?);
        Some((vertex, facing(&vertex, ray)))
    });
    let hits: Vec<(SurfaceInteraction, Vec3)> = hits.collect();
    let bounce = hits.iter().map(|(vertex, normal)| {
        let local = square_to_cosine_hemisphere(random.square());
        vertex.spawn(Frame::from_normal(*normal).to_world(local))
    });
    let bounce: Vec<Ray> = bounce.collect();
    let shadow = hits.iter().filter_map(|(vertex, _)| {
        let lamp = scene.lamp_at + random.point() * scene.lamp;
        let way = lamp - vertex.position;
        let ray = vertex.spawn(way.try_normalize()?);
        Some(Ray {
            t_max: way.length(),
            ..ray
        })
    });
    let shadow = shadow.collect();
    let mut shuffled = bounce.clone();
    random.shuffle(&mut shuffled);
    [primary, bounce, shuffled, shadow]
}

/// The normal on the side that a ray comes from.
fn facing(vertex: &SurfaceInteraction, ray: &Ray) -> Vec3 {
    match vertex.normal.dot(ray.direction) > 0.0 {
        true => -vertex.normal,
        false => vertex.normal,
    }
}

fn primary(scene: &Scene) -> Vec<Ray> {
    let view = Frame::from_normal((scene.eye - scene.target).normalize());
    let tiles = SIDE / 32;
    let pixels = (0..tiles * tiles).flat_map(|tile| {
        let corner = [tile % tiles * 32, tile / tiles * 32];
        (0..1024).map(move |pixel| [corner[0] + pixel % 32, corner[1] + pixel / 32])
    });
    let rays = pixels.map(|[x, y]| {
        let at = (Vec2::new(x as f32, y as f32) + 0.5) / SIDE as f32 * 2.0 - 1.0;
        let at = at * scene.half_width;
        let direction = view.to_world(Vec3::new(at.x, at.y, -1.0));
        Ray::new(scene.eye, direction.normalize(), 0.0)
    });
    rays.collect()
}
