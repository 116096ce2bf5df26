//! Positions of samples on the film, also for preparations: stratification, and the border pixels around the film.

use crate::render::progress::Progress;
use etalon_sampling::{SampleId, SamplerKind, stratified_pair};
use etalon_transport::{Film, FilmSample, Pass, Placing};
use glam::{UVec2, Vec2};

/// A film and the progress that may cancel a preparation, as [`Placing`].
pub(crate) struct CancellablePlacing<'a, F> {
    pub(crate) film: &'a F,
    pub(crate) progress: &'a dyn Progress,
}

impl<F: Film> Placing for CancellablePlacing<'_, F> {
    fn place(&self, pixel: UVec2, u: Vec2) -> FilmSample {
        self.film.place(pixel, u)
    }

    fn place_alone(&self, pixel: UVec2, u: Vec2) -> FilmSample {
        self.film.place_alone(pixel, u)
    }

    fn shares_samples(&self) -> bool {
        self.film.shares_samples()
    }

    fn dealt(&self, pixel: UVec2, even: u32) -> u32 {
        self.film.dealt(pixel, even)
    }

    fn stopped(&self) -> bool {
        self.progress.cancelled()
    }
}

/// The numbers that place a sample on the film, from `numbers` of its sampler. If pixels share samples, positions are
/// stratified even for `independent`; otherwise a constant picture would be noisy.
#[inline]
pub(crate) fn position<P: Placing>(
    film: &P,
    kind: SamplerKind,
    sample: &SampleId,
    numbers: Vec2,
) -> Vec2 {
    match kind {
        SamplerKind::Independent if film.shares_samples() => stratified_pair(sample),
        _ => numbers,
    }
}

/// A pixel, and those around the film that are nearest to it, up to `rim` away; coordinates are modulo 2³².
pub(crate) fn around(pixel: UVec2, pass: &Pass, rim: u32) -> impl Iterator<Item = UVec2> {
    let (first, last) = (pass.origin, pass.origin + pass.size - 1);
    let ends = |pixel: u32, first: u32, last: u32| {
        let before = if pixel == first { rim } else { 0 };
        let after = if pixel == last { rim } else { 0 };
        (pixel.wrapping_sub(before), before + after + 1)
    };
    let (left, columns) = ends(pixel.x, first.x, last.x);
    let (top, rows) = ends(pixel.y, first.y, last.y);
    let others = (0..rows).flat_map(move |y| {
        (0..columns).map(move |x| UVec2::new(left.wrapping_add(x), top.wrapping_add(y)))
    });
    core::iter::once(pixel).chain(others.filter(move |other| *other != pixel))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every pixel of the film and around it comes once. Mutants: corners that come twice or never.
    #[test]
    fn every_pixel_around_the_film_is_next_to_one() {
        let pass = Pass {
            seed: 0,
            replicate: 0,
            number: 0,
            count: 1,
            samples: 1,
            replicates: 1,
            image_samples: 1,
            origin: UVec2::new(1, 0),
            size: UVec2::new(3, 1),
            margin: 2,
        };
        let film = (1..4).map(|x| UVec2::new(x, 0));
        let mut all: Vec<[i32; 2]> = film
            .flat_map(|pixel| around(pixel, &pass, 2))
            .map(|pixel| pixel.as_ivec2().to_array())
            .collect();
        all.sort_unstable();
        let expected = (-1..6).flat_map(|x| (-2..3).map(move |y| [x, y]));
        assert_eq!(all, expected.collect::<Vec<_>>());
        assert_eq!(around(UVec2::new(2, 0), &pass, 0).count(), 1);
    }
}
