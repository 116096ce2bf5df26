//! Rays against Mitsuba 3.9.1's `sensor.sample_ray` (`scalar_rgb`).

use super::*;
use etalon_transport::Camera;
use glam::{Vec2, Vec3};

/// Mitsuba's samples are parts of the crop window.
fn raster(window: FilmWindow) -> Vec2 {
    window.origin.as_vec2() + Vec2::new(0.2, 0.7) * window.crop.as_vec2()
}

/// Origins agree to 2·10⁻⁶ (a few roundings of numbers up to 3 in either program), directions
/// to 10⁻⁶, lengths to a relative 2·10⁻⁶.
fn assert_ray(
    camera: &AnyCamera,
    window: FilmWindow,
    lens: Vec2,
    o: [f32; 3],
    d: [f32; 3],
    t: f32,
) {
    let sample = camera.ray(raster(window), lens, 0.25);
    assert_eq!((sample.weight, sample.ray.time), (1.0, 0.25));
    let ray = sample.ray;
    let (o, d) = (Vec3::from(o), Vec3::from(d));
    assert!((ray.origin - o).abs().max_element() < 2e-6, "{ray:?} {o}");
    assert!(
        (ray.direction - d).abs().max_element() < 1e-6,
        "{ray:?} {d}"
    );
    assert!((ray.t_max / t - 1.0).abs() < 2e-6, "{ray:?} {t}");
}

#[test]
fn field_of_view_axes_match_mitsuba() {
    let x: ([f32; 3], [f32; 3], f32) = (
        [1.002_550_1, 1.996_931, 2.990_311_6],
        [0.243_383_8, -0.292_913_82, -0.924_643_64],
        10_477.819,
    );
    let y = (
        [1.001_709_8, 1.996_471_3, 2.989_899_4],
        [0.157_811_12, -0.325_678_44, -0.932_217_4],
        10_834.906,
    );
    let diagonal = (
        [1.003_054_3, 1.997_206_7, 2.990_559],
        [0.296_292_6, -0.270_978_33, -0.915_85],
        10_308.354,
    );
    for (axis, (o, d, t)) in [
        ("x", x),
        ("y", y),
        ("diagonal", diagonal),
        ("smaller", y),
        ("larger", x),
    ] {
        let properties = [
            number("fov", 50.0),
            word("fov_axis", axis),
            placed(look_at()),
        ];
        let camera = camera("perspective", &properties, FILM);
        assert_ray(&camera, FILM, Vec2::ZERO, o, d, t);
    }
    let focal = [word("focal_length", "35mm"), placed(look_at())];
    assert_ray(
        &camera("perspective", &focal, FILM),
        FILM,
        Vec2::ZERO,
        [1.002_397_9, 1.996_847_6, 2.990_237],
        [0.227_592_19, -0.299_207_8, -0.926_647_96],
        10_535.774,
    );
    assert_ray(
        &camera("perspective", &[], FILM),
        FILM,
        Vec2::ZERO,
        [0.002_076_797_4, -0.001_038_398_1, 0.01],
        [0.202_298_03, -0.101_148_96, 0.974_086_46],
        10_266.019,
    );
}

#[test]
fn offset_and_crop_match_mitsuba() {
    let offset = [
        number("fov", 50.0),
        number("principal_point_offset_x", 0.1),
        number("principal_point_offset_y", -0.2),
    ];
    assert_ray(
        &camera("perspective", &offset, FILM),
        FILM,
        Vec2::ZERO,
        [0.001_865_230_7, 0.0, 0.01],
        [0.183_360_71, 0.0, 0.983_045_7],
        10_172.457,
    );
    assert_ray(
        &camera("perspective", &offset, CROPPED),
        CROPPED,
        Vec2::ZERO,
        [0.002_331_538_4, 0.002_191_645_8, 0.01],
        [0.222_061_98, 0.208_738_22, 0.952_426_8],
        10_499.483,
    );
    assert_ray(
        &camera("perspective", &offset[..1], CROPPED),
        CROPPED,
        Vec2::ZERO,
        [0.003_264_153_6, 0.000_792_722_74, 0.01],
        [0.309_425_4, 0.075_146_146, 0.947_949_9],
        10_549.069,
    );
}

#[test]
fn thin_lens_matches_mitsuba() {
    let lens = Vec2::new(0.3, 0.9);
    let parameters = lens_parameters();
    assert_ray(
        &camera("thinlens", &parameters, FILM),
        FILM,
        lens,
        [1.215_741_4, 2.043_231_2, 2.529_190_3],
        [0.222_156_05, -0.330_883_98, -0.917_149_1],
        20.663,
    );
    assert_ray(
        &camera("thinlens", &parameters[..4], FILM),
        FILM,
        lens,
        [0.050_344_37, 0.146_241_68, 0.5],
        [0.270_692_1, -0.143_713_43, 0.951_878_3],
        20.485_813,
    );
    assert_ray(
        &camera("thinlens", &parameters[..5], CROPPED),
        CROPPED,
        lens,
        [0.080_548_055, 0.239_194_1, 0.5],
        [0.325_776_46, 0.033_000_614, 0.944_870_7],
        20.637_745,
    );
}

#[test]
fn orthographic_matches_mitsuba() {
    let clip = [number("near_clip", 0.5), number("far_clip", 20.0)];
    let forward = [0.0, 0.0, 1.0];
    assert_ray(
        &camera("orthographic", &clip, FILM),
        FILM,
        Vec2::ZERO,
        [0.6, -0.3, 0.5],
        forward,
        19.5,
    );
    assert_ray(
        &camera("orthographic", &clip, CROPPED),
        CROPPED,
        Vec2::ZERO,
        [0.7, 0.17, 0.5],
        forward,
        19.5,
    );
    assert_ray(
        &camera("orthographic", &[], TALL),
        TALL,
        Vec2::ZERO,
        [0.6, -0.533_333_3, 0.01],
        forward,
        9_999.99,
    );
    let [near, far] = clip;
    let scaled = look_at() * DMat4::from_scale(DVec3::new(3.0, 2.0, 4.0));
    assert_ray(
        &camera("orthographic", &[near, far, placed(scaled)], FILM),
        FILM,
        Vec2::ZERO,
        [0.418_518_42, 1.070_572_1, 0.470_564_72],
        [0.507_092_6, -0.169_030_86, -0.845_154_35],
        19.5,
    );
}
