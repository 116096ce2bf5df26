//! Rendering and judging claims.

use crate::claim::{self, Claim, Estimator, Oracle};
use crate::fault::{Fault, Faulty};
use crate::{closed_form, folders, reference};
use etalon::judge::{self, Judgement, Known, Rules};
use etalon::pipeline::{self, LoadOptions, Loaded, RenderOptions};
use etalon_film::{Developed, ExactFilm, RenderFacts};
use etalon_images::{Frame, Image};
use etalon_integrators::{AnyIntegrator, Plan};
use etalon_sampling::SamplerKind;
use std::time::Instant;

/// What to run.
#[derive(Clone, Debug)]
pub struct Options {
    /// Only the claims whose names contain this.
    pub only: Option<String>,
    /// The budgets of the quick run.
    pub quick: bool,
    /// The seed of everything.
    pub seed: u64,
}

/// One comparison to be made: an estimator, perhaps with a fault, against its claim's oracle.
#[derive(Clone, Copy, Debug)]
pub struct Task<'a> {
    /// The claim.
    pub claim: &'a Claim,
    /// The estimator.
    pub estimator: &'a Estimator,
    /// The fault, for a comparison that must find it.
    pub fault: Option<Fault>,
}

/// A comparison that was made.
pub struct Compared {
    /// Our picture.
    pub picture: Developed,
    /// What it ought to be.
    pub oracle: Developed,
    /// The decision, before it is corrected over the whole run.
    pub judgement: Judgement,
    /// Samples per pixel, all replicates together.
    pub spp: u64,
    /// Independent replicates.
    pub replicates: u32,
    /// Seconds for rendering and judging.
    pub seconds: f64,
}

/// The comparisons that a run consists of.
pub fn tasks<'a>(claims: &'a [Claim], options: &Options) -> Vec<Task<'a>> {
    let wanted = |claim: &&Claim| match &options.only {
        Some(part) => claim.name.contains(part.as_str()),
        None => claim.quick || !options.quick,
    };
    let mut tasks = Vec::new();
    for claim in claims.iter().filter(wanted) {
        for estimator in &claim.estimators {
            let faults = estimator.mutants.iter().copied().map(Some);
            tasks.extend(std::iter::once(None).chain(faults).map(|fault| Task {
                claim,
                estimator,
                fault,
            }));
        }
    }
    tasks
}

/// The scene parameters of a claim, and of one of its estimators.
pub fn defines(claim: &Claim, estimator: Option<&Estimator>) -> Vec<(String, String)> {
    let mut all: Vec<_> = claim::pairs(&claim.defines).collect();
    if let Some(estimator) = estimator {
        for (key, value) in claim::pairs(&estimator.defines) {
            all.retain(|(other, _)| *other != key);
            all.push((key, value));
        }
    }
    all
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
    let options = LoadOptions {
        defines: defines.to_vec(),
        integrator: integrator.map(str::to_owned),
        data: Vec::new(),
    };
    pipeline::load(&folders::scenes().join(&claim.scene), &options).map_err(|refusal| {
        let lines: Vec<String> = refusal
            .diagnostics
            .iter()
            .map(|d| d.one_line(&refusal.sources))
            .collect();
        lines.join("\n")
    })
}

/// Renders and judges one comparison at the level `alpha`.
///
/// # Errors
/// If it cannot be made: a scene or a reference that cannot be read, numbers that are not finite.
pub fn compare(task: &Task<'_>, options: &Options, alpha: f64) -> Result<Compared, String> {
    let start = Instant::now();
    let claim = task.claim;
    let rules = Rules {
        image_bound: claim.bounds.image,
        tile_bound: claim.bounds.tile,
        alpha,
        rounding: if claim.oracle.is_exact() {
            claim.bounds.rounding
        } else {
            0.0
        },
    };
    let picture = picture(claim, task.estimator, options, options.seed, task.fault)?;
    let facts = picture.metadata.as_ref().ok_or("there are no statistics")?;
    let (spp, replicates) = (facts.spp, facts.replicates);
    let (judgement, oracle) = match &claim.oracle {
        Oracle::ClosedForm { formula } => {
            let known = closed_form::picture(formula, claim, facts.film.crop_size)?;
            (judge::judge_known(&picture, &known, rules)?, drawn(&known))
        }
        Oracle::Reference { .. } => {
            let hash = load(claim, &defines(claim, None), None)?.hash;
            let oracle = reference::read(&claim.name, &hash)?;
            (judge::judge(&picture, &oracle, rules)?, oracle)
        }
        Oracle::Agreement { estimator } => {
            // Another seed: the two pictures must be independent.
            let seed = options.seed ^ 0x6f72_6163_6c65;
            let oracle = self::picture(claim, estimator, options, seed, None)?;
            (judge::judge(&picture, &oracle, rules)?, oracle)
        }
    };
    Ok(Compared {
        picture,
        oracle,
        judgement,
        spp,
        replicates,
        seconds: start.elapsed().as_secs_f64(),
    })
}

/// Renders a claim's scene with an estimator.
fn picture(
    claim: &Claim,
    estimator: &Estimator,
    options: &Options,
    seed: u64,
    fault: Option<Fault>,
) -> Result<Developed, String> {
    let defines = defines(claim, Some(estimator));
    let loaded = load(claim, &defines, estimator.integrator.as_deref())?;
    let budget = match fault {
        None => estimator.budget(options.quick),
        Some(_) => estimator.fault_budget(),
    };
    let plan = pipeline::plan(
        &loaded,
        &RenderOptions {
            spp: Some(budget.spp),
            seed: Some(seed),
            replicates: Some(budget.replicates),
            sampler: Some(estimator.sampler.map_or(SamplerKind::Sobol, Into::into)),
        },
    );
    let developed = match fault {
        None => {
            let rendered = pipeline::render(&loaded, &plan, &()).map_err(|e| e.message)?;
            rendered.developed
        }
        Some(fault) => faulty_picture(&loaded, &plan, fault)?,
    };
    match &developed.metadata {
        Some(metadata) if !metadata.faults.is_empty() => Err(format!(
            "{} numbers were not finite or out of range",
            metadata.faults.total()
        )),
        _ => Ok(developed),
    }
}

/// Renders the path tracer's picture of a world with a fault.
fn faulty_picture(loaded: &Loaded, plan: &Plan, fault: Fault) -> Result<Developed, String> {
    let AnyIntegrator::Path(path) = &loaded.integrator else {
        return Err("faults are planted under `path` only".to_owned());
    };
    let compiled = &loaded.compiled;
    let mut film = ExactFilm::new(compiled.film.clone(), &[]).map_err(|e| e.message)?;
    let world = Faulty::new(&compiled.scene, fault);
    etalon_integrators::render(&world, path, &mut film, plan, &());
    Ok(film.develop(RenderFacts {
        version: etalon::VERSION.to_owned(),
        scene: loaded.path.display().to_string(),
        scene_hash: loaded.hash.clone(),
        integrator: format!("path with the fault `{fault}`"),
        seed: plan.seed,
        ..RenderFacts::default()
    }))
}

/// A known picture, for the eye.
fn drawn(known: &Known) -> Developed {
    let [width, height] = known.size.map(|n| n as usize);
    let mut image = Image::new(width, height);
    for (name, pixels) in &known.channels {
        image.push(name.as_str(), pixels.iter().map(|p| *p as f32).collect());
    }
    Developed {
        frame: Frame::whole(&image),
        image,
        metadata: None,
    }
}
