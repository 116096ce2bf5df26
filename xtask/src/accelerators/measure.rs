//! One scene with every accelerator and Embree: all are built, then traced by turns.

use etalon_benches::embree::{Device, Embree, Prepared};
use etalon_benches::rays::{Kind, rays_of_every_kind};
use etalon_benches::scenes::Scene;
use etalon_benches::stopwatch::Stopwatch;
use etalon_geometry::{AcceleratorKind, Geometry};
use etalon_transport::Ray;
use serde::Serialize;
use std::borrow::Cow;
use std::time::Instant;

/// Who takes part, and how often.
pub(super) struct Plan<'a> {
    pub(super) kinds: Vec<AcceleratorKind>,
    pub(super) embree: Option<&'a Device>,
    pub(super) repeats: u32,
}

/// What was measured of one accelerator on one scene.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Row {
    pub(super) scene: &'static str,
    pub(super) accelerator: &'static str,
    /// Primitives stored.
    pub(super) primitives: usize,
    /// To build it, on all threads (s).
    pub(super) build: f64,
    /// Memory of it (bytes).
    pub(super) bytes: usize,
    /// In the order of [`Kind::ALL`].
    pub(super) rays: [Rays; 4],
}

/// What was measured of one kind of ray.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub(super) struct Rays {
    /// Millions per second on one thread, …
    pub(super) one: f64,
    /// … and on all.
    pub(super) all: f64,
    /// Nodes and primitives that a ray looks at, where they can be counted.
    pub(super) looked_at: Option<[f64; 2]>,
    /// The share of rays that hit.
    pub(super) hits: f64,
}

/// The name of Embree's rows.
pub(super) const EMBREE: &str = "Embree 4";

/// Time (s) for all rays of a kind above which an accelerator traces only some of them, from all over the picture.
const PATIENCE: f64 = 1.0;
/// Number of rays for estimating that time.
const PILOT: usize = 64;

/// An accelerator that takes part.
enum Entrant<'a> {
    Ours(AcceleratorKind, Box<Geometry>),
    Embree(Embree<'a>),
}

impl Plan<'_> {
    /// Measures a scene.
    pub(super) fn measure(&self, scene: &Scene) -> Vec<Row> {
        let guide = scene.build(AcceleratorKind::Wide);
        let rays = rays_of_every_kind(scene, &guide);
        drop(guide);
        let mut entrants: Vec<(Entrant<'_>, f64)> = Vec::new();
        for &kind in &self.kinds {
            let (geometry, seconds) = self.best_build(|| scene.shapes(), |b| b.build_with(kind));
            entrants.push((Entrant::Ours(kind, Box::new(geometry)), seconds));
        }
        if let Some(device) = self.embree {
            let (embree, seconds) =
                self.best_build(|| Prepared::new(device, scene), Prepared::build);
            entrants.push((Entrant::Embree(embree), seconds));
        }
        let shares: Vec<[Cow<'_, [Ray]>; 4]> = (entrants.iter())
            .map(|(entrant, _)| Kind::ALL.map(|kind| entrant.share(kind, &rays[kind as usize])))
            .collect();
        let mut watches = vec![[Stopwatch::new(); 4]; entrants.len()];
        for _ in 0..self.repeats {
            for kind in Kind::ALL {
                for (((entrant, _), shares), watches) in
                    entrants.iter().zip(&shares).zip(&mut watches)
                {
                    entrant.run(&mut watches[kind as usize], kind, &shares[kind as usize]);
                }
            }
        }
        let rows = entrants.iter().zip(&shares).zip(&watches);
        rows.map(|(((entrant, build), shares), watches)| {
            entrant.row(scene, *build, watches, shares)
        })
        .collect()
    }

    /// The best time of a few builds, and the last of them.
    fn best_build<P, B>(&self, prepare: impl Fn() -> P, build: impl Fn(P) -> B) -> (B, f64) {
        let mut best = f64::INFINITY;
        let mut last = None;
        for _ in 0..self.repeats.min(3) {
            drop(last.take());
            let prepared = prepare();
            let start = Instant::now();
            last = Some(build(prepared));
            best = best.min(start.elapsed().as_secs_f64());
        }
        (last.expect("built at least once"), best)
    }
}

impl Entrant<'_> {
    fn run(&self, watch: &mut Stopwatch, kind: Kind, rays: &[Ray]) {
        match self {
            Self::Ours(_, geometry) => watch.run(&**geometry, kind, rays),
            Self::Embree(embree) => watch.run(embree, kind, rays),
        }
    }

    /// The rays that it traces: all, if that does not take too long.
    fn share<'r>(&self, kind: Kind, rays: &'r [Ray]) -> Cow<'r, [Ray]> {
        let every = |stride: usize| -> Vec<Ray> { rays.iter().step_by(stride).copied().collect() };
        let mut pilot = Stopwatch::new();
        self.run(&mut pilot, kind, &every(rays.len().div_ceil(PILOT)));
        let seconds = rays.len() as f64 * 1e-6 / pilot.rate().one;
        match (seconds / PATIENCE).ceil() as usize {
            0 | 1 => Cow::Borrowed(rays),
            stride => Cow::Owned(every(stride)),
        }
    }

    fn row(
        &self,
        scene: &Scene,
        build: f64,
        watches: &[Stopwatch; 4],
        rays: &[Cow<'_, [Ray]>; 4],
    ) -> Row {
        let (accelerator, bytes) = match self {
            Self::Ours(kind, geometry) => (kind.name(), geometry.statistics().accelerator_bytes),
            Self::Embree(embree) => (EMBREE, embree.bytes),
        };
        let mut measured = [Rays::default(); 4];
        for kind in Kind::ALL {
            let (rays, watch) = (&rays[kind as usize], &watches[kind as usize]);
            let rate = watch.rate();
            measured[kind as usize] = Rays {
                one: rate.one,
                all: rate.all,
                looked_at: self.looked_at(kind, rays),
                hits: watch.hits as f64 / rays.len() as f64,
            };
        }
        Row {
            scene: scene.name,
            accelerator,
            primitives: scene.primitives(),
            build,
            bytes,
            rays: measured,
        }
    }

    /// Nodes and primitives per ray.
    fn looked_at(&self, kind: Kind, rays: &[Ray]) -> Option<[f64; 2]> {
        let Self::Ours(_, geometry) = self else {
            return None;
        };
        let mut sums = [0; 2];
        for ray in rays {
            let visits = match kind {
                Kind::Shadow => geometry.occluded_counted(ray).1,
                _ => geometry.intersect_counted(ray).1,
            };
            sums[0] += visits.nodes;
            sums[1] += visits.primitives;
        }
        Some(sums.map(|sum| sum as f64 / rays.len() as f64))
    }
}

impl Row {
    /// Memory per primitive stored (bytes).
    pub(super) fn bytes_each(&self) -> f64 {
        self.bytes as f64 / self.primitives as f64
    }
}
