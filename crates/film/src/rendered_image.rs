//! A finished picture: means, standard errors and metadata; to and from EXR files.
//!
//! Every channel `NAME` is the mean over replicates. With two replicates or more it has a
//! companion `standard_error.NAME`, the standard deviation of the replicates' means over the
//! square root of their number; a confidence interval takes t quantiles with one degree of
//! freedom less than there are replicates. Where samples were not dealt evenly, `samples` says how many
//! each pixel has.

use crate::consistency::contradiction;
use crate::exact_film::STANDARD_ERROR;
use crate::exact_sums::EXACT;
use crate::pixel_moments::PixelMoments;
use crate::sample_counts::{SAMPLES, SampleCounts};
use crate::{ExactFilm, Metadata, RenderFacts, light_carriers};
use etalon_images::{Error, Frame, Image, exr};
use rayon::prelude::*;
use std::path::{Path, PathBuf};

/// A picture with its metadata and statistics.
#[derive(Clone, Debug, PartialEq)]
pub struct RenderedImage {
    /// The channels, `standard_error.*` included.
    pub image: Image,
    /// The position of the image in the whole film.
    pub frame: Frame,
    /// The metadata; `None` for files of other programs.
    pub metadata: Option<Metadata>,
}

/// Why a picture could not be read.
#[derive(Debug)]
pub enum ReadError {
    /// The file could not be read as an image.
    Image(Error),
    /// The image could be read, but its metadata are invalid.
    Metadata {
        /// The file.
        path: PathBuf,
        /// The mistake.
        reason: String,
    },
    /// It is no part of an image, or a damaged one.
    Part {
        /// The file.
        path: PathBuf,
        /// The mistake, and what would be accepted.
        reason: String,
    },
}

impl std::fmt::Display for ReadError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Image(error) => error.fmt(f),
            Self::Metadata { path, reason } => {
                write!(
                    f,
                    "{}: its metadata cannot be used: {reason}",
                    path.display()
                )
            }
            Self::Part { path, reason } => write!(f, "{}: {reason}", path.display()),
        }
    }
}

impl std::error::Error for ReadError {}

impl ReadError {
    pub(crate) fn metadata(path: &Path, reason: String) -> Self {
        Self::Metadata {
            path: path.to_owned(),
            reason,
        }
    }
}

/// The means of channels, and their standard errors if there are two replicates or more.
pub(crate) fn image_of(
    channels: &[String],
    moments: &[PixelMoments],
    replicates: u32,
    [width, height]: [usize; 2],
    counts: Option<&SampleCounts>,
) -> Image {
    let mut image = Image::new(width, height);
    let mut errors = Vec::new();
    for (channel, name) in channels.iter().enumerate() {
        let (mut mean, mut error) = (Vec::new(), Vec::new());
        (0..width * height)
            .into_par_iter()
            .with_min_len(1024)
            .map(|pixel| {
                let moments = moments[pixel * channels.len() + channel].of(replicates);
                let error = moments.standard_error().unwrap_or(f64::NAN);
                (moments.mean() as f32, error as f32)
            })
            .unzip_into_vecs(&mut mean, &mut error);
        image.push(name.as_str(), mean);
        if replicates >= 2 {
            errors.push((format!("{STANDARD_ERROR}{name}"), error));
        }
    }
    for (name, error) in errors {
        image.push(name, error);
    }
    if let Some(counts) = counts {
        let all = |&count: &u32| (f64::from(count) * f64::from(replicates)) as f32;
        image.push(SAMPLES, counts.of_pixels().iter().map(all).collect());
    }
    image
}

impl ExactFilm {
    /// The picture after the replicates finished so far; NaN in all pixels if there is none.
    pub fn develop(&self, facts: RenderFacts) -> RenderedImage {
        let settings = self.settings();
        let size = settings.crop_size.to_array().map(|n| n as usize);
        let developed = RenderedImage {
            image: image_of(
                self.channels(),
                self.moments(),
                self.replicates(),
                size,
                self.counts(),
            ),
            frame: Frame {
                offset: settings.crop_offset.to_array().map(|n| n as i32),
                size: settings.size.to_array().map(|n| n as usize),
            },
            metadata: Some(Metadata::new(self, facts)),
        };
        developed.with_unlit_pixels()
    }
}

impl ExactFilm {
    /// The picture of a first replicate that was to have so many samples per pixel and was
    /// interrupted: every pixel is the mean of the samples that it has, without standard errors.
    /// `None` if a replicate is finished, or no sample is there.
    pub fn develop_unfinished(
        &mut self,
        facts: RenderFacts,
        samples: u32,
    ) -> Option<RenderedImage> {
        let unfinished = self.unfinished().filter(|_| self.replicates() == 0)?;
        let mut developed = self.develop(facts);
        let size = [developed.image.width(), developed.image.height()];
        developed.image = unfinished.image(self.channels(), size);
        let mut facts = unfinished.facts(samples);
        let mut metadata = developed.metadata?;
        metadata.spp = facts.mean as u64;
        // They are those of the picture.
        metadata.faults = std::mem::take(&mut facts.faults);
        metadata.unfinished = Some(facts);
        developed.metadata = Some(metadata);
        Some(developed)
    }
}

