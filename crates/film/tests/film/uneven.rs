//! Films whose pixels get different numbers of samples, and films that go on from checkpoints.

use etalon_film::{
    CheckpointFacts, ExactFilm, FilmSettings, Filter, Part, RenderFacts, SAMPLES, SampleCounts,
};
use etalon_transport::{Film, Placing, Sink, TileSink};
use glam::UVec2;
use std::io::Cursor;
use std::path::Path;

const SIZE: [u32; 2] = [37, 21];
const OFFSET: UVec2 = UVec2::new(4, 3);

/// From one to seven samples.
fn counts() -> SampleCounts {
    let of_pixel = (0..SIZE[0] * SIZE[1]).map(|i| 1 + i * i % 7).collect();
    SampleCounts::new(of_pixel, 64).expect("none is zero")
}

fn empty(dealt: bool, first: u32) -> ExactFilm {
    let settings = FilmSettings {
        crop_offset: OFFSET,
        crop_size: UVec2::from(SIZE),
        ..FilmSettings::new(60, 40, Filter::default())
    };
    ExactFilm::new(settings, &[])
        .expect("a sound film")
        .dealing(dealt.then(counts))
        .starting_at(first)
}

/// What a sample finds: the mean over a pixel's samples is the pixel's and the replicate's number.
fn value(pixel: u32, replicate: u32, sample: u32, count: u32) -> f32 {
    let off = 2.0 * sample as f32 - (count - 1) as f32;
    (pixel % 64) as f32 + 16.0 * replicate as f32 + 0.25 * off
}

fn render(film: &mut ExactFilm, replicates: std::ops::Range<u32>) {
    for replicate in replicates {
        let mut tile = film.tile(OFFSET, OFFSET + film.size(), true, 0);
        for i in 0..SIZE[0] * SIZE[1] {
            let pixel = OFFSET + UVec2::new(i % SIZE[0], i / SIZE[0]);
            let count = film.dealt(pixel, 4);
            for sample in 0..count {
                tile.begin_sample(pixel, 1.0);
                let value = value(i, replicate, sample, count);
                tile.radiance([value, 1.0, if sample == 0 { f32::NAN } else { 0.0 }], 1.0);
                tile.splat(pixel.as_vec2() + 0.5, [0.0; 3]);
            }
        }
        drop(tile);
        film.end_replicate(4);
    }
}

fn facts() -> RenderFacts {
    RenderFacts {
        integrator: "path".to_owned(),
        ..RenderFacts::default()
    }
}

/// Every pixel is divided by its own number, and a tile is the mean of its pixels. The mutant divides by
/// the number of an even film.
#[test]
fn pixels_and_tiles_are_means_of_their_own_samples() {
    let mut film = empty(true, 0);
    for replicate in 0..2 {
        let mut tile = film.tile(OFFSET, OFFSET + film.size(), true, 0);
        for i in 0..SIZE[0] * SIZE[1] {
            let pixel = OFFSET + UVec2::new(i % SIZE[0], i / SIZE[0]);
            let count = film.dealt(pixel, 4);
            assert_eq!(count, 1 + i * i % 7);
            for sample in 0..count {
                tile.begin_sample(pixel, 1.0);
                tile.radiance([value(i, replicate, sample, count), 1.0, 0.0], 1.0);
            }
        }
        drop(tile);
        film.end_replicate(4);
    }
    let developed = film.develop(facts());
    let red = developed.image.channel("R").expect("red");
    let samples = developed.image.channel(SAMPLES).expect("told");
    let errors = developed.standard_error("R").expect("two replicates");
    for i in 0..red.len() as u32 {
        assert!((red[i as usize] - (i % 64) as f32 - 8.0).abs() < 1e-5);
        assert!((errors[i as usize] - 8.0).abs() < 1e-5);
        assert_eq!(samples[i as usize], 2.0 * (1 + i * i % 7) as f32);
    }
    let metadata = developed.metadata.expect("ours");
    let dealt = metadata.adaptive.clone().expect("said");
    assert_eq!((dealt.least, dealt.most, dealt.pilot), (1, 5, 64));
    assert_eq!(metadata.spp, 8);
    // Of the lower right tile there are 5 × 5 pixels.
    let tiles = metadata.tiles(Some(16)).expect("tiles");
    let pixels = (16..21).flat_map(|y| (32..37).map(move |x| y * SIZE[0] + x));
    let mean = pixels.map(|i| f64::from(i % 64)).sum::<f64>() / 25.0;
    for replicate in 0..2 {
        let told = f64::from(tiles.get(replicate, 0, 2, 1));
        assert!((told - mean - 16.0 * f64::from(replicate)).abs() < 1e-4);
        assert_eq!(tiles.get(replicate, 1, 2, 1), 1.0);
    }
}

/// A film that goes on from the file of a checkpoint ends as one that was never interrupted.
#[test]
fn a_film_goes_on() {
    for (dealt, first) in [(false, 0), (true, 0), (true, 3)] {
        let mut whole = empty(dealt, first);
        render(&mut whole, first..first + 5);
        let expected = whole.into_part(facts(), 9);

        let mut begun = empty(dealt, first);
        render(&mut begun, first..first + 2);
        let checkpoint = CheckpointFacts {
            asked: "--error 0.1".to_owned(),
            ..CheckpointFacts::default()
        };
        let bytes = begun.lend_part(facts(), 9, checkpoint.clone(), |part| {
            let mut file = Cursor::new(Vec::new());
            part.encode(&mut file).expect("written");
            file.into_inner()
        });
        // Who lends it keeps it.
        render(&mut begun, first + 2..first + 5);
        assert_eq!(begun.into_part(facts(), 9), expected);

        let read = Part::decode(&bytes, Path::new("c")).expect("a part");
        assert_eq!(read.metadata().checkpoint, Some(checkpoint));
        assert_eq!(read.counts().is_some(), dealt);
        let mut film = empty(false, first).go_on(read.clone()).expect("its own");
        render(&mut film, first + 2..first + 5);
        assert_eq!(film.into_part(facts(), 9), expected);
        // Those of other replicates and other films are refused.
        assert!(empty(false, first + 1).go_on(read.clone()).is_err());
        let other = FilmSettings::new(60, 40, Filter::default());
        let other = ExactFilm::new(other, &[])
            .expect("sound")
            .starting_at(first);
        assert!(other.go_on(read).is_err());
    }
}
