//! Films and sinks: the destination of samples.

use glam::{UVec2, Vec2};

/// A named channel beside the colour.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Channel(pub String);

/// A film position drawn for a sample.
#[derive(Clone, Copy, Debug)]
pub struct FilmSample {
    /// Pixels of the whole film.
    pub raster: Vec2,
    /// Weight of the sample: 1, or ±(∫|f|) for filters with negative lobes.
    pub weight: f32,
}

/// Receives the contributions of one sample.
///
/// Colours are linear Rec.709 on Mitsuba's scale. The sink applies the sample's weight, counts
/// non-finite values instead of swallowing them, and normalises by the number of samples.
pub trait Sink {
    /// Adds the radiance found for the current pixel, and its alpha (from 0 to 1). Called exactly
    /// once per camera sample.
    fn radiance(&mut self, rgb: [f32; 3], alpha: f32);

    /// Adds a contribution at any film position (already divided by everything that was
    /// sampled); the sink spreads it with the film's filter.
    fn splat(&mut self, raster: Vec2, rgb: [f32; 3]);

    /// Adds a value to one of the integrator's named channels for the current pixel.
    fn channel(&mut self, index: usize, value: f32);
}

/// A sink for the pixels of one tile.
pub trait TileSink: Sink {
    /// Begins a sample of `pixel` (of the whole film) with the weight `weight` (see [`FilmSample`]),
    /// which contributes to this pixel only. The samples of a pixel come one after the other.
    fn begin_sample(&mut self, pixel: UVec2, weight: f32);

    /// Begins a sample of `pixel` at this place. It contributes to all pixels under the filter if pixels share samples
    /// (see [`Placing::shares_samples`]). Samples of pixels around the film come after one of the nearest pixel on it.
    #[inline]
    fn begin_placed(&mut self, pixel: UVec2, placement: &FilmSample) {
        self.begin_sample(pixel, placement.weight);
    }

    /// Selects the bands 3 × `group` to 3 × `group` + 2 for what is added next. A colour film has one group.
    #[inline]
    fn select_group(&mut self, _group: usize) {}

    /// Adds radiance and alpha of the current sample to its own pixel only, without the filter. Not for samples of
    /// pixels around the film.
    #[inline]
    fn radiance_alone(&mut self, rgb: [f32; 3], alpha: f32) {
        self.radiance(rgb, alpha);
    }
}

/// Positions of samples on the film, and their number.
pub trait Placing: Sync {
    /// Draws a position for a sample of `pixel`: from the reconstruction filter, or evenly in the pixel if pixels share
    /// samples. Pixels left of the film or above it have negative coordinates, modulo 2³².
    fn place(&self, pixel: UVec2, u: Vec2) -> FilmSample;

    /// Draws a position for a sample of `pixel` from the reconstruction filter, even if pixels share samples: the sample
    /// contributes to this pixel only.
    #[inline]
    fn place_alone(&self, pixel: UVec2, u: Vec2) -> FilmSample {
        self.place(pixel, u)
    }

    /// Whether a sample counts for all pixels under the filter. The picture of a constant is a constant then only as far as
    /// positions are stratified.
    #[inline]
    fn shares_samples(&self) -> bool {
        false
    }

    /// Number of samples of a pixel of the whole film in a replicate; `even` if they are distributed
    /// evenly. Only estimators that neither splat nor take several passes may have another distribution.
    #[inline]
    fn dealt(&self, _pixel: UVec2, even: u32) -> u32 {
        even
    }

    /// Whether the render was asked to stop. The result of a preparation is then not used and may be
    /// incomplete; long preparations check this regularly.
    #[inline]
    fn stopped(&self) -> bool {
        false
    }
}

/// Evenly, in a box of the size of a pixel.
impl Placing for () {
    fn place(&self, pixel: UVec2, u: Vec2) -> FilmSample {
        FilmSample {
            raster: pixel.as_ivec2().as_vec2() + u,
            weight: 1.0,
        }
    }
}

/// A film: pixels that accumulate exactly.
pub trait Film: Placing {
    /// The sink of a tile.
    type Tile<'f>: TileSink
    where
        Self: 'f;

    /// First pixel of the cropped region.
    fn origin(&self) -> UVec2;
    /// Size of the cropped region (pixels).
    fn size(&self) -> UVec2;
    /// Distance (pixels) beyond the film up to which splats contribute.
    fn margin(&self) -> f32;
    /// Width (pixels) of the border around the film that is sampled too, for the pixels within. A border pixel has as
    /// many samples as the nearest pixel of the film, one after each of that pixel's.
    fn rim(&self) -> u32 {
        0
    }
    /// How many light paths are drawn for each sample of a pixel, over the whole film: one per pixel, around it too; none
    /// where the reconstruction filter is so narrow that splats would practically never find a pixel.
    fn light_paths(&self) -> u32;
    /// A sink for the pixels in [`from`, `to`) of the whole film; it delivers on drop. `alone`
    /// promises that meanwhile nothing else adds to these pixels, no other tile and no splat.
    fn tile(&self, from: UVec2, to: UVec2, alone: bool) -> Self::Tile<'_>;
    /// Number of samples that a pixel of the whole film already has in the current replicate. A resumed
    /// render continues after them.
    fn done(&self, _pixel: UVec2) -> u32 {
        0
    }
    /// Called between two rounds over the film, when no tile is open.
    fn end_round(&mut self) {}
    /// Ends a replicate of `samples` samples per pixel (as many light paths per pixel for
    /// splats; of as many as [`Placing::dealt`] deals to each): its means join the statistics.
    fn end_replicate(&mut self, samples: u32);
}
