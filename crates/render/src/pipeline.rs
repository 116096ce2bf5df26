//! From a scene file to an image: the way every command and every claim takes.

use crate::checkpointing::{Checkpointing, RenderFilm};
use crate::first_half::FirstHalf;
pub use crate::load_options::LoadOptions;
pub use crate::loaded::{Description, LoadError, Loaded};
use crate::objections::place;
use crate::scene_hash::scene_hash;
use crate::watcher::{Show, Watcher};
use crate::{VERSION, features, memory, objections};
use etalon_film::{
    ExactFilm, FilmSettings, Filter, Part, PixelFilter, RenderFacts, RenderedImage, SampleCounts,
    recorded_seconds,
};
pub use etalon_formats::is_scene;
use etalon_formats::{Document, FileAssets, ReadOutcome};
use etalon_integrators::{AnyIntegrator, Progress, RenderPlan, RenderStatistics, ReplicateRange};
use etalon_params::{Class, Diagnostic, Diagnostics, Node, Params, Span, Value};
use etalon_sampling::{ReplicateKind, SamplerKind};
use etalon_scene::{CompileOptions, Scene};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Reads and compiles a scene.
///
/// # Errors
/// Everything that is wrong with it, as far as one reading can find.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Loaded, LoadError> {
    let start = Instant::now();
    let read = etalon_formats::read(path, &options.reading());
    let assets = assets(&read);
    compile(read, &assets, path, options, start)
}

/// The files that a scene refers to.
pub fn assets(read: &ReadOutcome) -> FileAssets {
    read.document
        .as_ref()
        .map(FileAssets::of)
        .unwrap_or_default()
}

/// Compiles what was read from `start` on, with its files.
///
/// # Errors
/// As [`load`].
pub fn compile(
    read: ReadOutcome,
    assets: &FileAssets,
    path: &Path,
    options: &LoadOptions,
    start: Instant,
) -> Result<Loaded, LoadError> {
    let sound = !read.has_errors();
    let ReadOutcome {
        sources,
        diagnostics: mut messages,
        document,
        stand_ins,
    } = read;
    // A scene with mistakes is compiled all the same, to find further ones.
    let mut loaded = None;
    let mut complete = true;
    if let Some(document) = document {
        let diagnostics = Diagnostics::silent_about(&stand_ins);
        let overruled = CompileOptions {
            light_chooser: options.light_chooser,
            accelerator: options.accelerator,
            sensor: options.sensor.clone(),
            framing: options.framing,
            time: options.time,
        };
        let compiled = etalon_scene::compile_with(&document.root, assets, &diagnostics, &overruled);
        let integrator = integrator(&document.root, &diagnostics);
        if let (Some(compiled), Some((integrator, _))) = (&compiled, &integrator) {
            let place = place(&document.root, &[Class::Integrator]);
            diagnostics.keep(check_channels(&compiled.film, integrator, place));
            let film = &compiled.film;
            let mut capabilities = compiled
                .scene
                .capabilities(film.crop_offset, film.crop_size);
            capabilities.narrow_filter = !PixelFilter::new(film.filter).catches_splats();
            capabilities.classic = compiled.classic.is_some(); // One that no shape has does no harm.
            for incompatibility in integrator.incompatibilities(&capabilities) {
                complete = false;
                let root = &document.root;
                diagnostics.push(objections::diagnostic(incompatibility, root, compiled));
            }
        }
        if sound && !diagnostics.has_errors() {
            loaded = compiled.zip(integrator).map(|(compiled, integrator)| {
                let film_place = place(&compiled.sensor, &[Class::Film]);
                let described = Description {
                    root: Arc::clone(&document.root),
                    parameters: document.parameters.clone(),
                };
                (
                    compiled,
                    integrator,
                    scene_hash(&document, assets, options),
                    inputs(&document, assets),
                    film_place,
                    described,
                )
            });
        }
        messages.extend(diagnostics.into_sorted());
        messages.sort_by_key(|d| (d.span.is_none(), d.span.map(|s| (s.file, s.start))));
    }
    let Some((compiled, (integrator, integrator_name), hash, inputs, film_place, described)) =
        loaded
    else {
        return Err(LoadError {
            diagnostics: messages,
            sources,
        });
    };
    let build_time = compiled.build_time;
    Ok(Loaded {
        compiled: Arc::new(compiled),
        integrator,
        integrator_name,
        described,
        complete,
        notes: messages,
        hash,
        sources,
        path: path.to_owned(),
        inputs,
        load_time: start.elapsed().saturating_sub(build_time),
        build_time,
        film_place,
    })
}

