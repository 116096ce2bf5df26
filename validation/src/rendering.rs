//! Rendering a claim's scene: with an estimator, perhaps with a fault or a change.

use crate::claim::{self, Budget, Change, Claim, Estimator};
use crate::fault::{Faulty, PlantedFault};
use crate::folders;
use etalon_film::{ExactFilm, RenderFacts, RenderedImage, SampleCounts};
use etalon_integrators::RenderPlan;
use etalon_render::adaptive;
use etalon_render::pilot::Failure;
use etalon_render::pipeline::{self, LoadOptions, Loaded, RenderControls, RenderOptions};
use etalon_sampling::SamplerKind;
use etalon_scene::LightSamplerKind;
use std::path::Path;

/// The scene parameters of a claim, and of one of its estimators.
pub fn defines(claim: &Claim, estimator: Option<&Estimator>) -> Vec<(String, String)> {
    claim::pairs(&claim.defines_of(estimator)).collect()
}

/// Loads a claim's scene.
///
/// # Errors
/// The scene's mistakes, one a line.
pub fn load(
    claim: &Claim,
    defines: &[(String, String)],
    integrator: Option<&str>,
) -> Result<Loaded, String> {
    load_with(
        &claim.scene,
        &LoadOptions {
            defines: defines.to_vec(),
            integrator: integrator.map(str::to_owned),
            ..LoadOptions::default()
        },
    )
}

fn load_with(scene: &Path, options: &LoadOptions) -> Result<Loaded, String> {
    pipeline::load(&folders::scenes().join(scene), options).map_err(|refusal| {
        let lines: Vec<String> = refusal
            .diagnostics
            .iter()
            .map(|d| d.one_line(&refusal.sources))
            .collect();
        lines.join("\n")
    })
}

/// An estimator's scene.
///
/// # Errors
/// As [`load`].
pub fn load_for(claim: &Claim, estimator: &Estimator) -> Result<Loaded, String> {
    let light_chooser = match &estimator.light_chooser {
        None => None,
        Some(name) => {
            let unknown = || format!("there is no light chooser `{name}`");
            Some(LightSamplerKind::named(name).ok_or_else(unknown)?)
        }
    };
    load_with(
        estimator.scene.as_ref().unwrap_or(&claim.scene),
        &LoadOptions {
            defines: defines(claim, Some(estimator)),
            integrator: estimator.integrator.clone(),
            light_chooser,
            ..LoadOptions::default()
        },
    )
}

/// How an estimator spends a budget.
pub fn plan(loaded: &Loaded, estimator: &Estimator, budget: Budget, seed: u64) -> RenderPlan {
    pipeline::plan(
        loaded,
        &RenderOptions {
            spp: Some(budget.spp),
            seed: Some(seed),
            replicates: Some(budget.replicates),
            independent_replicates: !estimator.blocks,
            sampler: Some(estimator.sampler.map_or(SamplerKind::Sobol, Into::into)),
        },
    )
}

/// The samples of each pixel, if a pilot of an estimator deals them. As on the command line it has
/// seeds of its own, derived from the plan's.
///
/// # Errors
/// If the integrator's samples cannot be dealt to pixels.
fn counts(
    loaded: &Loaded,
    plan: &RenderPlan,
    estimator: &Estimator,
) -> Result<Option<SampleCounts>, String> {
    let Some(pilot) = estimator.adaptive else {
        return Ok(None);
    };
    adaptive::check(loaded).map_err(|e| e.message)?;
    let found = adaptive::pilot(loaded, plan, pilot, &()).map_err(|e| match e {
        Failure::Refused(diagnostic) => diagnostic.message,
        Failure::Cancelled => "cancelled".to_owned(),
    })?;
    Ok(Some(found.counts(plan.sampler, plan.samples_per_replicate)))
}

/// Renders an estimator's scene as it is, or as a fault or a change makes it.
///
/// # Errors
/// If it cannot be rendered so, or numbers are not finite.
pub fn picture(
    loaded: &Loaded,
    plan: &RenderPlan,
    estimator: &Estimator,
    fault: Option<PlantedFault>,
    change: Option<Change>,
) -> Result<RenderedImage, String> {
    let counts = counts(loaded, plan, estimator)?;
    let rotation = match change {
        Some(Change::Wavelengths) => 1,
        _ => 0,
    };
    let developed = if rotation > 0 || fault.is_some_and(PlantedFault::is_physical) {
        altered(loaded, plan, counts, (fault, rotation))?
    } else {
        let manner = RenderControls {
            counts,
            ..RenderControls::default()
        };
        let rendered = pipeline::render_as(loaded, plan, manner, &()).map_err(|e| e.message)?;
        rendered.developed
    };
    finite(developed)
}

/// The picture, unless it has numbers that are not finite.
///
/// # Errors
/// Says how many there are.
pub fn finite(picture: RenderedImage) -> Result<RenderedImage, String> {
    let faults = picture.metadata.as_ref().map_or(0, |m| m.faults.total());
    if faults > 0 {
        return Err(format!("{faults} numbers were not finite or out of range"));
    }
    let planes = picture
        .colours()
        .into_iter()
        .filter_map(|name| picture.image.channel(name));
    let bad = planes.flatten().filter(|x| !x.is_finite()).count();
    if bad > 0 {
        return Err(format!("{bad} pixels of the picture are not finite"));
    }
    Ok(picture)
}

/// What a film knows of a render.
pub fn facts(loaded: &Loaded, plan: &RenderPlan, integrator: String) -> RenderFacts {
    RenderFacts {
        version: etalon_render::VERSION.to_owned(),
        scene: loaded.path.display().to_string(),
        scene_hash: loaded.hash.clone(),
        integrator,
        sampler: pipeline::sampler_name(plan.sampler).to_owned(),
        replicate_kind: plan.replicate_kind,
        seed: plan.seed,
        seconds: None,
    }
}

/// Renders the picture of a world with a fault, or with its wavelengths' lanes rotated.
fn altered(
    loaded: &Loaded,
    plan: &RenderPlan,
    counts: Option<SampleCounts>,
    (fault, rotation): (Option<PlantedFault>, usize),
) -> Result<RenderedImage, String> {
    let compiled = &loaded.compiled;
    let named = loaded.integrator.channels();
    let film = ExactFilm::new(compiled.film.clone(), &named).map_err(|e| e.message)?;
    let mut film = film.dealing(counts);
    let world = Faulty::new(&compiled.scene, fault, rotation);
    loaded
        .integrator
        .render(std::slice::from_ref(&world), &mut film, plan, &());
    let of = &loaded.integrator_name;
    let name = match fault {
        Some(fault) => format!("{of} with the fault `{fault}`"),
        None => format!("{of} with rotated wavelengths"),
    };
    Ok(film.develop(facts(loaded, plan, name)))
}
