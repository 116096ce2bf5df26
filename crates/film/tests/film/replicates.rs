//! Means, standard errors, tile means and faults against plain arithmetic on the same numbers.

use etalon_film::{
    BoxFilter, ExactFilm, FilmSettings, Filter, InvalidKind, PixelFormat, RenderFacts,
    RenderedImage,
};
use etalon_math::float64;
use etalon_sampling::hash::{mix64, random_float};
use etalon_transport::{Channel, Film, Sink, TileSink};
use glam::UVec2;

const BOX: Filter = Filter::Box(BoxFilter);

/// A number in [0, 1) for every place.
fn uniform(place: [u32; 4]) -> f32 {
    let key = place.iter().fold(1, |key, &n| mix64(key ^ u64::from(n)));
    random_float((key >> 32) as u32)
}

/// Feeds `value(x, y, replicate, sample)` as (value, value², 1).
fn feed(
    film: &mut ExactFilm,
    replicates: u32,
    samples: u32,
    value: impl Fn(u32, u32, u32, u32) -> f32,
) {
    let (from, to) = (film.origin(), film.origin() + film.size());
    for replicate in 0..replicates {
        let mut tile = film.tile(from, to, false);
        for y in from.y..to.y {
            for x in from.x..to.x {
                for sample in 0..samples {
                    tile.begin_sample(UVec2::new(x, y), 1.0);
                    let v = value(x, y, replicate, sample);
                    tile.radiance([v, v * v, 1.0], v.round());
                }
            }
        }
        drop(tile);
        film.end_replicate(samples);
    }
}

fn develop(film: &ExactFilm) -> RenderedImage {
    film.develop(RenderFacts::default())
}

#[test]
fn statistics_are_those_of_the_replicate_means() {
    let (replicates, samples) = (5, 3);
    let mut film = ExactFilm::new(FilmSettings::new(70, 35, BOX), &[]).expect("names");
    let value = |x, y, r, s| uniform([x, y, r, s]) * 3.0 - 1.0;
    feed(&mut film, replicates, samples, value);
    let developed = develop(&film);
    let means = developed.image.channel("R").expect("R");
    let errors = developed.standard_error("R").expect("five replicates");
    let mean_of = |x, y, r| {
        (0..samples)
            .map(|s| f64::from(value(x, y, r, s)))
            .sum::<f64>()
            / f64::from(samples)
    };
    for y in 0..35 {
        for x in 0..70 {
            let of_replicates: Vec<f64> = (0..replicates).map(|r| mean_of(x, y, r)).collect();
            let n = f64::from(replicates);
            let mean = of_replicates.iter().sum::<f64>() / n;
            let variance = of_replicates
                .iter()
                .map(|m| (m - mean).powi(2))
                .sum::<f64>()
                / (n - 1.0);
            let pixel = (y * 70 + x) as usize;
            assert!((f64::from(means[pixel]) - mean).abs() < 1e-7);
            assert!((f64::from(errors[pixel]) - (variance / n).sqrt()).abs() < 1e-7);
        }
    }
    let metadata = developed.metadata.expect("metadata");
    assert_eq!((metadata.replicates, metadata.spp), (5, 15));
    for (side, columns, rows) in [(Some(16), 5, 3), (Some(64), 2, 1), (None, 1, 1)] {
        let tiles = metadata.tiles(side).expect("three sizes");
        assert_eq!((tiles.columns(), tiles.rows()), (columns, rows));
        let step = side.unwrap_or(1000);
        for (row, column, r) in (0..rows)
            .flat_map(|row| (0..columns).map(move |column| (row, column)))
            .flat_map(|(row, column)| (0..replicates).map(move |r| (row, column, r)))
        {
            let (mut sum, mut count) = (0.0, 0.0);
            for y in row * step..((row + 1) * step).min(35) {
                for x in column * step..((column + 1) * step).min(70) {
                    sum += mean_of(x, y, r);
                    count += 1.0;
                }
            }
            let found = tiles.get(r, 0, column, row);
            assert!(
                (f64::from(found) - sum / count).abs() < 1e-7,
                "{side:?} {column} {row}"
            );
        }
    }
}

