//! Where a scene stands: turned, grown and moved at random, so that no program can owe its answer to round numbers.
//!
//! Faults of rounding hide from seeds: they are the same in all of them. A program without random numbers has no other
//! replicates than these.

use crate::scene::{Camera, Light, Medium, Object, Projection, Scene, Shape, Sky, Triple};
use etalon_math::float64::{cos, sin};
use glam::{DMat3, DQuat, DVec3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::f64::consts::TAU;

/// A rotation, then a scale, then a shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// The rotation.
    pub rotation: DMat3,
    /// The factor on lengths.
    pub scale: f64,
    /// The shift (m).
    pub shift: DVec3,
}

/// How freely a scene may be posed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Freedom {
    /// In every way.
    Any,
    /// In every way, and anew for each picture: for faults that depend on how sizes are rounded.
    EachAnew,
    /// Its origin stays where it is, for scenes with things so small there that single precision cannot hold their corners
    /// elsewhere.
    AboutOrigin,
}

impl Pose {
    /// As the scene is written.
    pub const AS_IS: Self = Self {
        rotation: DMat3::IDENTITY,
        scale: 1.0,
        shift: DVec3::ZERO,
    };

    /// Pose number `index` of a suite's seed: a rotation evenly among all, a scale from 1/2 to 2, a shift of up to a metre along
    /// each axis.
    pub fn draw(seed: u64, index: u32, freedom: Freedom) -> Self {
        let mut random = Pcg64Mcg::seed_from_u64(seed ^ (u64::from(index) << 32 | 0x9e37_79b9));
        let mut next = || random.random::<f64>();
        // A quaternion evenly on its sphere (Shoemake 1992, "Uniform random rotations").
        let (u, a, b) = (next(), TAU * next(), TAU * next());
        let (first, second) = ((1.0 - u).sqrt(), u.sqrt());
        let turn = DQuat::from_xyzw(
            first * sin(a),
            first * cos(a),
            second * sin(b),
            second * cos(b),
        );
        let scale = etalon_math::float64::pow(2.0, 2.0 * next() - 1.0);
        let shift = DVec3::new(next(), next(), next()) * 2.0 - 1.0;
        Self {
            rotation: DMat3::from_quat(turn.normalize()),
            scale,
            shift: match freedom {
                Freedom::Any | Freedom::EachAnew => shift,
                Freedom::AboutOrigin => DVec3::ZERO,
            },
        }
    }

    /// Where a point goes.
    pub fn point(&self, point: DVec3) -> DVec3 {
        self.vector(point) + self.shift
    }

    /// Where the difference of two points goes.
    pub fn vector(&self, vector: DVec3) -> DVec3 {
        self.direction(vector) * self.scale
    }

    /// Where a direction goes.
    pub fn direction(&self, direction: DVec3) -> DVec3 {
        self.rotation * direction
    }
}

impl Scene {
    /// The scene turned, grown and moved together with its camera: the picture stays the same.
    #[must_use]
    pub fn posed(&self, pose: &Pose) -> Self {
        let point = |p: Triple| pose.point(p.into()).to_array();
        let vector = |v: Triple| pose.vector(v.into()).to_array();
        let direction = |v: Triple| pose.direction(v.into()).to_array();
        let scale = pose.scale;
        let projection = match self.camera.projection.clone() {
            Projection::Orthographic { width_m } => Projection::Orthographic {
                width_m: width_m * scale,
            },
            Projection::ThinLens {
                field_of_view_degrees,
                lens_radius_m,
                focus_distance_m,
            } => Projection::ThinLens {
                field_of_view_degrees,
                lens_radius_m: lens_radius_m * scale,
                focus_distance_m: focus_distance_m * scale,
            },
            pinhole @ Projection::Pinhole { .. } => pinhole,
        };
        let shape = |shape: &Shape| match shape {
            Shape::Sphere {
                center_m,
                radius_m,
                inward,
            } => Shape::Sphere {
                center_m: point(*center_m),
                radius_m: radius_m * scale,
                inward: *inward,
            },
            Shape::Quad {
                center_m,
                half_u_m,
                half_v_m,
            } => Shape::Quad {
                center_m: point(*center_m),
                half_u_m: vector(*half_u_m),
                half_v_m: vector(*half_v_m),
            },
            Shape::Box {
                center_m,
                half_axes_m,
            } => Shape::Box {
                center_m: point(*center_m),
                half_axes_m: half_axes_m.map(vector),
            },
            Shape::Mesh {
                positions_m,
                triangles,
            } => Shape::Mesh {
                positions_m: positions_m.iter().copied().map(point).collect(),
                triangles: triangles.clone(),
            },
        };
        let light = |light: &Light| match *light {
            Light::Point {
                position_m,
                intensity,
            } => Light::Point {
                position_m: point(position_m),
                intensity: intensity * scale * scale,
            },
            Light::Spot {
                position_m,
                target_m,
                intensity,
                even_to_degrees,
                dark_from_degrees,
                falloff,
            } => Light::Spot {
                position_m: point(position_m),
                target_m: point(target_m),
                intensity: intensity * scale * scale,
                even_to_degrees,
                dark_from_degrees,
                falloff,
            },
            Light::Sun {
                direction: toward,
                irradiance,
            } => Light::Sun {
                direction: direction(toward),
                irradiance,
            },
        };
        let object = |object: &Object| Object {
            shape: shape(&object.shape),
            interior: object.interior.map(|medium| Medium {
                absorption_per_m: medium.absorption_per_m / scale,
                scattering_per_m: medium.scattering_per_m / scale,
            }),
            ..object.clone()
        };
        let sky = |sky: &Sky| match sky.clone() {
            Sky::Map {
                interpolation,
                zenith,
                meridian,
                rows,
                columns,
                radiance,
            } => Sky::Map {
                interpolation,
                zenith: direction(zenith),
                meridian: direction(meridian),
                rows,
                columns,
                radiance,
            },
            even @ Sky::Even { .. } => even,
        };
        Self {
            camera: Camera {
                origin_m: point(self.camera.origin_m),
                target_m: point(self.camera.target_m),
                up: direction(self.camera.up),
                projection,
            },
            objects: self.objects.iter().map(object).collect(),
            lights: self.lights.iter().map(light).collect(),
            sky: self.sky.as_ref().map(sky),
            ..self.clone()
        }
    }
}
