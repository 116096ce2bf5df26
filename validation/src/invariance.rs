//! Invariance of bits: threads, the order of replicates, a split into parts, the accelerator and what
//! else is on the film change nothing; another seed changes everything.
//!
//! Accumulation is exact and a sample is a pure function of its address, so these are promises
//! about every bit of every channel and of every tile mean, and a single difference breaks them.

use crate::claim::{Change, Claim, Estimator, Oracle};
use crate::fault::PlantedFault;
use crate::rendering;
use etalon_film::{ExactFilm, Part, RenderedImage, TileMeans};
use etalon_formats::FileAssets;
use etalon_formats::{ReadOptions, mitsuba};
use etalon_integrators::{RenderPlan, ReplicateRange};
use etalon_params::Diagnostics;
use etalon_render::decide::measure::Measure;
use etalon_render::pipeline::{self, Loaded, RenderOptions};
use etalon_scene::{AcceleratorKind, CompileOptions, Compiled};
use std::io::Cursor;
use std::path::Path;

/// Numbers of threads that must give the same bits.
const THREADS: [usize; 3] = [1, 2, 16];

/// Numbers of parts whose merging must give the same bits.
const PARTS: [u32; 2] = [2, 3];

/// How many numbers a change alters; `None` for a change whose statistics are compared.
///
/// # Errors
/// If a picture cannot be rendered.
pub fn measure(
    claim: &Claim,
    estimator: &Estimator,
    loaded: &Loaded,
    plan: &RenderPlan,
    fault: Option<PlantedFault>,
) -> Result<Option<(Vec<Measure>, RenderedImage)>, String> {
    // The fault: the changed picture is of another seed.
    let other = match fault {
        None => *plan,
        Some(PlantedFault::AnotherSeed) => RenderPlan {
            seed: plan.seed ^ 1,
            ..*plan
        },
        Some(_) => return Ok(None),
    };
    let first = || rendering::picture(loaded, plan, estimator, None, None);
    Ok(Some(match estimator.change {
        None | Some(Change::Wavelengths) => return Ok(None),
        Some(Change::Threads) => {
            let first = on_threads(1, first)?;
            let mut measures = Vec::new();
            for count in &THREADS[1..] {
                let changed = on_threads(*count, || {
                    rendering::picture(loaded, &other, estimator, None, None)
                })?;
                measures.push(Measure::certain(
                    format!("numbers that {count} threads change"),
                    differing(&first, &changed, 0),
                ));
            }
            (measures, first)
        }
        Some(Change::Order) => {
            let halves = halves(plan);
            let changed = self::halves(&other);
            let first = one_after_another(loaded, halves)?;
            let swapped = one_after_another(loaded, [changed[1], changed[0]])?;
            let count = differing(&first, &swapped, halves[0].replicates);
            let name = "numbers that the order of replicates changes".to_owned();
            (vec![Measure::certain(name, count)], first)
        }
        Some(Change::Parts) => {
            let first = first()?;
            let mut measures = Vec::new();
            for count in PARTS {
                let changed = merged(loaded, &other, count)?;
                measures.push(Measure::certain(
                    format!("numbers that {count} parts change"),
                    differing(&first, &changed, 0),
                ));
            }
            (measures, first)
        }
        Some(Change::Accelerator) => {
            let first = first()?;
            let compiled = linear(claim, estimator, loaded)?;
            let film = film(&compiled)?;
            let estimator = (&loaded.integrator, &compiled.scene);
            let film = pipeline::render_into(film, estimator, &other, &());
            let facts = rendering::facts(loaded, &other, loaded.integrator_name.clone());
            let changed = rendering::finite(film.develop(facts))?;
            let name = "numbers that a linear scan changes".to_owned();
            (
                vec![Measure::certain(name, differing(&first, &changed, 0))],
                first,
            )
        }
        Some(Change::Seed) => {
            // By the way that every seed takes. The fault is that of a seed that does not matter.
            let seed = plan.seed ^ u64::from(fault.is_none());
            let changed = pipeline::plan(
                loaded,
                &RenderOptions {
                    spp: Some(plan.samples_per_replicate * plan.replicates),
                    seed: Some(seed),
                    replicates: Some(plan.replicates),
                    independent_replicates: plan.replicate_kind.is_independent(),
                    sampler: Some(plan.sampler),
                },
            );
            let pictures = [
                first()?,
                rendering::picture(loaded, &changed, estimator, None, None)?,
            ];
            let name = "replicates that repeat another one".to_owned();
            let measure = Measure::certain(name, repeated(&pictures)?);
            let [first, _] = pictures;
            (vec![measure], first)
        }
        Some(Change::Crop) => {
            let Oracle::Invariance { estimator: whole } = &claim.oracle else {
                return Ok(None);
            };
            let whole = rendering::load_for(claim, whole)?;
            let whole = rendering::picture(&whole, plan, estimator, None, None)?;
            let part = rendering::picture(loaded, &other, estimator, None, None)?;
            let name = "numbers of the part that differ from the whole".to_owned();
            let count = differing_part(&whole, &part)?;
            (vec![Measure::certain(name, count)], part)
        }
    }))
}

