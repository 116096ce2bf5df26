//! Pictures to EXR files and back, and files that lie.

use etalon_film::{
    ExactFilm, FilmSettings, Filter, Metadata, PixelFormat, ReadError, RenderFacts, RenderedImage,
    read_developed,
};
use etalon_images::{Frame, Image, exr};
use etalon_sampling::ReplicateKind;
use etalon_transport::{Channel, Film, Sink, TileSink};
use glam::UVec2;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

fn developed(replicates: u32, seconds: Option<f64>) -> RenderedImage {
    let settings = FilmSettings {
        pixel_format: PixelFormat::Rgba,
        crop_offset: UVec2::new(4, 3),
        crop_size: UVec2::new(19, 17),
        ..FilmSettings::new(40, 30, Filter::default())
    };
    let channels = [Channel("dd.y.T".to_owned()), Channel("m2_img.X".to_owned())];
    let mut film = ExactFilm::new(settings, &channels).expect("names");
    for replicate in 0..replicates {
        let mut tile = film.tile(film.origin(), film.origin() + film.size(), false);
        for i in 0..19 * 17 {
            tile.begin_sample(film.origin() + UVec2::new(i % 19, i / 19), 1.0);
            let value = (i as f32 + 0.1) / (replicate as f32 + 3.0);
            tile.radiance([value, value * 0.3, -value], 1.0);
            tile.channel(0, value);
            tile.channel(1, if i == 5 { f32::NAN } else { value });
        }
        drop(tile);
        film.end_replicate(1);
    }
    film.develop(RenderFacts {
        version: "0.1.0".to_owned(),
        scene: "cornell \"box\".xml".to_owned(),
        scene_hash: "0123".to_owned(),
        integrator: "aov/path".to_owned(),
        sampler: "sobol".to_owned(),
        replicate_kind: ReplicateKind::Independent,
        seed: u64::MAX - 5,
        seconds,
    })
}

#[test]
fn pictures_survive_a_file() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    for (replicates, seconds) in [(1, None), (3, Some(0.1 + 0.2))] {
        let path = directory.path().join(format!("{replicates}.exr"));
        let mut written = developed(replicates, seconds);
        written.write_exr(&path).expect("written");
        let read = read_developed(&path).expect("read");
        assert_eq!(read.metadata, written.metadata);
        assert_eq!(read.frame, written.frame);
        assert_eq!(read.image.channels().len(), written.image.channels().len());
        for channel in written.image.channels() {
            assert_eq!(
                read.image.channel(&channel.name),
                Some(&channel.samples[..])
            );
        }
        let metadata = read.metadata.expect("metadata");
        assert_eq!(metadata.faults.nan, u64::from(replicates));
        assert_eq!(metadata.channel_index("dd.y.T"), Some(4));
        assert_eq!(metadata.seed, u64::MAX - 5);
        assert_eq!(metadata.film.filter, "gaussian stddev=0.5");

        // Equal pictures, equal bytes.
        let again = directory.path().join("again.exr");
        developed(replicates, seconds)
            .write_exr(&again)
            .expect("written");
        let bytes = |path| std::fs::read(path).expect("read");
        assert!(bytes(&path) == bytes(&again));

        // Of other programs, there is nothing to say.
        written.metadata = None;
        written.write_exr(&again).expect("written");
        assert_eq!(read_developed(&again).expect("read").metadata, None);
    }
}

fn refusal(text: &str) -> String {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let path = directory.path().join("lies.exr");
    let image = developed(2, None).image;
    let frame = Frame {
        offset: [4, 3],
        size: [40, 30],
    };
    exr::write(&path, &image, frame, text).expect("written");
    match read_developed(&path) {
        Err(error @ ReadError::Metadata { .. }) => {
            let message = error.to_string();
            assert!(message.contains("lies.exr"), "{message}");
            message
        }
        other => panic!("not refused: {other:?}"),
    }
}

