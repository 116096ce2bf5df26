//! The metadata of a rendered file: JSON in the EXR attribute `etalon`.

use crate::{
    CheckpointFacts, DealtFacts, FaultLog, FilmSettings, OutlierLog, PartFacts, PixelFormat,
    SampleCounts, TileMeans, UnfinishedFacts, floating_point_fingerprint,
};
use etalon_sampling::ReplicateKind;
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// Facts of a render that only the caller knows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RenderFacts {
    /// The program's version.
    pub version: String,
    /// The scene file as it was named.
    pub scene: String,
    /// A hash of the scene's content.
    pub scene_hash: String,
    /// The integrator, innermost last (`aov/path`).
    pub integrator: String,
    /// The sampler.
    pub sampler: String,
    /// How replicates are related.
    pub replicate_kind: ReplicateKind,
    /// The seed.
    pub seed: u64,
    /// Time of rendering (s); see [`recorded_seconds`].
    pub seconds: Option<f64>,
}

/// Seconds to be written into a file: none if `SOURCE_DATE_EPOCH` is set in the environment, which
/// requests output that depends on the input alone
/// (reproducible-builds.org).
pub fn recorded_seconds(elapsed: Duration) -> Option<f64> {
    std::env::var_os("SOURCE_DATE_EPOCH")
        .is_none()
        .then_some(elapsed.as_secs_f64())
}

/// The film that was used.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FilmFacts {
    /// Width and height of the whole film (pixels).
    pub size: [u32; 2],
    /// The first pixel that was rendered.
    pub crop_offset: [u32; 2],
    /// Width and height of the part that was rendered.
    pub crop_size: [u32; 2],
    /// The stored components of a colour.
    pub pixel_format: String,
    /// The reconstruction filter and its parameters.
    pub filter: String,
    /// The method of reconstruction; absent if pixels do not share samples.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub filter_method: Option<String>,
}

/// What a file has for a denoiser: beside features, the means of the first half of its replicates (`half.NAME`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FeatureFacts {
    /// Samples per pixel of the features, which are none of the picture's.
    pub spp: u32,
}

/// Everything a file says of itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Metadata {
    /// The version of this description: [`Metadata::FORMAT`].
    pub format: u32,
    /// The version of the program.
    pub version: String,
    /// The scene file as it was named.
    pub scene: String,
    /// A hash of the scene's content.
    pub scene_hash: String,
    /// The integrator, innermost last.
    pub integrator: String,
    /// The sampler.
    pub sampler: String,
    /// Samples per pixel, all replicates together; where they are dealt unevenly, as many as they
    /// would be evenly.
    pub spp: u64,
    /// Finished replicates. With one, there are no standard errors; with none, the picture is that of
    /// the samples of the first so far.
    pub replicates: u32,
    /// How they are related; independent if not stated. The standard errors of blocks are upper estimates.
    #[serde(default, skip_serializing_if = "ReplicateKind::is_independent")]
    pub replicate_kind: ReplicateKind,
    /// The replicates of a part of a picture.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub part: Option<PartFacts>,
    /// The render that this is a checkpoint of, if it is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub checkpoint: Option<CheckpointFacts>,
    /// The replicate that was being rendered when the render was interrupted, if the file has it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unfinished: Option<UnfinishedFacts>,
    /// The distribution of samples, if uneven.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub adaptive: Option<DealtFacts>,
    /// The features for a denoiser, if there are any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub features: Option<FeatureFacts>,
    /// The denoiser that was applied, if any: standard errors are then its estimates, and there are no replicates to judge by.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub denoised: Option<String>,
    /// The seed.
    pub seed: u64,
    /// Time of rendering (s), unless the file is to be reproducible.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seconds: Option<f64>,
    /// [`floating_point_fingerprint`].
    pub floating_point: String,
    /// The film.
    pub film: FilmFacts,
    /// The channels with means, in the order of the tile means.
    pub channels: Vec<String>,
    /// In how many pixels not one sample found light: 0, with a standard error of 0 that says nothing.
    #[serde(default, skip_serializing_if = "is_none")]
    pub unlit_pixels: u64,
    /// Numbers that were refused.
    pub faults: FaultLog,
    /// Samples that stand out.
    #[serde(default, skip_serializing_if = "OutlierLog::is_empty")]
    pub outliers: OutlierLog,
    /// Tile means of every replicate.
    pub tile_means: Vec<TileMeans>,
}

/// Whether there is nothing to be said.
fn is_none(count: &u64) -> bool {
    *count == 0
}

