//! Environment maps: radiance against Mitsuba 3.9.1 (`scalar_spectral`), and their densities.

use super::*;
use etalon_params::{DMat4, DVec3};
use etalon_spectrum::{WavelengthDistribution, sensor_response};
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
            let found =
                light.background(&world, direction.normalize(), 0.0, &WAVELENGTHS) / white();
            assert!(
                (found - expected).abs().max_element() < 2e-3,
                "{direction}: {found} {expected}"
            );
        }
    }
}

/// The colour of a direction of the sky: the mean over wavelengths of what a sensor makes of it.
fn seen(world: &SmallWorld, light: &Light, direction: Vec3) -> Vec3 {
    const COUNT: usize = 512;
    let wavelengths = WavelengthDistribution::new(360.0, 830.0).expect("a range");
    let mean = (0..COUNT).map(|i| {
        let w = wavelengths.sample((i as f32 + 0.5) / COUNT as f32);
        sensor_response(&w).rgb(light.background(world, direction.normalize(), 0.0, &w))
    });
    // Four wavelengths each.
    mean.sum::<Vec3>() / (4 * COUNT) as f32
}

/// Between texels the colour is that of Mitsuba's `scalar_rgb`, which interpolates radiance. Its
/// spectral variants interpolate a colour and its brightness each for itself. The rest of the
/// difference is that of spectra fitted to saturated colours.
#[test]
fn colours_match_mitsuba() {
    let scaled = vec![("scale", Value::Float(2.0))];
    let mirrored = rotation(DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0)));
    let (a, b) = (Vec3::new(0.36, 0.48, 0.8), Vec3::new(-0.6, 0.1, 0.7));
    let c = Vec3::new(0.2, -0.9, -0.3);
    for (more, direction, expected) in [
        (vec![], a, [0.648_37, 0.461_204, 2.219_859]),
        (scaled, b, [1.336_615, 0.296_084, 5.193_664]),
        (vec![], c, [0.591_635, 1.658_557, 1.871_201]),
        (mirrored, b, MIRRORED),
    ] {
        let (world, light) = sky(4, &COLOUR, more);
        let found = seen(&world, &light, direction);
        let expected = Vec3::from_array(expected);
        let difference = (found - expected).abs().max_element();
        assert!(
            difference < 1e-2 * expected.max_element(),
            "{found} {expected}"
        );
    }
}

/// The image of the direction (−0.6, 0.1, 0.7) is that of (0.6, 0.1, 0.7) unmirrored.
const MIRRORED: [f32; 3] = [0.795_291, 0.703_810, 2.440_631];

/// Maps of any size, of grey that counts the texels from 1, against Mitsuba's `scalar_rgb`. One
/// column goes all around, one row from pole to pole. Of two rows one is at either pole, and the
/// horizon has their mean; Mitsuba repeats the lower row instead, which is not taken over.
#[test]
fn small_maps_match_mitsuba() {
    for (size, expected) in [
        ((1, 1), [1.0; 8]),
        ((2, 1), [1.5, 1.0, 1.5, 2.0, 1.5, 1.5, 1.365_4, 1.725_6]),
        ((1, 16), [8.5, 8.5, 8.5, 8.5, 1.0, 16.0, 6.109_5, 7.984_1]),
        ((3, 1), [2.0, 1.25, 2.0, 2.75, 2.0, 2.0, 1.798_1, 2.338_3]),
        ((16, 1), [8.5, 4.5, 8.5, 12.5, 8.5, 8.5, 7.423_2, 10.304_5]),
        ((2, 3), [3.5, 3.0, 3.5, 4.0, 1.5, 5.5, 2.727_9, 3.588]),
        ((1, 2), [1.5, 1.5, 1.5, 1.5, 1.0, 2.0, 1.340_7, 1.465_6]),
        ((2, 2), [2.5, 2.0, 2.5, 3.0, 1.5, 3.5, 2.046_7, 2.656_8]),
    ] {
        let (width, height): (usize, usize) = size;
        let texels: Vec<_> = (1..=width * height).map(|i| [i as f32; 3]).collect();
        let (world, light) = sky(width, &texels, vec![]);
        for (direction, expected) in DIRECTIONS.into_iter().zip(expected) {
            let found =
                light.background(&world, direction.normalize(), 0.0, &WAVELENGTHS) / white();
            assert!(
                (found - expected).abs().max_element() < 2e-3 * expected,
                "{size:?} {direction}: {found} {expected}"
            );
        }
    }
}

