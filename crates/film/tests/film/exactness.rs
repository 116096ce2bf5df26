//! The film's bits depend on nothing but what is added: not on tiles, threads or order.

use etalon_film::{
    ExactFilm, FilmSettings, Filter, FilterMethod, Lanczos, PixelFormat, RenderFacts,
};
use etalon_sampling::{SampleId, Sampler, Sobol};
use etalon_transport::{Channel, Film, Placing, Sink, TileSink};
use glam::UVec2;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use rayon::prelude::*;

const WIDTH: u32 = 37;
const HEIGHT: u32 = 41;
const SAMPLES: u32 = 4;

fn film(filter_method: FilterMethod) -> ExactFilm {
    let filter = Filter::Lanczos(Lanczos::new(2).expect("valid"));
    let settings = FilmSettings {
        filter_method,
        pixel_format: PixelFormat::Xyza,
        crop_offset: UVec2::new(3, 5),
        crop_size: UVec2::new(WIDTH, HEIGHT),
        ..FilmSettings::new(60, 50, filter)
    };
    let channels = ["depth.T", "m2_depth.T"].map(|name| Channel(name.to_owned()));
    ExactFilm::new(settings, &channels).expect("names differ")
}

/// A synthetic estimator that uses everything a sink offers.
fn sample(film: &ExactFilm, tile: &mut impl TileSink, replicate: u32, pixel: UVec2) {
    for sample in 0..SAMPLES {
        let mut sampler = Sobol::start(&SampleId {
            seed: 7,
            replicate,
            pixel: (pixel.x, pixel.y),
            sample,
            samples_per_replicate: SAMPLES,
            blocks: 1,
        });
        let placement = film.place(pixel, sampler.next_2d());
        tile.begin_placed(pixel, &placement);
        let [r, g, b] = [0, 1, 2].map(|_| sampler.next_1d());
        tile.radiance([r * 1e3, g * 1e-3, b], f32::from(r > 0.3));
        tile.channel(0, r + g);
        tile.channel(1, (r + g) * (r + g));
        tile.splat(sampler.next_2d() * 60.0, [g, b, r]);
    }
}

/// The film after two replicates, in tiles of `side` pixels taken in the order of `key`.
fn render(
    method: FilterMethod,
    side: UVec2,
    threads: usize,
    key: impl Fn(usize) -> u64,
) -> ExactFilm {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .expect("threads");
    let mut film = film(method);
    let (from, to) = (film.origin(), film.origin() + film.size());
    let mut tiles = Vec::new();
    for y in (from.y..to.y).step_by(side.y as usize) {
        for x in (from.x..to.x).step_by(side.x as usize) {
            let corner = UVec2::new(x, y);
            tiles.push((corner, (corner + side).min(to)));
        }
    }
    let mut order: Vec<usize> = (0..tiles.len()).collect();
    order.sort_by_key(|&i| key(i));
    for replicate in 0..2 {
        pool.install(|| {
            order.par_iter().with_max_len(1).for_each(|&i| {
                let (from, to) = tiles[i];
                let mut tile = film.tile(from, to, false);
                for y in from.y..to.y {
                    for x in from.x..to.x {
                        sample(&film, &mut tile, replicate, UVec2::new(x, y));
                    }
                }
            });
            film.end_replicate(SAMPLES);
        });
    }
    film
}

fn bits(film: &ExactFilm) -> Vec<u32> {
    let developed = film.develop(RenderFacts::default());
    let metadata = developed
        .metadata
        .expect("a developed picture has metadata");
    let tiles = metadata.tile_means.iter().flat_map(|means| {
        (0..means.replicates())
            .flat_map(move |r| (0..means.channels()).flat_map(move |c| means.plane(r, c).to_vec()))
    });
    let pixels = developed
        .image
        .channels()
        .iter()
        .flat_map(|c| c.samples.clone());
    pixels.chain(tiles).map(f32::to_bits).collect()
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 12,
        rng_seed: RngSeed::Fixed(11),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn tiles_threads_and_order_do_not_matter(
        side in (1u32..50, 1u32..50),
        threads in prop::sample::select(vec![1usize, 2, 16]),
        key in any::<u64>(),
    ) {
        for (_, method) in FilterMethod::ALL {
            let one = render(method, UVec2::splat(64), 1, |i| i as u64);
            let many = render(method, UVec2::new(side.0, side.1), threads, |i| {
                (i as u64).wrapping_mul(key | 1)
            });
            let (one, many) = (bits(&one), bits(&many));
            prop_assert_eq!(one.len(), many.len());
            prop_assert!(one == many);
            prop_assert!(one.iter().any(|b| *b != 0));
        }
    }
}

/// Sums that cancel catastrophically in floating point are exact here, in any order.
#[test]
fn cancellation_is_exact() {
    let mut film = ExactFilm::new(FilmSettings::new(1, 1, Filter::default()), &[]).expect("names");
    {
        let mut tile = film.tile(UVec2::ZERO, UVec2::ONE, false);
        for value in [1e14, 1.0, -1e14, 1e-7] {
            tile.begin_sample(UVec2::ZERO, 1.0);
            tile.radiance([value; 3], 1.0);
        }
    }
    film.end_replicate(1);
    let image = film.develop(RenderFacts::default()).image;
    assert_eq!(image.channel("R"), Some(&[1.0 + 1e-7f32][..]));
}

/// A replicate that was begun but not ended leaves no trace in the picture.
#[test]
fn an_unfinished_replicate_does_not_count() {
    let finished = render(FilterMethod::default(), UVec2::splat(16), 1, |i| i as u64);
    let begun = render(FilterMethod::default(), UVec2::splat(16), 1, |i| i as u64);
    {
        let pixel = begun.origin();
        let mut tile = begun.tile(pixel, pixel + 1, false);
        sample(&begun, &mut tile, 2, pixel);
    }
    assert_eq!(bits(&begun), bits(&finished));
}
