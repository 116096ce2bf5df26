//! The film as the renderer sees it: where samples lie, how many there are, and where they go.

use crate::footprint::Footprint;
use crate::layout::Divisor;
use crate::{ExactFilm, ExactTile};
use etalon_transport::{Film, FilmSample, Placing};
use glam::{UVec2, Vec2};

impl Placing for ExactFilm {
    #[inline]
    fn place(&self, pixel: UVec2, u: Vec2) -> FilmSample {
        if self.footprint().is_some() {
            return ().place(pixel, u);
        }
        self.place_alone(pixel, u)
    }

    #[inline]
    fn place_alone(&self, pixel: UVec2, u: Vec2) -> FilmSample {
        let (offset, weight) = self.filter().sample(u);
        let raster = pixel.as_ivec2().as_vec2() + 0.5 + offset;
        FilmSample { raster, weight }
    }

    fn shares_samples(&self) -> bool {
        self.footprint().is_some()
    }

    #[inline]
    fn dealt(&self, pixel: UVec2, even: u32) -> u32 {
        let Some(counts) = self.counts() else {
            return even;
        };
        let origin = self.settings().crop_offset;
        let inside = self.nearest((pixel.as_ivec2()) - origin.as_ivec2());
        counts.of_pixels()[self.index(inside - origin)]
    }
}

impl Film for ExactFilm {
    type Tile<'f> = ExactTile<'f>;

    fn origin(&self) -> UVec2 {
        self.settings().crop_offset
    }

    #[expect(
        clippy::misnamed_getters,
        reason = "to a renderer, the film is its crop"
    )]
    fn size(&self) -> UVec2 {
        self.settings().crop_size
    }

    fn margin(&self) -> f32 {
        self.filter().margin()
    }

    fn rim(&self) -> u32 {
        self.footprint().map_or(0, Footprint::reach)
    }

    fn light_paths(&self) -> u32 {
        match self.filter().catches_splats() {
            true => (self.settings().crop_size + 2 * self.rim()).element_product(),
            false => 0,
        }
    }

    fn tile(&self, from: UVec2, to: UVec2, alone: bool) -> ExactTile<'_> {
        ExactTile::new(self, from, to, alone)
    }

    fn done(&self, pixel: UVec2) -> u32 {
        let index = self.index(pixel - self.settings().crop_offset);
        self.running.samples(index)
    }

    fn end_replicate(&mut self, samples: u32) {
        let counts = self.counts.take();
        match &counts {
            Some(counts) if self.footprint().is_some() => {
                let divisor = Divisor::Even(counts.rounded_mean().into());
                self.finish_replicate(divisor, samples.into());
            }
            Some(counts) => {
                self.finish_replicate(Divisor::OfPixels(counts.of_pixels()), samples.into());
            }
            None if samples == 0 => return,
            None => self.finish_replicate(Divisor::Even(samples.into()), samples.into()),
        }
        self.counts = counts;
    }
}
