//! Single comparisons between fresh renders.
//!
//! A scene is rendered again and again, each time with a seed of its own, and one question is asked of each
//! pair, or of each picture and the formula: is this mean what it ought to be? Under the null
//! hypothesis p-values are uniform, alarms come at the level's rate, and Student's intervals cover.

use super::{CHANNEL, COVERAGES, LEVEL};
use crate::claim::{Budget, Claim, Oracle};
use crate::closed_form;
use crate::rendering;
use etalon_render::judge;
use etalon_statistics::error_rates::{self, Rate};
use etalon_statistics::{Estimate, Replicates, Summary, kolmogorov_smirnov};

/// A single comparison that is repeated.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// The claim whose scene, and whose formula if there is one, is taken.
    pub claim: &'static str,
    /// Width and height (pixels).
    pub size: u32,
    /// Work of each picture.
    pub budget: Budget,
}

/// The comparisons that are repeated: one with a formula, one of two pictures.
pub const SETTINGS: [Setting; 2] = [
    Setting {
        claim: "irradiance-rectangle",
        size: 32,
        budget: Budget {
            spp: 128,
            replicates: 16,
            bound: None,
        },
    },
    Setting {
        claim: "cornell-box",
        size: 32,
        budget: Budget {
            spp: 128,
            replicates: 16,
            bound: None,
        },
    },
];

/// What became of one question, over all repetitions.
pub struct Single {
    /// What was asked.
    pub name: String,
    /// Its p-values.
    pub p_values: Vec<f64>,
    /// Alarms at [`LEVEL`].
    pub alarms: Rate,
    /// How often intervals covered the truth, for each of [`COVERAGES`].
    pub coverages: Vec<Rate>,
    /// The p-value of "these p-values are uniform" (Kolmogorov & Smirnov).
    pub uniform: f64,
}

/// Repeats a setting's comparison; rates get intervals of this confidence.
///
/// # Errors
/// If there is no such claim, or it cannot be rendered.
pub fn repeat(
    setting: &Setting,
    claims: &[Claim],
    (repetitions, seed): (u32, u64),
    confidence: f64,
    watch: impl Fn(u32),
) -> Result<Vec<Single>, String> {
    let claim = claims.iter().find(|claim| claim.name == setting.claim);
    let mut claim = claim
        .cloned()
        .ok_or_else(|| format!("there is no claim `{}`", setting.claim))?;
    for side in ["resx", "resy"] {
        let size = toml::Value::Integer(setting.size.into());
        claim.defines.insert(side.to_owned(), size);
    }
    let estimator = &claim.estimators[0];
    let loaded = rendering::load_for(&claim, estimator)?;
    let size = loaded.compiled.film.crop_size.to_array();
    let known = match &claim.oracle {
        Oracle::ClosedForm { formula } => {
            Some(closed_form::picture(formula, &claim, estimator, size)?)
        }
        _ => None,
    };
    let picture = |number: u64| {
        let seed = seed.wrapping_add(number << 32);
        let plan = rendering::plan(&loaded, estimator, setting.budget, seed);
        rendering::picture(&loaded, &plan, estimator, None, None)
    };
    let questions = [("image mean", None), ("first tile of 16²", Some(16))];
    let mut estimates = vec![Vec::new(); questions.len()];
    for number in 0..repetitions {
        let hands = if known.is_some() { 1 } else { 2 };
        let first = u64::from(number * hands);
        let pictures: Vec<_> = (first..first + u64::from(hands))
            .map(picture)
            .collect::<Result<_, String>>()?;
        for (estimates, (_, side)) in estimates.iter_mut().zip(questions) {
            let summaries: Vec<Summary> = pictures
                .iter()
                .map(|picture| summary(picture, side))
                .collect::<Result<_, String>>()?;
            estimates.push(match (&summaries[..], &known) {
                ([own], Some(known)) => Estimate::excess(own, known.tile_mean(CHANNEL, side, 0)?),
                ([own, other], _) => Estimate::welch(own, other),
                _ => return Err("a comparison has one picture or two".to_owned()),
            });
        }
        watch(number + 1);
    }
    let against = if known.is_some() {
        "formula"
    } else {
        "two pictures"
    };
    questions
        .iter()
        .zip(estimates)
        .map(|((what, _), estimates)| {
            let name = format!("{}: {what}, {against}", setting.claim);
            Single::of(name, &estimates, confidence)
                .ok_or_else(|| "nothing was repeated".to_owned())
        })
        .collect()
}

/// The replicates of the first tile of `side` pixels, or of the image.
fn summary(picture: &etalon_film::RenderedImage, side: Option<u32>) -> Result<Summary, String> {
    let metadata = picture.metadata.as_ref().ok_or("there are no statistics")?;
    let (means, tiles) = judge::replicates(metadata, CHANNEL, side)?;
    let replicates = Replicates::new(&means, tiles).map_err(|e| e.to_string())?;
    replicates.summary(0).map_err(|e| e.to_string())
}

impl Single {
    /// What estimates of a difference that is zero came to; `None` without any.
    pub fn of(name: String, estimates: &[Estimate], confidence: f64) -> Option<Self> {
        let p_values: Vec<f64> = estimates.iter().map(|e| e.p_differs(0.0)).collect();
        let coverages = COVERAGES.iter().map(|level| {
            let intervals = estimates.iter().map(|e| e.interval(*level));
            error_rates::coverage(intervals, 0.0, *level, confidence)
        });
        Some(Self {
            name,
            alarms: error_rates::alarms(&p_values, LEVEL, confidence)?,
            coverages: coverages.collect::<Option<_>>()?,
            uniform: kolmogorov_smirnov::test_uniform(&p_values)?.p_value,
            p_values,
        })
    }
}
