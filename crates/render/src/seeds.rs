//! Pictures of one scene with different seeds, by any program, as one image with standard errors.
//!
//! The picture of a seed is a replicate: their mean is the image, their spread its standard error, and
//! [`crate::judge`] uses the means of their tiles. The only requirement is that the program's seeds are
//! independent.

use etalon_film::{BoxFilter, ExactFilm, FilmSettings, Filter, RenderFacts, RenderedImage};
use etalon_images::Image;
use etalon_sampling::ReplicateKind;

/// Pictures of different seeds, put together one after the other. Each has the channels `R`, `G`, `B`
/// in linear Rec. 709.
pub struct Seeds {
    film: ExactFilm,
    /// A hash over each picture's pixels, to tell those given twice.
    hashes: Vec<blake3::Hash>,
}

impl Seeds {
    /// Of pictures of this size (pixels), with pixels that share no samples.
    ///
    /// # Errors
    /// If there is no picture of this size.
    pub fn new([width, height]: [u32; 2]) -> Result<Self, String> {
        Self::on(FilmSettings::new(width, height, Filter::Box(BoxFilter)))
    }

    /// On the film of a scene.
    ///
    /// # Errors
    /// If its settings make no film.
    pub fn on(mut settings: FilmSettings) -> Result<Self, String> {
        settings.pixel_format = etalon_film::PixelFormat::Rgb;
        Ok(Self {
            film: ExactFilm::new(settings, &[]).map_err(|error| error.message)?,
            hashes: Vec::new(),
        })
    }

    /// Adds the picture of one more seed, of `samples` per pixel.
    ///
    /// # Errors
    /// If it has another size, lacks a channel, has pixels that are not finite, or was there before: a
    /// seed that counts twice would make the standard errors too small.
    pub fn add(&mut self, picture: &Image, samples: u64) -> Result<(), String> {
        let mut hasher = blake3::Hasher::new();
        for name in ["R", "G", "B"] {
            let plane = picture.channel(name);
            let plane = plane.ok_or_else(|| format!("it has no channel `{name}`"))?;
            if let Some(i) = plane.iter().position(|value| !value.is_finite()) {
                let [x, y] = [i % picture.width(), i / picture.width()];
                return Err(format!(
                    "pixel ({x}, {y}) has {name} = {}: leave this seed out, and see where that comes from",
                    plane[i]
                ));
            }
            plane.iter().for_each(|value| {
                hasher.update(&value.to_le_bytes());
            });
        }
        let hash = hasher.finalize();
        if let Some(before) = self.hashes.iter().position(|known| *known == hash) {
            return Err(format!(
                "it has the pixels of picture {}: each must be of a seed of its own",
                before + 1
            ));
        }
        self.film.add_replicate(picture, samples)?;
        self.hashes.push(hash);
        Ok(())
    }

    /// How many pictures there are.
    pub fn count(&self) -> usize {
        self.hashes.len()
    }

    /// The image, its standard errors and the means of its tiles.
    pub fn develop(self, facts: RenderFacts) -> RenderedImage {
        self.film.develop(RenderFacts {
            sampler: "independent".to_owned(),
            replicate_kind: ReplicateKind::Independent,
            ..facts
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(values: [f32; 2]) -> Image {
        let plane = |factor: f32| values.iter().map(|value| factor * value).collect();
        Image::new(2, 1)
            .with("R", plane(1.0))
            .with("G", plane(2.0))
            .with("B", plane(4.0))
    }

    #[test]
    fn seeds_have_their_mean_and_its_standard_error() {
        let mut seeds = Seeds::new([2, 1]).expect("a size");
        // Means 2 and 5; standard deviations 1 and 2 over √3 pictures.
        for values in [[1.0, 3.0], [2.0, 5.0], [3.0, 7.0]] {
            seeds.add(&picture(values), 16).expect("it fits");
        }
        let image = seeds.develop(RenderFacts::default());
        assert_eq!(image.image.channel("G"), Some(&[4.0, 10.0][..]));
        let errors = image.standard_error("B").expect("three seeds");
        let root = 3.0_f32.sqrt();
        // Mutant rejected: divided by the number of seeds and not by one less.
        for (error, known) in errors.iter().zip([4.0 / root, 8.0 / root]) {
            assert!((error / known - 1.0).abs() < 1e-6, "{error} {known}");
        }
        let facts = image.metadata.as_ref().expect("statistics");
        assert_eq!((facts.replicates, facts.spp), (3, 48));
    }

    #[test]
    fn what_would_spoil_the_standard_errors_is_refused() {
        let mut seeds = Seeds::new([2, 1]).expect("a size");
        seeds.add(&picture([1.0, 3.0]), 1).expect("it fits");
        let refused = |seeds: &mut Seeds, image: &Image| seeds.add(image, 1).expect_err("refused");
        let twice = refused(&mut seeds, &picture([1.0, 3.0]));
        assert!(twice.contains("the pixels of picture 1"), "{twice}");
        let lost = refused(&mut seeds, &picture([1.0, f32::NAN]));
        assert!(lost.contains("pixel (1, 0) has R = NaN"), "{lost}");
        let small = Image::new(1, 1).with("R", vec![1.0]);
        let small = small.with("G", vec![1.0]).with("B", vec![1.0]);
        let small = refused(&mut seeds, &small);
        assert!(small.contains("1 × 1 pixels, not 2 × 1"), "{small}");
        let grey = refused(&mut seeds, &Image::new(2, 1).with("R", vec![1.0; 2]));
        assert!(grey.contains("no channel `G`"), "{grey}");
        assert_eq!(seeds.count(), 1);
    }
}
