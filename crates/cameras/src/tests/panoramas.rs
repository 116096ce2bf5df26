//! Cameras that see more than half of all directions.

use super::*;
use core::f32::consts::PI;
use etalon_transport::Camera;

const FISHEYES: [&str; 4] = ["equidistant", "equisolid", "stereographic", "orthographic"];

/// One of each projection, cropped and whole, one of them mirrored.
pub(super) fn panoramas() -> Vec<(AnyCamera, FilmWindow)> {
    let mirrored = look_at() * DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let mut all = Vec::new();
    for window in [FILM, CROPPED, TALL] {
        for mapping in ["equirectangular", "equalarea"] {
            let properties = [word("mapping", mapping), placed(look_at())];
            all.push((camera("spherical", &properties, window), window));
        }
        for mapping in FISHEYES {
            let properties = [
                word("mapping", mapping),
                number("fov", 178.0),
                // All of the film is in the disk.
                word("fov_axis", "diagonal"),
                placed(mirrored),
            ];
            all.push((camera("fisheye", &properties, window), window));
        }
    }
    all
}

/// The weight is the Jacobian between the film and areas across the ray, by central differences, which err by the square of
/// the step. A direction that is seen n times is found with n times the weight, and its places see it. Mutants rejected: any other
/// mapping's Jacobian, a missing 1/r², the copies of an edge that is turned the wrong way.
#[test]
fn weights_are_the_jacobian() {
    const STEP: f32 = 2e-3;
    for (camera, window) in panoramas() {
        let mut compared = 0;
        for i in 0..300 {
            let at = |step: f32| (i as f32 * step + 0.01).fract();
            let place = Vec2::new(0.03 + 0.94 * at(0.618), 0.03 + 0.94 * at(0.414));
            let raster = window.origin.as_vec2() + place * window.crop.as_vec2();
            let ray = camera.ray(raster, Vec2::ZERO, 0.0).ray;
            let point = ray.at(1.5 + at(0.3));
            let (a, b) = ray.direction.any_orthonormal_pair();
            let see = |offset: Vec3| camera.connect(point + offset * STEP, Vec2::ZERO, 0.0, 0.1);
            let all = [see(a), see(-a), see(b), see(-b), see(Vec3::ZERO)];
            let [Some(left), Some(right), Some(up), Some(down), Some(found)] = all else {
                continue;
            };
            let rasters = [left, right, up, down, found].map(|sample| sample.raster);
            let [left, right, up, down, centre] = rasters;
            // An edge between them, or a crease of the map.
            let bent = |one: Vec2, other: Vec2| {
                (one + other - 2.0 * centre).length() > 5e-3 * one.distance(other)
            };
            if bent(left, right) || bent(up, down) {
                continue;
            }
            let jacobian = (left - right).perp_dot(up - down).abs() / (4.0 * STEP * STEP);
            let error = (jacobian / found.weight - 1.0).abs();
            assert!(error < 0.02, "{jacobian} {found:?} {camera:?}");
            compared += 1;
        }
        assert!(compared > 150, "{compared} {camera:?}");
    }
}

/// In the margin around the film a direction is seen again; connections choose among the places uniformly, and count as many times as there are.
#[test]
fn what_is_seen_again_beyond_the_edge_is_found_there() {
    for mapping in ["equirectangular", "equalarea"] {
        let camera = camera("spherical", &[word("mapping", mapping)], FILM);
        // Just inside of the left edge.
        let raster = Vec2::new(0.25, 11.0);
        let ray = camera.ray(raster, Vec2::ZERO, 0.0).ray;
        let connect = |choice, margin| {
            let lens = Vec2::new(choice, 0.0);
            camera
                .connect(ray.at(2.0), lens, 0.0, margin)
                .expect("seen")
        };
        let alone = connect(0.9, 0.1);
        assert!(alone.raster.distance(raster) < 1e-3);
        let both = [0.2, 0.7].map(|choice| connect(choice, 0.5));
        assert_ne!(both[0].raster, both[1].raster);
        for seen in both {
            assert!((seen.weight / (2.0 * alone.weight) - 1.0).abs() < 1e-5);
            let again = camera.ray(seen.raster, Vec2::ZERO, 0.0).ray;
            assert!(again.direction.distance(ray.direction) < 1e-4, "{seen:?}");
        }
    }
    assert!(camera("spherical", &[], FILM).has_lens());
    assert!(!camera("fisheye", &[], FILM).has_lens());
}

