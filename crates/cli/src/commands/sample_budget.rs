//! How much to render, and how to deal it to the pixels: what the command line says, what a pilot
//! finds, or what a checkpoint holds.

use super::note;
use crate::args::RenderArgs;
use crate::outputs::Outputs;
use crate::progress::Bar;
use etalon_film::{
    CheckpointFacts, Disagreement, ExactFilm, Metadata, Part, PartFacts, ReplicateSet,
    SampleCounts, disagreements, read_developed,
};
use etalon_integrators::{RenderPlan, ReplicateRange};
use etalon_params::Diagnostic;
use etalon_render::adaptive::{self, Distribution};
use etalon_render::part::PartOfMany;
use etalon_render::pilot::Failure;
use etalon_render::pipeline::{self, Loaded, RenderOptions};
use etalon_render::target::{self, Pilot, Target};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// What will be rendered.
pub(super) struct SampleBudget {
    /// Replicates, samples, seed.
    pub(super) plan: RenderPlan,
    /// The samples of each pixel in a replicate, if they are not dealt evenly.
    pub(super) counts: Option<SampleCounts>,
    /// Samples per pixel and time (s) of pilots, if there were any.
    pub(super) pilot: Option<(u32, f64)>,
    /// What was rendered before.
    pub(super) earlier: Option<Part>,
}

impl SampleBudget {
    /// A plan and nothing else.
    pub(super) fn plain(plan: RenderPlan) -> Self {
        Self {
            plan,
            counts: None,
            pilot: None,
            earlier: None,
        }
    }
}

/// What the command line says of the amount of work.
pub(super) fn plan(args: &RenderArgs, loaded: &Loaded) -> RenderPlan {
    let options = RenderOptions {
        spp: args.spp,
        seed: args.seed,
        replicates: args.replicates,
        // Blocks of one sequence overstate the noise that a denoiser is to take away.
        independent_replicates: args.independent_replicates || args.features,
        sampler: None,
    };
    let plan = pipeline::plan(loaded, &options);
    RenderPlan {
        seed: match args.frame.filter(|_| args.seed.is_none()) {
            Some(frame) => frame.seed(plan.seed),
            None => plan.seed,
        },
        ..plan
    }
}

/// Decides; with a pilot, if the command line asks for one.
pub(super) fn decide(
    args: &RenderArgs,
    loaded: &Loaded,
    cancelled: &AtomicBool,
) -> Result<SampleBudget, Failure> {
    let plan = plan(args, loaded);
    if args.adaptive {
        adaptive::check(loaded)?;
    }
    if args.resume {
        let path = checkpoint(args);
        if path.exists() {
            return Ok(go_on(args, loaded, &plan, &path)?);
        }
    }
    let error = args.error.map(Target::Error);
    let target = error.or(args.time.map(Target::Seconds));
    let start = Instant::now();
    let size = loaded.compiled.film.crop_size;
    let samples = args.pilot.unwrap_or(target::PILOT);
    let of_pilots = u64::from(samples) * (u64::from(args.adaptive) + u64::from(target.is_some()));
    let bar = Bar::new(
        of_pilots * u64::from(size.x) * u64::from(size.y),
        args.quiet || of_pilots == 0,
        cancelled,
    );
    let pilots = || {
        let distribution = match (args.adaptive, target, args.pilot) {
            (false, _, _) => None,
            (true, Some(Target::Seconds(seconds)), None) => {
                let samples = target::affordable(loaded, &plan, seconds, &bar)?;
                Some(adaptive::pilot(loaded, &plan, samples, &bar)?)
            }
            (true, _, _) => Some(adaptive::pilot(loaded, &plan, samples, &bar)?),
        };
        let dealt = start.elapsed().as_secs_f64();
        let pilot = Pilot {
            samples,
            distribution: distribution.as_ref(),
            start,
        };
        let fixed = target
            .map(|target| target::fix(loaded, &plan, target, pilot, args.replicates, &bar))
            .transpose()?;
        Ok::<_, Failure>((distribution, dealt, fixed))
    };
    let found = pilots();
    bar.finish();
    let (distribution, dealt, fixed) = found?;
    let plan = fixed.map_or(plan, |fixed| fixed.plan);
    let counts = distribution
        .as_ref()
        .map(|d| d.counts(plan.sampler, plan.samples_per_replicate));
    if !args.quiet {
        if let (Some(distribution), Some(counts)) = (&distribution, &counts) {
            tell_dealt(distribution, counts, dealt);
        }
        if let Some(fixed) = &fixed {
            let RenderPlan {
                replicates,
                samples_per_replicate,
                ..
            } = plan;
            note(format!(
                "after a pilot of {} samples per pixel ({:.2} s): {replicates} replicates of \
                 {samples_per_replicate}, {} samples per pixel",
                fixed.pilot,
                fixed.seconds,
                u64::from(replicates) * u64::from(samples_per_replicate),
            ));
        } else {
            tell_rounding(args, loaded, &plan);
        }
    }
    let taken = [
        distribution.as_ref().map(Distribution::pilot),
        fixed.map(|fixed| fixed.pilot),
    ];
    let pilot = taken.into_iter().flatten().reduce(|a, b| a + b);
    let seconds = fixed.map_or(dealt, |fixed| fixed.seconds);
    Ok(SampleBudget {
        plan,
        counts,
        pilot: pilot.map(|pilot| (pilot, seconds)),
        earlier: None,
    })
}