impl RenderedImage {
    /// The standard errors of a channel, if there are any.
    pub fn standard_error(&self, name: &str) -> Option<&[f32]> {
        self.image.channel(&format!("{STANDARD_ERROR}{name}"))
    }

    /// The same with the number of pixels in which no sample found light; parts do not count them.
    #[must_use]
    pub(crate) fn with_unlit_pixels(mut self) -> Self {
        let count = light_carriers::unlit(&self.image, &self.colours()).len() as u64;
        if let Some(metadata) = &mut self.metadata
            && metadata.part.is_none()
            && metadata.replicates > 0
        {
            metadata.unlit_pixels = count;
        }
        self
    }

    /// The names of the colour channels; of a file that does not say, those of linear Rec. 709 and CIE XYZ that are there.
    pub fn colours(&self) -> Vec<&str> {
        match &self.metadata {
            Some(metadata) => metadata.colours(),
            None => {
                let there = |name: &&str| self.image.channel(name).is_some();
                ["R", "G", "B", "X", "Y", "Z"]
                    .into_iter()
                    .filter(there)
                    .collect()
            }
        }
    }

    /// One figure for the noise of the picture,
    ///
    /// √( mean over pixels and colour channels of  s² / (m² + 0.01) ),
    ///
    /// with m the mean and s its standard error. The constant keeps dark pixels from deciding
    /// it. `None` without standard errors.
    pub fn mean_relative_standard_error(&self) -> Option<f64> {
        self.standard_error_relative_to(self)
    }

    /// The same with m of another picture of the same size.
    pub fn standard_error_relative_to(&self, other: &Self) -> Option<f64> {
        let mut sum = 0.0;
        let mut count = 0u32;
        for name in self.colours() {
            let (Some(means), Some(errors)) =
                (other.image.channel(name), self.standard_error(name))
            else {
                continue;
            };
            let squares = means.iter().zip(errors).map(|(&m, &s)| {
                let (m, s) = (f64::from(m), f64::from(s));
                s * s / (m * m + 0.01)
            });
            sum += squares.sum::<f64>() / means.len() as f64;
            count += 1;
        }
        (count > 0).then(|| (sum / f64::from(count)).sqrt())
    }

    /// Writes an EXR file of 32-bit floats; equal pictures give equal bytes.
    ///
    /// # Errors
    /// If the file cannot be written; nothing is left behind then.
    pub fn write_exr(&self, path: &Path) -> Result<(), Error> {
        let text = self
            .metadata
            .as_ref()
            .map(Metadata::to_json)
            .unwrap_or_default();
        exr::write(path, &self.image, self.frame, &text)
    }
}

/// Reads an EXR file, ours or of another program.
///
/// # Errors
/// If it is not an EXR file that can be read, or if it has metadata of ours that contradict
/// themselves or the image.
pub fn read_developed(path: &Path) -> Result<RenderedImage, ReadError> {
    // The exact sums of a part are not for looking at.
    let (document, _) = exr::read_with_integers(path, EXACT).map_err(ReadError::Image)?;
    of_document(document, path)
}

/// The picture of a file that was read.
pub(crate) fn of_document(
    document: exr::Document,
    path: &Path,
) -> Result<RenderedImage, ReadError> {
    let text = document.text.clone();
    let (image, frame) = document.flatten();
    let refused = |reason| ReadError::metadata(path, reason);
    let metadata = metadata_of(&text, [image.width(), image.height()]).map_err(refused)?;
    let missing = metadata.iter().flat_map(|metadata| &metadata.channels);
    if let Some(name) = missing
        .into_iter()
        .find(|name| image.channel(name).is_none())
    {
        return Err(refused(format!(
            "they name a channel `{name}` that is not there"
        )));
    }
    if let Some(what) = metadata
        .as_ref()
        .and_then(|metadata| contradiction(&image, metadata))
    {
        return Err(refused(format!("they are of another picture: {what}")));
    }
    Ok(RenderedImage {
        image,
        frame,
        metadata,
    })
}

/// The metadata from the text of a file with an image of this size; `None` without text.
pub(crate) fn metadata_of(text: &str, size: [usize; 2]) -> Result<Option<Metadata>, String> {
    if text.is_empty() {
        return Ok(None);
    }
    Metadata::from_json(text, size).map(Some)
}
