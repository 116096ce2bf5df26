//! What rough metals show, by Smith's integral over slopes and by the directions of the hemisphere.

use crate::camera;
use crate::geometry::nearest;
use crate::specular::{complex_fresnel, sky};
use etalon_conform::scene::{Light, Masking, Material, Scene};
use etalon_math::float64::{cos, sin};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// The picture by point lights, and by n × n directions of the hemisphere under a sky, at k × k places in each pixel.
pub(crate) fn by_facets(scene: &Scene, k: u32, n: u32) -> Vec<f64> {
    camera::picture(scene, camera::grid(k), |at| {
        let ray = camera::ray(scene, at, [0.0; 2]);
        let hit = nearest(scene, &ray).expect("the picture is full");
        let (u, v) = hit.normal.any_orthonormal_pair();
        let own = |w: DVec3| DVec3::new(w.dot(u), w.dot(v), w.dot(hit.normal));
        let eye = own(-ray.direction);
        let seen = Seen::of(&hit.object.material, eye);
        let from_light = |light: &Light| match *light {
            Light::Point {
                position_m,
                intensity,
            } => {
                let to = DVec3::from(position_m) - hit.point;
                intensity * seen.reflected(own(to.normalize())) / to.length_squared()
            }
            other => panic!("{other:?} is not expected here"),
        };
        let lights: f64 = scene.lights.iter().map(from_light).sum();
        let from_sky = |[z, turn]: [f64; 2]| {
            let across = (1.0 - z * z).sqrt();
            let i = DVec3::new(across * cos(TAU * turn), across * sin(TAU * turn), z);
            let world = i.x * u + i.y * v + i.z * hit.normal;
            sky(scene, world) * seen.reflected(i)
        };
        let skies: f64 = match scene.sky {
            Some(_) => camera::grid(n).map(from_sky).sum(),
            None => 0.0,
        };
        lights + skies * TAU / f64::from(n * n)
    })
}

/// A rough metal that is seen from a direction, in the frame of the surface.
struct Seen {
    index: [f64; 2],
    alpha: f64,
    masking: Masking,
    eye: DVec3,
    eye_hidden: f64,
}

impl Seen {
    fn of(material: &Material, eye: DVec3) -> Self {
        let Material::RoughConductor {
            n,
            k,
            alpha,
            masking,
        } = *material
        else {
            panic!("{material:?} is not a rough metal");
        };
        Self {
            index: [n, k],
            alpha,
            masking,
            eye,
            eye_hidden: hidden(eye, alpha),
        }
    }

    /// f cos θi of the light from a direction.
    fn reflected(&self, i: DVec3) -> f64 {
        let m = (self.eye + i).normalize();
        // The density of slopes α²/(π (α² + s²)²), over cos⁴ for that of normals.
        let (a2, slope2) = (
            self.alpha * self.alpha,
            (m.x * m.x + m.y * m.y) / (m.z * m.z),
        );
        let density = a2 / (PI * (a2 + slope2).powi(2)) / m.z.powi(4);
        let (o_hidden, i_hidden) = (self.eye_hidden, hidden(i, self.alpha));
        let seen = match self.masking {
            Masking::Separable => 1.0 / (1.0 + o_hidden) / (1.0 + i_hidden),
            Masking::HeightCorrelated => 1.0 / (1.0 + o_hidden + i_hidden),
        };
        let [n, k] = self.index;
        complex_fresnel(self.eye.dot(m), n, k) * density * seen / (4.0 * self.eye.z)
    }
}

/// Smith's Λ = ∫ (s − μ) p(s) ds/μ over slopes s steeper than the ray's μ = cot θ, p = α²/(2 (α² + s²)^(3/2)) along one axis.
fn hidden(w: DVec3, alpha: f64) -> f64 {
    const STEPS: u32 = 100;
    let across = (w.x * w.x + w.y * w.y).sqrt();
    if across < 1e-9 {
        return 0.0;
    }
    let mu = w.z / across;
    // s = μ + α tan² a from a = 0 to a right angle.
    let step = 0.5 * PI / f64::from(STEPS);
    let term = |index: u32| {
        let a = step * (f64::from(index) + 0.5);
        let tangent = sin(a) / cos(a);
        let beyond = alpha * tangent * tangent;
        let s = mu + beyond;
        let square = alpha * alpha + s * s;
        let p = 0.5 * alpha * alpha / (square * square.sqrt());
        beyond * p * 2.0 * alpha * tangent / (cos(a) * cos(a))
    };
    (0..STEPS).map(term).sum::<f64>() * step / mu
}
