//! Lenses by their formula: what they blur, and which numbers contradict each other.

use super::*;
use etalon_transport::Camera;
use glam::{Vec2, Vec3};

/// How wide a point on the axis is on the film (pixels), by where it is seen through two ends of the aperture.
fn spread(properties: &[(&str, Value)], depth: f32) -> f64 {
    let camera = camera("thinlens", properties, FILM);
    // Both ends of the first axis of the disk.
    let ends = [Vec2::new(1.0, 0.5), Vec2::new(0.0, 0.5)];
    let seen = ends.map(|lens| {
        let point = Vec3::new(0.0, 0.0, depth);
        camera
            .connect(point, lens, 0.0, 1e3)
            .expect("it is in view")
            .raster
    });
    let [a, b] = seen.map(Vec2::as_dvec2);
    (a - b).length()
}

/// The circle of confusion is (f/N) |z − z₀| z₁ / (z z₀) wide on the film, by similar triangles; a hundredth of a pixel is told apart, and
/// the mutants z₁ = f (5 %) and R = f/N (100 %) are rejected.
#[test]
fn blur_is_that_of_the_lens_equation() {
    let (f, number_f, z0, width) = (0.1, 2.0, 2.1, 0.036);
    let z1 = 1.0 / (1.0 / f - 1.0 / z0);
    let lens = |rest: &[(&'static str, f64)]| -> Vec<(&'static str, Value)> {
        let given = rest.iter().map(|(name, value)| number(name, *value));
        given.chain([number("film_width", width)]).collect()
    };
    for properties in [
        lens(&[
            ("focal_length", f),
            ("focus_distance", z0),
            ("f_number", number_f),
        ]),
        lens(&[
            ("focal_length", f),
            ("image_distance", z1),
            ("f_number", number_f),
        ]),
        lens(&[
            ("focus_distance", z0),
            ("image_distance", z1),
            ("f_number", number_f),
        ]),
        lens(&[
            ("focal_length", f),
            ("focus_distance", z0),
            ("aperture_radius", f / number_f / 2.0),
        ]),
        vec![
            number("focal_length", f),
            number("focus_distance", z0),
            number("f_number", number_f),
        ],
    ] {
        for z in [1.0, 1.7, 2.1, 3.0, 40.0] {
            let on_film = f / number_f * (z - z0).abs() * z1 / (z * z0);
            let expected = on_film / width * f64::from(FILM.size.x);
            let found = spread(&properties, z as f32);
            assert!(
                (found - expected).abs() < 0.01,
                "{z}: {found} for {expected}"
            );
        }
    }
}

#[test]
fn numbers_that_contradict_each_other_are_refused() {
    for (properties, expected) in [
        (
            vec![
                number("focal_length", 0.05),
                number("focus_distance", 2.0),
                number("image_distance", 0.06),
                number("f_number", 2.0),
            ],
            "1/f = 1/z₀ + 1/z₁ does not hold for f = 0.05, z₀ = 2, z₁ = 0.06 m",
        ),
        (
            vec![
                number("focal_length", 0.05),
                number("focus_distance", 0.04),
                number("f_number", 2.0),
            ],
            "`focus_distance` of `thinlens` cannot be 0.04",
        ),
        (
            vec![
                number("focal_length", 0.05),
                number("f_number", 2.0),
                number("aperture_radius", 0.1),
            ],
            "f/2 of f = 0.05 m has a radius of 0.0125 m, and `aperture_radius` is 0.1 m",
        ),
        (
            vec![
                number("focal_length", 0.05),
                number("f_number", 2.0),
                number("film_width", 0.036),
                number("fov", 60.0),
            ],
            "`fov` says 2 tan(φ/2)",
        ),
        (
            vec![number("f_number", 2.0)],
            "an f-number says nothing without the focal length",
        ),
        (
            vec![number("aperture_radius", 0.1), number("film_width", 0.03)],
            "says nothing without its distance",
        ),
        (
            vec![
                number("aperture_radius", 0.1),
                number("image_distance", 0.1),
            ],
            "says nothing without the lens",
        ),
        (
            vec![number("focal_length", -1.0), number("f_number", 2.0)],
            "cannot be -1",
        ),
        (
            vec![number("focal_length", 0.05), number("f_number", 0.0)],
            "cannot be 0",
        ),
    ] {
        let (camera, messages) = read("thinlens", &properties, FILM);
        assert!(camera.is_none() || !messages.is_empty());
        assert!(
            matches!(&messages[..], [message] if message.contains(expected)),
            "{expected}: {messages:?}"
        );
    }
}