/// The samples of each pixel, if a replayed sample is one of those that were dealt unevenly.
pub(super) fn counts(
    args: &RenderArgs,
    loaded: &Loaded,
    plan: &RenderPlan,
) -> Result<Option<SampleCounts>, Failure> {
    if !args.adaptive {
        return Ok(None);
    }
    adaptive::check(loaded)?;
    let samples = args.pilot.unwrap_or(target::PILOT);
    let distribution = adaptive::pilot(loaded, plan, samples, &())?;
    Ok(Some(
        distribution.counts(plan.sampler, plan.samples_per_replicate),
    ))
}

/// Says how a pilot deals samples.
fn tell_dealt(distribution: &Distribution, counts: &SampleCounts, seconds: f64) {
    let facts = counts.facts();
    note(format!(
        "a pilot of {} samples per pixel ({seconds:.2} s) deals {} to {} samples to a pixel of a \
         replicate, {:.2} on average",
        distribution.pilot(),
        facts.least,
        facts.most,
        facts.mean
    ));
}

/// Says if there are more samples than were asked for.
fn tell_rounding(args: &RenderArgs, loaded: &Loaded, plan: &RenderPlan) {
    let spp = u64::from(plan.replicates) * u64::from(plan.samples_per_replicate);
    let asked = u64::from(args.spp.unwrap_or(loaded.compiled.sampler.spp));
    if spp != asked {
        note(format!(
            "{spp} samples per pixel instead of {asked}: {} replicates of {}",
            plan.replicates, plan.samples_per_replicate
        ));
    }
}

/// Where the checkpoint of an image is kept.
pub(super) fn checkpoint(args: &RenderArgs) -> PathBuf {
    (args.outputs.as_ref()).map_or_else(PathBuf::new, Outputs::checkpoint)
}

/// What a checkpoint of this render says beside what a part says.
pub(super) fn checkpoint_facts(args: &RenderArgs, pilot: Option<(u32, f64)>) -> CheckpointFacts {
    let aimed = args.error.is_some() || args.time.is_some();
    let words = [
        args.error.map(|error| format!("--error {error}")),
        args.time.map(|seconds| format!("--time {seconds}")),
        args.adaptive.then(|| "--adaptive".to_owned()),
        args.pilot.map(|pilot| format!("--pilot {pilot}")),
        // Otherwise the numbers themselves are compared.
        (args.replicates.filter(|_| aimed)).map(|count| format!("--replicates {count}")),
        args.part
            .map(|part| format!("--part {}/{}", part.number, part.count)),
    ];
    CheckpointFacts {
        asked: words.into_iter().flatten().collect::<Vec<_>>().join(" "),
        pilot: pilot.map(|(samples, _)| samples),
        // Files that depend on the input alone record no times.
        pilot_seconds: pilot
            .map(|(_, seconds)| seconds)
            .filter(|_| std::env::var_os("SOURCE_DATE_EPOCH").is_none()),
    }
}

/// Reads a checkpoint of this very render.
fn go_on(
    args: &RenderArgs,
    loaded: &Loaded,
    plan: &RenderPlan,
    path: &Path,
) -> Result<SampleBudget, Diagnostic> {
    let refused = |reason: String| {
        Diagnostic::error_nowhere(reason).help(format!(
            "to begin anew, remove {} or render without `--resume`",
            path.display()
        ))
    };
    let metadata = Part::read_metadata(path).map_err(|error| refused(error.to_string()))?;
    let Some(facts) = metadata.checkpoint.clone() else {
        return Err(refused(format!("{} is no checkpoint", path.display())));
    };
    let differences = differences(args, loaded, plan, &metadata, &facts)?;
    if !differences.is_empty() {
        let message = format!(
            "{} is a checkpoint of another render: {}",
            path.display(),
            in_words(&differences)
        );
        return Err(refused(message));
    }
    let earlier = Part::read(path).map_err(|error| refused(error.to_string()))?;
    let of = metadata.part.as_ref().map_or(0, |part| part.of);
    if !args.quiet {
        let begun = metadata.unfinished.as_ref().map(|begun| {
            format!(
                ", and {:.1} of {} samples per pixel of another",
                begun.mean, begun.samples_per_replicate
            )
        });
        note(format!(
            "going on after {} of {of} replicates{} ({})",
            metadata.replicates,
            begun.unwrap_or_default(),
            path.display()
        ));
    }
    let each = metadata.samples_per_replicate();
    let seconds = facts.pilot_seconds.unwrap_or(0.0);
    Ok(SampleBudget {
        plan: RenderPlan {
            replicates: of,
            samples_per_replicate: u32::try_from(each).unwrap_or(u32::MAX),
            ..*plan
        },
        counts: earlier.counts().cloned(),
        pilot: facts.pilot.map(|pilot| (pilot, seconds)),
        earlier: Some(earlier),
    })
}