/// Refuses an integrator that would give two channels of the image the same name.
fn check_channels(
    film: &FilmSettings,
    integrator: &AnyIntegrator,
    place: Span,
) -> Result<(), Diagnostic> {
    let channels = integrator.channels();
    if !film.bands.is_empty() && !channels.is_empty() {
        let message =
            "a spectral film has a channel for each band, and none for those of the integrator";
        return Err(Diagnostic::error(place, message).help("render them with an `hdrfilm`"));
    }
    let pixel = FilmSettings {
        pixel_format: film.pixel_format,
        bands: film.bands.clone(),
        ..FilmSettings::new(1, 1, Filter::default())
    };
    ExactFilm::new(pixel, &channels)
        .map(|_| ())
        .map_err(|error| at(error, place))
}

/// The same message, at a place.
fn at(diagnostic: Diagnostic, place: Span) -> Diagnostic {
    Diagnostic {
        span: Some(place),
        ..diagnostic
    }
}

/// The scene's integrator, or a path tracer, with its name.
fn integrator(root: &Node, diagnostics: &Diagnostics) -> Option<(AnyIntegrator, String)> {
    let scene = Params::new(root, diagnostics);
    let Some(node) = scene.child(Class::Integrator) else {
        let path = etalon_integrators::path::Path::default();
        return Some((AnyIntegrator::Path(path), "path".to_owned()));
    };
    Some((
        AnyIntegrator::from_node(node, diagnostics)?,
        full_name(node),
    ))
}

/// The integrator's name, nested ones after a slash: `aov/path`.
fn full_name(node: &Node) -> String {
    let nested = node.properties.iter().filter_map(|p| match &p.value {
        Value::Object(child) if child.class == Class::Integrator => Some(full_name(child)),
        _ => None,
    });
    std::iter::once(node.plugin.value.clone())
        .chain(nested)
        .collect::<Vec<_>>()
        .join("/")
}

/// The files of a scene, and those that it refers to.
fn inputs(document: &Document, assets: &FileAssets) -> Vec<PathBuf> {
    let files = document.files.iter().map(|file| file.path.clone());
    files.chain(assets.used()).collect()
}

/// How to render a loaded scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RenderOptions {
    /// Samples per pixel, if not the scene's.
    pub spp: Option<u32>,
    /// Seed, if not the scene's.
    pub seed: Option<u64>,
    /// Replicates, if not the default number.
    pub replicates: Option<u32>,
    /// Independent replicates, also where the integrator could have blocks of one sequence.
    pub independent_replicates: bool,
    /// Kind of sampler, if not the scene's.
    pub sampler: Option<SamplerKind>,
}

/// The default number of replicates: enough for a t distribution with light tails.
pub(crate) const REPLICATES: u32 = 8;

/// What will be rendered: replicates × samples, rounded up to what the sampler can stratify.
pub fn plan(loaded: &Loaded, options: &RenderOptions) -> RenderPlan {
    let settings = &loaded.compiled.sampler;
    let spp = options.spp.unwrap_or(settings.spp);
    let replicates = options.replicates.unwrap_or_else(|| REPLICATES.min(spp));
    let sampler = options.sampler.unwrap_or(settings.kind);
    RenderPlan {
        seed: options.seed.unwrap_or(settings.seed),
        replicates,
        replicate_kind: match options.independent_replicates {
            true => ReplicateKind::Independent,
            false => loaded.integrator.replicate_kind(),
        },
        share: None,
        samples_per_replicate: sampler.round_up(spp.div_ceil(replicates)),
        sampler,
    }
}

/// A finished (or interrupted) render.
pub struct Rendered {
    /// The image with its statistics.
    pub developed: RenderedImage,
    /// The same with exact sums, if it is a share of the image's replicates.
    pub part: Option<Part>,
    /// What was done, replicates of a checkpoint included.
    pub outcome: RenderStatistics,
    /// How long it took.
    pub time: Duration,
    /// The replicates that were planned here; fewer are finished if the render was interrupted. If none is,
    /// the image is of the samples that there are of the first, if there are any, and without
    /// standard errors.
    pub replicates: u32,
    /// Those of them that a checkpoint had finished before.
    pub finished: u32,
}

impl Rendered {
    /// Whether there is anything in the image: not if it was interrupted at once.
    pub fn has_samples(&self) -> bool {
        let metadata = self.developed.metadata.as_ref();
        self.outcome.replicates > 0 || metadata.is_some_and(|m| m.unfinished.is_some())
    }
}

/// Renders a loaded scene on the current thread pool.
///
/// # Errors
/// If there is no memory for the film.
pub fn render(
    loaded: &Loaded,
    plan: &RenderPlan,
    progress: &dyn Progress,
) -> Result<Rendered, Diagnostic> {
    render_as(loaded, plan, RenderControls::default(), progress)
}

