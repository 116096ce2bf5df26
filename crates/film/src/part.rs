//! A part of a picture: some of its replicates, with the exact sums that merging takes.
//!
//! Sums over replicates are whole numbers, so those of the parts add up to exactly those of the
//! whole, in any order; means and standard errors are computed from them at the end, as if
//! nothing had been split. The file of a part is an image like any other (its means and
//! standard errors are of its own replicates) with planes of the sums beside ([`EXACT`]) and a
//! checksum over the sums and all the file says of itself.

use crate::disagreement::{Conflict, disagreements};
use crate::exact_sums::{EXACT, ExactSums};
use crate::metadata::recorded_seconds;
use crate::rendered_image::{self, ReadError, image_of, metadata_of};
use crate::unfinished::Unfinished;
use crate::{
    CheckpointFacts, ExactFilm, Metadata, PartFacts, RenderFacts, RenderedImage, ReplicateSet,
    SampleCounts,
};
use etalon_images::{Error, Frame, exr};
use std::io::{self, Seek, Write};
use std::path::Path;
use std::time::Duration;

/// The plane with the samples of each pixel in a replicate, where they are not dealt evenly.
const COUNTS: &str = "exact.samples";

/// Some replicates of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    metadata: Metadata,
    facts: PartFacts,
    sums: ExactSums,
    counts: Option<SampleCounts>,
    /// The unfinished replicate of a checkpoint.
    unfinished: Option<Unfinished>,
}

impl ExactFilm {
    /// The replicates finished so far as a part of a picture of `of` replicates.
    ///
    /// # Panics
    /// If no replicate is finished, or they are not among `of`, or these are more than
    /// [`PartFacts::MOST`].
    #[must_use]
    pub fn into_part(mut self, facts: RenderFacts, of: u32) -> Part {
        assert!(self.replicates() > 0, "a part has replicates");
        self.take_part(facts, of)
    }

    /// As [`ExactFilm::into_part`], but leaves an empty husk, and there may be no replicate.
    pub(crate) fn take_part(&mut self, facts: RenderFacts, of: u32) -> Part {
        let first = self.first_replicate();
        let replicates = ReplicateSet::new(first..first + self.replicates());
        assert!(
            replicates.end() <= of && of <= PartFacts::MOST,
            "a part has replicates of its whole"
        );
        Part {
            metadata: Metadata::new(self, facts),
            facts: PartFacts {
                of,
                replicates,
                checksum: String::new(),
            },
            sums: self.take_sums(),
            counts: self.counts().cloned(),
            unfinished: None,
        }
    }
}

impl Part {
    /// Its replicates.
    #[must_use]
    pub fn replicates(&self) -> &ReplicateSet {
        &self.facts.replicates
    }

    /// The replicates of the whole that it lacks.
    #[must_use]
    pub fn missing(&self) -> ReplicateSet {
        self.facts.replicates.missing(self.facts.of)
    }

    /// The samples of each pixel in a replicate, if they were not dealt evenly.
    #[must_use]
    pub fn counts(&self) -> Option<&SampleCounts> {
        self.counts.as_ref()
    }

    /// The metadata of its file.
    #[must_use]
    pub fn metadata(&self) -> Metadata {
        self.described()
    }

    /// Makes it a checkpoint, with the replicate that was being rendered and the samples per pixel
    /// that this was to have.
    pub(crate) fn mark(
        &mut self,
        checkpoint: CheckpointFacts,
        unfinished: Option<(Unfinished, u32)>,
    ) {
        self.metadata.checkpoint = Some(checkpoint);
        let (unfinished, facts) = unfinished
            .map(|(sums, samples)| {
                let facts = sums.facts(samples);
                (sums, facts)
            })
            .unzip();
        (self.unfinished, self.metadata.unfinished) = (unfinished, facts);
    }

    /// Its metadata, its exact sums, and those of the unfinished replicate.
    pub(crate) fn into_parts(self) -> (Metadata, ExactSums, Option<Unfinished>) {
        (self.metadata, self.sums, self.unfinished)
    }

