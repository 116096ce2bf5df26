//! Parts of a picture: however the replicates are split, and in whatever order the parts are
//! merged, the picture is the unsplit one to the bit. And files of parts that lie.

use etalon_film::{
    Conflict, EXACT, ExactFilm, FilmSettings, Filter, Metadata, Part, PixelFormat, RenderFacts,
    RenderedImage, disagreements, read_developed,
};
use etalon_images::exr;
use etalon_sampling::ReplicateKind;
use etalon_sampling::hash::mix64;
use etalon_transport::{Channel, Film, Sink, TileSink};
use glam::{UVec2, Vec2};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::io::Cursor;
use std::path::Path;

const OF: u32 = 6;

fn facts(seed: u64) -> RenderFacts {
    RenderFacts {
        version: "0.1.0".to_owned(),
        scene: "s.xml".to_owned(),
        scene_hash: "0123".to_owned(),
        integrator: "path".to_owned(),
        sampler: "sobol".to_owned(),
        replicate_kind: ReplicateKind::Independent,
        seed,
        seconds: None,
    }
}

/// A film with the replicates from `first`: numbers of every size and sign, some not finite,
/// splats among them.
fn film(first: u32, count: u32, seed: u64) -> ExactFilm {
    let settings = FilmSettings {
        pixel_format: PixelFormat::Rgba,
        crop_offset: UVec2::new(4, 3),
        crop_size: UVec2::new(19, 17),
        ..FilmSettings::new(40, 30, Filter::default())
    };
    let film = ExactFilm::new(settings, &[Channel("dd.y".to_owned())]).expect("names");
    let mut film = film.starting_at(first);
    for replicate in first..first + count {
        let mut tile = film.tile(film.origin(), film.origin() + film.size(), false);
        for i in 0..19 * 17u32 {
            let pixel = film.origin() + UVec2::new(i % 19, i / 19);
            for sample in 0..3u64 {
                tile.begin_sample(pixel, 1.0);
                let bits =
                    mix64(seed ^ mix64(u64::from(replicate) << 32 | u64::from(i) << 4 | sample));
                // Up to 2⁴⁷, down to what is rounded, and one in about 128 not finite.
                let exponent = 127 - 80 + (bits as u32 >> 8) % 128;
                let exponent = if exponent == 127 + 47 { 255 } else { exponent };
                let value = f32::from_bits((bits >> 41) as u32 | exponent << 23);
                tile.radiance([value, -value * 0.3, 0.1], 1.0);
                tile.channel(0, value);
                tile.splat(pixel.as_vec2() + Vec2::splat(0.7), [0.3, value * 0.7, 1e-9]);
            }
        }
        drop(tile);
        film.end_replicate(3);
    }
    film
}

fn part(first: u32, count: u32) -> Part {
    film(first, count, 5).into_part(facts(5), OF)
}

fn encode(part: &Part) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    part.encode(&mut file).expect("written");
    file.into_inner()
}

fn decode(bytes: &[u8]) -> Result<Part, String> {
    Part::decode(bytes, Path::new("p.exr")).map_err(|error| error.to_string())
}

/// Whether two pictures are equal in every bit of every channel, and in what they say.
fn same(a: &RenderedImage, b: &RenderedImage) -> bool {
    let bits = |picture: &RenderedImage| {
        let channels = picture.image.channels().iter();
        let bits = channels.map(|channel| {
            let samples = channel
                .samples
                .iter()
                .map(|x| x.to_bits())
                .collect::<Vec<_>>();
            (channel.name.clone(), samples)
        });
        bits.collect::<Vec<_>>()
    };
    let said = |picture: &RenderedImage| picture.metadata.as_ref().map(Metadata::to_json);
    bits(a) == bits(b) && said(a) == said(b) && a.frame == b.frame
}

fn unsplit() -> RenderedImage {
    film(0, OF, 5).develop(facts(5))
}

