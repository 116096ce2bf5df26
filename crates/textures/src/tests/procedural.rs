//! Computed patterns.

use super::*;

fn read(plugin: &str, mut properties: Vec<(&'static str, Value)>) -> One {
    properties.push(("color0", Value::Float(0.2)));
    properties.push(("color1", Value::Float(0.6)));
    One::new(
        &Files::default(),
        &node(plugin, properties),
        SpectrumKind::Reflectance,
    )
}

#[test]
fn patterns_mix_their_colours_and_vary() {
    let patterns = [
        "noise",
        "fbm",
        "turbulence",
        "marble",
        "wood",
        "voronoi",
        "bricks",
        "cubes",
        "dots",
        "gradient",
    ];
    for plugin in patterns {
        let one = read(plugin, vec![("space", text("world"))]);
        let numbers: Vec<f32> = (0..500)
            .map(|i| {
                let position = Vec3::new(0.371, 0.243, 0.172) * i as f32;
                let at = TexturePoint {
                    position,
                    ..TexturePoint::at_uv(Vec2::ZERO)
                };
                let number = one.set.number(one.id, &OneShape, &at);
                let spectrum = one.set.spectrum(one.id, &OneShape, &at, LAMBDA);
                assert!((spectrum - number).abs().max_element() < 1e-6, "{plugin}");
                number
            })
            .collect();
        let [low, high] = [f32::min, f32::max].map(|f| numbers.iter().copied().reduce(f));
        let (low, high) = (low.unwrap_or(0.0), high.unwrap_or(0.0));
        assert!((0.2 - 1e-6..0.45).contains(&low), "{plugin} {low}");
        assert!(high > low + 0.1 && high <= 0.6 + 1e-6, "{plugin} {high}");
    }
}

/// The pattern stands where `to_world` puts it, and its slope along a surface is that of its values.
#[test]
fn patterns_are_placed_in_the_world() {
    let scale = etalon_params::DMat4::from_scale(glam::DVec3::splat(4.0));
    let one = read(
        "gradient",
        vec![
            ("space", text("world")),
            ("to_world", Value::Transform(scale)),
        ],
    );
    let at = TexturePoint {
        position: Vec3::new(1.0, 7.0, -3.0),
        ..TexturePoint::at_uv(Vec2::ZERO)
    };
    assert!((one.set.number(one.id, &OneShape, &at) - 0.3).abs() < 1e-6);
    let moved = [Vec3::new(2.0, 0.0, 0.0), Vec3::Y];
    let slope = one.set.gradient(one.id, &OneShape, &at, moved);
    assert!((slope - Vec2::new(0.2, 0.0)).length() < 1e-3, "{slope}");
}

/// Cubes alternate along each axis; a dot is a disk of the radius 0.35 within its square.
///
/// In the middle of a square the noise is a sum of 16 terms ±1/16, which is above 0 with the probability (1 − C(16, 8)/2¹⁶)/2 = 0.402: so many
/// squares have a dot, here 4096 within 4 standard deviations. A disk's area of 0.3848 is met by a grid of 32² places within 0.01.
#[test]
fn cubes_and_dots() {
    let cubes = read("cubes", vec![]);
    let at = |x: f32, y: f32, z: f32| TexturePoint {
        position: Vec3::new(x, y, z),
        ..TexturePoint::at_uv(Vec2::ZERO)
    };
    for (place, expected) in [
        (at(0.5, 0.5, 0.5), 0.2),
        (at(1.5, 0.5, 0.5), 0.6),
        (at(0.5, -0.5, 0.5), 0.6),
        (at(-0.5, 0.5, 1.5), 0.2),
        (at(-0.5, -0.5, -0.5), 0.6),
    ] {
        assert!((cubes.set.number(cubes.id, &OneShape, &place) - expected).abs() < 1e-6);
    }
    let dots = read("dots", vec![]);
    let mut with_dot = 0;
    for square in 0..4096 {
        let (x, y) = ((square % 64) as f32 - 0.5, (square / 64) as f32 - 0.5);
        let inside = (0..1024).filter(|k| {
            let (u, v) = ((k % 32) as f32 + 0.5, (k / 32) as f32 + 0.5);
            dots.number(x + u / 32.0, y + v / 32.0) > 0.5
        });
        let share = inside.count() as f32 / 1024.0;
        if share > 0.0 {
            with_dot += 1;
            assert!((share - 0.384_8).abs() < 0.01, "{square} {share}");
        }
    }
    let share = f64::from(with_dot) / 4096.0;
    assert!((share - 0.402).abs() < 0.031, "{share}");
}
