//! One estimator that takes part: an integrator, a sampler, a reconstruction filter and a rule by which
//! points choose lights.
//!
//! All share one compiled scene, or one for each way of choosing lights. An integrator is named as for `render --integrator`: it replaces
//! the innermost one and keeps its depths. A sampler or filter that has the name of the scene's own
//! is the scene's own, with its parameters; another has Mitsuba's defaults.

use crate::pipeline::{self, LoadError, LoadOptions, Loaded};
use etalon_film::{FilmSettings, Filter, PixelFormat};
use etalon_integrators::AnyIntegrator;
use etalon_params::{Class, Diagnostic, Diagnostics, Node, Params, Sources, Span, Spanned};
use etalon_sampling::SamplerKind;
use etalon_scene::{Compiled, LightSamplerKind};
use std::sync::Arc;

/// An estimator.
#[derive(Clone)]
pub struct EstimatorConfig {
    /// What tells it from the others: `ptracer`, `path, sobol`.
    pub name: String,
    /// The scene that it sees.
    pub compiled: Arc<Compiled>,
    /// The integrator.
    pub integrator: AnyIntegrator,
    /// Its name, nested ones after a slash.
    pub integrator_name: String,
    /// The sampler.
    pub sampler: SamplerKind,
    /// Size and crop of the scene's film, with this estimator's filter; always in RGB.
    pub film: FilmSettings,
}

/// The compared settings; an empty list means the scene's own.
#[derive(Clone, Copy, Debug)]
pub struct Lists<'a> {
    /// Names of integrators.
    pub integrators: &'a [String],
    /// Names of samplers.
    pub samplers: &'a [String],
    /// Names of reconstruction filters.
    pub filters: &'a [String],
    /// Rules by which points choose lights.
    pub light_choosers: &'a [LightSamplerKind],
}

/// How a scene is loaded with these options.
pub type Load<'a> = &'a dyn Fn(&LoadOptions) -> Result<Loaded, LoadError>;

/// Loads the scene, and makes every combination of the lists.
///
/// # Errors
/// What is wrong with the scene or the lists, as for [`pipeline::load`].
pub fn gather(
    load: Load<'_>,
    options: &LoadOptions,
    lists: &Lists<'_>,
) -> Result<(Loaded, Vec<EstimatorConfig>), LoadError> {
    let load_with = |name: Option<&String>, light_chooser: Option<&LightSamplerKind>| {
        let options = LoadOptions {
            integrator: name.cloned(),
            light_chooser: light_chooser.copied().or(options.light_chooser),
            ..options.clone()
        };
        load(&options)
    };
    let choosers: Vec<String> = (lists.light_choosers.iter())
        .map(|chooser| chooser.name().to_owned())
        .collect();
    for (option, names) in [
        ("--integrators", lists.integrators),
        ("--samplers", lists.samplers),
        ("--filters", lists.filters),
        ("--light-choosers", &choosers),
    ] {
        refuse_repeated(option, names)?;
    }
    let scene = load_with(lists.integrators.first(), lists.light_choosers.first())?;
    let mut integrators = vec![(scene.integrator.clone(), scene.integrator_name.clone())];
    for name in lists.integrators.iter().skip(1) {
        // Only the integrator is kept: estimators see the very same scene.
        let loaded = load_with(Some(name), None)?;
        integrators.push((loaded.integrator, loaded.integrator_name));
    }
    let mut scenes = vec![(scene.compiled.clone(), choosers.first())];
    for (chooser, name) in (lists.light_choosers.iter().zip(&choosers)).skip(1) {
        let loaded = load_with(lists.integrators.first(), Some(chooser))?;
        scenes.push((loaded.compiled, Some(name)));
    }
    let samplers = samplers(lists.samplers, scene.compiled.sampler.kind)?;
    let filters = filters(lists.filters, scene.compiled.film.filter)?;
    let mut entrants = Vec::new();
    for (integrator, integrator_name) in &integrators {
        for &sampler in &samplers {
            for &filter in &filters {
                for (compiled, chooser) in &scenes {
                    let parts = [
                        (integrators.len() > 1, integrator_name.as_str()),
                        (samplers.len() > 1, pipeline::sampler_name(sampler)),
                        (filters.len() > 1, filter.name()),
                        (scenes.len() > 1, chooser.map_or("", |name| name)),
                    ];
                    let told: Vec<&str> = parts.iter().filter(|p| p.0).map(|p| p.1).collect();
                    entrants.push(EstimatorConfig {
                        name: match told.is_empty() {
                            true => integrator_name.clone(),
                            false => told.join(", "),
                        },
                        compiled: compiled.clone(),
                        integrator: integrator.clone(),
                        integrator_name: integrator_name.clone(),
                        sampler,
                        film: FilmSettings {
                            filter,
                            pixel_format: PixelFormat::Rgb,
                            ..scene.compiled.film.clone()
                        },
                    });
                }
            }
        }
    }
    Ok((scene, entrants))
}

/// A word of the command line that messages can point at.
struct Word {
    sources: Sources,
    plugin: Spanned<String>,
}

impl Word {
    fn new(option: &str, word: &str) -> Self {
        let mut sources = Sources::default();
        let file = sources.add(option, word);
        let span = Span {
            file,
            start: 0,
            end: word.len() as u32,
        };
        let plugin = Spanned {
            value: word.to_owned(),
            span,
        };
        Self { sources, plugin }
    }

    fn refuse(self, diagnostics: Vec<Diagnostic>) -> LoadError {
        LoadError {
            diagnostics,
            sources: self.sources,
        }
    }
}

fn refuse_repeated(option: &str, names: &[String]) -> Result<(), LoadError> {
    let repeated = (names.iter().enumerate()).find(|(i, name)| names[..*i].contains(name));
    let Some((_, name)) = repeated else {
        return Ok(());
    };
    let word = Word::new(option, name);
    let message = format!("`{name}` is listed twice: there is nothing to compare it with");
    let error = Diagnostic::error(word.plugin.span, message);
    Err(word.refuse(vec![error]))
}

fn samplers(names: &[String], own: SamplerKind) -> Result<Vec<SamplerKind>, LoadError> {
    const KINDS: [SamplerKind; 3] = [
        SamplerKind::Independent,
        SamplerKind::Stratified { jitter: true },
        SamplerKind::Sobol,
    ];
    if names.is_empty() {
        return Ok(vec![own]);
    }
    let found = names.iter().map(|name| {
        let named = |kind: &SamplerKind| pipeline::sampler_name(*kind) == name;
        let kind = [own].into_iter().chain(KINDS).find(named);
        kind.ok_or_else(|| {
            let word = Word::new("--samplers", name);
            let error = Diagnostic::error(word.plugin.span, format!("unknown sampler `{name}`"))
                .suggest(name, KINDS.map(pipeline::sampler_name));
            word.refuse(vec![error])
        })
    });
    found.collect()
}

fn filters(names: &[String], own: Filter) -> Result<Vec<Filter>, LoadError> {
    if names.is_empty() {
        return Ok(vec![own]);
    }
    let found = names.iter().map(|name| {
        if name == own.name() {
            return Ok(own);
        }
        let word = Word::new("--filters", name);
        let diagnostics = Diagnostics::default();
        let node = Node {
            class: Class::ReconstructionFilter,
            plugin: word.plugin.clone(),
            id: None,
            span: word.plugin.span,
            properties: Vec::new(),
        };
        let filter = Filter::from_params(&Params::new(&node, &diagnostics));
        match diagnostics.has_errors() {
            true => Err(word.refuse(diagnostics.into_sorted())),
            false => Ok(filter),
        }
    });
    found.collect()
}