/// Whether the image of this render is there already.
///
/// # Errors
/// If it is there and of another render.
pub(super) fn is_finished(
    args: &RenderArgs,
    loaded: &Loaded,
    plan: &RenderPlan,
) -> Result<bool, Diagnostic> {
    let path = args.output();
    if !path.exists() || checkpoint(args).exists() {
        return Ok(false);
    }
    let refused = |reason: String| {
        let help = "to render it anew, remove it or leave `--resume` out";
        Diagnostic::error_nowhere(format!("{}: {reason}", path.display())).help(help)
    };
    let there = if args.part.is_some() {
        // All of it, so that its checksum is verified.
        Part::read(path)
            .map(|part| Some(part.metadata()))
            .map_err(|error| refused(error.to_string()))?
    } else {
        let there = read_developed(path).map_err(|error| refused(error.to_string()))?;
        there.metadata
    };
    let Some(there) = there else {
        return Err(refused("is no image of Etalon's".to_owned()));
    };
    let lacks = args.part.is_some_and(|part| !has_share(&there, part, plan));
    if there.unfinished.is_some() || lacks {
        return Ok(false);
    }
    let film = ExactFilm::new(loaded.compiled.film.clone(), &loaded.integrator.channels())?;
    let mut here = film.metadata(pipeline::facts(loaded, plan));
    here.adaptive.clone_from(&there.adaptive);
    here.part = there.part.clone().map(|part| PartFacts {
        of: plan.replicates,
        ..part
    });
    (here.spp, here.replicates) = match args.error.is_some() || args.time.is_some() {
        true => (there.spp, there.replicates),
        false => {
            let each = u64::from(plan.samples_per_replicate);
            let replicates = match args.part {
                Some(_) => there.replicates,
                None => plan.replicates,
            };
            (each * u64::from(replicates), replicates)
        }
    };
    let differences = disagreements(&there, &here);
    if differences.is_empty() {
        return Ok(true);
    }
    Err(refused(format!(
        "is of another render: {}",
        in_words(&differences)
    )))
}

/// Whether a file has all the replicates that are the share of `part` in the whole.
fn has_share(there: &Metadata, part: PartOfMany, plan: &RenderPlan) -> bool {
    let share = ReplicateRange::of(plan.replicates, part.number - 1, part.count);
    share.zip(there.part.as_ref()).is_some_and(|(share, part)| {
        part.replicates == ReplicateSet::new(share.first..share.first + share.count)
    })
}

/// What differs there and here.
fn in_words(differences: &[Disagreement]) -> String {
    let each = (differences.iter())
        .map(|d| format!("the {} is {} there, {} here", d.what, d.first, d.second));
    each.collect::<Vec<_>>().join("; ")
}

/// Everything in which a checkpoint is not what this render would write.
fn differences(
    args: &RenderArgs,
    loaded: &Loaded,
    plan: &RenderPlan,
    there: &Metadata,
    facts: &CheckpointFacts,
) -> Result<Vec<Disagreement>, Diagnostic> {
    let film = ExactFilm::new(loaded.compiled.film.clone(), &loaded.integrator.channels())?;
    let mut here = film.metadata(pipeline::facts(loaded, plan));
    here.part.clone_from(&there.part);
    here.adaptive.clone_from(&there.adaptive);
    here.replicates = there.replicates;
    here.spp = there.spp;
    here.unfinished.clone_from(&there.unfinished);
    if args.error.is_none() && args.time.is_none() {
        here.spp = u64::from(plan.samples_per_replicate) * u64::from(there.replicates);
        if let Some(begun) = &mut here.unfinished {
            begun.samples_per_replicate = plan.samples_per_replicate;
        }
        if let Some(part) = &mut here.part {
            part.of = plan.replicates;
        }
    }
    let mut found = disagreements(there, &here);
    let asked = checkpoint_facts(args, None).asked;
    if asked != facts.asked {
        let quoted = |words: &str| match words {
            "" => "(nothing)".to_owned(),
            words => format!("`{words}`"),
        };
        found.push(Disagreement {
            what: "amount asked for",
            first: quoted(&facts.asked),
            second: quoted(&asked),
        });
    }
    Ok(found)
}