/// Directions where the definitions put them, for a viewer who looks along +z with +y up and +x to the left.
#[test]
fn pictures_are_the_right_way_around() {
    let sees = |camera: &AnyCamera, x: f32, y: f32| {
        let raster = Vec2::new(x, y) * FILM.size.as_vec2();
        camera.ray(raster, Vec2::ZERO, 0.0).ray.direction
    };
    let around = camera("spherical", &[], FILM);
    let square = camera("spherical", &[word("mapping", "equalarea")], FILM);
    let fish = camera(
        "fisheye",
        &[number("fov", 180.0), word("fov_axis", "x")],
        FILM,
    );
    for (seen, expected) in [
        (sees(&around, 0.5, 0.5), Vec3::Z),
        (sees(&around, 0.75, 0.5), Vec3::NEG_X),
        (sees(&around, 0.3, 0.0), Vec3::Y),
        (sees(&square, 0.5, 0.5), Vec3::Y),
        (sees(&square, 0.5, 1.0), Vec3::Z),
        (sees(&square, 1.0, 0.5), Vec3::NEG_X),
        (sees(&square, 0.0, 0.0), Vec3::NEG_Y),
        (sees(&fish, 0.5, 0.5), Vec3::Z),
        (sees(&fish, 1.0, 0.5), Vec3::NEG_X),
    ] {
        assert!(seen.distance(expected) < 1e-5, "{seen} {expected}");
    }
    // 20 px from the centre are a right angle.
    let up = sees(&fish, 0.5, 0.0);
    assert!((up.angle_between(Vec3::Z) - 0.75 * 0.5 * PI).abs() < 1e-5 && up.y > 0.0);
}

/// The disk's area weighed with 1/J is the cone's solid angle 2π (1 − cos φ/2), within what the pixels at its edge let expect. Outside of
/// it nothing is seen, and no point behind the cone is.
#[test]
fn a_fisheye_sees_its_cone_and_no_more() {
    for mapping in FISHEYES {
        for fov in [60.0, 150.0, 180.0, 300.0] {
            if mapping == "orthographic" && fov > 180.0 {
                continue;
            }
            let window = FilmWindow::whole(UVec2::splat(200));
            let properties = [word("mapping", mapping), number("fov", fov)];
            let camera = camera("fisheye", &properties, window);
            let mut sum = 0.0;
            for i in 0..200 * 200 {
                let raster = Vec2::new((i % 200) as f32 + 0.5, (i / 200) as f32 + 0.5);
                let seen = camera.ray(raster, Vec2::ZERO, 0.0);
                if seen.weight == 0.0 {
                    assert_eq!(seen.ray.t_max, 0.0);
                    assert!(raster.distance(Vec2::splat(100.0)) > 99.9);
                    continue;
                }
                let found = camera
                    .connect(seen.ray.at(1.0), Vec2::ZERO, 0.0, 0.0)
                    .expect("seen");
                let distance = seen.ray.at(1.0).length();
                sum += 1.0 / f64::from(found.weight * distance * distance);
            }
            let cone = core::f64::consts::TAU
                * (1.0 - etalon_math::float64::cos((0.5 * fov).to_radians()));
            assert!(
                (sum / cone - 1.0).abs() < 0.01,
                "{mapping} {fov}: {sum} {cone}"
            );
            let beyond = (0.5 * fov as f32 + 1.0).to_radians();
            let (sin, cos) = etalon_math::float::sin_cos(beyond);
            let point = Vec3::new(sin, 0.0, cos) * 3.0;
            assert!(camera.connect(point, Vec2::ZERO, 0.0, 1.0).is_none());
        }
    }
}
