//! The contract of a camera: it makes rays, and it can be connected to.

use crate::Ray;
use etalon_math::lane::{Lane, Vector};
use glam::{Vec2, Vec3};

/// A ray into the scene.
#[derive(Clone, Copy, Debug)]
pub struct CameraRay {
    /// The ray; it starts at the near and ends at the far clipping distance.
    pub ray: Ray,
    /// The factor by which the radiance along it counts (1 for every camera so far).
    pub weight: f32,
}

/// Rays into the scene, in lanes.
#[derive(Clone, Copy, Debug)]
pub struct CameraRays<F: Lane> {
    /// Origins (m, world), at the near clipping distance.
    pub origin: F::Vector,
    /// Unit directions.
    pub direction: F::Vector,
    /// Lengths (m), to the far clipping distance.
    pub t_max: F,
    /// Factors by which the radiance along them counts.
    pub weight: F,
}

impl<F: Lane> CameraRays<F> {
    /// The rays of a camera that makes them one by one.
    #[inline(always)]
    pub fn one_by_one(camera: &impl Camera, raster: [F; 2], lens: [F; 2], time: F) -> Self {
        let at = |[x, y]: [F; 2], i| Vec2::new(x.lane(i), y.lane(i));
        let [ox, oy, oz, dx, dy, dz, t_max, weight] = F::columns(|i| {
            let start = camera.ray(at(raster, i), at(lens, i), time.lane(i));
            let CameraRay { ray, weight } = start;
            let ([ox, oy, oz], [dx, dy, dz]) = (ray.origin.to_array(), ray.direction.to_array());
            [ox, oy, oz, dx, dy, dz, ray.t_max, weight]
        });
        Self {
            origin: F::Vector::from_xyz(ox, oy, oz),
            direction: F::Vector::from_xyz(dx, dy, dz),
            t_max,
            weight,
        }
    }

    /// The ray in any lane, at this moment.
    #[inline(always)]
    pub fn lanes(self) -> impl Fn(usize, f32) -> CameraRay {
        let ([ox, oy, oz], [dx, dy, dz]) = (self.origin.xyz(), self.direction.xyz());
        let rows = F::rows([ox, oy, oz, dx, dy, dz, self.t_max, self.weight]);
        move |i, time| {
            let [ox, oy, oz, dx, dy, dz, t_max, weight] = rows.as_ref()[i];
            let mut ray = Ray::new(Vec3::new(ox, oy, oz), Vec3::new(dx, dy, dz), time);
            ray.t_max = t_max;
            CameraRay { ray, weight }
        }
    }
}

/// A connection of a scene point with the camera.
#[derive(Clone, Copy, Debug)]
pub struct CameraSample {
    /// Film position (pixels; (0, 0) is the upper left corner of the whole, uncropped film).
    pub raster: Vec2,
    /// Unit direction from the point to the camera.
    pub direction: Vec3,
    /// The end of the shadow ray at the camera (on the near clipping plane's sphere).
    pub target: Vec3,
    /// Pixels² per unit of the beam's cross-section at the point (px²·m⁻²), over the density of
    /// the lens point: dx/dω / r² for a perspective camera, dx/dA for an orthographic one. A
    /// splat of β·f·|cos θ|·`weight` with a filter that integrates to one estimates the pixel.
    pub weight: f32,
}

/// A ray's arrival on the camera's aperture.
#[derive(Clone, Copy, Debug)]
pub struct ApertureHit {
    /// Film position (pixels of the whole film).
    pub raster: Vec2,
    /// Distance along the ray to the near clipping plane (m). The ray must be unoccluded up to there;
    /// the camera sees nothing between that plane and the aperture.
    pub t: f32,
    /// Pixels² per unit of flux (px²·m⁻²·sr⁻¹): dx/dω over the aperture's area and the cosine of
    /// arrival. A splat of Φ·`weight` with a filter that integrates to one estimates the pixel,
    /// for a particle of flux Φ.
    pub weight: f32,
}

/// A camera. Measures are chosen so that a pixel is the mean radiance over its filter: the ray
/// through a uniformly chosen raster point has weight one.
pub trait Camera: Sync {
    /// The ray through `raster` (pixels of the whole film), with `lens` in [0, 1)² choosing the
    /// point on the aperture and `time` the moment.
    fn ray(&self, raster: Vec2, lens: Vec2, time: f32) -> CameraRay;

    /// [`Camera::ray`] in lanes.
    fn rays<F: Lane>(&self, raster: [F; 2], lens: [F; 2], time: F) -> CameraRays<F>;

    /// Connects a scene point with the aperture point chosen by `lens` at the moment `time`; `None` if the camera
    /// does not see the point (behind it, clipped, or more than `margin` pixels outside of the
    /// film).
    fn connect(&self, point: Vec3, lens: Vec2, time: f32, margin: f32) -> Option<CameraSample>;

    /// Whether [`Camera::connect`] connects every point that it sees; otherwise none at all.
    fn can_connect(&self) -> bool;

    /// Where a ray that travels through space happens to hit the aperture; `None` if it misses it,
    /// starts where the camera does not see, or arrives more than `margin` pixels outside of the
    /// film. An aperture without extent, or one through which each point of
    /// the film looks in one direction only, is never hit.
    fn intersect_aperture(&self, ray: &Ray, margin: f32) -> Option<ApertureHit>;

    /// Whether [`Camera::intersect_aperture`] can ever receive anything.
    fn can_receive(&self) -> bool;

    /// Whether `lens` matters.
    fn has_lens(&self) -> bool;
}