#[test]
fn the_numbers_are_of_every_kind() {
    let metadata = unsplit().metadata.expect("metadata");
    assert!(metadata.faults.infinite + metadata.faults.nan > 20);
    assert_eq!(metadata.faults.first.len(), 8);
    let last = part(4, 2).picture().metadata.expect("metadata").faults;
    assert!(last.first.iter().all(|offence| offence.replicate >= 4));
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 24,
        rng_seed: RngSeed::Fixed(0x0003_9a27),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Any split, any order, through files or not, merged one by one or parts of parts.
    #[test]
    fn merging_gives_the_unsplit_picture(
        cuts in prop::collection::btree_set(1..OF, 0..4),
        keys in prop::collection::vec(any::<u32>(), 6),
        pairs: bool,
    ) {
        let ends = cuts.iter().copied().chain([OF]);
        let mut first = 0;
        let mut parts = Vec::new();
        for (end, key) in ends.zip(&keys) {
            let part = decode(&encode(&part(first, end - first)));
            parts.push((key, part.expect("a sound file")));
            first = end;
        }
        parts.sort_by_key(|(key, _)| **key);
        let mut parts: Vec<Part> = parts.into_iter().map(|(_, part)| part).collect();
        if pairs && parts.len() > 2 {
            let last = parts.pop().expect("three at least");
            let before = parts.last_mut().expect("two at least");
            before.absorb(&last).expect("parts of one render");
            *before = decode(&encode(before)).expect("a part, too");
        }
        let mut merged = parts.remove(0);
        for part in &parts {
            prop_assert!(merged.whole().is_none());
            merged.absorb(part).expect("parts of one render");
        }
        let whole = merged.whole().expect("nothing is missing");
        prop_assert!(same(&whole, &unsplit()));
    }

    /// Files that were changed anywhere are refused, or what was changed did not matter.
    #[test]
    fn damaged_files_are_refused(place in 0.0..1.0f64, change in 1u8..) {
        let sound = part(1, 2);
        let mut bytes = encode(&sound);
        let place = (place * bytes.len() as f64) as usize;
        bytes[place] ^= change;
        if let Ok(read) = decode(&bytes) {
            prop_assert_eq!(read, sound);
        }
    }
}

/// The faults of merging that the comparison above must find.
#[test]
fn what_is_not_the_unsplit_picture_is_found() {
    let merged = |second: Part| {
        let mut merged = part(0, 3);
        merged.absorb(&second).expect("parts of one render");
        merged.whole().expect("nothing is missing")
    };
    let unsplit = unsplit();
    assert!(same(&merged(part(3, 3)), &unsplit));
    // The second part has the random numbers of the first, or of another seed.
    let repeated = film(0, 3, 5);
    let other = film(3, 3, 6).into_part(facts(5), OF);
    assert!(!same(&merged(other), &unsplit));
    let renumbered = repeated.starting_at(3).into_part(facts(5), OF);
    assert!(!same(&merged(renumbered), &unsplit));
    // Means of means, in floating point, are not the same bits.
    let [a, b] = [part(0, 2), part(2, 4)].map(|part| part.picture().image);
    let [a, b] = [&a, &b].map(|image| image.channel("R").expect("R"));
    let mean = a.iter().zip(b).map(|(a, b)| (2.0 * a + 4.0 * b) / 6.0);
    let exact = unsplit.image.channel("R").expect("R");
    assert!(
        !exact
            .iter()
            .zip(mean)
            .all(|(x, y)| x.to_bits() == y.to_bits())
    );
}

#[test]
fn what_does_not_belong_together_stays_apart() {
    let mut merged = part(0, 3);
    let before = merged.clone();
    let Err(Conflict::Overlap(common)) = merged.absorb(&part(2, 2)) else {
        panic!("the replicate 2 is in both");
    };
    assert_eq!(common.to_string(), "2");
    let other = film(3, 3, 6).into_part(facts(6), OF);
    let Err(Conflict::Disagreement(found)) = merged.absorb(&other) else {
        panic!("the seeds differ");
    };
    assert_eq!(
        (found.what, &*found.first, &*found.second),
        ("seed", "5", "6")
    );
    assert_eq!(merged, before);

    let base = part(0, 3).picture().metadata.expect("metadata");
    let differing = |change: &dyn Fn(&mut Metadata)| {
        let mut other = base.clone();
        change(&mut other);
        let found = disagreements(&base, &other);
        found.iter().map(|d| d.what).collect::<Vec<_>>().join(", ")
    };
    assert_eq!(
        differing(&|m| m.version = "0.2.0".to_owned()),
        "version of Etalon"
    );
    assert_eq!(
        differing(&|m| m.scene_hash = "4".to_owned()),
        "scene's hash"
    );
    assert_eq!(
        differing(&|m| m.floating_point.push('0')),
        "floating-point fingerprint"
    );
    assert_eq!(
        differing(&|m| m.integrator = "direct".to_owned()),
        "integrator"
    );
    assert_eq!(
        differing(&|m| m.sampler = "independent".to_owned()),
        "sampler"
    );
    assert_eq!(
        differing(&|m| m.spp = 12),
        "number of samples per replicate"
    );
    assert_eq!(differing(&|m| m.film.filter = "box".to_owned()), "filter");
    assert_eq!(differing(&|m| m.film.crop_offset[1] += 1), "film");
    assert_eq!(differing(&|m| m.channels.swap(0, 1)), "list of channels");
    assert_eq!(differing(&|m| drop(m.tile_means.pop())), "choice of tiles");
    assert_eq!(differing(&|m| m.scene = "elsewhere/s.xml".to_owned()), "");
}