/// Renders into a film of one's own, and gives it back. Not generic, and through the type of film that
/// [`render_as`] uses: all integrators are compiled once.
pub fn render_into(
    film: ExactFilm,
    (integrator, scene): (&AnyIntegrator, &Scene),
    plan: &RenderPlan,
    progress: &dyn Progress,
) -> ExactFilm {
    let mut film = RenderFilm::unkept(film);
    integrator.render(std::slice::from_ref(scene), &mut film, plan, progress);
    film.finish()
}

/// What is not ordinary about a render.
#[derive(Clone, Debug, Default)]
pub struct RenderControls {
    /// The samples of each pixel in a replicate, if they are not dealt evenly.
    pub counts: Option<SampleCounts>,
    /// How to keep checkpoints, if there are to be any.
    pub keeping: Option<Checkpointing>,
    /// Who looks on.
    pub watcher: Option<Arc<dyn Watcher>>,
    /// Whether the image gets what a denoiser needs ([`crate::features`]).
    pub features: bool,
}

/// The metadata of a render, without its time.
pub fn facts(loaded: &Loaded, plan: &RenderPlan) -> RenderFacts {
    RenderFacts {
        version: VERSION.to_owned(),
        scene: loaded.path.display().to_string(),
        scene_hash: loaded.hash.clone(),
        integrator: loaded.integrator_name.clone(),
        sampler: sampler_name(plan.sampler).to_owned(),
        replicate_kind: plan.replicate_kind,
        seed: plan.seed,
        seconds: None,
    }
}

/// As [`render`], in this manner.
///
/// # Errors
/// If there is no memory for the film, or the checkpoint to resume from is of another film.
pub fn render_as(
    loaded: &Loaded,
    plan: &RenderPlan,
    manner: RenderControls,
    progress: &dyn Progress,
) -> Result<Rendered, Diagnostic> {
    let start = Instant::now();
    let compiled = &loaded.compiled;
    let channels = loaded.integrator.channels();
    let alpha = usize::from(compiled.film.pixel_format.has_alpha());
    let planes = compiled.film.colours().len() + alpha + channels.len();
    let share = plan.share();
    let RenderControls {
        counts,
        keeping,
        watcher,
        features,
    } = manner;
    if features {
        features::check(loaded, plan)?;
    }
    let exact = plan.share.is_some() || keeping.is_some();
    memory::check(loaded, planes, exact)?;
    let film = ExactFilm::new(compiled.film.clone(), &channels)
        .map_err(|error| at(error, loaded.film_place))?
        .starting_at(share.first)
        .dealing(counts);
    let (finished, before) = keeping
        .as_ref()
        .map(Checkpointing::finished)
        .unwrap_or_default();
    let facts = facts(loaded, plan);
    let of = (plan.replicates, plan.samples_per_replicate);
    let show = watcher.map(|watcher| Show::new(watcher, plan.samples_per_replicate));
    let mut film = RenderFilm::new(film, keeping, &facts, share, of)
        .map_err(Diagnostic::error_nowhere)?
        .shown(show)
        .halved(features.then(|| FirstHalf::of(plan.replicates)));
    let remaining = RenderPlan {
        share: Some(ReplicateRange {
            first: share.first + finished,
            count: share.count - finished.min(share.count),
        }),
        ..*plan
    };
    let mut outcome = loaded
        .integrator
        .render(&compiled.scenes, &mut film, &remaining, progress);
    outcome.replicates += finished;
    let half = film.take_half();
    let mut film = film.finish();
    let time = start.elapsed();
    let facts = RenderFacts {
        seconds: recorded_seconds(before + time),
        ..facts
    };
    let unfinished = film.develop_unfinished(facts.clone(), plan.samples_per_replicate);
    let (mut developed, part) = match unfinished {
        Some(developed) => (developed, None),
        None if plan.share.is_some() && film.replicates() > 0 => {
            let part = film.into_part(facts, plan.replicates);
            (part.picture(), Some(part))
        }
        None => (film.develop(facts), None),
    };
    if let Some(half) = half {
        features::add(&mut developed, half, loaded, plan, progress)?;
    }
    Ok(Rendered {
        developed,
        part,
        outcome,
        time,
        replicates: share.count,
        finished,
    })
}

/// The name by which scenes ask for a sampler.
pub fn sampler_name(kind: SamplerKind) -> &'static str {
    match kind {
        SamplerKind::Independent => "independent",
        SamplerKind::Stratified { .. } => "stratified",
        SamplerKind::Sobol => "sobol",
    }
}
