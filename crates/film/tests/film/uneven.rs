//! Films whose pixels get different numbers of samples, and films that go on from checkpoints.

use etalon_film::{
    BoxFilter, CheckpointFacts, ExactFilm, FilmSettings, Filter, Part, RenderFacts, SAMPLES,
    SampleCounts,
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
        let mut tile = film.tile(OFFSET, OFFSET + film.size(), true);
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
        let mut tile = film.tile(OFFSET, OFFSET + film.size(), true);
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

/// The file of a checkpoint.
fn kept(film: &mut ExactFilm, checkpoint: CheckpointFacts) -> Vec<u8> {
    let bytes = film.lend_part(facts(), (9, 12), checkpoint, |part| {
        let mut file = Cursor::new(Vec::new());
        part.encode(&mut file).expect("written");
        file.into_inner()
    });
    bytes.expect("there is something to keep")
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
        let bytes = kept(&mut begun, checkpoint.clone());
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

/// Samples of a replicate up to `until` of every pixel, but fewer in every third, after those that
/// are there: numbers of many sizes, some that stand out, some that are none, and splats elsewhere.
fn draw(film: &ExactFilm, until: impl Fn(u32) -> u32) {
    let mut tile = film.tile(OFFSET, OFFSET + film.size(), false);
    for i in 0..SIZE[0] * SIZE[1] {
        let pixel = OFFSET + UVec2::new(i % SIZE[0], i / SIZE[0]);
        for sample in film.done(pixel)..until(i) {
            tile.begin_sample(pixel, 1.0);
            let one = ((i * 12 + sample).wrapping_mul(2_654_435_761) >> 8) as f32;
            let value = if i % 5 == 0 && sample == 3 { 1e12 } else { one };
            let blue = if (one as u32).is_multiple_of(97) {
                f32::NAN
            } else {
                -one
            };
            tile.radiance([value, 1e-9 * one, blue], 1.0);
            let elsewhere = OFFSET + UVec2::new(i * 7 % SIZE[0], i * 5 % SIZE[1]);
            tile.splat(elsewhere.as_vec2() + 0.7, [0.3 * one, 1.0, 0.0]);
        }
    }
}

/// A film that is kept anywhere within a replicate, its first one too, ends as one that never was.
/// Mutants: sums of splats that are left out, samples that are counted anew, what stands out that is judged by
/// the second half alone.
#[test]
fn a_film_goes_on_within_a_replicate() {
    for (finished, cut) in [(0, 1), (0, 5), (2, 11), (1, 12)] {
        let mut whole = empty(false, 0);
        let mut begun = empty(false, 0);
        for replicate in 0..3 {
            draw(&whole, |_| 12);
            whole.end_replicate(12);
            if replicate < finished {
                draw(&begun, |_| 12);
                begun.end_replicate(12);
            }
        }
        draw(&begun, |i| if i % 3 == 0 { cut / 2 } else { cut });
        let bytes = kept(&mut begun, CheckpointFacts::default());
        let read = Part::decode(&bytes, Path::new("c")).expect("a part");
        let metadata = read.metadata();
        assert_eq!(metadata.replicates, finished);
        let told = metadata.unfinished.expect("told");
        assert_eq!((told.least, told.most), (cut / 2, cut));
        let film = empty(false, 0).go_on(read).expect("its own");
        for mut film in [film, begun] {
            for _ in finished..3 {
                draw(&film, |_| 12);
                film.end_replicate(12);
            }
            assert_eq!(film.outliers().largest(), whole.outliers().largest());
            assert!(!film.outliers().is_empty() && film.faults().nan > 0);
            assert!(film.into_part(facts(), 9) == clone(&mut whole));
        }
        // A damaged one is refused.
        let mut damaged = bytes;
        let middle = damaged.len() / 2;
        damaged[middle..middle + 8].fill(0x55);
        assert!(Part::decode(&damaged, Path::new("c")).is_err());
    }
}

/// The film's finished replicates, by way of a file.
fn clone(film: &mut ExactFilm) -> Part {
    let part = film.lend_part(facts(), (9, 12), CheckpointFacts::default(), Clone::clone);
    let part = part.expect("finished replicates");
    let film = empty(false, 0).go_on(part).expect("its own");
    film.into_part(facts(), 9)
}

/// Without a finished replicate each pixel is the mean of its own samples; what splats bring is the
/// mean over all of them. The mutant divides both by the number that there should be.
#[test]
fn the_picture_of_an_unfinished_replicate_is_of_its_samples() {
    let settings = FilmSettings {
        crop_offset: OFFSET,
        crop_size: UVec2::from(SIZE),
        ..FilmSettings::new(60, 40, Filter::Box(BoxFilter))
    };
    let mut film = ExactFilm::new(settings, &[]).expect("sound");
    assert!(film.develop_unfinished(facts(), 64).is_none());
    {
        let mut tile = film.tile(OFFSET, OFFSET + film.size(), false);
        for i in 0..SIZE[0] * SIZE[1] {
            let pixel = OFFSET + UVec2::new(i % SIZE[0], i / SIZE[0]);
            for sample in 0..i % 4 {
                tile.begin_sample(pixel, 1.0);
                tile.radiance([(i % 64) as f32 + sample as f32, 0.0, 2.0], 1.0);
                tile.splat(OFFSET.as_vec2() + 0.5, [0.0, 1.0, 0.0]);
            }
        }
    }
    let picture = film.develop_unfinished(facts(), 64).expect("samples");
    let channel = |name| picture.image.channel(name).expect("there");
    for i in 0..SIZE[0] * SIZE[1] {
        let count = i % 4;
        let at = |name| channel(name)[i as usize];
        assert_eq!(at(SAMPLES), count as f32);
        let mean = (i % 64) as f32 + 0.5 * (count.max(1) - 1) as f32;
        assert_eq!(at("R"), if count > 0 { mean } else { 0.0 });
        assert_eq!(at("B"), if count > 0 { 2.0 } else { 0.0 });
        // One splat for every sample, all to one pixel, over the samples per pixel.
        let splats = (SIZE[0] * SIZE[1]) as f32;
        assert!((at("G") - if i == 0 { splats } else { 0.0 }).abs() < 1e-3);
    }
    assert!(picture.standard_error("R").is_none());
    let metadata = picture.metadata.as_ref().expect("ours");
    let told = metadata.unfinished.as_ref().expect("told");
    assert_eq!(
        (told.least, told.most, told.samples_per_replicate),
        (0, 3, 64)
    );
    assert_eq!((metadata.replicates, metadata.spp), (0, 1));
    assert_eq!(told.without, u64::from((SIZE[0] * SIZE[1]).div_ceil(4)));
    // Its file can be read.
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.exr");
    picture.write_exr(&path).expect("written");
    let read = etalon_film::read_developed(&path).expect("sound");
    assert!(read.metadata == picture.metadata);
    for name in ["R", "G", "B", SAMPLES] {
        assert!(read.image.channel(name) == Some(channel(name)), "{name}");
    }
}
