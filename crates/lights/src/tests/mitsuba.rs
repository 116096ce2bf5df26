//! Point, spot and directional lights against `sample_direction` of Mitsuba 3.9.1
//! (`scalar_spectral`); values are given over D65, which Mitsuba scales a little differently.

use super::*;
use etalon_params::{DMat4, DVec3};
use etalon_transport::SamplePdf;

/// Mitsuba's `look_at` from (1, 2, 3) to (4, 1, −2) with +Y up.
pub(super) fn look_at() -> Value {
    let origin = DVec3::new(1.0, 2.0, 3.0);
    let forward = (DVec3::new(4.0, 1.0, -2.0) - origin).normalize();
    let left = DVec3::Y.cross(forward).normalize();
    let up = forward.cross(left);
    Value::Transform(DMat4::from_cols(
        left.extend(0.0),
        up.extend(0.0),
        forward.extend(0.0),
        origin.extend(1.0),
    ))
}

fn number(value: f64) -> Value {
    Value::Float(value)
}

fn vector(x: f64, y: f64, z: f64) -> Value {
    Value::Vector(DVec3::new(x, y, z))
}

/// Direction, distance (infinite: none) and radiance over D65 toward a light from `from`.
fn toward(world: &SmallWorld, light: &Light, from: Vec3) -> (Vec3, f32, f32) {
    let receiver = receiver(from, Vec3::Z);
    let sample = light
        .sample(world, &receiver, &WAVELENGTHS, Vec2::splat(0.5))
        .expect("the light is seen");
    assert!(matches!(sample.chance, SamplePdf::Discrete(p) if p.0 == Vec4::ONE));
    let ratio = sample.radiance / white();
    assert!((ratio - ratio.x).abs().max_element() < 1e-5 * ratio.x);
    let distance = sample
        .target
        .map_or(f32::INFINITY, |target| target.distance(from));
    (sample.direction, distance, ratio.x)
}

fn assert_toward(
    world: &SmallWorld,
    light: &Light,
    from: [f32; 3],
    direction: [f32; 3],
    distance: f32,
    value: f32,
) {
    let (d, r, v) = toward(world, light, Vec3::from(from));
    assert!(
        (d - Vec3::from(direction)).abs().max_element() < 2e-6,
        "{d}"
    );
    assert!(r == distance || (r / distance - 1.0).abs() < 1e-6, "{r}");
    assert!((v / value - 1.0).abs() < 2e-5, "{v} {value}");
}

#[test]
fn point_and_directional_match_mitsuba() {
    let mut world = SmallWorld::default();
    let point = vec![
        ("position", vector(1.0, 2.0, 3.0)),
        ("intensity", number(2.0)),
    ];
    let moved = vec![("to_world", look_at()), ("intensity", number(2.0))];
    for properties in [point, moved] {
        let light = light(&mut world, "point", properties).light;
        let direction = [0.112_196_8, 0.426_347_7, 0.897_574_2];
        assert_toward(
            &world,
            &light,
            [0.5, 0.1, -1.0],
            direction,
            4.456_456,
            0.100_704_9,
        );
    }
    let direction = vec![
        ("direction", vector(1.0, 2.0, -2.0)),
        ("irradiance", number(3.0)),
    ];
    let third = 1.0 / 3.0;
    let sun = light(&mut world, "directional", direction).light;
    let toward_sun = [-third, -2.0 * third, 2.0 * third];
    assert_toward(
        &world,
        &sun,
        [0.5, 0.1, -1.0],
        toward_sun,
        f32::INFINITY,
        3.0,
    );
    let turned = vec![("to_world", look_at()), ("irradiance", number(3.0))];
    let sun = light(&mut world, "directional", turned).light;
    let toward_sun = [-0.507_092_5, 0.169_030_8, 0.845_154_2];
    assert_toward(
        &world,
        &sun,
        [0.5, 0.1, -1.0],
        toward_sun,
        f32::INFINITY,
        3.0,
    );
}

