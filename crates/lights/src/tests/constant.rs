//! A uniform sky: its directions, from every kind of receiver.

use super::{SmallWorld, WAVELENGTHS, light, numbers, white};
use crate::Light;
use etalon_math::float64;
use etalon_sampling::Sampler;
use etalon_statistics::chi_squared::goodness_of_fit;
use etalon_transport::LightSampleContext;
use glam::{Vec2, Vec3};

/// In space, lit on both sides, and on one.
fn receivers() -> [LightSampleContext; 3] {
    let normal = Vec3::new(0.3, -0.5, 0.8).normalize();
    let both = LightSampleContext::on_surface(Vec3::ONE, normal);
    let mut one = both;
    one.one_sided = true;
    [LightSampleContext::in_space(Vec3::ONE), both, one]
}

fn sky() -> (SmallWorld, Light) {
    let mut world = SmallWorld::default();
    let sky = light(&mut world, "constant", vec![]).light;
    (world, sky)
}

/// A direction by its height over the normal (−1 to 1) and its azimuth in turns.
fn direction(from: &LightSampleContext, height: f64, turns: f64) -> Vec3 {
    let n = if from.normal == Vec3::ZERO {
        Vec3::Z
    } else {
        from.normal
    };
    let (s, t) = n.any_orthonormal_pair();
    let (sin, cos) = float64::sin_cos(core::f64::consts::TAU * turns);
    let across = (1.0 - height * height).sqrt();
    (s * (across * cos) as f32 + t * (across * sin) as f32 + n * height as f32).normalize()
}

/// χ² over 16 × 8 cells of equal solid angle, α = 10⁻³ for each of three receivers; and the density
/// integrates to one. Rejects the density of the sphere for any other, and one of both sides that is
/// sampled on one.
#[test]
fn directions_follow_the_density() {
    const ROWS: usize = 16;
    const COLUMNS: usize = 8;
    const COUNT: usize = 40_000;
    let (world, sky) = sky();
    for (index, from) in receivers().iter().enumerate() {
        let mut expected = vec![0.0; ROWS * COLUMNS];
        for y in 0..ROWS * 16 {
            for x in 0..COLUMNS {
                let height = 2.0 * (y as f64 + 0.5) / (16 * ROWS) as f64 - 1.0;
                let toward = direction(from, height, (x as f64 + 0.5) / COLUMNS as f64);
                let solid_angle = 4.0 * core::f64::consts::PI / (16 * ROWS * COLUMNS) as f64;
                let density = f64::from(sky.background_density(from, toward).hero());
                expected[y / 16 * COLUMNS + x] += density * solid_angle;
            }
        }
        let total: f64 = expected.iter().sum();
        assert!((total - 1.0).abs() < 1e-4, "{index}: {total}");
        expected.iter_mut().for_each(|e| *e *= COUNT as f64);
        let mut observed = vec![0_u64; ROWS * COLUMNS];
        let mut random = numbers(7 + index as u64);
        let n = direction(from, 1.0, 0.0);
        let (s, t) = n.any_orthonormal_pair();
        for _ in 0..COUNT {
            let sample = sky.sample(&world, from, &WAVELENGTHS, random.next_2d());
            let sample = sample.expect("not on the horizon");
            let density = sky.background_density(from, sample.direction);
            assert_eq!(sample.chance.lanes(), density.lanes());
            let d = sample.direction;
            let turns = etalon_math::float::atan2(d.dot(t), d.dot(s)) / core::f32::consts::TAU;
            let column = ((turns - turns.floor()) * COLUMNS as f32) as usize;
            let row = ((d.dot(n) + 1.0) * 0.5 * ROWS as f32) as usize;
            observed[row.min(ROWS - 1) * COLUMNS + column.min(COLUMNS - 1)] += 1;
        }
        let test = goodness_of_fit(&observed, &expected).expect("enough counts");
        assert!(test.p_value > 1e-3, "{index}: {test:?}");
    }
}

/// What is lit on one side gets the same irradiance π L from every sample, and no receiver misses any
/// direction from which light counts.
#[test]
fn one_side_is_sampled_without_variance() {
    let (world, sky) = sky();
    let [_, both, one] = receivers();
    let mut random = numbers(3);
    for _ in 0..1000 {
        let u = random.next_2d();
        let sample = sky.sample(&world, &one, &WAVELENGTHS, u).expect("light");
        let cos = sample.direction.dot(one.normal);
        let irradiance = sample.radiance * cos / sample.chance.lanes() / white();
        assert!(
            (irradiance / core::f32::consts::PI - 1.0)
                .abs()
                .max_element()
                < 1e-5
        );
        for side in [1.0, -1.0] {
            let toward = side * sample.direction;
            assert!(sky.background_density(&both, toward).hero() >= 1.0 / 26.0);
            let seen = sky.background_density(&one, toward).hero() > 0.0;
            assert_eq!(seen, side > 0.0);
        }
    }
    let corner = Vec2::new(0.999_999_94, 0.5);
    for from in receivers() {
        let sample = sky.sample(&world, &from, &WAVELENGTHS, corner);
        assert!(sample.is_none_or(|s| s.chance.lanes().x > 0.0 && s.direction.is_finite()));
    }
}
