//! What a film estimates: the filtered image, whether by camera samples or by splats.

use etalon_film::{
    BoxFilter, CatmullRom, ExactFilm, FilmSettings, Filter, FilterMethod, Gaussian, Lanczos,
    Mitchell, PixelFilter, RenderFacts, Tent,
};
use etalon_math::float64;
use etalon_sampling::{SampleId, Sampler, SamplerKind};
use etalon_transport::{Film, Placing, Sink, TileSink};
use glam::{DVec2, IVec2, UVec2, Vec2};

const SIDE: u32 = 6;

/// See [`z_scores`].
const QUANTILE: f64 = 8.17;

fn filters() -> [Filter; 7] {
    [
        Filter::Box(BoxFilter),
        Filter::Tent(Tent::new(1.0).expect("valid")),
        Filter::Gaussian(Gaussian::new(0.5).expect("valid")),
        Filter::Mitchell(Mitchell::new(1.0 / 3.0, 1.0 / 3.0).expect("valid")),
        Filter::CatmullRom(CatmullRom),
        Filter::Lanczos(Lanczos::new(3).expect("valid")),
        Filter::Lanczos(Lanczos::new(2).expect("valid")),
    ]
}

/// Stripes with sharp edges, several in every pixel, a ripple and a gradient.
fn pattern(p: DVec2) -> [f64; 3] {
    let phase = 1.3 * p.x + 0.7 * p.y;
    let stripes = if phase - phase.floor() < 0.37 {
        2.0
    } else {
        0.25
    };
    let ripple = 1.0 + float64::sin(3.0 * p.x) * float64::cos(2.0 * p.y);
    [stripes, ripple, 0.1 * p.x + 0.05 * p.y + 3.0]
}

/// The filtered pattern at a pixel, by brute force.
fn truth(filter: &PixelFilter, pixel: UVec2) -> [f64; 3] {
    let centre = pixel.as_dvec2() + 0.5;
    let radius = filter.filter().radius();
    let steps = (radius * 60.0) as i32;
    let h = radius / f64::from(steps);
    let offsets: Vec<(f64, f64)> = (-steps..steps)
        .map(|i| (f64::from(i) + 0.5) * h)
        .map(|x| (x, filter.density(x) * h))
        .collect();
    let mut sum = [0.0; 3];
    for &(y, fy) in &offsets {
        for &(x, fx) in &offsets {
            let value = pattern(centre + DVec2::new(x, y));
            for (sum, value) in sum.iter_mut().zip(value) {
                *sum += value * fx * fy;
            }
        }
    }
    sum
}

fn settings(filter: Filter, filter_method: FilterMethod) -> FilmSettings {
    FilmSettings {
        filter_method,
        crop_offset: UVec2::new(1, 2),
        crop_size: UVec2::splat(SIDE),
        ..FilmSettings::new(9, 9, filter)
    }
}

/// The pixels of a film, and those around it that take samples.
pub(crate) fn sources(film: &ExactFilm) -> impl Iterator<Item = UVec2> {
    let rim = IVec2::splat(film.rim() as i32);
    let from = film.origin().as_ivec2() - rim;
    let to = (film.origin() + film.size()).as_ivec2() + rim;
    (from.y..to.y).flat_map(move |y| (from.x..to.x).map(move |x| IVec2::new(x, y).as_uvec2()))
}

fn estimate(
    (filter, method): (Filter, FilterMethod),
    kind: SamplerKind,
    samples: u32,
    splats: bool,
) -> ExactFilm {
    let mut film = ExactFilm::new(settings(filter, method), &[]).expect("names");
    let (from, to) = (film.origin(), film.origin() + film.size());
    let margin = film.margin();
    for replicate in 0..16 {
        let mut tile = film.tile(from, to, false);
        for pixel in sources(&film) {
            let inside = pixel.cmpge(from).all() && pixel.cmplt(to).all();
            if splats && !inside {
                continue;
            }
            for sample in 0..samples {
                let mut sampler = kind.start(&SampleId {
                    seed: 3,
                    replicate,
                    pixel: pixel.into(),
                    sample,
                    samples_per_replicate: samples,
                    blocks: 1,
                });
                if splats {
                    // A uniform position on the film and its margin, over its density; one
                    // light path per pixel and sample.
                    let low = from.as_vec2() - margin;
                    let extent = film.size().as_vec2() + 2.0 * margin;
                    let raster = low + sampler.next_2d() * extent;
                    let scale = extent.x * extent.y / (SIDE * SIDE) as f32;
                    tile.begin_sample(pixel, 1.0);
                    let value = pattern(raster.as_dvec2()).map(|v| v as f32 * scale);
                    tile.splat(raster, value);
                } else {
                    let placement = film.place(pixel, sampler.next_2d());
                    tile.begin_placed(pixel, &placement);
                    let value = pattern(placement.raster.as_dvec2()).map(|v| v as f32);
                    tile.radiance(value, 1.0);
                }
            }
        }
        drop(tile);
        film.end_replicate(samples);
    }
    film
}

