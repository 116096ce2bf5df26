//! Do two images agree, as `etalon compare` has it: whether they can be judged at all, and then what [`crate::judge`]
//! says.

use crate::judge::{self, ImageComparison, Tolerances};
use crate::report::comparison;
use etalon_film::{LightCarriers, RenderedImage};
use etalon_images::{Channel, Image};
use etalon_statistics::Verdict;

/// What came of comparing two images.
#[derive(Clone, Debug)]
pub enum Compared {
    /// They hold the same numbers in every channel: they are not two estimates, and there is nothing to test.
    Identical,
    /// They cannot be judged, for this reason, which is no pass.
    Unfit(String),
    /// They were judged.
    Judged(ImageComparison),
}

impl Compared {
    /// Compares two images, which have these names in messages.
    ///
    /// # Errors
    /// One sentence, if they are bad input: of different sizes, or with pixels that are no finite numbers.
    pub fn new(
        images: [&RenderedImage; 2],
        names: &[String; 2],
        rules: Tolerances,
    ) -> Result<Self, String> {
        let [first, second] = images;
        let size = |image: &RenderedImage| (image.image.width(), image.image.height());
        let ((width, height), (other_width, other_height)) = (size(first), size(second));
        if (width, height) != (other_width, other_height) {
            let [a, b] = names;
            return Err(format!(
                "the images differ in size: {width} × {height} ({a}) and {other_width} × {other_height} ({b})"
            ));
        }
        let named = || names.iter().zip(images);
        let broken = |(name, image): (&String, &RenderedImage)| {
            Some(format!("{name}: {}", not_a_number(&image.image)?))
        };
        if let Some(message) = named().find_map(broken) {
            return Err(message);
        }
        if identical(&first.image, &second.image) {
            return Ok(Self::Identical);
        }
        for reason in [unfit, black] {
            let said = |(name, image)| Some(format!("{name} {}", reason(image)?));
            if let Some(reason) = named().find_map(said) {
                return Ok(Self::Unfit(reason));
            }
        }
        judge::judge(first, second, rules).map(Self::Judged)
    }

    /// The verdict.
    pub fn verdict(&self) -> Verdict {
        match self {
            Self::Identical => Verdict::Agrees,
            Self::Unfit(_) => Verdict::Undecided,
            Self::Judged(judgement) => judgement.verdict,
        }
    }

    /// A self-contained page (HTML).
    pub fn report(&self, [first, second]: [&RenderedImage; 2], names: &[String; 2]) -> String {
        match self {
            Self::Identical => comparison::identical(names.clone()),
            Self::Unfit(reason) => comparison::inconclusive(reason, first, second, names),
            Self::Judged(judgement) => comparison::judged(judgement, first, second, names),
        }
    }

    /// What one should know of the images to read the verdict.
    pub fn remarks(&self, images: [&RenderedImage; 2], names: &[String; 2]) -> Vec<String> {
        if !matches!(self, Self::Judged(_)) {
            return Vec::new();
        }
        let [first, second] = images;
        let seed = shared_seed(first, second).map(|seed| {
            format!(
                "both images were rendered with seed {seed}: what they share of their noise \
                 makes the comparison less sharp; another seed for one of them makes it sharper"
            )
        });
        let carriers = names.iter().zip(images).filter_map(|(name, image)| {
            let warning = LightCarriers::of(image).and_then(LightCarriers::warning)?;
            Some(format!("{name}: {warning}"))
        });
        let scenes = other_scenes(first, second);
        seed.into_iter().chain(scenes).chain(carriers).collect()
    }
}

/// Whether two images are of different scenes, as far as their files say.
fn other_scenes(first: &RenderedImage, second: &RenderedImage) -> Option<String> {
    let (first, second) = (first.metadata.as_ref()?, second.metadata.as_ref()?);
    // Another integrator by the command line is another hash, and the same scene.
    if first.scene_hash == second.scene_hash || first.integrator != second.integrator {
        return None;
    }
    Some(match first.scene == second.scene {
        true => format!(
            "the images are of different states of {}: its files or what `-D` said have changed",
            first.scene
        ),
        false => format!(
            "the images are of different scenes, {} and {}: what differs may be the scenes, not the estimators",
            first.scene, second.scene
        ),
    })
}