#[test]
fn false_metadata_are_refused() {
    let good = developed(2, None).metadata.expect("metadata").to_json();
    let replace = |from: &str, to: &str| {
        assert!(good.contains(from), "{from} in {good}");
        refusal(&good.replacen(from, to, 1))
    };
    assert!(refusal("what?").contains("expected value"));
    assert!(refusal("{}").contains("format"));
    assert!(refusal("[1]").contains("metadata"));
    assert!(replace("\"format\":1", "\"format\":2").contains("only 1 is known"));
    assert!(replace("\"crop_size\":[19,17]", "\"crop_size\":[17,19]").contains("17 × 19"));
    assert!(replace("\"crop_offset\":[4,3]", "\"crop_offset\":[4294967295,3]").contains("crop"));
    assert!(replace("\"size\":[40,30]", "\"size\":[20,30]").contains("crop"));
    assert!(replace("\"replicates\":2", "\"replicates\":3").contains("tile means"));
    assert!(replace("\"dd.y.T\"", "\"dd.y.Q\"").contains("`dd.y.Q`"));
    assert!(replace("\"R\",", "").contains("tile means"));
    assert!(replace("\"columns\":2", "\"columns\":4294967295").contains("bytes"));
    assert!(replace("\"side\":16", "\"side\":0").contains("side"));
    assert!(replace("\"side\":16", "\"side\":3").contains("tile means"));
    assert!(replace("\"means\":\"", "\"means\":\"!").contains("Base64"));
    assert!(replace("\"means\":\"", "\"means\":\"AAAA").contains("bytes"));
    // A text that fits another image.
    let error = Metadata::from_json(&good, [3, 4]).expect_err("refused");
    assert!(error.contains("3 × 4"), "{error}");
}

/// A picture whose pixels were changed after its statistics were made.
fn changed(name: &str, change: impl Fn(f32) -> f32) -> Result<(), String> {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let path = directory.path().join("changed.exr");
    let mut picture = developed(3, None);
    let mut image = Image::new(picture.image.width(), picture.image.height());
    for channel in picture.image.channels() {
        let mut samples = channel.samples.clone();
        if channel.name == name {
            // One pixel of the last tile, which is not whole.
            let last = samples.len() - 1;
            samples[last] = change(samples[last]);
        }
        image.push(channel.name.as_str(), samples);
    }
    picture.image = image;
    picture.write_exr(&path).expect("written");
    let read = read_developed(&path);
    read.map(|_| ()).map_err(|error| error.to_string())
}

#[test]
fn pixels_that_are_not_those_of_the_statistics_are_refused() {
    assert_eq!(changed("G", |x| x), Ok(()));
    // A rounding is none: half a unit in the last place.
    assert_eq!(changed("G", |x| x * (1.0 + 1e-7)), Ok(()));
    for change in [|x: f32| 1.1 * x + 0.1, |_| f32::NAN, |_| f32::INFINITY] {
        let refusal = changed("G", change).expect_err("refused");
        assert!(
            refusal.contains("another picture: channel `G`"),
            "{refusal}"
        );
        assert!(refusal.contains("pixel (16, 16)"), "{refusal}");
    }
}

#[test]
fn a_file_that_is_no_image_is_refused() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let path = directory.path().join("text.exr");
    std::fs::write(&path, "hello").expect("written");
    assert!(matches!(read_developed(&path), Err(ReadError::Image(_))));
    assert!(matches!(
        read_developed(&directory.path().join("missing.exr")),
        Err(ReadError::Image(_))
    ));
    let plain = directory.path().join("plain.exr");
    let image = Image::new(2, 1).with("R", vec![1.0, 2.0]);
    exr::write(&plain, &image, Frame::whole(&image), "").expect("written");
    assert_eq!(
        read_developed(&plain).expect("read").image.channel("R"),
        Some(&[1.0, 2.0][..])
    );
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 400,
        rng_seed: RngSeed::Fixed(5),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// One changed character never leads to a panic, and what is accepted is consistent.
    #[test]
    fn damaged_metadata_never_panic(place in any::<prop::sample::Index>(), new in "[ -~]") {
        let mut text = developed(2, None).metadata.expect("metadata").to_json();
        let at = place.index(text.len());
        text.replace_range(at..=at, &new);
        if let Ok(metadata) = Metadata::from_json(&text, [19, 17]) {
            prop_assert_eq!(metadata.film.crop_size, [19, 17]);
            for means in &metadata.tile_means {
                let last = means.plane(means.replicates() - 1, means.channels() - 1);
                prop_assert_eq!(last.len(), (means.columns() * means.rows()) as usize);
            }
        }
    }
}