    /// Adds the replicates of another part.
    ///
    /// # Errors
    /// If it is of another render or has replicates that are here already; nothing is added
    /// then.
    pub fn absorb(&mut self, other: &Self) -> Result<(), Conflict> {
        let mut disagreements = disagreements(&self.described(), &other.described());
        if !disagreements.is_empty() {
            return Err(Conflict::Disagreement(disagreements.swap_remove(0)));
        }
        let (here, there) = (&self.facts.replicates, &other.facts.replicates);
        let common = here.intersection(there);
        if !common.is_empty() {
            return Err(Conflict::Overlap(common));
        }
        self.sums
            .merge(&other.sums)
            .expect("so few replicates stay in range");
        let numbers: Vec<u32> = here.iter().chain(there.iter()).collect();
        let mut order: Vec<u32> = (0..numbers.len() as u32).collect();
        order.sort_unstable_by_key(|&index| numbers[index as usize]);
        let metadata = &mut self.metadata;
        for (means, others) in (metadata.tile_means.iter_mut()).zip(&other.metadata.tile_means) {
            means
                .append(others)
                .expect("the parts agree about their tiles");
            *means = means.chosen(&order);
        }
        if there.iter().next() < here.iter().next() {
            metadata.scene.clone_from(&other.metadata.scene);
        }
        metadata.faults.merge(other.metadata.faults.clone());
        metadata.outliers.merge(other.metadata.outliers.clone());
        metadata.replicates += other.metadata.replicates;
        metadata.spp += other.metadata.spp;
        metadata.seconds = match (metadata.seconds, other.metadata.seconds) {
            (Some(a), Some(b)) => Some(a + b),
            _ => None,
        };
        self.facts.replicates = here.union(there);
        // Only whole replicates are merged.
        self.unfinished = None;
        self.metadata.unfinished = None;
        Ok(())
    }

    /// The picture of these replicates, as that of a part; its time is the sum of all that
    /// went into it.
    #[must_use]
    pub fn picture(&self) -> RenderedImage {
        self.developed(self.described())
    }

    /// The picture that an unsplit render would have given, if no replicate is missing.
    #[must_use]
    pub fn whole(&self) -> Option<RenderedImage> {
        self.missing()
            .is_empty()
            .then(|| Metadata {
                checkpoint: None,
                unfinished: None,
                ..self.metadata.clone()
            })
            .map(|metadata| self.developed(metadata))
    }

    fn developed(&self, metadata: Metadata) -> RenderedImage {
        let size = metadata.film.crop_size.map(|n| n as usize);
        let moments = self.sums.moments();
        let seconds = metadata.seconds;
        let image = match &self.unfinished {
            Some(unfinished) if metadata.replicates == 0 => {
                unfinished.image(&metadata.channels, size)
            }
            _ => image_of(
                &metadata.channels,
                moments,
                metadata.replicates,
                size,
                self.counts.as_ref(),
            ),
        };
        let developed = RenderedImage {
            image,
            frame: Frame {
                offset: metadata.film.crop_offset.map(|n| n as i32),
                size: metadata.film.size.map(|n| n as usize),
            },
            metadata: Some(Metadata {
                seconds: seconds
                    .and_then(|seconds| Duration::try_from_secs_f64(seconds).ok())
                    .and_then(recorded_seconds),
                ..metadata
            }),
        };
        developed.with_unlit_pixels()
    }

    /// The metadata, those of a part, without checksum.
    fn described(&self) -> Metadata {
        Metadata {
            part: Some(self.facts.clone()),
            ..self.metadata.clone()
        }
    }

    fn checksum(&self) -> String {
        let described = Metadata {
            seconds: None,
            ..self.described()
        };
        let mut hasher = blake3::Hasher::new();
        hasher.update(described.to_json().as_bytes());
        self.sums.hash_into(&mut hasher);
        for count in self.counts.iter().flat_map(SampleCounts::of_pixels) {
            hasher.update(&count.to_le_bytes());
        }
        if let Some(unfinished) = &self.unfinished {
            unfinished.hash_into(&mut hasher);
        }
        hasher.finalize().to_hex().to_string()
    }

    /// Writes an EXR file; equal parts give equal bytes.
    ///
    /// # Errors
    /// If the file cannot be written; nothing is left behind then.
    pub fn write_exr(&self, path: &Path) -> Result<(), Error> {
        let (picture, text) = self.signed();
        let planes = self.planes();
        exr::write_with_integers(path, &picture.image, &planes, picture.frame, &text)
    }

