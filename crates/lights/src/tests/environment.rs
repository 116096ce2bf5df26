//! Environment maps: radiance against Mitsuba 3.9.1 (`scalar_spectral`), and their densities.

use super::*;
use etalon_params::{DMat4, DVec3};
use etalon_statistics::chi_squared::goodness_of_fit;

/// 8 × 4 texels of grey that grows with the index.
fn grey() -> Vec<[f32; 3]> {
    (0..32).map(|i| [0.1 * i as f32 + 0.05; 3]).collect()
}

/// 4 × 3 texels of colour.
const COLOUR: [[f32; 3]; 12] = [
    [0.81, 1.62, 2.58],
    [0.29, 0.11, 1.92],
    [0.41, 0.09, 0.24],
    [1.0, 1.3, 1.17],
    [0.43, 1.95, 4.49],
    [0.84, 0.78, 2.47],
    [0.68, 0.12, 2.78],
    [0.27, 1.76, 0.32],
    [0.68, 1.74, 1.14],
    [0.9, 1.74, 0.09],
    [0.71, 0.0, 2.52],
    [0.44, 0.41, 1.62],
];

fn sky(width: usize, rgb: &[[f32; 3]], more: Vec<(&'static str, Value)>) -> (SmallWorld, Light) {
    let mut world = SmallWorld::default();
    add_file(&mut world, "sky.pfm", width, rgb);
    let mut properties = vec![("filename", Value::String("sky.pfm".into()))];
    properties.extend(more);
    let light = light(&mut world, "envmap", properties).light;
    (world, light)
}

fn rotation(matrix: DMat4) -> Vec<(&'static str, Value)> {
    vec![("to_world", Value::Transform(matrix))]
}

/// Directions of Mitsuba's tests.
const DIRECTIONS: [Vec3; 8] = [
    Vec3::Z,
    Vec3::X,
    Vec3::NEG_Z,
    Vec3::NEG_X,
    Vec3::Y,
    Vec3::NEG_Y,
    Vec3::new(0.36, 0.48, 0.8),
    Vec3::new(-0.6, 0.1, 0.7),
];

#[test]
fn orientation_matches_mitsuba() {
    let about_y = DMat4::from_rotation_y(30.0_f64.to_radians());
    let about_x = DMat4::from_rotation_x(90.0_f64.to_radians());
    for (more, expected) in [
        (vec![], [1.6, 1.4, 1.6, 1.8, 0.4, 2.8, 1.163_688, 1.607_687]),
        (
            rotation(about_y),
            [
                1.666_667, 1.466_667, 1.266_667, 1.866_667, 0.4, 2.8, 1.230_355, 1.674_353,
            ],
        ),
        (
            rotation(about_x),
            [0.4, 1.4, 2.8, 1.8, 1.6, 1.6, 0.573_531_5, 1.167_554],
        ),
    ] {
        let (world, light) = sky(8, &grey(), more);
        for (direction, expected) in DIRECTIONS.into_iter().zip(expected) {
            let found = light.background(&world, direction.normalize(), &WAVELENGTHS) / white();
            assert!(
                (found - expected).abs().max_element() < 2e-3,
                "{direction}: {found} {expected}"
            );
        }
    }
}

/// Colours come from another table of the same family as Mitsuba's: 3 % of the largest value.
#[test]
fn colours_match_mitsuba() {
    let scaled = vec![("scale", Value::Float(2.0))];
    let mirrored = rotation(DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0)));
    let (a, b) = (Vec3::new(0.36, 0.48, 0.8), Vec3::new(-0.6, 0.1, 0.7));
    for (more, direction, expected) in [
        (
            scaled.clone(),
            a,
            [6.334_701, 2.560_8, 1.051_092, 1.437_885],
        ),
        (
            scaled.clone(),
            b,
            [8.050_279, 2.072_124, 0.690_066, 1.562_058],
        ),
        (
            scaled,
            Vec3::new(0.2, -0.9, -0.3),
            [2.315_911, 4.419_815, 3.468_05, 0.908_978],
        ),
        (mirrored, a, [3.031_641, 0.916_699, 0.398_076, 0.999_898]),
    ] {
        let (world, light) = sky(4, &COLOUR, more);
        let found = light.background(&world, direction.normalize(), &WAVELENGTHS);
        let expected = Vec4::from_array(expected);
        let difference = (found - expected).abs().max_element();
        assert!(
            difference < 0.03 * expected.max_element(),
            "{found} {expected}"
        );
    }
}

/// A midpoint rule in (cos θ, φ) that does not know of texels.
fn integrate(density: impl Fn(Vec3) -> f64) -> f64 {
    const N: usize = 600;
    let mut sum = 0.0;
    for i in 0..N {
        let cos_theta = (i as f32 + 0.5) / N as f32 * 2.0 - 1.0;
        let sin_theta = (1.0 - cos_theta * cos_theta).sqrt();
        for j in 0..2 * N {
            let (sin, cos) = etalon_math::float::sin_cos_turns((j as f32 + 0.5) / (2 * N) as f32);
            sum += density(Vec3::new(sin * sin_theta, cos_theta, -cos * sin_theta));
        }
    }
    sum * 4.0 * core::f64::consts::PI / (2 * N * N) as f64
}

