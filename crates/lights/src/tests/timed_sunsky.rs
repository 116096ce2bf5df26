//! The sky while days pass against Mitsuba's radiances (`timed_sunsky_values.txt`), and its sampling.

use super::sunsky::{LAMBDA, irradiances_agree, parsed, sky, vector};
use super::*;
use crate::SunSky;
use crate::light_model::LightModel;

const VALUES: &str = include_str!("timed_sunsky_values.txt");

const NAMES: [&str; 13] = [
    "latitude",
    "longitude",
    "timezone",
    "start_year",
    "start_month",
    "start_day",
    "end_year",
    "end_month",
    "end_day",
    "window_start_time",
    "window_end_time",
    "shutter_open",
    "shutter_close",
];

/// The sky of a calendar, under a disk of the sun of 4°.
fn timed(world: &mut SmallWorld, calendar: &[f64]) -> SunSky {
    let properties = NAMES.into_iter().zip(calendar).map(|(name, &value)| {
        let whole = name.starts_with("start") || name.starts_with("end");
        let value = if whole {
            Value::Integer(value as i64)
        } else {
            Value::Float(value)
        };
        (name, value)
    });
    let mut properties: Vec<_> = properties.collect();
    properties.push(("sun_aperture", Value::Float(4.0)));
    properties.push(("complex_sun", Value::Boolean(true)));
    sky(world, "timed_sunsky", properties)
}

#[test]
fn radiances_are_mitsubas() {
    for line in VALUES.lines() {
        let fields: Vec<&str> = line.split(" ; ").collect();
        let head = parsed(fields[0]);
        let mut world = SmallWorld::default();
        // The sensor's shutter opens with the light's, half a unit into a frame, and is open for twice as long.
        let [open, close, share] = [head[11], head[12], head[13]];
        world.shutter = Shutter {
            open: 0.5,
            close: 0.5 + 2.0 * (close - open),
            frame: open - 0.5,
            ..Shutter::default()
        };
        let sky = timed(&mut world, &head[..13]);
        let ours = sky.background(
            &world,
            vector(fields[1]).as_vec3(),
            0.5 * share as f32,
            &LAMBDA,
        );
        let expected: Vec<f32> = parsed(fields[2]).iter().map(|&x| x as f32).collect();
        let expected = Vec4::from_slice(&expected);
        // As in `sunsky.rs`, in the ultraviolet products are interpolated otherwise. Mitsuba counts days in single precision,
        // so that its sun is off by up to 0.1°.
        let tolerance = Vec4::new(0.06, 0.02, 0.02, 0.02);
        let off = (ours - expected).abs();
        assert!(
            off.cmple(expected * tolerance + 1e-6).all(),
            "{line}\n  {ours}"
        );
    }
}

#[test]
fn samples_have_the_density_of_their_direction_at_their_moment() {
    let mut world = SmallWorld {
        shutter: Shutter {
            close: 1.0,
            ..Shutter::default()
        },
        ..SmallWorld::default()
    };
    let day = [
        45.0, 0.0, 0.0, 2025.0, 6.0, 21.0, 2025.0, 6.0, 22.0, 0.0, 24.0, 0.0, 1.0,
    ];
    let sky = timed(&mut world, &day);
    let mut variances = [0.0; 2];
    for hour in [5.0, 6.0, 9.0, 12.0, 18.5] {
        let at = irradiances_agree(&world, &sky, hour / 24.0);
        (variances.iter_mut().zip(at)).for_each(|(sum, at)| *sum += at);
    }
    assert!(variances[0] < 0.3 * variances[1], "{variances:?}");
    let night = receiver(Vec3::ZERO, Vec3::Z);
    assert!(
        sky.sample(&world, &night, &LAMBDA, Vec2::splat(0.5))
            .is_none()
    );
    // The power is that of the mean irradiance.
    let bounds = BoundingSphere::of_box(-Vec3::ONE, Vec3::ONE);
    let strata = 400;
    let mut random = numbers(7);
    let mut irradiance = 0.0;
    for stratum in 0..strata {
        let mut from = receiver(Vec3::ZERO, Vec3::Z);
        from.time = (stratum as f32 + random.next_1d()) / strata as f32;
        for _ in 0..200 {
            let lambda = Vec4::splat(345.0 + 370.0 * random.next_1d());
            let at = Wavelengths {
                lambda,
                density: Vec4::ONE,
            };
            let sample = sky.sample(&world, &from, &at, random.next_2d());
            irradiance += sample.map_or(0.0, |s| f64::from(s.radiance.x / s.chance.lanes().x));
        }
    }
    irradiance /= f64::from(strata) * 200.0;
    let said = sky.power(&world, &bounds) / bounds.cross_section();
    assert!(
        (said / irradiance - 1.0).abs() < 0.05,
        "{said} {irradiance}"
    );
}

#[test]
fn skies_that_show_nothing_of_the_days_say_so() {
    let winter = |hours: [f64; 2]| {
        vec![
            ("latitude", Value::Float(80.0)),
            ("end_year", Value::Integer(2025)),
            ("window_start_time", Value::Float(hours[0])),
            ("window_end_time", Value::Float(hours[1])),
        ]
    };
    let mut world = SmallWorld::default();
    let said = |world: &mut SmallWorld, properties| {
        let said = read(world, "timed_sunsky", properties).expect_err("a note");
        said.join("; ")
    };
    let closed = said(&mut world, vec![]);
    assert!(closed.contains("this sky stands still"), "{closed}");
    world.shutter.close = 1.0;
    let night = said(&mut world, winter([0.0, 24.0]));
    assert!(night.contains("the sun never rises"), "{night}");
    let backward = said(&mut world, winter([14.0, 11.0]));
    assert!(
        backward.contains("`window_end_time` of `timed_sunsky` cannot be 11"),
        "{backward}"
    );
    let past = vec![("end_year", Value::Integer(2024))];
    let past = said(&mut world, past);
    assert!(
        past.contains("the last day must not be before the first"),
        "{past}"
    );
}
