//! Checkpoints: a film that is written while it is being filled, and that is filled further later.
//!
//! A checkpoint is the part ([`Part`]) of the replicates finished so far, which holds exact sums,
//! and those of the replicate that is being rendered: there may be none but this one. A film that
//! takes it over stands where the one that wrote it stood; so the picture that it ends as has the
//! bits of one that was never interrupted.

use crate::{ExactFilm, Metadata, Part, RenderFacts};
use serde::{Deserialize, Serialize};

/// Metadata of checkpoints only.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CheckpointFacts {
    /// Options that decided how much to render, and how; a render resumes only under the same.
    pub asked: String,
    /// Samples per pixel of the pilot that fixed the number of samples.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pilot: Option<u32>,
    /// Time that the pilot took (s).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pilot_seconds: Option<f64>,
}

impl ExactFilm {
    /// The metadata of a file of the film in its current state.
    pub fn metadata(&self, facts: RenderFacts) -> Metadata {
        Metadata::new(self, facts)
    }

    /// Hands all there is so far, as a part of a picture of `of` replicates of `samples` per pixel,
    /// to `use_part`, without making a copy of the finished sums; `None` if there is nothing.
    ///
    /// # Panics
    /// If the replicates are not among `of`, or these are more than [`crate::PartFacts::MOST`].
    pub fn lend_part<T>(
        &mut self,
        facts: RenderFacts,
        (of, samples): (u32, u32),
        checkpoint: CheckpointFacts,
        use_part: impl FnOnce(&Part) -> T,
    ) -> Option<T> {
        let unfinished = self.unfinished();
        if self.replicates() == 0 && unfinished.is_none() {
            return None;
        }
        let mut part = self.take_part(facts, of);
        part.mark(checkpoint, unfinished.map(|sums| (sums, samples)));
        let value = use_part(&part);
        self.put_sums(part.into_parts().1);
        Some(value)
    }

    /// Continues after the replicates of a checkpoint. The film is new and has the same first
    /// replicate.
    ///
    /// # Errors
    /// If the checkpoint is of another film, or its replicates do not follow one another from the
    /// film's first.
    pub fn go_on(self, checkpoint: Part) -> Result<Self, String> {
        let first = self.first_replicate();
        let here = checkpoint.replicates();
        if self.replicates() > 0 || here.iter().next().unwrap_or(first) != first {
            return Err(format!(
                "its replicates are {here}, and this render begins with {first}"
            ));
        }
        if !here.is_empty() && here.end() - first != here.count() {
            return Err(format!("there are gaps in its replicates {here}"));
        }
        let size = self.settings().crop_size.to_array();
        let counts = checkpoint.counts().cloned();
        let (metadata, sums, unfinished) = checkpoint.into_parts();
        if metadata.channels != self.channels() || metadata.film.crop_size != size {
            return Err("it is of another film".to_owned());
        }
        let mut film = self.dealing(counts);
        film.put_sums(sums);
        film.go_on_after(metadata)?;
        if let Some(unfinished) = unfinished {
            film.go_on_with(unfinished);
        }
        Ok(film)
    }
}
