//! Conditions for merging parts.

use crate::{Metadata, ReplicateSet};
use std::fmt;

/// Why two parts cannot be merged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Conflict {
    /// They are of different renders.
    Disagreement(Disagreement),
    /// Both have these replicates.
    Overlap(ReplicateSet),
}

impl fmt::Display for Conflict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Disagreement(disagreement) => disagreement.fmt(f),
            Self::Overlap(common) => write!(f, "both have the replicates {common}"),
        }
    }
}

impl std::error::Error for Conflict {}

/// Something in which two parts differ and must not.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Disagreement {
    /// Its name.
    pub what: &'static str,
    /// The first part's value.
    pub first: String,
    /// The second part's value.
    pub second: String,
}

impl fmt::Display for Disagreement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            what,
            first,
            second,
        } = self;
        write!(f, "the {what} of one is {first}, of the other {second}")
    }
}

/// Everything in which two parts are of different renders; which replicates they have does not
/// matter, nor where the scene's file lay.
#[must_use]
pub fn disagreements(first: &Metadata, second: &Metadata) -> Vec<Disagreement> {
    type View = fn(&Metadata) -> String;
    let views: [(&'static str, View); 14] = [
        ("version of Etalon", |m| m.version.clone()),
        ("floating-point fingerprint", |m| m.floating_point.clone()),
        ("scene's hash", |m| m.scene_hash.clone()),
        ("integrator", |m| format!("`{}`", m.integrator)),
        ("sampler", |m| format!("`{}`", m.sampler)),
        ("seed", |m| m.seed.to_string()),
        ("number of replicates of the whole", |m| {
            m.part.as_ref().map_or(m.replicates, |p| p.of).to_string()
        }),
        ("kind of replicates", |m| m.replicate_kind.name().to_owned()),
        ("number of samples per replicate", |m| {
            m.samples_per_replicate().to_string()
        }),
        ("distribution of samples", |m| {
            m.adaptive.as_ref().map_or("even".to_owned(), |dealt| {
                format!(
                    "adaptive ({} to {} in a pixel, {})",
                    dealt.least, dealt.most, dealt.hash
                )
            })
        }),
        ("film", |m| {
            let [[w, h], [cw, ch], [x, y]] = [m.film.size, m.film.crop_size, m.film.crop_offset];
            format!("{w} × {h} pixels, of these {cw} × {ch} at {x}, {y}")
        }),
        ("filter", |m| {
            let method = m.film.filter_method.as_deref();
            let method = method.unwrap_or("importance_sampling");
            format!("{} ({method}), {}", m.film.filter, m.film.pixel_format)
        }),
        ("list of channels", |m| m.channels.join(", ")),
        ("choice of tiles", |m| {
            let shape = |means: &crate::TileMeans| {
                let side = means
                    .side()
                    .map_or("all".to_owned(), |side| side.to_string());
                format!("{side}: {} × {}", means.columns(), means.rows())
            };
            let shapes: Vec<_> = m.tile_means.iter().map(shape).collect();
            shapes.join(", ")
        }),
    ];
    let compared = views.into_iter().map(|(what, view)| Disagreement {
        what,
        first: view(first),
        second: view(second),
    });
    compared.filter(|d| d.first != d.second).collect()
}