fn on_threads(
    count: usize,
    work: impl FnOnce() -> Result<RenderedImage, String> + Send,
) -> Result<RenderedImage, String> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count).build();
    pool.map_err(|e| e.to_string())?.install(work)
}

/// Two independent halves of a plan.
fn halves(plan: &RenderPlan) -> [RenderPlan; 2] {
    let half = RenderPlan {
        replicates: plan.replicates.div_ceil(2),
        ..*plan
    };
    let rest = RenderPlan {
        seed: plan.seed ^ 0x5eed,
        ..half
    };
    [half, rest]
}

fn film(compiled: &Compiled) -> Result<ExactFilm, String> {
    ExactFilm::new(compiled.film.clone(), &[]).map_err(|e| e.message)
}

/// All replicates of one plan, then those of another, in one film.
fn one_after_another(loaded: &Loaded, plans: [RenderPlan; 2]) -> Result<RenderedImage, String> {
    let compiled = &loaded.compiled;
    let mut film = film(compiled)?;
    for plan in &plans {
        let estimator = (&loaded.integrator, &compiled.scene);
        film = pipeline::render_into(film, estimator, plan, &());
    }
    let facts = rendering::facts(loaded, &plans[0], loaded.integrator_name.clone());
    rendering::finite(film.develop(facts))
}

/// The picture of a plan that is rendered in so many parts. These pass through files' bytes and
/// are merged, the last one first.
fn merged(loaded: &Loaded, plan: &RenderPlan, count: u32) -> Result<RenderedImage, String> {
    let mut merged: Option<Part> = None;
    for index in (0..count).rev() {
        let share = ReplicateRange::of(plan.replicates, index, count);
        let share = share.ok_or("there are more parts than replicates")?;
        let plan = RenderPlan {
            share: Some(share),
            ..*plan
        };
        let rendered = pipeline::render(loaded, &plan, &()).map_err(|e| e.message)?;
        let part = rendered
            .part
            .ok_or("a share of the replicates is no part")?;
        let mut file = Cursor::new(Vec::new());
        part.encode(&mut file).map_err(|e| e.to_string())?;
        let name = Path::new("part.exr");
        let read = Part::decode(file.get_ref(), name).map_err(|e| e.to_string())?;
        match &mut merged {
            None => merged = Some(read),
            Some(merged) => merged.absorb(&read).map_err(|e| e.to_string())?,
        }
    }
    let whole = merged.and_then(|merged| merged.whole());
    rendering::finite(whole.ok_or("replicates are missing")?)
}

/// The claim's scene behind a linear scan.
fn linear(claim: &Claim, estimator: &Estimator, loaded: &Loaded) -> Result<Compiled, String> {
    let read = mitsuba::read(
        &loaded.path,
        &ReadOptions {
            defines: rendering::defines(claim, Some(estimator)),
            integrator: estimator.integrator.clone(),
            ..ReadOptions::default()
        },
    );
    let refused = "the scene could not be compiled with a linear scan";
    let document = read.document.ok_or(refused)?;
    let assets = FileAssets::of(&document);
    let diagnostics = Diagnostics::silent_about(&read.stand_ins);
    let options = CompileOptions {
        accelerator: AcceleratorKind::Linear,
        ..CompileOptions::default()
    };
    etalon_scene::compile_with(&document.root, &assets, &diagnostics, &options)
        .ok_or_else(|| refused.to_owned())
}