/// Every pixel and channel within its confidence interval. Family: 7 filters × 36 pixels × 3
/// channels × 4 techniques = 3024 hypotheses; α = 2·10⁻³ over all, two-sided, Student's t with 15
/// degrees of freedom: 8.17 by Bonferroni (6.6·10⁻⁷ each).
/// Brute force is good to 2·10⁻³ (its cells at the stripes' edges), which is added.
/// Rejects: a Gaussian of 1.2 times the deviation (checked below), a forgotten margin, a border without samples around
/// it, a weight of one for negative lobes.
fn z_scores(film: &ExactFilm, against: &PixelFilter) -> f64 {
    let developed = film.develop(RenderFacts::default());
    let mut worst = 0.0f64;
    for (channel, name) in ["R", "G", "B"].into_iter().enumerate() {
        let means = developed.image.channel(name).expect("a colour");
        let errors = developed.standard_error(name).expect("16 replicates");
        for (i, (mean, error)) in means.iter().zip(errors).enumerate() {
            let pixel = UVec2::new(i as u32 % SIDE, i as u32 / SIDE) + film.origin();
            let truth = truth(against, pixel)[channel];
            let excess = ((f64::from(*mean) - truth).abs() - 2e-3).max(0.0);
            worst = worst.max(excess / f64::from(*error).max(1e-9));
        }
    }
    worst
}

#[test]
fn camera_samples_estimate_the_filtered_image() {
    for filter in filters() {
        for (_, method) in FilterMethod::ALL {
            let film = estimate((filter, method), SamplerKind::Independent, 64, false);
            let worst = z_scores(&film, film.filter());
            assert!(worst < QUANTILE, "{filter}, {method}: {worst}");
        }
    }
}

#[test]
fn splats_estimate_the_same_image() {
    for filter in filters() {
        let film = estimate(
            (filter, FilterMethod::Splatting),
            SamplerKind::Independent,
            256,
            true,
        );
        let worst = z_scores(&film, film.filter());
        assert!(worst < QUANTILE, "{filter}: {worst}");
    }
}

#[test]
fn another_filter_is_rejected() {
    let wider = PixelFilter::new(Filter::Gaussian(Gaussian::new(0.6).expect("valid")));
    for (method, splats) in FilterMethod::ALL
        .into_iter()
        .flat_map(|(_, m)| [(m, false), (m, true)])
    {
        let film = estimate(
            (Filter::default(), method),
            SamplerKind::Independent,
            256,
            splats,
        );
        let worst = z_scores(&film, &wider);
        assert!(worst > QUANTILE, "{method}, {splats}: {worst}");
    }
}

/// Importance-sampled, radiance one gives one: exactly, for filters without negative lobes; for the others, with
/// Sobol' points, within what one sample of the wrong sign makes (2 W / N, see `pixel_filter`).
#[test]
fn a_constant_stays_constant() {
    for filter in filters() {
        let samples = 64u32;
        let settings = settings(filter, FilterMethod::ImportanceSampling);
        let mut film = ExactFilm::new(settings, &[]).expect("names");
        let (from, to) = (film.origin(), film.origin() + film.size());
        let mut weight = 0.0f32;
        {
            let mut tile = film.tile(from, to, false);
            for pixel in (from.y..to.y).flat_map(|y| (from.x..to.x).map(move |x| (x, y))) {
                for sample in 0..samples {
                    let mut sampler = SamplerKind::Sobol.start(&SampleId {
                        seed: 5,
                        replicate: 0,
                        pixel,
                        sample,
                        samples_per_replicate: samples,
                        blocks: 1,
                    });
                    let placement = film.place(UVec2::from(pixel), sampler.next_2d());
                    weight = weight.max(placement.weight);
                    tile.begin_sample(UVec2::from(pixel), placement.weight);
                    tile.radiance([1.0; 3], 1.0);
                }
            }
        }
        film.end_replicate(samples);
        let image = film.develop(RenderFacts::default()).image;
        let allowed = if weight == 1.0 {
            0.0
        } else {
            2.0 * weight / samples as f32 + 1e-6
        };
        for value in image.channel("G").expect("a colour") {
            assert!(
                (value - 1.0).abs() <= allowed,
                "{filter}: {value}, weight {weight}"
            );
        }
    }
}

/// Splats of one at every point of a fine lattice, margin included, make a flat image of one:
/// the filter's values at shifted pixel centres add up to what they integrate to.
#[test]
fn splats_of_a_constant_make_a_flat_image() {
    for filter in filters() {
        let settings = settings(filter, FilterMethod::default());
        let mut film = ExactFilm::new(settings, &[]).expect("names");
        let (from, to) = (film.origin(), film.origin() + film.size());
        let per_pixel = 16;
        let margin = film.margin().ceil() as i32;
        {
            let mut tile = film.tile(from, to, false);
            tile.begin_sample(from, 1.0);
            let area = 1.0 / (per_pixel * per_pixel) as f32;
            let lattice = |from: u32, to: u32| {
                let (low, high) = (from as i32 - margin, to as i32 + margin);
                (low * per_pixel..high * per_pixel)
                    .map(move |i| (i as f32 + 0.5) / per_pixel as f32)
            };
            for y in lattice(from.y, to.y) {
                for x in lattice(from.x, to.x) {
                    tile.splat(Vec2::new(x, y), [area; 3]);
                }
            }
        }
        film.end_replicate(1);
        let image = film.develop(RenderFacts::default()).image;
        for value in image.channel("R").expect("a colour") {
            assert!((value - 1.0).abs() < 2e-3, "{filter}: {value}");
        }
    }
}
