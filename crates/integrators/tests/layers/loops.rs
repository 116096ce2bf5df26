//! The render loop: every sample once, the same bits in any order, replicates finished whole.

use crate::tally::Tally;
use crate::world::{Plane, Stack, ZERO};
use etalon_integrators::{Progress, RenderPlan, RenderStatistics, ReplicateRange, render};
use etalon_sampling::{ReplicateKind, Sampler, SamplerKind};
use etalon_transport::{
    Channel, Incompatibility, Integrator, Pass, PixelSample, Placing, Preparation,
    SceneCapabilities, Sink, Surfaces, World, one_by_one,
};
use glam::UVec2;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

/// Writes a random number where it is, and another one anywhere on the film.
struct Marbles {
    origin: UVec2,
    size: UVec2,
    first_replicate: u32,
    /// Of that replicate, where the film has samples already.
    first_pass: u32,
    samples_per_pass: Option<u32>,
}

/// The number of a pass, counted through all replicates.
struct Turn(u32);

impl Preparation for Turn {
    fn remarks(&self) -> Vec<String> {
        Vec::new()
    }
}

impl Integrator for Marbles {
    const UNBIASED: bool = false;
    const MEDIA: bool = false;
    const DIFFUSION: bool = false;
    const FOLLOWS_LIGHT: bool = false;

    type State = Turn;

    fn channels(&self) -> Vec<Channel> {
        Vec::new()
    }

    fn splats(&self) -> bool {
        true
    }

    fn incompatibilities(&self, _: &SceneCapabilities) -> Vec<Incompatibility> {
        Vec::new()
    }

    fn replicate_kind(&self) -> ReplicateKind {
        ReplicateKind::Independent
    }

    fn samples_per_pass(&self) -> Option<u32> {
        self.samples_per_pass
    }

    fn prepare<W: World>(
        &self,
        _: &W,
        _: &impl Placing,
        pass: &Pass,
        before: Option<Turn>,
    ) -> Turn {
        let expected = Pass {
            seed: 5,
            origin: self.origin,
            size: self.size,
            ..*pass
        };
        assert_eq!(*pass, expected);
        let length = self.samples_per_pass.unwrap_or(4).max(1);
        assert_eq!(pass.count, 4_u32.div_ceil(length));
        assert_eq!(pass.samples, length.min(4 - pass.number * length));
        assert_eq!(pass.image_samples % 4, 0);
        let turn = pass.replicate * pass.count + pass.number;
        let first = self.first_replicate * pass.count + self.first_pass;
        let expected = turn.checked_sub(1).filter(|_| turn > first);
        assert_eq!(before.map(|turn| turn.0), expected);
        Turn(turn)
    }
    fn sample<W: World, S: Sampler, K: Sink>(
        &self,
        world: &W,
        _: &Turn,
        site: &PixelSample,
        sampler: &mut S,
        sink: &mut K,
    ) {
        assert!(site.sample < self.samples_per_pass.unwrap_or(4).max(1));
        assert_eq!(site.margin, 1.5);
        assert_eq!(site.pixels, self.size.x * self.size.y);
        assert_eq!(site.raster.as_uvec2(), site.pixel);
        // Two dimensions went into the film position.
        assert_eq!(sampler.dimension(), 2);
        let value = sampler.next_1d() + site.raster.x.fract() + site.spacing;
        sink.radiance([value; 3], 1.0);
        sampler.skip_to(4);
        let anywhere = self.origin.as_vec2() + sampler.next_2d() * self.size.as_vec2();
        sink.splat(anywhere, [sampler.next_1d(); 3]);
        world.surfaces().intersect(&etalon_transport::Ray::new(
            glam::Vec3::Z,
            glam::Vec3::X,
            0.0,
        ));
    }

    one_by_one!();
}

/// Counts, and asks to stop once `patience` tiles are done. Lingers over some tiles, so that
/// others overtake them.
#[derive(Default)]
struct Watch {
    tiles: AtomicU32,
    samples: AtomicU64,
    patience: Option<u32>,
}

impl Progress for Watch {
    fn tile_done(&self, samples: u64) {
        let tiles = self.tiles.fetch_add(1, Ordering::Relaxed);
        self.samples.fetch_add(samples, Ordering::Relaxed);
        if tiles.is_multiple_of(3) {
            std::thread::sleep(std::time::Duration::from_micros(300));
        }
    }
    fn cancelled(&self) -> bool {
        self.patience
            .is_some_and(|p| self.tiles.load(Ordering::Relaxed) >= p)
    }
}

fn run(
    threads: usize,
    sampler: SamplerKind,
    window: (UVec2, UVec2),
    watch: &Watch,
) -> (Tally, RenderStatistics) {
    run_passes(threads, sampler, window, watch, (None, None))
}

/// Renders a share in passes of so many samples.
fn run_passes(
    threads: usize,
    sampler: SamplerKind,
    window: (UVec2, UVec2),
    watch: &Watch,
    passes: (Option<ReplicateRange>, Option<u32>),
) -> (Tally, RenderStatistics) {
    run_on(threads, sampler, window, watch, passes, None)
}

