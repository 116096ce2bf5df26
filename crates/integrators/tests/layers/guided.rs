//! `guided` against exact radiances, with a field that it learned in the very world.

use crate::agreement::everything;
use crate::exact::Exact;
use crate::measure::{LIMIT, measure};
use crate::world::{Fault, Plane, Stack};
use etalon_integrators::guided::{Guided, Learned};
use etalon_integrators::settings::PathSettings;
use etalon_sampling::Sampler;
use etalon_transport::{Integrator, Pass, PixelSite, Sink, World};
use glam::UVec2;

const N: u32 = 60_000;

/// `guided` after its lessons.
struct Prepared {
    integrator: Guided,
    learned: Learned,
}

impl Integrator for Prepared {
    type State = ();

    fn prepare<W: World>(&self, _: &W, _: &Pass, _: Option<()>) {}

    fn sample<W: World, S: Sampler, K: Sink>(
        &self,
        world: &W,
        (): &(),
        site: &PixelSite,
        sampler: &mut S,
        sink: &mut K,
    ) {
        (self.integrator).sample(world, &self.learned, site, sampler, sink);
    }
}

fn pass(replicate: u32) -> Pass {
    Pass {
        seed: 17,
        replicate,
        number: 0,
        count: 1,
        samples: 8,
        image_samples: 64,
        origin: UVec2::new(3, 5),
        size: UVec2::new(16, 24),
        margin: 0,
    }
}

fn guided(max_depth: u32, rr_depth: u32) -> Guided {
    Guided {
        settings: PathSettings {
            max_depth,
            rr_depth,
            hide_emitters: false,
        },
        spatial_threshold: 500.0,
        ..Guided::default()
    }
}

fn prepared(stack: &Stack, max_depth: u32, rr_depth: u32) -> Prepared {
    let integrator = guided(max_depth, rr_depth);
    Prepared {
        learned: integrator.prepare(stack, &pass(0), None),
        integrator,
    }
}

/// Mirrors that turn with wavelength and glossy lobes, below a filter and a sky that brightens upward.
fn rainbow() -> Stack {
    let planes = vec![
        Plane {
            smooth: 0.4,
            exponent: |nm| 1.0 + (nm - 360.0) * 0.03,
            ..Plane::WHITE
        },
        Plane {
            height: 1.0,
            passing: |nm| if nm < 500.0 { 0.7 } else { 0.4 },
            smooth: 0.3,
            reflectance: |_| 0.9,
            ..Plane::WHITE
        },
    ];
    Stack::new(planes, |_| 1.0, 0.5, false)
}

#[test]
fn guided_is_exact_whatever_it_learned() {
    for (name, stack) in [("everything", everything()), ("rainbow", rainbow())] {
        for (max_depth, rr_depth) in [(1, 9), (2, 9), (3, 9), (5, 1), (80, 2), (80, 5)] {
            let exact = Exact {
                stack: &stack,
                max_depth,
                hidden: false,
            };
            let guided = prepared(&stack, max_depth, rr_depth);
            let z = measure(&guided, &stack, N).z(exact.colour());
            assert!(z < LIMIT, "{name}, {max_depth}, rr {rr_depth}: z = {z:.2}");
        }
    }
}

#[test]
fn wrong_densities_are_noticed() {
    let cases = [
        (everything as fn() -> Stack, Fault::OtherLanes),
        (everything, Fault::FreePassage),
        (everything, Fault::LightChoice),
        (rainbow, Fault::AtomForAll),
        (rainbow, Fault::FreePassage),
    ];
    for (stack, fault) in cases {
        let stack = stack().with(fault);
        let exact = Exact {
            stack: &stack,
            max_depth: 7,
            hidden: false,
        };
        let z = measure(&prepared(&stack, 7, 99), &stack, N).z(exact.colour());
        assert!(z > LIMIT, "{fault:?} unnoticed: z = {z:.2}");
    }
}

/// The field is the same for every replicate and any number of threads, and is handed on.
#[test]
fn the_field_belongs_to_the_image() {
    let stack = rainbow();
    let integrator = guided(8, 5);
    let learn = |threads: usize, replicate: u32| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let learn = || integrator.prepare(&stack, &pass(replicate), None);
        format!("{:?}", pool.expect("threads").install(learn))
    };
    let first = learn(1, 0);
    assert!(first.len() > 10_000, "it learned something");
    assert_eq!(first, learn(2, 0));
    assert_eq!(first, learn(16, 3));
    let before = integrator.prepare(&stack, &pass(1), None);
    let kept = integrator.prepare(&stack, &pass(2), Some(before));
    assert_eq!(first, format!("{kept:?}"));
    let other = Pass {
        image_samples: 256,
        ..pass(0)
    };
    let other = integrator.prepare(&stack, &other, None);
    assert_ne!(first, format!("{other:?}"));
}
