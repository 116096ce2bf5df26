//! Things that move while the shutter is open, against the mean of 64 pictures in which they stand still.

use etalon_film::{ExactFilm, RenderFacts, RenderedImage};
use etalon_images::Image;
use etalon_integrators::AnyIntegrator;
use etalon_render::judge::{Tolerances, judge};
use etalon_render::pipeline::{self, LoadOptions, Loaded, RenderOptions};
use etalon_statistics::Verdict;
use rayon::prelude::*;

/// Pictures at rest.
const STILLS: u32 = 64;

/// The scene `motion` with its shutter open from `open` to `close`.
fn scene(integrator: &str, open: f64, close: f64) -> Loaded {
    let path = etalon_validation::folders::scenes().join("motion/scene.xml");
    let define = |key: &str, value: String| (key.to_owned(), value);
    let options = LoadOptions {
        defines: vec![
            define("open", open.to_string()),
            define("close", close.to_string()),
            define("resx", "32".to_owned()),
            define("resy", "24".to_owned()),
            define("max_depth", "3".to_owned()),
        ],
        integrator: Some(integrator.to_owned()),
        ..LoadOptions::default()
    };
    let loaded = pipeline::load(&path, &options);
    let mut loaded = loaded.unwrap_or_else(|error| panic!("{:?}", error.diagnostics));
    if let AnyIntegrator::PhotonMapper(maps) = &mut loaded.integrator {
        maps.photons = 1 << 13;
    }
    loaded
}

fn render(loaded: &Loaded, spp: u32, replicates: u32, seed: u64) -> RenderedImage {
    let options = RenderOptions {
        spp: Some(spp),
        seed: Some(seed),
        replicates: Some(replicates),
        independent_replicates: true,
        sampler: None,
    };
    let plan = pipeline::plan(loaded, &options);
    let rendered = pipeline::render(loaded, &plan, &());
    rendered
        .unwrap_or_else(|error| panic!("{}", error.message))
        .developed
}

/// The mean of the pictures at rest, in so many replicates.
fn mean_of_stills(integrator: &str, spp: u32, replicates: u32, close: f64) -> RenderedImage {
    let moment = |still: u32| close * (f64::from(still) + 0.5) / f64::from(STILLS);
    let scenes: Vec<Loaded> = (0..STILLS)
        .map(|still| scene(integrator, moment(still), moment(still)))
        .collect();
    let film = scenes[0].compiled.film.clone();
    let size = film.crop_size;
    let mut film = ExactFilm::new(film, &[]).expect("a small film");
    for replicate in 0..replicates {
        let pictures: Vec<RenderedImage> = (scenes.par_iter().enumerate())
            .map(|(still, scene)| {
                let seed = 1_000_000 + u64::from(replicate * STILLS) + still as u64;
                render(scene, spp, 1, seed)
            })
            .collect();
        let mean = ["R", "G", "B"].into_iter().fold(
            Image::new(size.x as usize, size.y as usize),
            |image, name| {
                let planes = pictures.iter().filter_map(|p| p.image.channel(name));
                let mut sum = vec![0.0_f64; (size.x * size.y) as usize];
                for plane in planes {
                    for (sum, x) in sum.iter_mut().zip(plane) {
                        *sum += f64::from(*x);
                    }
                }
                let mean = sum.iter().map(|sum| (sum / f64::from(STILLS)) as f32);
                image.with(name, mean.collect())
            },
        );
        film.add_replicate(&mean, (spp * STILLS).into())
            .expect("it fits");
    }
    film.develop(RenderFacts::default())
}

/// Says whether the two agree, within `bound` of the image and four times that of tiles; false alarms are as rare
/// as 10⁻³.
fn verdict(moving: &RenderedImage, stills: &RenderedImage, bound: f64) -> Verdict {
    let rules = Tolerances {
        image_bound: bound,
        tile_bound: 4.0 * bound,
        ..Tolerances::default()
    };
    judge(moving, stills, rules).expect("comparable").verdict
}

#[test]
fn motion_is_the_mean_of_stills() {
    for (integrator, spp, replicates) in [("path", 8, 16), ("bdpt", 4, 16), ("ptracer", 16, 16)] {
        let moving = render(
            &scene(integrator, 0.0, 1.0),
            spp * STILLS * replicates,
            replicates,
            7,
        );
        let stills = mean_of_stills(integrator, spp, replicates, 1.0);
        assert_eq!(
            verdict(&moving, &stills, 0.02),
            Verdict::Agrees,
            "{integrator}"
        );
        if integrator == "path" {
            // Mutant rejected: the shutter closes a fifth too early.
            let early = mean_of_stills(integrator, spp, replicates, 0.8);
            assert_eq!(verdict(&moving, &early, 0.02), Verdict::Differs);
        }
    }
}

/// A replicate has one map of photons, and one moment.
#[test]
fn photons_move_as_well() {
    let moving = render(&scene("photonmap", 0.0, 1.0), 8 * 256, 256, 7);
    let stills = mean_of_stills("photonmap", 8, 4, 1.0);
    assert_eq!(verdict(&moving, &stills, 0.04), Verdict::Agrees);
}
