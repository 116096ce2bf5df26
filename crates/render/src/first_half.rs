//! The first half of a picture's replicates, which a denoiser gets beside the whole ([`crate::features`]).

use etalon_film::{ExactFilm, RenderFacts};
use etalon_images::Image;

/// The image of the first half of the replicates, once they are finished.
#[derive(Debug)]
pub(crate) struct FirstHalf {
    /// How many replicates are half of all.
    pub(crate) replicates: u32,
    /// Their image.
    pub(crate) image: Option<Image>,
}

impl FirstHalf {
    /// Of a render with so many replicates.
    pub(crate) fn of(replicates: u32) -> Self {
        Self {
            replicates: replicates / 2,
            image: None,
        }
    }

    /// Looks at a film after each of its replicates.
    pub(crate) fn see(&mut self, film: &ExactFilm) {
        if film.replicates() == self.replicates {
            self.image = Some(film.develop(RenderFacts::default()).image);
        }
    }
}
