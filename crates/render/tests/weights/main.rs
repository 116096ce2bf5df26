//! The weights of `bdpt` and `vcm` sum to one, over all techniques and all four wavelengths.
//!
//! In three scenes random complete paths are drawn. For each, a script makes every technique, with
//! every lane standing first, find this very path and no other ([`script`]); what it contributes is
//! held against densities written down anew, in double precision and with each lane's own density as
//! the one that chooses ([`densities`]).

mod course;
mod densities;
mod rooms;
mod script;
mod scripted_bsdf;

use course::Course;
use densities::{Densities, LANES};
use etalon_integrators::bdpt::{Bidirectional, Technique};
use etalon_integrators::photons::radius::Radius;
use etalon_integrators::settings::PathSettings;
use etalon_integrators::vcm::ConnectionMerging;
use etalon_sampling::Independent;
use etalon_spectrum::sensor_response;
use etalon_transport::{Integrator, Pass, PixelSample, Sink, World};
use glam::{UVec2, Vec2, Vec3, Vec4};
use script::Script;
use std::collections::BTreeMap;

/// How many pixels the film has, each with a light's walk that may be seen by the camera.
const PIXELS: u32 = 7;

/// Photons of a pass.
const PHOTONS: u32 = 64;

/// Relative error of single precision along a path: rays leave surfaces by an offset that turns
/// them by some 10⁻⁵, and a lobe of exponent 50 fifty times as much.
const TOLERANCE: f64 = 2e-3;

/// Adds up what an integrator finds.
#[derive(Default)]
struct Found(Vec3);

impl Sink for Found {
    fn radiance(&mut self, rgb: [f32; 3], _: f32) {
        self.0 += Vec3::from_array(rgb);
    }
    fn splat(&mut self, _: Vec2, rgb: [f32; 3]) {
        self.0 += Vec3::from_array(rgb);
    }
    fn channel(&mut self, _: usize, _: f32) {}
}

/// What one sample finds of the lane `j`.
fn found<I: Integrator, W: World>(
    integrator: &I,
    state: &I::State,
    script: &Script<'_, W>,
    lane: usize,
) -> f64 {
    let site = PixelSample {
        pixel: UVec2::ZERO,
        raster: script.course.raster,
        margin: 0.0,
        pixels: PIXELS,
        spacing: 1.0,
        sample: 0,
    };
    let mut sink = Found::default();
    let mut dice = Independent::from_key(1);
    integrator.sample(script, state, &site, &mut dice, &mut sink);
    let unit = sensor_response(&script.course.wavelengths).rgb(Vec4::AXES[lane]);
    let channel = unit.abs().max_position();
    f64::from(sink.0[channel]) / f64::from(unit[channel])
}

fn settings(course: &Course) -> PathSettings {
    PathSettings {
        max_depth: course.segments(),
        rr_depth: u32::MAX,
        hide_emitters: false,
    }
}

/// Σ over techniques and lanes of n·p·C/f, by lane of f: C is what `bdpt` finds.
fn bidirectional<W: World>(world: &W, course: &Course, seen: &mut Seen) {
    let densities = Densities::of(world, course, 0.0);
    let mut sums = [0.0; LANES];
    for light in 0..=course.surfaces.len() + 1 {
        let technique = Technique {
            light,
            camera: course.surfaces.len() + 2 - light,
            weighted: true,
        };
        let integrator = Bidirectional {
            settings: settings(course),
            only: Some(technique),
        };
        for first in 0..LANES {
            let made = densities.made(light, first);
            if made == 0.0 {
                continue;
            }
            seen.note(course, light, densities.alone());
            for (lane, sum) in sums.iter_mut().enumerate() {
                let value = densities.value[lane];
                if value == 0.0 {
                    continue;
                }
                let script = Script::new(world, course, first, lane);
                let found = found(&integrator, &(), &script, lane);
                *sum += made * found / value;
                let expected = value / densities.total;
                assert!(
                    (found / expected - 1.0).abs() < TOLERANCE,
                    "{technique:?}, lane {lane} where {first} chose: {found:e} for {expected:e} \
                     along {course:#?}"
                );
            }
        }
    }
    for (lane, sum) in sums.into_iter().enumerate() {
        assert!(
            densities.value[lane] <= 0.0 || (sum - 1.0).abs() < TOLERANCE,
            "weights sum to {sum} in lane {lane} along {course:#?}"
        );
    }
}