    /// As [`Part::write_exr`], to anything that can seek.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn encode(&self, writer: impl Write + Seek) -> io::Result<()> {
        let (picture, text) = self.signed();
        let planes = self.planes();
        exr::encode_with_integers(writer, &picture.image, &planes, picture.frame, &text)
    }

    /// The exact sums, and the samples of each pixel if they were dealt unevenly.
    fn planes(&self) -> Vec<exr::IntegerPlane> {
        let mut planes = self.sums.planes(&self.metadata.channels);
        planes.extend(self.counts.iter().map(|counts| exr::IntegerPlane {
            name: COUNTS.to_owned(),
            samples: counts.of_pixels().to_vec(),
        }));
        let unfinished = self.unfinished.iter();
        planes.extend(unfinished.flat_map(|sums| sums.planes(&self.metadata.channels)));
        planes
    }

    /// The picture, and its metadata with the checksum.
    fn signed(&self) -> (RenderedImage, String) {
        let mut picture = self.picture();
        let metadata = picture.metadata.as_mut();
        if let Some(facts) = metadata.and_then(|metadata| metadata.part.as_mut()) {
            facts.checksum = self.checksum();
        }
        let text = picture.metadata.as_ref().map(Metadata::to_json);
        (picture, text.unwrap_or_default())
    }

    /// Reads the file of a part.
    ///
    /// # Errors
    /// If it is no EXR file, no part, or damaged.
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        let read = exr::read_with_integers(path, EXACT);
        Self::of_document(read.map_err(ReadError::Image)?, path)
    }

    /// As [`Part::read`], of a file's bytes; `path` is only for messages.
    ///
    /// # Errors
    /// As [`Part::read`].
    pub fn decode(bytes: &[u8], path: &Path) -> Result<Self, ReadError> {
        let read = exr::decode_with_integers(bytes, path, EXACT);
        Self::of_document(read.map_err(ReadError::Image)?, path)
    }

    /// What the file of a part says of itself, without its pixels.
    ///
    /// # Errors
    /// As [`Part::read`], as far as it can be known.
    pub fn read_metadata(path: &Path) -> Result<Metadata, ReadError> {
        let header = exr::read_header(path).map_err(ReadError::Image)?;
        let refused = refusal(path);
        let [part] = &header.parts[..] else {
            return Err(refused(no_part(None)));
        };
        let metadata = metadata_of(&header.text, [part.width, part.height])
            .map_err(|reason| ReadError::metadata(path, reason))?;
        match metadata {
            Some(metadata) if metadata.part.is_some() => Ok(metadata),
            other => Err(refused(no_part(other.as_ref()))),
        }
    }

    fn of_document(
        (document, planes): (exr::Document, Vec<exr::IntegerPlane>),
        path: &Path,
    ) -> Result<Self, ReadError> {
        let picture = rendered_image::of_document(document, path)?;
        let refused = refusal(path);
        let pixels = picture.image.width() * picture.image.height();
        let mut metadata = match picture.metadata {
            Some(metadata) => metadata,
            None => return Err(refused(no_part(None))),
        };
        let Some(mut facts) = metadata.part.take() else {
            return Err(refused(no_part(Some(&metadata))));
        };
        let checksum = std::mem::take(&mut facts.checksum);
        let count = metadata.replicates;
        let counts = match &metadata.adaptive {
            None => None,
            Some(dealt) => {
                let plane = planes.iter().find(|plane| plane.name == COUNTS);
                let here = plane.filter(|plane| plane.samples.len() == pixels);
                let counts = here.and_then(|p| SampleCounts::new(p.samples.clone(), dealt.pilot));
                let Some(counts) = counts else {
                    return Err(refused(format!("it has no numbers of samples `{COUNTS}`")));
                };
                Some(counts)
            }
        };
        let colours = metadata.colours().len();
        let unfinished = (metadata.unfinished.as_ref())
            .map(|facts| {
                Unfinished::from_planes(&planes, facts, &metadata.channels, colours, pixels)
            })
            .transpose()
            .map_err(refused)?;
        let sums =
            ExactSums::from_planes(planes, &metadata.channels, pixels, count).map_err(refused)?;
        let part = Self {
            metadata,
            facts,
            sums,
            counts,
            unfinished,
        };
        if part.checksum() != checksum {
            return Err(refused(
                "its checksum is wrong: the file is damaged; render this part again".to_owned(),
            ));
        }
        Ok(part)
    }
}

fn refusal(path: &Path) -> impl Fn(String) -> ReadError + Copy {
    move |reason| ReadError::Part {
        path: path.to_owned(),
        reason,
    }
}

/// Why a file that may well be sound is not a part.
fn no_part(metadata: Option<&Metadata>) -> String {
    match metadata {
        Some(metadata) if metadata.replicates == 0 => {
            "its render was interrupted within the first replicate: it is not a part, which has \
             whole replicates"
                .to_owned()
        }
        Some(Metadata {
            denoised: Some(method),
            ..
        }) => format!("it was denoised ({method}), and holds no replicates"),
        Some(metadata) => format!(
            "it is a whole image of {} replicates, not a part (`etalon render --part I/N` renders \
             one): it does not hold the exact sums",
            metadata.replicates
        ),
        None => "it is not a part of an image rendered by Etalon".to_owned(),
    }
}