/// The same, on a film that was begun.
fn run_on(
    threads: usize,
    sampler: SamplerKind,
    window: (UVec2, UVec2),
    watch: &Watch,
    (share, samples_per_pass): (Option<ReplicateRange>, Option<u32>),
    begun: Option<Tally>,
) -> (Tally, RenderStatistics) {
    let (origin, size) = window;
    let world = Stack::new(vec![Plane::WHITE], ZERO, 1.0, true);
    let mut film = begun.unwrap_or_else(|| Tally::new(origin, size));
    let integrator = Marbles {
        origin,
        size,
        first_replicate: share.map_or(0, |share| share.first),
        first_pass: film.first_pass(samples_per_pass),
        samples_per_pass,
    };
    let plan = RenderPlan {
        seed: 5,
        replicates: 3,
        replicate_kind: ReplicateKind::Independent,
        share,
        samples_per_replicate: 4,
        sampler,
    };
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .expect("threads");
    let outcome = pool.install(|| {
        render(
            std::slice::from_ref(&world),
            &integrator,
            &mut film,
            &plan,
            watch,
        )
    });
    (film, outcome)
}

const WHOLE: (UVec2, UVec2) = (UVec2::ZERO, UVec2::new(53, 37));
const CROP: (UVec2, UVec2) = (UVec2::new(7, 11), UVec2::new(20, 18));

const KINDS: [SamplerKind; 4] = [
    SamplerKind::Independent,
    SamplerKind::Sobol,
    SamplerKind::Stratified { jitter: true },
    SamplerKind::Stratified { jitter: false },
];

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    for sampler in KINDS {
        let (one, outcome) = run(1, sampler, WHOLE, &Watch::default());
        assert_eq!(outcome.replicates, 3);
        assert_eq!(outcome.samples, 53 * 37 * 3 * 4);
        for threads in [2, 16] {
            let (many, other) = run(threads, sampler, WHOLE, &Watch::default());
            assert_eq!(one.replicates, many.replicates);
            assert_eq!(outcome, other);
            // That they ran in some order is no proof unless all pixels were visited alike, and several
            // threads could share them.
            let visits = many.visits();
            assert!(visits.iter().all(|&count| count == visits[0] && count >= 3));
            let tiles = |film: &Tally| film.tiles.lock().expect("no panic").len();
            assert!(tiles(&many) > tiles(&one));
        }
        // Replicates are different numbers.
        assert_ne!(one.replicates[0], one.replicates[1]);
        assert_ne!(one.replicates[1], one.replicates[2]);
    }
}

/// A sample is a function of its pixel of the whole film.
#[test]
fn a_cropped_film_takes_the_same_samples() {
    for sampler in KINDS {
        let (whole, _) = run(2, sampler, WHOLE, &Watch::default());
        let (crop, _) = run(2, sampler, CROP, &Watch::default());
        for (a, b) in whole.replicates.iter().zip(&crop.replicates) {
            for y in 0..CROP.1.y {
                for x in 0..CROP.1.x {
                    let pixel = CROP.0 + UVec2::new(x, y);
                    assert_eq!(a[whole.index(pixel)][0], b[crop.index(pixel)][0]);
                }
            }
        }
    }
}

/// Whoever says stop is heard within the replicate, and a render that goes on from there draws what is
/// left, of pixels that have different numbers of samples, too. Mutants: the replicate is drawn anew; it is finished
/// first.
#[test]
fn a_cancelled_render_goes_on_where_it_stood() {
    for samples_per_pass in [None, Some(1), Some(3)] {
        let run = |watch: &Watch, begun: Option<Tally>| {
            run_on(
                2,
                SamplerKind::Sobol,
                WHOLE,
                watch,
                (None, samples_per_pass),
                begun,
            )
        };
        let patient = Watch::default();
        let (all, _) = run(&patient, None);
        assert_eq!(patient.samples.into_inner(), 53 * 37 * 3 * 4);
        for patience in [0, 1, 2, 9, 30, 50] {
            let watch = Watch {
                patience: Some(patience),
                ..Watch::default()
            };
            let (begun, outcome) = run(&watch, None);
            assert_eq!(outcome.replicates, 0, "after {patience} tiles");
            assert!(outcome.samples < 53 * 37 * 4);
            assert_eq!(outcome.samples, begun.samples());
            let drawn = begun.samples();
            let watch = Watch::default();
            let (film, outcome) = run(&watch, Some(begun));
            assert_eq!(outcome.replicates, 3);
            assert_eq!(outcome.samples, 53 * 37 * 3 * 4 - drawn);
            assert_eq!(film.replicates, all.replicates, "{patience}");
        }
    }
}

/// A share renders its replicates under their own numbers, as samples of the whole image.
#[test]
fn shares_of_the_replicates_are_those_of_the_whole() {
    for sampler in KINDS {
        let (all, _) = run(2, sampler, CROP, &Watch::default());
        for count in 1..=3 {
            let mut dealt = Vec::new();
            for index in 0..count {
                let share = ReplicateRange::of(3, index, count);
                let (film, outcome) =
                    run_passes(2, sampler, CROP, &Watch::default(), (share, None));
                assert_eq!(Some(outcome.replicates), share.map(|share| share.count));
                dealt.extend(film.replicates);
            }
            assert_eq!(dealt, all.replicates, "{count} shares");
        }
    }
}

/// However a replicate is cut into passes, its samples are the same.
#[test]
fn passes_draw_the_samples_of_a_replicate() {
    for sampler in KINDS {
        let (all, outcome) = run(2, sampler, CROP, &Watch::default());
        for length in 0..=5 {
            let watch = Watch::default();
            let asked = (None, Some(length));
            let (film, other) = run_passes(2, sampler, CROP, &watch, asked);
            assert_eq!(film.replicates, all.replicates, "{length} samples per pass");
            assert_eq!(outcome, other);
            assert_eq!(watch.samples.into_inner(), outcome.samples);
        }
    }
}
