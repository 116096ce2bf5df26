//! What a denoiser is given beside a picture: `render --features`.
//!
//! - `half.NAME` for each colour: the mean of the first half of the replicates. They are independent, and with the picture's
//!   own mean it tells the second half.
//! - [`FEATURES`]: albedo under daylight, shading normal and distance of the first surface, with standard errors, from
//!   samples of their own: their noise has nothing to do with the picture's, and the picture's bits are those without them.

use crate::checkpointing::RenderFilm;
use crate::first_half::FirstHalf;
use crate::loaded::Loaded;
use etalon_film::STANDARD_ERROR;
use etalon_film::{ExactFilm, FeatureFacts, FilmSettings, PixelFormat, RenderFacts, RenderedImage};
use etalon_images::Image;
use etalon_integrators::aov::Aov;
use etalon_integrators::{AnyIntegrator, Progress, RenderPlan};
use etalon_params::Diagnostic;
use etalon_sampling::hash::mix64;
use etalon_sampling::{ReplicateKind, SamplerKind};
use etalon_transport::Channel;

/// What the names of channels with the means of the first half of the replicates begin with.
pub const HALF: &str = "half.";

/// The channels that describe the first surface.
pub const FEATURES: [&str; 7] = [
    "albedo.R", "albedo.G", "albedo.B", "normal.X", "normal.Y", "normal.Z", "depth.T",
];

/// Replicates of the features, which are blocks of one sequence, and samples of a pixel in each.
const REPLICATES: u32 = 4;
const SAMPLES: u32 = 4;

/// Sets their seeds apart from those of pictures.
const SEEDS: u64 = 0x6665_6174_7572_6573;

/// Refuses a render whose features a denoiser could not use, or whose channels have their names.
///
/// # Errors
/// If it is one.
pub(crate) fn check(loaded: &Loaded, plan: &RenderPlan) -> Result<(), Diagnostic> {
    let taken =
        |Channel(name): &Channel| FEATURES.contains(&name.as_str()) || name.starts_with(HALF);
    if let Some(Channel(name)) = loaded.integrator.channels().iter().find(|name| taken(name)) {
        let message =
            format!("`--features` makes a channel `{name}`, which the integrator has, too");
        return Err(Diagnostic::error_nowhere(message).help("give the variable another name"));
    }
    if plan.replicates % 2 == 1 {
        let message = format!(
            "`--features` takes an even number of replicates, and there are {}",
            plan.replicates
        );
        let help = "a denoiser takes either half of them: see `--replicates` and `--spp`";
        return Err(Diagnostic::error_nowhere(message).help(help));
    }
    if plan.replicate_kind != ReplicateKind::Independent {
        let message = "`--features` takes independent replicates";
        return Err(Diagnostic::error_nowhere(message));
    }
    Ok(())
}

/// Renders the features of a picture and adds them to it, with its first half. A picture of a render that was ended early has neither.
///
/// # Errors
/// If there is no memory for them.
pub(crate) fn add(
    picture: &mut RenderedImage,
    half: FirstHalf,
    loaded: &Loaded,
    plan: &RenderPlan,
    progress: &dyn Progress,
) -> Result<(), Diagnostic> {
    let colours: Vec<String> = picture.colours().into_iter().map(str::to_owned).collect();
    let (Some(metadata), Some(first)) = (&mut picture.metadata, &half.image) else {
        return Ok(());
    };
    if metadata.replicates != 2 * half.replicates {
        return Ok(());
    }
    let Some(rendered) = render(loaded, plan.seed, progress)? else {
        return Ok(());
    };
    metadata.features = Some(FeatureFacts {
        spp: REPLICATES * SAMPLES,
    });
    for name in colours {
        if let Some(plane) = first.channel(&name) {
            picture.image.push(format!("{HALF}{name}"), plane.to_vec());
        }
    }
    for prefix in ["", STANDARD_ERROR] {
        for name in FEATURES {
            let name = format!("{prefix}{name}");
            if let Some(plane) = rendered.channel(&name) {
                picture.image.push(name, plane.to_vec());
            }
        }
    }
    Ok(())
}

/// The features alone; `None` if somebody asked to stop.
fn render(
    loaded: &Loaded,
    seed: u64,
    progress: &dyn Progress,
) -> Result<Option<Image>, Diagnostic> {
    let integrator = AnyIntegrator::Aov(Aov::features());
    let settings = FilmSettings {
        pixel_format: PixelFormat::Rgb,
        bands: Vec::new(),
        ..loaded.compiled.film.clone()
    };
    let film = ExactFilm::new(settings, &integrator.channels())?;
    let plan = RenderPlan {
        seed: mix64(seed ^ SEEDS),
        replicates: REPLICATES,
        replicate_kind: ReplicateKind::Blocks,
        share: None,
        samples_per_replicate: SAMPLES,
        sampler: SamplerKind::Sobol,
    };
    let mut film = RenderFilm::unkept(film);
    integrator.render(
        &loaded.compiled.scenes,
        &mut film,
        &plan,
        &Quietly(progress),
    );
    let film = film.finish();
    let whole = film.replicates() == REPLICATES;
    Ok(whole.then(|| film.develop(RenderFacts::default()).image))
}

/// Stops when asked to, and counts nothing: what is counted are the picture's samples.
struct Quietly<'a>(&'a dyn Progress);

impl Progress for Quietly<'_> {
    fn tile_done(&self, _: u64) {}

    fn cancelled(&self) -> bool {
        self.0.cancelled()
    }
}