/// A file whose text, or one of whose words, is changed.
fn forged(change: impl Fn(&mut String, &mut Vec<exr::IntegerPlane>)) -> String {
    let bytes = encode(&part(1, 2));
    let path = Path::new("p.exr");
    let (document, mut planes) = exr::decode_with_integers(&bytes, path, EXACT).expect("sound");
    let mut text = document.text.clone();
    change(&mut text, &mut planes);
    let (image, frame) = document.flatten();
    let mut file = Cursor::new(Vec::new());
    exr::encode_with_integers(&mut file, &image, &planes, frame, &text).expect("written");
    decode(file.get_ref()).expect_err("it was forged")
}

#[test]
fn forgeries_are_refused() {
    let replaced = |from: &str, to: &str, words: &str| {
        let message = forged(|text, _| {
            assert!(text.contains(from), "{from} in {text}");
            *text = text.replacen(from, to, 1);
        });
        assert!(
            message.contains("p.exr") && message.contains(words),
            "{message}"
        );
    };
    replaced("\"seed\":5", "\"seed\":6", "checksum");
    replaced("[[1,3]]", "[[2,4]]", "checksum");
    replaced("[[1,3]]", "[[0,3]]", "replicates 0 to 2 of 6");
    replaced("[[1,3]]", "[[5,7]]", "replicates 5 to 6 of 6");
    replaced("[[1,3]]", "[[3,1]]", "ranges of replicates");
    replaced("\"of\":6", "\"of\":4294967295", "of 4294967295");
    replaced("\"spp\":6", "\"spp\":7", "7 samples");
    replaced("\"spp\":6", "\"spp\":18446744073709551614", "samples");
    replaced(
        "\"channels\":[\"R\",\"G\"",
        "\"channels\":[\"R\",\"R\"",
        "another picture",
    );
    replaced("\"part\":", "\"tarp\":", "not a part");
    replaced(
        "\"crop_size\":[19,17]",
        "\"crop_size\":[65000,65000]",
        "pixels",
    );
    let plane = |change: &dyn Fn(&mut Vec<exr::IntegerPlane>)| forged(|_, planes| change(planes));
    let named = |planes: &mut Vec<exr::IntegerPlane>, name: &str| {
        planes
            .iter()
            .position(|plane| plane.name == name)
            .expect("it is there")
    };
    let lost = plane(&|planes| {
        let index = named(planes, "exact.G.sum.2");
        planes.remove(index);
    });
    assert!(lost.contains("`exact.G.sum.2`"), "{lost}");
    // Sums that no replicates can have: too great, or with squares that are too small.
    for (name, word) in [
        ("exact.G.sum.3", 0x7fff_ffff),
        ("exact.G.squares.7", u32::MAX),
    ] {
        let impossible = plane(&|planes| {
            let index = named(planes, name);
            planes[index].samples[40] = word;
        });
        assert!(impossible.contains("`G` in pixel 40"), "{impossible}");
    }
    let slight = plane(&|planes| {
        let index = named(planes, "exact.A.squares.0");
        planes[index].samples[0] ^= 1;
    });
    assert!(slight.contains("checksum"), "{slight}");
}

#[test]
fn a_part_is_an_image_like_any_other() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let path = directory.path().join("p.exr");
    let part = part(2, 3);
    part.write_exr(&path).expect("written");
    assert_eq!(Part::read(&path).expect("sound"), part);
    let picture = read_developed(&path).expect("an image");
    assert!(
        picture
            .image
            .channels()
            .iter()
            .all(|c| !c.name.starts_with(EXACT))
    );
    assert_eq!(picture.image.channels().len(), 2 * 5);
    let metadata = Part::read_metadata(&path).expect("a part");
    assert_eq!(Some(&metadata), picture.metadata.as_ref());
    assert_eq!((metadata.replicates, metadata.spp), (3, 9));
    assert_eq!(part.missing().to_string(), "0 to 1, 5");

    unsplit().write_exr(&path).expect("written");
    for error in [
        Part::read(&path).map(drop),
        Part::read_metadata(&path).map(drop),
    ] {
        let message = error.expect_err("no part").to_string();
        assert!(
            message.contains("a whole image of 6 replicates"),
            "{message}"
        );
    }
}
