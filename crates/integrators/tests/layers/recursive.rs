//! `whitted` against exact radiances: every way at every wavelength, and every light.

use crate::exact::Exact;
use crate::world::{Fault, Plane, Stack, ZERO};
use etalon_integrators::whitted::{CausticSettings, Falloff, Grid, Placement, PointSet, Whitted};
use etalon_sampling::{Independent, SampleId};
use etalon_spectrum::{QuadratureNode, sensor_response};
use etalon_transport::{Integrator, Pass, PixelSample, Sensor, Sink, World};
use glam::{UVec2, Vec2, Vec4};

const WAVELENGTHS: u32 = 24;

fn whitted(max_depth: u32, light_samples: u32) -> Whitted {
    Whitted {
        max_depth,
        hide_emitters: false,
        falloff: Falloff::InverseSquare,
        ambient: 1.0,
        light_points: PointSet {
            side: light_samples,
            placement: Placement::Grid,
        },
        lens_points: PointSet {
            side: 1,
            placement: Placement::Grid,
        },
        caustics: CausticSettings {
            photons: 0,
            radius: None,
            nearest: 0,
        },
        wavelengths: WAVELENGTHS,
        grid: Grid {
            side: 1,
            levels: 0,
            contrast: 0.0,
        },
    }
}

const PASS: Pass = Pass {
    seed: 1,
    replicate: 0,
    number: 0,
    count: 1,
    samples: 1,
    replicates: 1,
    image_samples: 1,
    origin: UVec2::ZERO,
    size: UVec2::ONE,
    margin: 0,
};

struct Seen {
    rgb: [f32; 3],
    alpha: f32,
}

impl Sink for Seen {
    fn radiance(&mut self, rgb: [f32; 3], alpha: f32) {
        *self = Self { rgb, alpha };
    }
    fn splat(&mut self, _: Vec2, _: [f32; 3]) {
        unreachable!("it splats nothing");
    }
    fn channel(&mut self, _: usize, _: f32) {}
}

fn seen(integrator: &Whitted, world: &Stack) -> [f32; 3] {
    look(integrator, world).rgb
}

fn look(integrator: &Whitted, world: &Stack) -> Seen {
    let mut sampler = Independent::start(&SampleId {
        seed: 1,
        replicate: 0,
        pixel: (0, 0),
        sample: 0,
        samples_per_replicate: 1,
        blocks: 1,
    });
    let site = PixelSample {
        pixel: UVec2::ZERO,
        raster: Vec2::splat(0.5),
        margin: 0.0,
        pixels: 1,
        spacing: 1.0,
        sample: 0,
    };
    let mut sink = Seen {
        rgb: [f32::NAN; 3],
        alpha: f32::NAN,
    };
    let picture = integrator.prepare(world, &(), &PASS, None);
    integrator.sample(world, &picture, &site, &mut sampler, &mut sink);
    sink
}

/// The same by the exact radiances at the same wavelengths.
fn exact(stack: &Stack, max_depth: u32) -> [f32; 3] {
    let exact = Exact {
        stack,
        max_depth,
        hidden: false,
    };
    let nodes = QuadratureNode::all(
        WAVELENGTHS / 4,
        |u| stack.sensor().wavelengths(u),
        sensor_response,
    );
    let colour = nodes.map(|node| {
        let lambda = node.wavelengths.lambda.to_array();
        let radiance = lambda.map(|l| exact.radiance(l) as f32);
        (node.response).rgb(Vec4::from_array(radiance) / WAVELENGTHS as f32)
    });
    colour.sum::<glam::Vec3>().to_array()
}

fn error(found: [f32; 3], expected: [f32; 3]) -> f32 {
    let scale = expected.iter().fold(1e-6_f32, |most, x| most.max(x.abs()));
    (0..3)
        .map(|i| (found[i] - expected[i]).abs() / scale)
        .fold(0.0, f32::max)
}

/// Coloured lamps seen through coloured filters, and in mirrors that send each wavelength its own
/// way.
fn mirrors() -> Stack {
    let planes = vec![
        Plane {
            smooth: 1.0,
            reflectance: |nm| 0.4 + (nm - 360.0) * 1e-3,
            emission: [ZERO, |nm| 700.0 / nm],
            ..Plane::WHITE
        },
        Plane {
            height: 1.0,
            smooth: 1.0,
            passing: |nm| if nm < 560.0 { 0.8 } else { 0.3 },
            reflectance: |_| 0.9,
            ..Plane::WHITE
        },
        Plane {
            height: 2.0,
            emission: [|nm| nm / 500.0, ZERO],
            ..Plane::BLACK
        },
    ];
    Stack::new(planes, ZERO, 0.5, false)
}

#[test]
fn every_discrete_way_is_followed_at_every_wavelength() {
    let stack = mirrors();
    for depth in [0, 1, 2, 3, 4, 6, 9] {
        let error = error(seen(&whitted(depth, 1), &stack), exact(&stack, depth));
        assert!(error < 2e-5, "max_depth {depth}: {error}");
    }
    // Mutant: a direction that claims to be every wavelength's loses the light of three of four.
    let faulty = mirrors().with(Fault::AtomForAll);
    let error = error(seen(&whitted(4, 1), &faulty), exact(&faulty, 4));
    assert!(error > 0.05, "{error}");
}

/// Two lamps over a matt plane, each of which fills the half-space that it lights.
fn lamps() -> Stack {
    let planes = vec![
        Plane {
            exponent: |nm| 1.0 + (nm - 360.0) * 2e-3,
            reflectance: |nm| 0.3 + (nm - 360.0) * 1e-3,
            ..Plane::WHITE
        },
        Plane {
            height: 1.0,
            emission: [|nm| nm / 500.0, ZERO],
            ..Plane::BLACK
        },
    ];
    Stack::new(planes, ZERO, 0.5, false)
}

#[test]
fn lights_with_an_extent_are_integrated_over_points() {
    let stack = lamps();
    let expected = exact(&stack, 2);
    // The midpoint rule in two dimensions, of which one matters: errors fall with the square.
    let errors = [8, 32].map(|n| error(seen(&whitted(2, n), &stack), expected));
    assert!(errors[1] < 2e-4, "{errors:?}");
    assert!((8.0..32.0).contains(&(errors[0] / errors[1])), "{errors:?}");
    // Mutant: the light's density is wrong by a factor. (There is one light, so that forgetting the
    // choice among lights would not show; the density of a hemisphere, halved, does.)
    let half = error(expected, expected.map(|x| 2.0 * x));
    assert!(half > 0.4);
}

/// Mutant rejected: a light that is looked through counts as a segment, or only the first one is looked through.
#[test]
fn hidden_lights_are_not_there_in_alpha() {
    let lamp = |height| Plane {
        height,
        emission: [|_| 1.0; 2],
        ..Plane::BLACK
    };
    let alpha = |planes, max_depth| {
        let integrator = Whitted {
            hide_emitters: true,
            ..whitted(max_depth, 1)
        };
        look(&integrator, &Stack::new(planes, ZERO, 0.5, false)).alpha
    };
    assert_eq!(alpha(vec![lamp(1.0), lamp(2.0)], 4), 0.0);
    assert_eq!(alpha(vec![Plane::WHITE, lamp(1.0), lamp(2.0)], 1), 1.0);
}
