//! The sink of a tile: a pixel's samples are summed here and delivered once.

use crate::outliers::Standing;
use crate::{ExactFilm, faults::FaultLog, splat::Taps};
use etalon_statistics::{Fault, Fixed128};
use etalon_transport::{Sink, TileSink};
use glam::{UVec2, Vec2};

/// Takes the samples of one tile's pixels, one pixel after the other.
#[derive(Debug)]
pub struct ExactTile<'f> {
    film: &'f ExactFilm,
    alone: bool,
    /// The pixel's sums: colours, alpha, the integrator's channels.
    sums: Vec<Fixed128>,
    colours: usize,
    from: UVec2,
    to: UVec2,
    pixel: UVec2,
    /// Samples begun in this pixel, and the number of the first of them in the replicate.
    samples: u32,
    first: u32,
    /// What all of the pixel's samples so far bring.
    standing: Standing,
    weight: f32,
    taps: Taps,
    faults: FaultLog,
}

impl<'f> ExactTile<'f> {
    pub(crate) fn new(film: &'f ExactFilm, from: UVec2, to: UVec2, alone: bool) -> Self {
        let begin = film.settings().crop_offset;
        let end = begin + film.settings().crop_size;
        assert!(
            from.cmpge(begin).all() && to.cmple(end).all(),
            "a tile lies within the crop"
        );
        Self {
            film,
            alone,
            sums: vec![Fixed128::ZERO; film.channels().len()],
            colours: film.settings().pixel_format.colours().len(),
            from,
            to,
            pixel: from,
            samples: 0,
            first: 0,
            standing: Standing::default(),
            weight: 1.0,
            taps: Taps::default(),
            faults: FaultLog::default(),
        }
    }

    #[cold]
    fn refuse(&mut self, source: &str, fault: Fault) {
        let sample = self.samples.checked_sub(1).map(|n| self.first + n);
        let offence = self.film.offence(self.pixel, sample, source, fault);
        self.faults.note(offence);
    }

    /// Notes what the sample brings.
    #[inline]
    fn bring(&mut self, [r, g, b]: [f32; 3], weight: f32) {
        let sample = (self.first + self.samples).wrapping_sub(1);
        self.standing.bring(sample, r.max(g).max(b) * weight);
    }

    fn add(&mut self, channel: usize, value: f32) {
        if let Err(fault) = self.sums[channel].add(value * self.weight) {
            let film = self.film;
            self.refuse(&film.channels()[channel], fault);
        }
    }
}

impl Sink for ExactTile<'_> {
    #[inline]
    fn radiance(&mut self, rgb: [f32; 3], alpha: f32) {
        let format = self.film.settings().pixel_format;
        let colour = format.convert(rgb);
        match fixed(&colour[..self.colours], self.weight) {
            Ok(terms) => {
                self.bring(rgb, self.weight.abs());
                for (channel, term) in terms.into_iter().enumerate().take(self.colours) {
                    if let Err(fault) = self.sums[channel].merge(term) {
                        self.refuse("radiance", fault);
                    }
                }
            }
            Err(fault) => self.refuse("radiance", cause(rgb).unwrap_or(fault)),
        }
        if format.has_alpha() {
            self.add(self.colours, alpha);
        }
    }

    fn splat(&mut self, raster: Vec2, rgb: [f32; 3]) {
        let colour = self.film.settings().pixel_format.convert(rgb);
        let outcome = match cause(rgb) {
            Some(fault) => Err(fault),
            None => self.taps.spread(self.film, raster, &colour[..self.colours]),
        };
        match outcome {
            Ok(()) => self.bring(rgb, 1.0),
            Err(fault) => self.refuse("splat", fault),
        }
    }

    #[inline]
    fn channel(&mut self, index: usize, value: f32) {
        let alpha = usize::from(self.film.settings().pixel_format.has_alpha());
        self.add(self.colours + alpha + index, value);
    }
}

impl TileSink for ExactTile<'_> {
    #[inline]
    fn begin_sample(&mut self, pixel: UVec2, weight: f32) {
        if pixel != self.pixel || self.samples == 0 {
            self.begin_pixel(pixel);
        }
        self.samples += 1;
        self.weight = weight;
    }
}

impl ExactTile<'_> {
    #[cold]
    fn begin_pixel(&mut self, pixel: UVec2) {
        assert!(
            pixel.cmpge(self.from).all() && pixel.cmplt(self.to).all(),
            "pixel {pixel} is not in this tile"
        );
        self.end_pixel();
        self.pixel = pixel;
        (self.first, self.standing) = self.film.progress(pixel);
    }

    fn end_pixel(&mut self) {
        if self.samples > 0 {
            self.film
                .deliver(self.pixel, self.alone, &mut self.sums, &mut self.faults);
            let samples = self.first + self.samples;
            self.film.advance(self.pixel, samples, &self.standing);
            self.standing = Standing::default();
            self.samples = 0;
        }
    }
}

impl Drop for ExactTile<'_> {
    fn drop(&mut self) {
        self.end_pixel();
        self.film.report(std::mem::take(&mut self.faults));
    }
}

/// The weighted colours in fixed point: all of them or none, so that one bad component does not
/// leave a sample half counted.
#[inline]
fn fixed(colours: &[f32], weight: f32) -> Result<[Fixed128; 3], Fault> {
    let mut terms = [Fixed128::ZERO; 3];
    for (term, colour) in terms.iter_mut().zip(colours) {
        *term = Fixed128::from_f32(colour * weight)?;
    }
    Ok(terms)
}

/// What is wrong with a colour before it was converted, which may turn one fault into another.
fn cause(rgb: [f32; 3]) -> Option<Fault> {
    let sum: f32 = rgb.iter().map(|x| x * 0.0).sum();
    if sum == 0.0 {
        None
    } else if rgb.iter().any(|x| x.is_nan()) {
        Some(Fault::NotANumber)
    } else {
        Some(Fault::Infinite)
    }
}