fn variants() -> Vec<(SmallWorld, Light)> {
    let turned = DMat4::from_rotation_x(0.8) * DMat4::from_rotation_y(2.0);
    let compensated = vec![("mis_compensation", Value::Boolean(true))];
    let mut spot = vec![[0.1; 3]; 16 * 9];
    spot[3 * 16 + 15] = [50.0, 40.0, 30.0];
    spot[0] = [5.0; 3];
    vec![
        sky(8, &grey(), vec![]),
        sky(4, &COLOUR, rotation(turned)),
        sky(4, &COLOUR, compensated),
        sky(16, &spot, vec![]),
        // Nothing is left of a uniform image after compensation; it is not compensated then.
        sky(
            2,
            &[[1.0; 3]; 6],
            vec![("mis_compensation", Value::Boolean(true))],
        ),
    ]
}

/// Rejects a missing sin θ, a missing half texel and a forgotten periodic column.
#[test]
fn densities_integrate_to_one() {
    for (_, light) in variants() {
        let total = integrate(|d| f64::from(light.background_density(d).chooser()));
        assert!((total - 1.0).abs() < 2e-3, "{total}");
    }
}

/// Directions follow the density: χ² over 12 × 24 cells of equal solid angle, α = 10⁻³ for each
/// of five maps. Rejects a density that lacks the half texel.
#[test]
fn directions_follow_the_density() {
    const ROWS: usize = 12;
    const COLUMNS: usize = 24;
    const FINE: usize = 24;
    const COUNT: usize = 60_000;
    for (index, (world, light)) in variants().into_iter().enumerate() {
        let mut expected = vec![0.0; ROWS * COLUMNS];
        let solid_angle = 4.0 * core::f64::consts::PI / (ROWS * COLUMNS * FINE * FINE) as f64;
        for y in 0..ROWS * FINE {
            let cos_theta = 1.0 - 2.0 * (y as f32 + 0.5) / (ROWS * FINE) as f32;
            let sin_theta = (1.0 - cos_theta * cos_theta).sqrt();
            for x in 0..COLUMNS * FINE {
                let turns = (x as f32 + 0.5) / (COLUMNS * FINE) as f32;
                let (sin, cos) = etalon_math::float::sin_cos_turns(turns);
                let d = Vec3::new(sin * sin_theta, cos_theta, -cos * sin_theta);
                let mass = f64::from(light.background_density(d).chooser()) * solid_angle;
                expected[y / FINE * COLUMNS + x / FINE] += mass * COUNT as f64;
            }
        }
        let mut observed = vec![0_u64; ROWS * COLUMNS];
        let mut random = numbers(100 + index as u64);
        let from = receiver(Vec3::ZERO, Vec3::Z);
        for _ in 0..COUNT {
            let sample = light
                .sample(&world, &from, &WAVELENGTHS, random.next_2d())
                .expect("the sky is not black");
            let d = sample.direction;
            let turns = etalon_math::float::atan2(d.x, -d.z) / core::f32::consts::TAU;
            let column = ((turns - turns.floor()) * COLUMNS as f32) as usize;
            let row = ((1.0 - d.y) * 0.5 * ROWS as f32) as usize;
            observed[row.min(ROWS - 1) * COLUMNS + column.min(COLUMNS - 1)] += 1;
        }
        let test = goodness_of_fit(&observed, &expected).expect("enough counts");
        assert!(test.p_value > 1e-3, "{index}: {test:?}");
    }
}

/// The power is 4π·πr² times the mean radiance, here by quadrature; a black image has none.
#[test]
fn power_is_the_mean_radiance() {
    let bounds = Bounds::of_box(Vec3::splat(-1.0), Vec3::splat(1.0));
    let (world, uniform) = sky(2, &[[0.7; 3]; 6], vec![]);
    let expected = 4.0
        * core::f64::consts::PI
        * bounds.cross_section()
        * 0.7
        * Spectrum::d65(1.0).expect("finite").mean();
    assert!((uniform.power(&world, &bounds) / expected - 1.0).abs() < 1e-5);
    let (world, black) = sky(2, &[[0.0; 3]; 6], vec![]);
    assert_eq!(black.power(&world, &bounds), 0.0);
    let from = receiver(Vec3::ZERO, Vec3::Z);
    assert!(
        black
            .sample(&world, &from, &WAVELENGTHS, Vec2::splat(0.3))
            .is_none()
    );
    assert_eq!(black.background(&world, Vec3::X, &WAVELENGTHS), Vec4::ZERO);
}