/// The same of `vcm`, whose sample finds the path by all techniques at once, and by one merging
/// for each photon at each surface that scatters continuously: each contributes the same.
fn merging<W: World>(world: &W, course: &Course, seed: u64) {
    let radius = 0.4 * course.least_distance();
    let area = f64::from(PHOTONS) * core::f64::consts::PI * f64::from(radius).powi(2);
    let densities = Densities::of(world, course, area);
    let integrator = ConnectionMerging {
        settings: settings(course),
        radius: Radius {
            first: Some(radius),
            alpha: 0.5,
        },
        photons: Some(PHOTONS),
        connections: true,
    };
    let pass = Pass {
        seed,
        replicate: 0,
        number: 0,
        count: 1,
        samples: 1,
        replicates: 1,
        image_samples: 1,
        origin: UVec2::ZERO,
        size: UVec2::new(PIXELS, 1),
        margin: 0,
    };
    let ends = 0..=course.surfaces.len() + 1;
    let scattering = course.sharp.iter().filter(|sharp| !**sharp).count();
    for turn in 0..LANES {
        for lane in 0..LANES {
            let script = Script::new(world, course, turn, lane);
            let state = integrator.prepare(&script, &(), &pass, None);
            let first = script.first();
            let made = |s: &usize| densities.made(*s, first) > 0.0;
            if densities.chance[first] == 0.0 || densities.value[lane] == 0.0 {
                continue;
            }
            let ways = ends.clone().filter(made).count() + PHOTONS as usize * scattering;
            let expected = densities.value[lane] / densities.total * ways as f64;
            let found = found(&integrator, &state, &script, lane);
            assert!(
                (found - expected).abs() <= TOLERANCE * expected,
                "lane {lane} where {first} chose: {found:e} for {expected:e}, {ways} ways, along \
                 {course:#?}"
            );
        }
    }
}

/// The ways in which a path is made.
const WAYS: [&str; 4] = [
    "running into a light",
    "light sampling",
    "a connection",
    "the camera",
];

/// How often what was tested, so that nothing is missing without a word.
#[derive(Default)]
struct Seen(BTreeMap<String, u32>);

impl Seen {
    fn note(&mut self, course: &Course, light: usize, alone: bool) {
        let way = match light {
            0 | 1 => WAYS[light],
            s if s == course.surfaces.len() + 1 => WAYS[3],
            _ => WAYS[2],
        };
        let mut count = |what: String| *self.0.entry(what).or_default() += 1;
        count(format!("{:?} by {way}", course.start.origin));
        if course.sharp.contains(&true) {
            count(format!("{way}, past smooth surfaces"));
        }
        if alone {
            count(format!("{way}, past smooth dispersion"));
        }
    }

    #[track_caller]
    fn at_least(&self, count: u32, what: &str) {
        let found = self.0.get(what).copied();
        assert!(found >= Some(count), "{what}: {found:?} of {:#?}", self.0);
    }
}

/// Mutants it is known to reject: light sampling left out of the sum of a connection's weight (`weight.rs`), the
/// η² of a refraction left out (`path_vertex.rs`), merging left out of it (mutant
/// `merging-is-not-weighed`), one lane's density for all (`product * corner.prefix.ratio.x`).
#[test]
fn weights_over_techniques_and_lanes_sum_to_one() {
    let mut seen = Seen::default();
    for (seed, loaded) in (1..).zip(rooms::all()) {
        let world = &loaded.compiled.scene;
        let mut dice = Independent::from_key(seed);
        for _ in 0..8000 {
            if let Some(course) = course::draw(world, &mut dice) {
                bidirectional(world, &course, &mut seen);
                merging(world, &course, seed);
            }
        }
    }
    for way in WAYS {
        for origin in ["Surface", "Sky", "Point", "Parallel"] {
            if way != WAYS[0] || matches!(origin, "Surface" | "Sky") {
                seen.at_least(20, &format!("{origin} by {way}"));
            }
        }
        seen.at_least(5, &format!("{way}, past smooth surfaces"));
        seen.at_least(5, &format!("{way}, past smooth dispersion"));
    }
}