/// How many numbers of two pictures differ in their bits; the second's replicates begin with the
/// first's replicate `shift`.
fn differing(first: &RenderedImage, second: &RenderedImage, shift: u32) -> usize {
    let (Some(a), Some(b)) = (&first.metadata, &second.metadata) else {
        return 1;
    };
    if a.channels != b.channels || a.replicates != b.replicates {
        return 1;
    }
    let unequal = |x: &[f32], y: &[f32]| {
        let pairs = x.iter().zip(y);
        pairs.filter(|(x, y)| x.to_bits() != y.to_bits()).count() + x.len().abs_diff(y.len())
    };
    let mut count = 0;
    for name in &a.channels {
        for name in [
            name.clone(),
            format!("{}{name}", etalon_film::STANDARD_ERROR),
        ] {
            let plane = |of: &RenderedImage| of.image.channel(&name).map(<[f32]>::to_vec);
            let (x, y) = (plane(first), plane(second));
            count += unequal(&x.unwrap_or_default(), &y.unwrap_or_default());
        }
    }
    for (x, y) in a.tile_means.iter().zip(&b.tile_means) {
        for replicate in 0..x.replicates() {
            let other = (replicate + shift) % x.replicates();
            for channel in 0..x.channels() {
                count += unequal(x.plane(replicate, channel), y.plane(other, channel));
            }
        }
    }
    count
}

/// How many replicates of all pictures have the same bits in every tile's mean as another one.
///
/// # Errors
/// If all is black, or a picture has no statistics.
fn repeated(pictures: &[RenderedImage]) -> Result<usize, String> {
    let mut replicates: Vec<Vec<u32>> = Vec::new();
    for picture in pictures {
        let metadata = picture.metadata.as_ref();
        let metadata = metadata.ok_or("a picture has no statistics")?;
        replicates.extend((0..metadata.replicates).map(|replicate| {
            let of = |tiles: &TileMeans| -> Vec<u32> {
                let planes = (0..tiles.channels()).map(|c| tiles.plane(replicate, c));
                planes.flatten().map(|mean| mean.to_bits()).collect()
            };
            metadata.tile_means.iter().flat_map(of).collect()
        }));
    }
    if replicates.iter().flatten().all(|bits| *bits == 0) {
        return Err("all pictures are black".to_owned());
    }
    let all = replicates.len();
    replicates.sort_unstable();
    replicates.dedup();
    Ok(all - replicates.len())
}

/// How many means and standard errors of a part differ in their bits from the same pixels of the
/// whole.
///
/// # Errors
/// If it is not a part, but all of it or beyond it: nothing would be shown then.
fn differing_part(whole: &RenderedImage, part: &RenderedImage) -> Result<usize, String> {
    let missing = "a picture has no statistics";
    let channels = &whole.metadata.as_ref().ok_or(missing)?.channels;
    let [from, to] = [whole, part].map(|picture| picture.frame.offset);
    let shift = [to[0] - from[0], to[1] - from[1]].map(usize::try_from);
    let [Ok(left), Ok(top)] = shift else {
        return Err("the part begins before the whole".to_owned());
    };
    let [outer, inner] = [whole, part].map(|p| [p.image.width(), p.image.height()]);
    if left + inner[0] > outer[0] || top + inner[1] > outer[1] || inner == outer {
        return Err("the part is not a part of the whole".to_owned());
    }
    let mut count = 0;
    for name in channels {
        for name in [
            name.clone(),
            format!("{}{name}", etalon_film::STANDARD_ERROR),
        ] {
            let plane = |of: &RenderedImage| of.image.channel(&name).map(<[f32]>::to_vec);
            let (x, y) = (plane(whole).ok_or(missing)?, plane(part).ok_or(missing)?);
            for (row, pixels) in y.chunks_exact(inner[0]).enumerate() {
                let begin = (top + row) * outer[0] + left;
                let same = &x[begin..begin + inner[0]];
                count += (same.iter().zip(pixels))
                    .filter(|(x, y)| x.to_bits() != y.to_bits())
                    .count();
            }
        }
    }
    Ok(count)
}
