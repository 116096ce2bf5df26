//! A film whose sums are exact, for tests of the render loop.

use etalon_transport::{Film, FilmSample, Placing, Sink, TileSink};
use glam::{UVec2, Vec2};
use std::sync::Mutex;

/// A film that adds whole numbers.
pub(crate) struct Tally {
    pub(crate) origin: UVec2,
    pub(crate) size: UVec2,
    /// Per pixel: sum, samples, splats.
    pub(crate) pixels: Mutex<Vec<[i64; 3]>>,
    /// The pixels after each replicate.
    pub(crate) replicates: Vec<Vec<[i64; 3]>>,
    /// Tiles, as their first pixel and the one beyond their last, in the order in which they were begun.
    pub(crate) tiles: Mutex<Vec<[UVec2; 2]>>,
}

impl Tally {
    pub(crate) fn new(origin: UVec2, size: UVec2) -> Self {
        Self {
            origin,
            size,
            pixels: Mutex::new(vec![[0; 3]; (size.x * size.y) as usize]),
            replicates: Vec::new(),
            tiles: Mutex::default(),
        }
    }

    /// Samples of the replicate that is not finished.
    pub(crate) fn samples(&self) -> u64 {
        let pixels = self.pixels.lock().expect("no panic while it is held");
        pixels.iter().map(|pixel| pixel[1] as u64).sum()
    }

    /// The pass in which it goes on.
    pub(crate) fn first_pass(&self, samples_per_pass: Option<u32>) -> u32 {
        let pixels = self.pixels.lock().expect("no panic while it is held");
        let least = pixels.iter().map(|pixel| pixel[1] as u32).min();
        least.unwrap_or(0) / samples_per_pass.unwrap_or(4).max(1)
    }

    /// How many tiles each pixel was in.
    pub(crate) fn visits(&self) -> Vec<u32> {
        let mut visits = vec![0; (self.size.x * self.size.y) as usize];
        for &[from, to] in self.tiles.lock().expect("no panic").iter() {
            for y in from.y..to.y {
                for x in from.x..to.x {
                    visits[self.index(UVec2::new(x, y))] += 1;
                }
            }
        }
        visits
    }

    pub(crate) fn index(&self, pixel: UVec2) -> usize {
        let at = pixel - self.origin;
        (at.y * self.size.x + at.x) as usize
    }

    pub(crate) fn add(&self, index: usize, part: usize, value: i64) {
        self.pixels.lock().expect("no panic while it is held")[index][part] += value;
    }
}

/// A value as a whole number of 2⁻²⁴.
fn whole(value: f32) -> i64 {
    (value * 16_777_216.0) as i64
}

pub(crate) struct TallyTile<'f> {
    film: &'f Tally,
    pixel: UVec2,
    from: UVec2,
    to: UVec2,
}

impl Sink for TallyTile<'_> {
    fn radiance(&mut self, [value, ..]: [f32; 3], _: f32) {
        let index = self.film.index(self.pixel);
        self.film.add(index, 0, whole(value));
        self.film.add(index, 1, 1);
    }
    fn splat(&mut self, raster: Vec2, [value, ..]: [f32; 3]) {
        let index = self.film.index(raster.as_uvec2());
        self.film.add(index, 2, whole(value));
    }
    fn channel(&mut self, _: usize, _: f32) {}
}

impl TileSink for TallyTile<'_> {
    fn begin_sample(&mut self, pixel: UVec2, weight: f32) {
        assert!(pixel.cmpge(self.from).all() && pixel.cmplt(self.to).all());
        self.pixel = pixel;
        assert_eq!(weight, 2.0);
    }
}

impl Placing for Tally {
    fn place(&self, pixel: UVec2, u: Vec2) -> FilmSample {
        FilmSample {
            raster: pixel.as_vec2() + u,
            weight: 2.0,
        }
    }
}

impl Film for Tally {
    type Tile<'f> = TallyTile<'f>;
    fn origin(&self) -> UVec2 {
        self.origin
    }
    fn size(&self) -> UVec2 {
        self.size
    }
    fn margin(&self) -> f32 {
        1.5
    }

    fn light_paths(&self) -> u32 {
        self.size().element_product()
    }
    fn tile(&self, from: UVec2, to: UVec2, _: bool) -> TallyTile<'_> {
        self.tiles
            .lock()
            .expect("no panic while it is held")
            .push([from, to]);
        TallyTile {
            film: self,
            pixel: from,
            from,
            to,
        }
    }
    fn done(&self, pixel: UVec2) -> u32 {
        let index = self.index(pixel);
        self.pixels.lock().expect("no panic while it is held")[index][1] as u32
    }
    fn end_replicate(&mut self, samples: u32) {
        let pixels = self.pixels.get_mut().expect("no panic while it is held");
        assert!(pixels.iter().all(|p| p[1] == i64::from(samples)));
        let blank = vec![[0; 3]; pixels.len()];
        self.replicates.push(std::mem::replace(pixels, blank));
    }
}
