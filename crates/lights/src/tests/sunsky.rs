//! The sky of Hošek and Wilkie against Mitsuba's radiances (`sunsky_values.txt`), and its sampling.

use super::*;
use crate::SunSky;
use crate::light_model::LightModel;
use etalon_math::float64;
use etalon_params::DVec3;

const VALUES: &str = include_str!("sunsky_values.txt");

pub(super) const LAMBDA: Wavelengths = Wavelengths {
    lambda: Vec4::new(330.0, 450.0, 555.0, 690.0),
    density: Vec4::ONE,
};

pub(super) fn parsed(text: &str) -> Vec<f64> {
    text.split_whitespace()
        .map(|word| word.parse().expect("a number"))
        .collect()
}

pub(super) fn vector(text: &str) -> DVec3 {
    DVec3::from_slice(&parsed(text))
}

pub(super) fn sky(world: &mut SmallWorld, plugin: &str, properties: Vec<(&str, Value)>) -> SunSky {
    let light = read(world, plugin, properties).expect("a sky without mistakes");
    match light.light {
        Light::SunSky(sky) | Light::TimedSunSky(sky) => sky,
        other => panic!("{other:?}"),
    }
}

fn sunsky(world: &mut SmallWorld, properties: Vec<(&str, Value)>) -> SunSky {
    sky(world, "sunsky", properties)
}

#[test]
fn radiances_are_mitsubas() {
    let mut failures = Vec::new();
    for line in VALUES.lines() {
        let mut world = SmallWorld::default();
        let fields: Vec<&str> = line.split(" ; ").collect();
        let (sky, direction, expected) = if let Some(moment) = fields[0].strip_prefix("moment ") {
            let names = [
                "latitude",
                "longitude",
                "timezone",
                "year",
                "month",
                "day",
                "hour",
                "minute",
                "second",
            ];
            let mut properties: Vec<(&str, Value)> = names
                .into_iter()
                .zip(parsed(moment))
                .map(|(name, value)| match name {
                    "year" | "month" | "day" => (name, Value::Integer(value as i64)),
                    _ => (name, Value::Float(value)),
                })
                .collect();
            properties.push(("sun_scale", Value::Float(0.0)));
            (sunsky(&mut world, properties), fields[1], fields[2])
        } else {
            let head = parsed(fields[0]);
            let properties = vec![
                ("turbidity", Value::Float(head[0])),
                ("albedo", Value::Float(head[1])),
                ("complex_sun", Value::Boolean(head[2] != 0.0)),
                ("sun_aperture", Value::Float(head[3])),
                ("sun_direction", Value::Vector(vector(fields[1]))),
            ];
            (sunsky(&mut world, properties), fields[2], fields[3])
        };
        let direction = vector(direction).as_vec3();
        let ours = sky.background(&world, direction, 0.0, &LAMBDA);
        let expected: Vec<f32> = parsed(expected).iter().map(|&x| x as f32).collect();
        let expected = Vec4::from_slice(&expected);
        // Mitsuba's irradiance of the sun is a table that ends 2° above the horizon.
        if fields.len() == 4 && vector(fields[1]).z < 0.03 && expected.element_sum() > 1.0 {
            continue;
        }
        // In the ultraviolet the sun's limb and radiance change much from band to band; Mitsuba multiplies interpolations
        // of either, we interpolate the product.
        let tolerance = Vec4::new(0.04, 0.01, 0.01, 0.01);
        if !(ours - expected)
            .abs()
            .cmple(expected * tolerance + 1e-6)
            .all()
        {
            failures.push(format!("{line}\n  {ours}"));
        }
    }
    assert!(
        failures.is_empty(),
        "{}:\n{}",
        failures.len(),
        failures.join("\n")
    );
}

#[test]
fn samples_have_the_density_of_their_direction() {
    let mut world = SmallWorld::default();
    for theta in [0.0f64, 0.6, 1.3, 1.56] {
        let sun = DVec3::new(float64::sin(theta), 0.0, float64::cos(theta));
        let properties = vec![
            ("sun_direction", Value::Vector(sun)),
            ("sun_aperture", Value::Float(8.0)),
        ];
        let sky = sunsky(&mut world, properties);
        let variances = irradiances_agree(&world, &sky, 0.0);
        // Sampling by brightness is better by far, unless the sun sets in red.
        let [by_brightness, evenly] = variances;
        assert!(
            theta > 1.5 || by_brightness < 0.5 * evenly,
            "{theta}: {variances:?}"
        );
    }
}

/// Checks the densities of samples at a moment, and that the sampled irradiance is that of directions chosen evenly, within
/// four standard errors of either; the variances of both.
pub(super) fn irradiances_agree(world: &SmallWorld, sky: &SunSky, time: f32) -> [f64; 2] {
    let mut from = receiver(Vec3::ZERO, Vec3::Z);
    from.time = time;
    let mut random = numbers(5);
    let (mut sums, count) = ([[0.0f64; 2]; 2], 200_000);
    for _ in 0..count {
        let u = random.next_2d();
        if let Some(sample) = sky.sample(world, &from, &LAMBDA, u) {
            let density = sky.background_density(&from, sample.direction).hero();
            let sampled = sample.chance.lanes().x;
            assert!(
                (density / sampled - 1.0).abs() < 1e-3,
                "{} {density} {sampled}",
                sample.direction
            );
            let value = f64::from(sample.radiance.y / sampled);
            sums[0][0] += value;
            sums[0][1] += value * value;
        }
        let z = u.x;
        let (y, x) = etalon_math::float::sin_cos(core::f32::consts::TAU * u.y);
        let r = (1.0 - z * z).sqrt();
        let even = sky
            .background(world, Vec3::new(r * x, r * y, z), time, &LAMBDA)
            .y;
        let value = f64::from(even) * core::f64::consts::TAU;
        sums[1][0] += value;
        sums[1][1] += value * value;
    }
    let n = f64::from(count);
    let [a, b] = sums.map(|[sum, squares]| {
        let mean = sum / n;
        (mean, (squares / n - mean * mean) / n)
    });
    let z = (a.0 - b.0) / (a.1 + b.1).sqrt();
    assert!(z.abs() < 4.0, "{time}: {} instead of {}", a.0, b.0);
    [a.1, b.1]
}