/// One bright texel, at a pole, beside one, or elsewhere, brings all its energy both ways, and
/// every sample of the sky counts the same within the factor that interpolation allows:
///
/// ```text
/// ∫ L dω = L · 2π/w · ∫ hat(v) sin πv π dv
/// ```
///
/// Rejects nodes that vanish at the poles, where the density would be zero and the radiance not.
#[test]
fn one_bright_texel_brings_its_energy() {
    let bounds = BoundingSphere::of_box(Vec3::splat(-1.0), Vec3::splat(1.0));
    let from = receiver(Vec3::ZERO, Vec3::Z);
    for (width, height) in [(64, 32), (1, 1), (2, 1), (2, 2), (1, 16), (5, 3)] {
        for row in [0, height / 3, height - 1] {
            let mut texels = vec![[0.0; 3]; width * height];
            texels[row * width] = [1e5; 3];
            let (world, light) = sky(width, &texels, vec![]);
            let rows = height.max(2) - 1;
            let hat = |v: f64| {
                let at = v * rows as f64;
                let all = [0, 1].map(|j| (1.0 - (at - (row + j) as f64).abs()).max(0.0));
                if height == 1 { all[0] + all[1] } else { all[0] }
            };
            const STEPS: usize = 20_000;
            let integral: f64 = (0..STEPS)
                .map(|i| (i as f64 + 0.5) / STEPS as f64)
                .map(|v| hat(v) * etalon_math::float64::sin(core::f64::consts::PI * v))
                .sum::<f64>()
                * core::f64::consts::PI
                / STEPS as f64;
            let expected = 1e5 * 2.0 * core::f64::consts::PI / width as f64 * integral;
            const COUNT: usize = 64 * 64;
            let (mut toward, mut emitted) = (0.0, 0.0);
            for i in 0..COUNT {
                let u = Vec2::new((i % 64) as f32 + 0.5, (i / 64) as f32 + 0.5) / 64.0;
                let sample = light.sample(&world, &from, &WAVELENGTHS, u).expect("light");
                let direct = (sample.radiance / white()).x;
                toward += f64::from(direct / sample.chance.lanes().x);
                let density = light.background_density(&from, sample.direction).hero();
                assert!((density / sample.chance.lanes().x - 1.0).abs() < 2e-2);
                let particle = light
                    .emit(&world, &bounds, &WAVELENGTHS, Vec2::splat(0.5), u, 0.0)
                    .expect("a particle");
                emitted += f64::from((particle.weight / white()).x);
            }
            let flux = expected * bounds.cross_section();
            let power = light.power(&world, &bounds) / Spectrum::d65(1.0).expect("finite").mean();
            for (what, found, expected) in [
                ("toward", toward / COUNT as f64, expected),
                ("emitted", emitted / COUNT as f64, flux),
                ("power", power, flux),
            ] {
                let ratio = found / expected;
                assert!(
                    (ratio - 1.0).abs() < 2e-3,
                    "{what} {width}×{height}, row {row}: {ratio}"
                );
            }
        }
    }
}

/// A receiver that does not combine light sampling with scattering.
fn alone() -> LightSampleContext {
    receiver(Vec3::ZERO, Vec3::Z)
}