/// The interval mean ± t·SE holds the truth as often as it says. 128² pixels, normal samples,
/// R = 8: coverage of the 95 % interval (t₇ = 2.3646) is binomial with n = 16384; accepted are
/// 4.4 standard deviations around it (α = 10⁻⁵). Rejects, as asserted: the normal quantile 1.96 in
/// place of t (coverage 0.909), and R in place of R − 1 in the variance (0.937).
#[test]
fn standard_errors_cover_the_truth() {
    let mut film = ExactFilm::new(FilmSettings::new(128, 128, BOX), &[]).expect("names");
    let normal = |x, y, r, s| {
        let [u, v] = [0, 1].map(|k| f64::from(uniform([x, y, r * 2 + k, s + 77])));
        let radius = (-2.0 * float64::ln(1.0 - u)).sqrt();
        (5.0 + 0.5 * radius * float64::cos(2.0 * core::f64::consts::PI * v)) as f32
    };
    feed(&mut film, 8, 2, normal);
    let developed = develop(&film);
    let means = developed.image.channel("R").expect("R");
    let errors = developed.standard_error("R").expect("eight replicates");
    let coverage = |quantile: f32| {
        let inside = means
            .iter()
            .zip(errors)
            .filter(|(m, e)| (*m - 5.0).abs() < quantile * **e);
        inside.count() as f64 / 16384.0
    };
    let allowed = 4.4 * (0.95f64 * 0.05 / 16384.0).sqrt();
    assert!(
        (coverage(2.3646) - 0.95).abs() < allowed,
        "{}",
        coverage(2.3646)
    );
    for mutant in [1.96, 2.3646 * (7.0f32 / 8.0).sqrt()] {
        assert!(
            (coverage(mutant) - 0.95).abs() > allowed,
            "{}",
            coverage(mutant)
        );
    }
    // √(1/16 · 1/4) over 5, in R; 2·5·that over 25 in G; nothing in B.
    let figure = developed
        .mean_relative_standard_error()
        .expect("eight replicates");
    assert!(
        (figure - 0.025 * (5.0f64 / 3.0).sqrt()).abs() < 0.001,
        "{figure}"
    );
}

#[test]
fn one_replicate_has_no_standard_error() {
    let mut film = ExactFilm::new(FilmSettings::new(3, 2, BOX), &[]).expect("names");
    feed(&mut film, 1, 4, |_, _, _, s| s as f32);
    let developed = develop(&film);
    assert_eq!(developed.image.channels().len(), 3);
    assert_eq!(developed.standard_error("R"), None);
    assert_eq!(developed.mean_relative_standard_error(), None);
    assert_eq!(developed.image.channel("R"), Some(&[1.5; 6][..]));
}

/// The standard error of a luminance is that of the luminances, not a combination of errors:
/// R and G here always add up to one, so that their noise cancels in the sum.
#[test]
fn formats_are_converted_before_they_are_squared() {
    let formats = PixelFormat::ALL.map(|(_, format)| format);
    for format in formats {
        let settings = FilmSettings {
            pixel_format: format,
            ..FilmSettings::new(4, 4, BOX)
        };
        let mut film = ExactFilm::new(settings, &[Channel("depth.T".to_owned())]).expect("names");
        for replicate in 0..4 {
            let mut tile = film.tile(UVec2::ZERO, UVec2::splat(4), false);
            for pixel in (0..16).map(|i| UVec2::new(i % 4, i / 4)) {
                tile.begin_sample(pixel, 1.0);
                let noise = uniform([pixel.x, pixel.y, replicate, 0]) - 0.5;
                let [wr, wg, _] = etalon_spectrum::colour_space::LUMINANCE_WEIGHTS;
                tile.radiance([1.0 + noise, 1.0 - noise * (wr / wg) as f32, 1.0], 0.25);
                tile.channel(0, 7.0);
            }
            drop(tile);
            film.end_replicate(1);
        }
        let developed = develop(&film);
        let mut expected: Vec<&str> = format.colours().to_vec();
        expected.extend(format.has_alpha().then_some("A"));
        expected.push("depth.T");
        let names = developed.image.channels().iter().map(|c| c.name.as_str());
        let (plain, errors): (Vec<&str>, Vec<&str>) =
            names.partition(|name| !name.starts_with("standard_error."));
        assert_eq!(plain, expected);
        assert_eq!(errors.len(), plain.len());
        assert_eq!(developed.image.channel("depth.T"), Some(&[7.0; 16][..]));
        if format.has_alpha() {
            assert_eq!(developed.image.channel("A"), Some(&[0.25; 16][..]));
        }
        if let Some(luminance) = developed.image.channel("Y") {
            let errors = developed.standard_error("Y").expect("four replicates");
            assert!(
                luminance.iter().all(|y| (y - 1.0).abs() < 1e-6),
                "{luminance:?}"
            );
            assert!(errors.iter().all(|e| *e < 1e-6), "{errors:?}");
        } else {
            let errors = developed.standard_error("R").expect("four replicates");
            assert!(errors.iter().all(|e| *e > 0.01));
        }
    }
}

