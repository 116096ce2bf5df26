//! Camera rays in vector lanes: lane i has the bits of the ray alone.

use super::connections::cameras;
use super::panoramas::panoramas;
use super::*;
use crate::{ClipRange, ImagePlane, Perspective};
use etalon_math::lane::{F32x8, F32x16, Lane};
use etalon_math::{Animated, Interpolation, Motion, MotionKey};
use etalon_sampling::{Independent, Sampler};
use etalon_transport::Camera;
use glam::{DVec2, Vec2};

/// A pinhole camera that moves and turns while the shutter is open.
fn moving() -> AnyCamera {
    let turned = DMat4::from_translation(DVec3::new(0.5, -1.0, 2.0)) * DMat4::from_rotation_y(0.7);
    let keys = [(0.0, look_at()), (1.0, turned * look_at())].map(MotionKey::from);
    let motion = Motion::new(Interpolation::Linear, &keys).expect("a motion");
    let image = ImagePlane::new(FILM, 0.6, DVec2::ZERO);
    let pose = Animated::new(motion);
    AnyCamera::Perspective(Perspective::new(pose, image, ClipRange::default()))
}

fn compare<F: Lane>(camera: &AnyCamera, random: &mut Independent) {
    let samples: Vec<(Vec2, Vec2, f32)> = (0..F::WIDTH)
        .map(|_| (random.next_2d() * 30.0, random.next_2d(), random.next_1d()))
        .collect();
    let both = |of: fn(&(Vec2, Vec2, f32)) -> Vec2| {
        [0, 1].map(|axis| F::from_fn(|i| of(&samples[i])[axis]))
    };
    let time = F::from_fn(|i| samples[i].2);
    let together = camera.rays::<F>(both(|s| s.0), both(|s| s.1), time).lanes();
    for (i, &(raster, lens, time)) in samples.iter().enumerate() {
        let (alone, lane) = (camera.ray(raster, lens, time), together(i, time));
        assert_eq!(alone.ray, lane.ray);
        assert_eq!(alone.weight.to_bits(), lane.weight.to_bits());
    }
}

/// Mutants rejected: the pose of another lane's moment, the aperture point of another lane, x for y.
#[test]
fn rays_in_lanes_are_those_of_each_sample() {
    let mut random = Independent::from_key(1);
    let moving = moving();
    let all: Vec<_> = cameras().into_iter().chain(panoramas()).collect();
    for camera in all.iter().map(|(camera, _)| camera).chain([&moving]) {
        for _ in 0..64 {
            compare::<F32x8>(camera, &mut random);
            compare::<F32x16>(camera, &mut random);
        }
    }
    // The moments matter.
    let at = |time| moving.ray(Vec2::splat(3.0), Vec2::ZERO, time).ray.origin;
    assert!(at(0.0).distance(at(1.0)) > 1.0);
}