/// The first pixel that is not a finite number, if there is one.
fn not_a_number(image: &Image) -> Option<String> {
    image.channels().iter().find_map(|channel| {
        let (pixel, value) = (channel.samples.iter().enumerate()).find(|(_, v)| !v.is_finite())?;
        let (x, y) = (pixel % image.width(), pixel / image.width());
        Some(format!(
            "pixel ({x}, {y}) of channel `{}` is {value}: there is nothing to compare",
            channel.name
        ))
    })
}

/// Why an image does not carry what a judgement is made of, if it does not.
fn unfit(image: &RenderedImage) -> Option<String> {
    let Some(metadata) = &image.metadata else {
        return Some("was not written by Etalon: it has no replicates to judge by".to_owned());
    };
    if let Some(facts) = metadata
        .unfinished
        .as_ref()
        .filter(|_| metadata.replicates == 0)
    {
        return Some(format!(
            "was interrupted within its first replicate, at {:.1} of {} samples per pixel, and so has no \
             standard error: render it to its end",
            facts.mean, facts.samples_per_replicate
        ));
    }
    if let Some(method) = &metadata.denoised {
        return Some(format!(
            "was denoised ({method}): it is biased and has no replicates, and no verdict is made of it"
        ));
    }
    if metadata.replicates < 2 {
        return Some(
            "has a single replicate and so no standard error: render it with --replicates"
                .to_owned(),
        );
    }
    let faults = metadata.faults.total();
    if faults > 0 {
        return Some(format!(
            "left out {faults} contributions that were not finite or out of range: what it shows is not \
             what was to be rendered (`etalon info` says where)"
        ));
    }
    let whole = metadata.tiles(None);
    whole
        .is_none_or(|means| means.replicates() < 2)
        .then(|| "carries no tile means of its replicates: there is nothing to judge by".to_owned())
}

/// Why a black image cannot be judged, if it is one.
///
/// Its replicates do not spread, but that is no knowledge: of n samples that all found nothing, the chance of one to
/// find something is below ln(1/α)/n with confidence 1 − α, and what it would find has no bound. An estimator
/// that misses what is rare leaves the same picture as a scene without light.
fn black(image: &RenderedImage) -> Option<String> {
    let metadata = image.metadata.as_ref()?;
    let colours = image.colours();
    let mut planes = colours.iter().filter_map(|name| image.image.channel(name));
    let is_black = planes.all(|pixels| pixels.iter().all(|value| *value == 0.0));
    is_black.then(|| {
        format!(
            "is black: not one of its {} samples per pixel found light, and so nothing tells how far it may \
             be off; either there is none, or `{}` cannot find it or needs more samples",
            metadata.spp, metadata.integrator
        )
    })
}

/// Whether two images hold the same numbers in the same channels, bit for bit.
fn identical(a: &Image, b: &Image) -> bool {
    let same = |(a, b): (&Channel, &Channel)| {
        let bits = |c: &Channel| c.samples.iter().map(|v| v.to_bits()).collect::<Vec<u32>>();
        a.name == b.name && bits(a) == bits(b)
    };
    (a.width(), a.height(), a.channels().len()) == (b.width(), b.height(), b.channels().len())
        && a.channels().iter().zip(b.channels()).all(same)
}

/// The seed of both images, if it is the same and they are renders of the same scene. Replicates of other programs have
/// no hash of a scene, and no seed either.
fn shared_seed(a: &RenderedImage, b: &RenderedImage) -> Option<u64> {
    let (a, b) = (a.metadata.as_ref()?, b.metadata.as_ref()?);
    let alike = a.seed == b.seed && a.sampler == b.sampler && a.scene == b.scene;
    (alike && !a.scene_hash.is_empty()).then_some(a.seed)
}
