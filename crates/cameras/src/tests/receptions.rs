//! What arrives on the aperture by chance: the reverse of a camera's ray.

use super::*;
use core::f32::consts::PI;
use etalon_transport::{Camera, Ray};
use glam::{Vec2, Vec3};

const RADIUS: f32 = 0.3;
const NEAR: f32 = 0.5;

fn forward() -> Vec3 {
    look_at().z_axis.truncate().as_vec3()
}

/// dx/dω is known from connections, whose Jacobian is tested by itself: their weight times the
/// squared distance. A reception's is this over the aperture's area and the cosine of arrival. The
/// tolerance is for roundings; a missing cosine is off by up to 15 %, a diameter for the radius by
/// 4.
#[test]
fn a_reversed_ray_is_received_where_it_came_from() {
    for window in [FILM, CROPPED, TALL] {
        let camera = camera("thinlens", &lens_parameters(), window);
        for i in 0..400 {
            let at = |step: f32| (i as f32 * step).fract();
            let place = Vec2::new(at(0.618), at(0.414)) * window.crop.as_vec2();
            let raster = window.origin.as_vec2() + place;
            let lens = Vec2::new(at(0.303), at(0.732));
            let ray = camera.ray(raster, lens, 0.0).ray;
            let cos = ray.direction.dot(forward());
            let aperture = ray.at(-NEAR / cos);
            let back = Ray::new(ray.at(4.0), -ray.direction, 0.0);
            // Points on the very edge of the aperture may be off it by a rounding.
            let Some(found) = camera.intersect_aperture(&back, 1e-2) else {
                let centre = look_at().w_axis.truncate().as_vec3();
                assert!(aperture.distance(centre) > 0.999 * RADIUS);
                continue;
            };
            assert!((found.raster - raster).abs().max_element() < 5e-3);
            assert!(back.at(found.t).distance(ray.origin) < 2e-5);
            let seen = camera.connect(back.origin, lens, 0.0, 1e-2).expect("seen");
            let per_direction = seen.weight * back.origin.distance_squared(aperture);
            let flux = found.weight * PI * RADIUS * RADIUS * cos;
            assert!(
                (flux / per_direction - 1.0).abs() < 1e-4,
                "{flux} {per_direction}"
            );
        }
    }
}

#[test]
fn what_the_camera_does_not_see_is_not_received() {
    let camera = camera("thinlens", &lens_parameters(), FILM);
    let centre = look_at().w_axis.truncate().as_vec3();
    let ray = |depth: f32, direction: Vec3| Ray::new(centre + forward() * depth, direction, 0.0);
    let receives = |depth, direction| {
        let ray = ray(depth, direction);
        camera.intersect_aperture(&ray, 0.0).is_some()
    };
    let back = -forward();
    assert!(receives(0.6, back) && receives(19.0, back));
    // Too near, too far, from behind, in the wrong direction.
    assert!(!receives(0.4, back) && !receives(21.0, back));
    assert!(!receives(-2.0, back) && !receives(-2.0, forward()));
    assert!(!receives(4.0, forward()));
    // Past the aperture, and from outside of the picture.
    let side = look_at().x_axis.truncate().as_vec3();
    assert!(!receives(4.0, (back * 4.0 + side * 0.4).normalize()));
    let slanted = Ray::new(
        centre + forward() + side * 2.0,
        (back - side * 2.0).normalize(),
        0.0,
    );
    assert!(camera.intersect_aperture(&slanted, 1.0).is_none());
    assert!(camera.intersect_aperture(&slanted, 1e3).is_some());
}

#[test]
fn only_an_aperture_with_extent_can_receive() {
    assert!(camera("thinlens", &lens_parameters(), FILM).can_receive());
    let pinholes = [
        camera("thinlens", &[number("aperture_radius", 0.0)], FILM),
        camera("perspective", &[], FILM),
        camera("orthographic", &[], FILM),
        camera("spherical", &[], FILM),
        camera("fisheye", &[], FILM),
    ];
    for camera in pinholes {
        assert!(!camera.can_receive());
        let ray = Ray::new(Vec3::new(0.0, 0.0, 3.0), Vec3::NEG_Z, 0.0);
        assert!(camera.intersect_aperture(&ray, 1.0).is_none());
    }
}