#[test]
fn a_projector_throws_as_in_mitsuba() {
    let mut world = SmallWorld::default();
    let properties = vec![
        ("to_world", look_at()),
        ("irradiance", number(0.5)),
        ("scale", number(3.0)),
        ("fov", number(50.0)),
    ];
    let projector = light(&mut world, "projector", properties).light;
    let axis = [-0.507_092_5, 0.169_030_8, 0.845_154_2];
    for (from, direction, distance, value) in [
        ([4.0, 1.0, -2.0], axis, 5.916_08, 0.134_639_7),
        (
            [3.0, 2.0, -1.0],
            [-0.447_213_6, 0.0, 0.894_427_2],
            4.472_136,
            0.248_277,
        ),
        (
            [4.0, 0.0, -1.5],
            [-0.520_266, 0.346_844, 0.780_399],
            5.766_281,
            0.149_66,
        ),
    ] {
        assert_toward(&world, &projector, from, direction, distance, value);
    }
    let beside = receiver(Vec3::splat(9.0), Vec3::Z);
    assert!((projector.sample(&world, &beside, &WAVELENGTHS, Vec2::ZERO)).is_none());
}

#[test]
fn spot_falls_off_as_in_mitsuba() {
    let mut world = SmallWorld::default();
    let properties = vec![
        ("to_world", look_at()),
        ("intensity", number(2.0)),
        ("cutoff_angle", number(20.0)),
        ("beam_width", number(5.0)),
    ];
    let spot = light(&mut world, "spot", properties).light;
    for (from, direction, distance, value) in [
        (
            [4.0, 1.0, -2.0],
            [-0.507_092_5, 0.169_030_8, 0.845_154_2],
            5.916_08,
            0.057_142_85,
        ),
        (
            [3.7, 1.2, -2.0],
            [-0.470_509, 0.139_410_1, 0.871_312_9],
            5.738_467,
            0.060_734_89,
        ),
        (
            [3.5, 0.6, -2.0],
            [-0.433_816, 0.242_937, 0.867_632],
            5.762_812,
            0.055_792_75,
        ),
        (
            [3.0, 1.0, -2.0],
            [-0.365_148_4, 0.182_574_2, 0.912_870_9],
            5.477_226,
            0.048_650_55,
        ),
    ] {
        assert_toward(&world, &spot, from, direction, distance, value);
    }
    // The default beam width is three quarters of the cutoff; uniform scale has no effect.
    let scaled = Value::Transform(DMat4::from_scale(DVec3::splat(2.0)));
    let properties = vec![("to_world", scaled), ("intensity", number(2.0))];
    let spot = light(&mut world, "spot", properties).light;
    let direction = [-0.024_984_39, -0.024_984_39, -0.999_375_6];
    assert_toward(
        &world,
        &spot,
        [0.1, 0.1, 4.0],
        direction,
        4.002_499,
        0.124_844,
    );
    let behind = receiver(Vec3::new(0.0, 0.0, -1.0), Vec3::Z);
    let u = Vec2::splat(0.5);
    assert!(spot.sample(&world, &behind, &WAVELENGTHS, u).is_none());
    let beside = receiver(Vec3::new(1.0, 0.0, 1.0), Vec3::Z);
    assert!(spot.sample(&world, &beside, &WAVELENGTHS, u).is_none());
}

#[test]
fn spot_projects_its_texture_as_in_mitsuba() {
    let mut world = SmallWorld::default();
    let properties = vec![
        ("to_world", look_at()),
        ("intensity", number(2.0)),
        ("cutoff_angle", number(20.0)),
        ("beam_width", number(19.999)),
        ("texture", texture("squares")),
    ];
    let spot = light(&mut world, "spot", properties).light;
    for (from, expected) in [
        (Vec3::new(4.0, 1.0, -2.0), 0.04),
        (Vec3::new(3.7, 1.2, -2.0), 0.042_514_43),
        (Vec3::new(3.5, 0.6, -2.0), 0.030_111_41),
        (Vec3::new(3.9, 1.9, -2.0), 0.041_891_09),
    ] {
        let (_, _, value) = toward(&world, &spot, from);
        assert!((value / expected - 1.0).abs() < 1e-5, "{value} {expected}");
    }
}
