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