#[test]
fn bad_numbers_are_counted_and_left_out() {
    let settings = FilmSettings {
        pixel_format: PixelFormat::Rgba,
        crop_offset: UVec2::new(2, 1),
        crop_size: UVec2::new(4, 3),
        ..FilmSettings::new(8, 8, BOX)
    };
    let mut film = ExactFilm::new(settings, &[Channel("depth.T".to_owned())]).expect("names");
    {
        let mut tile = film.tile(film.origin(), film.origin() + film.size(), false);
        for pixel in [UVec2::new(3, 2), UVec2::new(2, 1)] {
            for bad in [1.0, f32::NAN, f32::INFINITY, 1e30] {
                tile.begin_sample(pixel, 1.0);
                tile.radiance([1.0, bad, 1.0], 1.0);
            }
            tile.begin_sample(pixel, 1.0);
            tile.radiance([1.0; 3], 1.0);
            tile.channel(0, f32::NEG_INFINITY);
            tile.splat(glam::Vec2::new(f32::NAN, 1.0), [1.0; 3]);
            tile.splat(glam::Vec2::new(2.5, 1.5), [f32::NAN, 0.0, 0.0]);
        }
    }
    film.end_replicate(1);
    let faults = film.faults();
    assert_eq!((faults.nan, faults.infinite, faults.overflow), (6, 4, 2));
    assert_eq!(faults.total(), 12);
    assert_eq!(faults.first.len(), 8);
    // In the order of the image, although the other pixel came first.
    let first = &faults.first[0];
    assert_eq!(
        (first.pixel, first.sample, first.kind),
        ([2, 1], Some(1), InvalidKind::Nan)
    );
    assert_eq!(first.source, "radiance");
    assert_eq!(faults.first[3].source, "depth.T");
    assert_eq!(faults.first[4].source, "splat");
    assert_eq!(faults.first[6].pixel, [3, 2]);
    let image = develop(&film).image;
    // Two whole samples remain of five; alpha is counted for all of them.
    assert_eq!(
        image.channel("R").map(|r| (r[0], r[5], r[1])),
        Some((2.0, 2.0, 0.0))
    );
    assert_eq!(image.channel("A").map(|a| a[0]), Some(5.0));
}

#[test]
fn channels_need_different_names() {
    let refused = |names: &[&str]| {
        let channels: Vec<Channel> = names.iter().map(|n| Channel((*n).to_owned())).collect();
        ExactFilm::new(FilmSettings::new(2, 2, BOX), &channels)
            .err()
            .map(|d| d.message)
    };
    assert_eq!(refused(&["dd.T", "nn.X"]), None);
    for bad in [&["dd.T", "dd.T"][..], &["R"], &["standard_error.R"], &[""]] {
        let message = refused(bad).expect("refused");
        assert!(message.contains(bad[bad.len() - 1]), "{message}");
    }
}

/// Images added as replicates give what the same numbers give as samples.
#[test]
fn replicates_can_come_from_elsewhere() {
    let settings = FilmSettings {
        pixel_format: PixelFormat::Rgba,
        crop_offset: UVec2::new(5, 6),
        crop_size: UVec2::new(20, 18),
        ..FilmSettings::new(32, 32, BOX)
    };
    let value = |x, y, r, _| uniform([x, y, r, 0]) * 4.0 - 1.0;
    let mut rendered = ExactFilm::new(settings.clone(), &[]).expect("names");
    feed(&mut rendered, 3, 1, value);
    let mut imported = ExactFilm::new(settings, &[]).expect("names");
    for replicate in 0..3 {
        let plane = |f: &dyn Fn(f32) -> f32| -> Vec<f32> {
            (0..360)
                .map(|i| f(value(5 + i % 20, 6 + i / 20, replicate, 0)))
                .collect()
        };
        let image = etalon_images::Image::new(20, 18)
            .with("A", plane(&f32::round))
            .with("R", plane(&|v| v))
            .with("G", plane(&|v| v * v))
            .with("B", plane(&|_| 1.0))
            .with("unused", plane(&|_| f32::NAN));
        imported.add_replicate(&image, 64).expect("fits");
    }
    let (mut rendered, imported) = (develop(&rendered), develop(&imported));
    let spp = imported.metadata.as_ref().map(|m| m.spp);
    assert_eq!(spp, Some(192));
    rendered.metadata.as_mut().expect("metadata").spp = 192;
    assert!(rendered == imported);

    let mut film = ExactFilm::new(FilmSettings::new(2, 1, BOX), &[]).expect("names");
    let image = etalon_images::Image::new(2, 1).with("R", vec![0.0; 2]);
    assert!(
        film.add_replicate(&image, 1)
            .is_err_and(|e| e.contains("`G`"))
    );
    let image = etalon_images::Image::new(1, 2);
    assert!(
        film.add_replicate(&image, 1)
            .is_err_and(|e| e.contains("1 × 2"))
    );
    assert_eq!(film.replicates(), 0);
}

#[test]
fn a_crop_lies_within_the_film() {
    let film = |offset: [u32; 2], crop: [u32; 2]| {
        let (crop_offset, crop_size) = (UVec2::from(offset), UVec2::from(crop));
        let settings = FilmSettings {
            crop_offset,
            crop_size,
            ..FilmSettings::new(8, 4, BOX)
        };
        ExactFilm::new(settings, &[])
    };
    assert!(film([0, 0], [8, 4]).is_ok());
    assert!(film([7, 3], [1, 1]).is_ok());
    for (offset, crop) in [
        ([0, 0], [0, 4]),
        ([1, 0], [8, 4]),
        ([8, 0], [1, 1]),
        ([9, 0], [1, 1]),
        ([u32::MAX, 0], [2, 1]),
    ] {
        assert!(film(offset, crop).is_err(), "{offset:?} {crop:?}");
    }
    assert!(ExactFilm::new(FilmSettings::new(1 << 17, 1, BOX), &[]).is_err());
}