impl Metadata {
    /// The version of this description that is written, and the only one read so far.
    pub const FORMAT: u32 = 1;

    /// Puts together what the film and the caller know.
    pub(crate) fn new(film: &crate::ExactFilm, facts: RenderFacts) -> Self {
        let settings: &FilmSettings = film.settings();
        Self {
            format: Self::FORMAT,
            version: facts.version,
            scene: facts.scene,
            scene_hash: facts.scene_hash,
            integrator: facts.integrator,
            sampler: facts.sampler,
            spp: film.samples(),
            replicates: film.replicates(),
            replicate_kind: facts.replicate_kind,
            part: None,
            checkpoint: None,
            unfinished: None,
            adaptive: film.counts().map(SampleCounts::facts),
            features: None,
            denoised: None,
            seed: facts.seed,
            seconds: facts.seconds,
            floating_point: floating_point_fingerprint(),
            film: FilmFacts {
                size: settings.size.to_array(),
                crop_offset: settings.crop_offset.to_array(),
                crop_size: settings.crop_size.to_array(),
                pixel_format: settings.pixel_format.name().to_owned(),
                filter: settings.filter.to_string(),
                filter_method: film
                    .footprint()
                    .map(|_| settings.filter_method.name().to_owned()),
            },
            channels: film.channels().to_vec(),
            unlit_pixels: 0,
            faults: film.faults(),
            outliers: film.outliers(),
            tile_means: film.tile_means().to_vec(),
        }
    }

    /// Samples per pixel of a replicate.
    pub fn samples_per_replicate(&self) -> u64 {
        match &self.unfinished {
            Some(unfinished) => unfinished.samples_per_replicate.into(),
            None => self.spp / u64::from(self.replicates.max(1)),
        }
    }

    /// The names of the colour channels.
    pub fn colours(&self) -> Vec<&str> {
        let named = |(name, _): &&(&str, PixelFormat)| *name == self.film.pixel_format;
        match PixelFormat::ALL.iter().find(named) {
            Some((_, format)) => format.colours().to_vec(),
            // A spectral film has no other channels.
            None => self.channels.iter().map(String::as_str).collect(),
        }
    }

    /// The index of a channel in the tile means.
    pub fn channel_index(&self, name: &str) -> Option<u32> {
        let index = self.channels.iter().position(|channel| channel == name)?;
        u32::try_from(index).ok()
    }

    /// The tile means for tiles of `side` pixels, or of the whole image for `None`.
    pub fn tiles(&self, side: Option<u32>) -> Option<&TileMeans> {
        self.tile_means.iter().find(|means| means.side() == side)
    }

    /// The JSON text. Equal metadata have equal texts.
    pub fn to_json(&self) -> String {
        serde_json::to_string(self).expect("metadata are representable in JSON")
    }

    /// Reads the JSON text that belongs to an image of `size` pixels.
    ///
    /// # Errors
    /// Says what is wrong where the text is not ours, is of another version, or contradicts
    /// itself or the image's size.
    pub fn from_json(text: &str, size: [usize; 2]) -> Result<Self, String> {
        /// The one field that every version has.
        #[derive(Deserialize)]
        struct Version {
            format: u32,
        }
        let error = |error: serde_json::Error| error.to_string();
        let Version { format } = serde_json::from_str(text).map_err(error)?;
        if format != Self::FORMAT {
            let known = Self::FORMAT;
            return Err(format!(
                "they are of format {format}, and only {known} is known"
            ));
        }
        let metadata: Self = serde_json::from_str(text).map_err(error)?;
        metadata.check(size)?;
        Ok(metadata)
    }

    fn check(&self, size: [usize; 2]) -> Result<(), String> {
        let film = &self.film;
        if film.crop_size.map(|n| n as usize) != size {
            let ([w, h], [x, y]) = (film.crop_size, size);
            return Err(format!(
                "they are of an image of {w} × {h} pixels, not {x} × {y}"
            ));
        }
        for axis in 0..2 {
            let end = film.crop_offset[axis].checked_add(film.crop_size[axis]);
            if end.is_none_or(|end| end > film.size[axis]) {
                return Err("their crop lies outside of the film".to_owned());
            }
        }
        for means in &self.tile_means {
            if !means.fits(film.crop_size)
                || means.channels() as usize != self.channels.len()
                || means.replicates() != self.replicates
            {
                return Err("their tile means do not belong to the image".to_owned());
            }
        }
        match &self.part {
            Some(part) => part.check(self.replicates, self.spp, self.unfinished.is_some()),
            None => Ok(()),
        }
    }
}
