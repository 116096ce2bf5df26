//! Light sampling in vector lanes: lane i has the bits of a light sample alone.

use crate::reading::{LANES, scene};
use etalon_math::lane::{F32x8, F32x16, Lane, Mask, Spectral, Vector};
use etalon_sampling::{Independent, Sampler};
use etalon_scene::Scene;
use etalon_transport::{LaneReceiver, LaneShading, Lights, World};
use glam::{Vec2, Vec3};

const LAMP: &str = "<shape type=\"rectangle\"><transform name=\"to_world\"><scale x=\"0.7\" y=\"0.4\"/><rotate x=\"1\" y=\"2\" \
                    z=\"0\" angle=\"40\"/></transform><emitter type=\"area\"/></shape>";
const MOVED: &str = "<shape type=\"shapegroup\" id=\"g\"><shape type=\"rectangle\"><emitter type=\"area\"/></shape></shape>\
                     <shape type=\"instance\"><ref id=\"g\"/><transform name=\"to_world\"><translate x=\"1\"/></transform></shape>";

/// Numbers from −1 to 1.
fn random_numbers(random: &mut impl Sampler) -> [f32; 16] {
    [(); 16].map(|()| 2.0 * random.next_1d() - 1.0)
}

/// Compares as many light samples as there are lanes with the same ones alone.
fn compare<F: Lane>(world: &Scene, reach: f32, random: &mut impl Sampler) {
    let lanes = world.lanes().expect("a scene without media");
    let [x, y, z, nx, ny, nz] = [(); 6].map(|()| random_numbers(random));
    let [choice, u, v, coin] = [(); 4].map(|()| [(); 16].map(|()| random.next_1d()));
    let normal = |i: usize| match coin[i] < 0.2 {
        true => Vec3::ZERO,
        false => Vec3::new(nx[i], ny[i], nz[i]).normalize_or(Vec3::Z),
    };
    let from = LaneReceiver {
        position: F::Vector::of_lanes(|i| reach * Vec3::new(x[i], y[i], z[i])),
        normal: F::Vector::of_lanes(normal),
        one_sided: F::Mask::from_fn(|i| coin[i] > 0.5),
        time: F::ZERO,
    };
    let waves = [LANES; 16];
    let [u_light, u, v] = [choice, u, v].map(|numbers| F::load(&numbers));
    let together = lanes.sample_light(
        &from,
        &waves[..F::WIDTH],
        F::Mask::splat(true),
        u_light,
        [u, v],
    );
    let [x, y, z] = [(); 3].map(|()| random_numbers(random));
    let along = |i: usize| Vec3::new(x[i], y[i], z[i]).normalize_or(Vec3::Y);
    let direction = F::Vector::of_lanes(along);
    let (seen, density) = LaneShading::background(lanes, &from, direction, &waves[..F::WIDTH]);
    for i in 0..F::WIDTH {
        let receiver = from.at_lane(i);
        let radiance = Lights::background(world.lights(), along(i), 0.0, &LANES);
        assert_eq!(seen.at_lane(i), radiance);
        let alone = world.background_density(&receiver, along(i)).lanes().x;
        assert_eq!(density.lane(i), alone);
        let u = Vec2::new(u.lane(i), v.lane(i));
        let alone = world.sample_light(&from.at_lane(i), &LANES, u_light.lane(i), u);
        assert_eq!(together.found.lane(i), alone.is_some());
        let Some(alone) = alone else { continue };
        let target = together
            .has_target
            .lane(i)
            .then(|| together.target.at_lane(i));
        assert_eq!(target, alone.target);
        assert_eq!(together.direction.at_lane(i), alone.direction);
        assert_eq!(together.radiance.at_lane(i), alone.radiance);
        assert_eq!(together.chance.lane(i), alone.chance.lanes().x);
        assert_eq!(together.is_delta.lane(i), alone.chance.is_delta());
    }
}

/// Alone and together. Mutants rejected: a near receiver that samples by area, radiance on the back of a lamp, a placed lamp where
/// its shape was, the light of another lane's choice, a density without the probability of the light, one sky of two that is not
/// the sum, a background without the probability of the light.
#[test]
fn lanes_sample_lights_as_one_by_one() {
    let mut random = Independent::from_key(1);
    let ball = "<shape type=\"sphere\"><float name=\"radius\" value=\"0.6\"/><emitter type=\"area\"/></shape>";
    let disk = "<shape type=\"disk\"><emitter type=\"area\"/></shape>";
    let varied = "<shape type=\"sphere\"><point name=\"center\" x=\"2\" y=\"0\" z=\"1\"/><emitter type=\"area\">\
                  <texture type=\"checkerboard\" name=\"radiance\"/></emitter></shape>";
    let sky = "<emitter type=\"constant\"/>";
    let map = format!(
        "<emitter type=\"envmap\"><string name=\"filename\" value=\"{}/../../scenes/spheres/sky.exr\"/>\
         <transform name=\"to_world\"><rotate y=\"0.6\" x=\"0.8\" angle=\"70\"/></transform></emitter>",
        env!("CARGO_MANIFEST_DIR")
    );
    let sun = "<emitter type=\"directional\"><vector name=\"direction\" x=\"1\" y=\"2\" z=\"-1\"/></emitter>";
    let point =
        "<emitter type=\"point\"><point name=\"position\" x=\"0\" y=\"1\" z=\"2\"/></emitter>";
    let of = |lights: &[&str]| lights.concat();
    let scenes = [
        of(&[LAMP]),
        of(&[MOVED]),
        of(&[ball]),
        of(&[disk]),
        of(&[varied]),
        of(&[sky]),
        of(&[&map]),
        of(&[sun]),
        of(&[LAMP, LAMP, ball]),
        of(&[LAMP, MOVED, disk, ball, varied, sky, sun, point]),
        of(&[LAMP, sky, sky]),
        of(&[LAMP, &map, ball]),
        of(&[&LAMP.repeat(12), ball, sky]),
    ];
    for lights in &scenes {
        let world = scene(lights);
        for reach in [0.5, 4.0, 1e3] {
            for _ in 0..32 {
                compare::<f32>(&world, reach, &mut random);
                compare::<F32x8>(&world, reach, &mut random);
                compare::<F32x16>(&world, reach, &mut random);
            }
        }
    }
}

/// Where light sampling chooses among media too, or a path comes out elsewhere than it went in.
#[test]
fn scenes_with_shining_media_or_profiles_have_no_lanes() {
    let ball = |inside: &str| format!("<shape type=\"sphere\">{inside}</shape>{LAMP}");
    let fog = "<medium type=\"homogeneous\" name=\"interior\"/>";
    let fire = "<medium type=\"homogeneous\" name=\"interior\"><float name=\"emission\" value=\"1\"/></medium>";
    let profile = "<subsurface type=\"dipole\"/>";
    for (inside, expected) in [("", true), (fog, true), (fire, false), (profile, false)] {
        assert_eq!(scene(&ball(inside)).lanes().is_some(), expected, "{inside}");
    }
}
