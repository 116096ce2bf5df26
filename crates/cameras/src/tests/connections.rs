//! A connection finds the raster position of a ray, and its weight is the Jacobian.

use super::panoramas::panoramas;
use super::*;
use etalon_transport::Camera;
use glam::{Vec2, Vec3};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Cameras of every kind, cropped and whole, mirrored and scaled where that is allowed.
pub(super) fn cameras() -> Vec<(AnyCamera, FilmWindow)> {
    let mirrored = look_at() * DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let sheared = look_at()
        * DMat4::from_cols_array(&[
            3.0, 0.0, 0.0, 0.0, 0.5, 2.0, 0.0, 0.0, 0.3, -0.4, 4.0, 0.0, 0.0, 0.0, 0.0, 1.0,
        ]);
    let lens = lens_parameters();
    let mut all = Vec::new();
    for window in [FILM, CROPPED, TALL] {
        let pinhole = [
            number("fov", 70.0),
            placed(mirrored),
            number("principal_point_offset_x", 0.2),
        ];
        all.push((camera("perspective", &pinhole, window), window));
        all.push((camera("thinlens", &lens, window), window));
        all.push((camera("orthographic", &[placed(sheared)], window), window));
    }
    all
}

proptest! {
    #![proptest_config(ProptestConfig {
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(1),
        ..ProptestConfig::with_cases(500)
    })]

    #[test]
    fn a_connection_finds_the_ray_again(
        x in 0.0f32..1.0, y in 0.0f32..1.0, u in 0.0f32..1.0, v in 0.0f32..1.0,
        t in 0.5f32..15.0,
    ) {
        let lens = Vec2::new(u, v);
        for (camera, window) in cameras().into_iter().chain(panoramas()) {
            let raster = window.origin.as_vec2() + Vec2::new(x, y) * window.crop.as_vec2();
            let ray = camera.ray(raster, lens, 0.0).ray;
            let found = camera.connect(ray.at(t), lens, 0.0, 1e-3).expect("the camera sees its own ray");
            // Coordinates up to 20 carry roundings of 10⁻⁶ each; a pixel is at least 0.02 wide
            // at the distance 0.5.
            prop_assert!((found.raster - raster).abs().max_element() < 2e-3);
            prop_assert!((found.direction + ray.direction).abs().max_element() < 1e-5);
            prop_assert!((found.target - ray.origin).abs().max_element() < 2e-5);
            prop_assert!(found.weight > 0.0 && found.weight.is_finite());
        }
    }
}

/// Area of a quadrilateral (shoelace formula).
fn area(corners: [Vec2; 4]) -> f64 {
    let twice: f64 = (0..4)
        .map(|i| {
            corners[i]
                .as_dvec2()
                .perp_dot(corners[(i + 1) % 4].as_dvec2())
        })
        .sum();
    twice.abs() / 2.0
}

/// ∫ weight·|cos θ| dA over a parallelogram in the world is the area of its image (px²), since a
/// straight edge has a straight image. Rejects a wrong power of the distance or cosine, and a
/// pixel of the wrong size; midpoint quadrature on 48² cells is exact to about 10⁻⁵.
#[test]
fn connection_weights_are_the_jacobian() {
    const CELLS: usize = 48;
    for (camera, window) in cameras() {
        for lens in [Vec2::new(0.5, 0.5), Vec2::new(0.1, 0.8)] {
            let centre = window.origin.as_vec2() + window.crop.as_vec2() * 0.5;
            let ray = camera.ray(centre, lens, 0.0).ray;
            let corner = ray.at(4.0);
            // A slanted patch that begins at a point well inside of the picture.
            let (a, b) = (Vec3::new(0.4, 0.1, 0.2), Vec3::new(-0.1, 0.45, 0.3));
            let normal = a.cross(b).normalize();
            let patch = f64::from(a.cross(b).length());
            let see = |p| {
                camera
                    .connect(p, lens, 0.0, 1e6)
                    .expect("in front of the camera")
            };
            let image = area([
                see(corner).raster,
                see(corner + a).raster,
                see(corner + a + b).raster,
                see(corner + b).raster,
            ]);
            let mut sum = 0.0;
            for i in 0..CELLS * CELLS {
                let s = ((i % CELLS) as f32 + 0.5) / CELLS as f32;
                let t = ((i / CELLS) as f32 + 0.5) / CELLS as f32;
                let connection = see(corner + a * s + b * t);
                let cosine = connection.direction.dot(normal).abs();
                sum += f64::from(connection.weight * cosine);
            }
            let integral = sum * patch / (CELLS * CELLS) as f64;
            assert!(
                (integral / image - 1.0).abs() < 1e-4,
                "{integral} {image} {camera:?}"
            );
        }
    }
}

#[test]
fn clipped_and_unseen_points_are_not_connected() {
    let clip = [
        number("near_clip", 0.5),
        number("far_clip", 20.0),
        number("aperture_radius", 0.1),
    ];
    for (plugin, parameters) in [
        ("perspective", &clip[..2]),
        ("orthographic", &clip[..2]),
        ("thinlens", &clip[..]),
    ] {
        let camera = camera(plugin, parameters, FILM);
        let connects = |z| {
            camera
                .connect(Vec3::new(0.0, 0.0, z), Vec2::splat(0.5), 0.0, 0.0)
                .is_some()
        };
        assert!(connects(0.6) && connects(19.9));
        assert!(!connects(0.4) && !connects(20.1) && !connects(-1.0) && !connects(f32::NAN));
        let beside = Vec3::new(-300.0, 0.0, 10.0);
        assert!(camera.connect(beside, Vec2::splat(0.5), 0.0, 1.0).is_none());
    }
    assert!(!camera("thinlens", &[number("aperture_radius", 0.0)], FILM).has_lens());
    assert!(camera("thinlens", &clip, FILM).has_lens());
}