/// A midpoint rule in (θ, φ) that does not know of texels.
fn integrate(density: impl Fn(Vec3) -> f64) -> f64 {
    const N: usize = 600;
    let mut sum = 0.0;
    for i in 0..N {
        let turns = (i as f32 + 0.5) / (2 * N) as f32;
        let (sin_theta, cos_theta) = etalon_math::float::sin_cos_turns(turns);
        for j in 0..2 * N {
            let (sin, cos) = etalon_math::float::sin_cos_turns((j as f32 + 0.5) / (2 * N) as f32);
            let direction = Vec3::new(sin * sin_theta, cos_theta, -cos * sin_theta);
            sum += density(direction) * f64::from(sin_theta);
        }
    }
    let step = core::f64::consts::PI / N as f64;
    sum * step * step
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
        equal_area(5, &[7, 12, 24], vec![]),
        equal_area(4, &[0, 3, 9], rotation(turned)),
        equal_area(1, &[0], vec![]),
    ]
}

/// A square map in pbrt's equal-area mapping, of 0.1 with bright texels here and there.
fn equal_area(
    side: usize,
    bright: &[usize],
    more: Vec<(&'static str, Value)>,
) -> (SmallWorld, Light) {
    let mut texels = vec![[0.1; 3]; side * side];
    for &texel in bright {
        texels[texel] = [30.0, 20.0, 10.0];
    }
    let mapping = ("mapping", Value::String("equalarea".into()));
    sky(side, &texels, [vec![mapping], more].concat())
}

/// A bright texel of an equal-area map is seen where pbrt-v4 has it, as bright as it is, and has 4π/n² of the sphere, wherever it is:
/// also on an edge and in a corner, which stand four times in the square. Rejects a border that is not mirrored, and directions
/// of the border that count once.
#[test]
fn equal_area_texels_are_where_pbrt_has_them() {
    const SIDE: usize = 8;
    let from = receiver(Vec3::ZERO, Vec3::Z);
    for (column, row) in [(3, 4), (0, 0), (7, 2), (5, 7), (0, 3), (6, 1)] {
        let mut texels = vec![[0.0; 3]; SIDE * SIDE];
        texels[row * SIDE + column] = [1e3; 3];
        let mapping = vec![("mapping", Value::String("equalarea".into()))];
        let (world, light) = sky(SIDE, &texels, mapping);
        let centre = [column, row].map(|i| (i as f32 + 0.5) / SIDE as f32);
        let direction = etalon_math::equal_area::to_direction::<f32>(centre);
        let seen = (light.background(&world, direction, 0.0, &WAVELENGTHS) / white()).x;
        assert!((seen / 1e3 - 1.0).abs() < 1e-4, "{column} {row}: {seen}");
        const COUNT: usize = 128;
        let mut toward = 0.0;
        for i in 0..COUNT * COUNT {
            let u = Vec2::new((i % COUNT) as f32 + 0.5, (i / COUNT) as f32 + 0.5) / COUNT as f32;
            let sample = light.sample(&world, &from, &WAVELENGTHS, u).expect("light");
            toward += f64::from((sample.radiance / white()).x / sample.chance.lanes().x);
        }
        let expected = 1e3 * 4.0 * core::f64::consts::PI / (SIDE * SIDE) as f64;
        let ratio = toward / (COUNT * COUNT) as f64 / expected;
        assert!((ratio - 1.0).abs() < 2e-3, "{column} {row}: {ratio}");
    }
}

/// Rejects a missing sin θ, a missing half texel and a forgotten periodic column.
#[test]
fn densities_integrate_to_one() {
    for (_, light) in variants() {
        for from in [alone(), alone().combined()] {
            let total = integrate(|d| f64::from(light.background_density(&from, d).hero()));
            assert!((total - 1.0).abs() < 2e-3, "{total}");
        }
    }
}

/// Compensation leaves dark regions to scattering, if there is any to find them, and is the default.
/// Rejects the compensated distribution for receivers that have light sampling only.
#[test]
fn compensation_is_for_receivers_that_scatter() {
    let compensated = |value| vec![("mis_compensation", Value::Boolean(value))];
    let maps = [vec![], compensated(true), compensated(false)];
    for (properties, leaves_out) in maps.into_iter().zip([true, true, false]) {
        let (_, light) = sky(8, &grey(), properties);
        let densities = |d| [alone(), alone().combined()].map(|f| light.background_density(&f, d));
        let (mut all, mut left_out) = (0, 0);
        for i in 0..200 {
            let turns = (i % 20) as f32 / 20.0;
            let (sin, cos) = etalon_math::float::sin_cos_turns(turns);
            let d = Vec3::new(sin, 0.2 * (i / 20) as f32 - 0.9, cos).normalize();
            let [all_of_it, rest] = densities(d).map(|density| density.hero());
            if light.background(&SmallWorld::default(), d, 0.0, &WAVELENGTHS) != Vec4::ZERO {
                all += 1;
                assert!(all_of_it > 0.0, "{d}");
                left_out += i32::from(rest == 0.0);
            }
        }
        assert!(
            all > 100 && (left_out > 20) == leaves_out,
            "{left_out} of {all}"
        );
    }
}

/// Directions follow the density: χ² over 12 × 24 cells of equal solid angle, α = 10⁻³ for each
/// of eight maps. Rejects a density that lacks the half texel.
#[test]
fn directions_follow_the_density() {
    const ROWS: usize = 12;
    const COLUMNS: usize = 24;
    const FINE: usize = 24;
    const COUNT: usize = 60_000;
    for (index, (world, light)) in variants().into_iter().enumerate() {
        let from = alone().combined();
        let mut expected = vec![0.0; ROWS * COLUMNS];
        // Steps of θ, since the density per solid angle has a pole at the poles.
        let border = |y: usize| etalon_math::float64::acos(1.0 - 2.0 * y as f64 / ROWS as f64);
        for y in 0..ROWS * FINE {
            let (low, high) = (border(y / FINE), border(y / FINE + 1));
            let step = (high - low) / FINE as f64;
            let theta = low + ((y % FINE) as f64 + 0.5) * step;
            let (sin, cos) = etalon_math::float64::sin_cos(theta);
            let turn = 2.0 * core::f64::consts::PI / (COLUMNS * FINE) as f64;
            let solid_angle = sin * step * turn;
            let (sin_theta, cos_theta) = (sin as f32, cos as f32);
            for x in 0..COLUMNS * FINE {
                let turns = (x as f32 + 0.5) / (COLUMNS * FINE) as f32;
                let (sin, cos) = etalon_math::float::sin_cos_turns(turns);
                let d = Vec3::new(sin * sin_theta, cos_theta, -cos * sin_theta);
                let mass = f64::from(light.background_density(&from, d).hero()) * solid_angle;
                expected[y / FINE * COLUMNS + x / FINE] += mass * COUNT as f64;
            }
        }
        let mut observed = vec![0_u64; ROWS * COLUMNS];
        let mut random = numbers(100 + index as u64);
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
        // The rule of the integral misses where the density jumps.
        let total: f64 = expected.iter().sum();
        expected.iter_mut().for_each(|e| *e *= COUNT as f64 / total);
        let test = goodness_of_fit(&observed, &expected).expect("enough counts");
        assert!(test.p_value > 1e-3, "{index}: {test:?}");
    }
}

/// The power is 4π·πr² times the mean radiance, here by quadrature; a black image has none.
#[test]
fn power_is_the_mean_radiance() {
    let bounds = BoundingSphere::of_box(Vec3::splat(-1.0), Vec3::splat(1.0));
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
    assert_eq!(
        black.background(&world, Vec3::X, 0.0, &WAVELENGTHS),
        Vec4::ZERO
    );
}
