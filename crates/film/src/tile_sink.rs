//! The sink of a tile: a pixel's samples are summed here and delivered once, and those that pixels share are
//! summed for the whole tile ([`crate::spread`]).

use crate::outliers::DominantSample;
use crate::spread::{Spread, Term};
use crate::taps::Taps;
use crate::{ExactFilm, faults::FaultLog};
use etalon_statistics::{Fixed128, InvalidValue};
use etalon_transport::{Film, FilmSample, Sink, TileSink};
use glam::{IVec2, UVec2, Vec2};

/// Takes the samples of one tile's pixels, one pixel after the other.
#[derive(Debug)]
pub struct ExactTile<'f> {
    film: &'f ExactFilm,
    alone: bool,
    /// The pixel's sums: colours, alpha, the integrator's channels, and what samples count if the film divides by it.
    sums: Vec<Fixed128>,
    /// The footprint of samples if pixels share them.
    spread: Option<Box<Spread>>,
    spreading: bool,
    /// The film's first colour channel that samples bring now, and how many they bring.
    first_colour: usize,
    colours: usize,
    from: UVec2,
    to: UVec2,
    pixel: UVec2,
    /// The place of the current sample's pixel: that, or one around the film.
    place: IVec2,
    /// Samples begun in this pixel, and the number of the first of them in the replicate.
    samples: u32,
    first: u32,
    /// The dominant sample of the pixel so far.
    standing: DominantSample,
    weight: f32,
    /// Factor on the weights of this pixel's samples, for uneven numbers.
    dealt: f32,
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
        let sums = film.sums_per_pixel();
        let spread = film.footprint().map(|footprint| {
            let within = [from - begin, to - begin].map(|corner| corner.as_ivec2());
            let size = film.settings().crop_size.as_ivec2();
            Box::new(Spread::new(footprint, within, size, sums))
        });
        Self {
            film,
            alone,
            sums: vec![Fixed128::ZERO; sums],
            spread,
            spreading: false,
            first_colour: 0,
            colours: film.colours().min(3),
            from,
            to,
            pixel: from,
            place: from.as_ivec2(),
            samples: 0,
            first: 0,
            standing: DominantSample::default(),
            weight: 1.0,
            dealt: 1.0,
            taps: Taps::default(),
            faults: FaultLog::default(),
        }
    }

    #[cold]
    fn refuse(&mut self, source: &str, fault: InvalidValue) {
        let sample = self.samples.checked_sub(1).map(|n| self.first + n);
        let offence = self.film.offence(self.place, sample, source, fault);
        self.faults.note(offence);
    }

    /// Notes what the sample brings.
    #[inline]
    fn bring(&mut self, [r, g, b]: [f32; 3], weight: f32) {
        if self.place != self.pixel.as_ivec2() {
            return;
        }
        let sample = (self.first + self.samples).wrapping_sub(1);
        self.standing.bring(sample, r.max(g).max(b) * weight);
    }

    fn add(&mut self, channel: usize, value: f32) {
        let value = value * self.weight;
        let outcome = match &mut self.spread {
            Some(spread) if self.spreading => {
                Term::new(value).map(|term| spread.add(channel, [term]))
            }
            _ => self.sums[channel].add(value),
        };
        if let Err(fault) = outcome {
            let film = self.film;
            self.refuse(&film.channels()[channel], fault);
        }
    }

    /// Adds a colour that pixels share: all of it or nothing.
    #[inline]
    fn share(&mut self, rgb: [f32; 3], colour: [f32; 3]) {
        let Some(spread) = &mut self.spread else {
            return;
        };
        let [x, y, z] = colour.map(|value| Term::new(value * self.weight));
        let outcome = match self.colours {
            1 => x.map(|x| spread.add(self.first_colour, [x])),
            2 => (|| {
                spread.add(self.first_colour, [x?, y?]);
                Ok(())
            })(),
            _ => (|| {
                spread.add(self.first_colour, [x?, y?, z?]);
                Ok(())
            })(),
        };
        match outcome {
            Ok(()) => {
                let most = spread.most() * (self.weight / self.dealt).abs();
                self.bring(rgb, most);
            }
            Err(fault) => self.refuse("radiance", cause(rgb).unwrap_or(fault)),
        }
    }
}

impl Sink for ExactTile<'_> {
    #[inline]
    fn radiance(&mut self, rgb: [f32; 3], alpha: f32) {
        let format = self.film.settings().pixel_format;
        let mut colour = format.convert(rgb);
        if self.spreading {
            self.share(rgb, colour);
            if format.has_alpha() {
                self.add(self.film.colours(), alpha);
            }
            return;
        }
        colour[self.colours.min(3)..].fill(0.0);
        match fixed(colour, self.weight) {
            Ok(terms) => {
                self.bring(rgb, self.weight.abs());
                let sums = &mut self.sums[self.first_colour..][..self.colours];
                let refused = (sums.iter_mut().zip(terms))
                    .filter_map(|(sum, term)| sum.merge(term).err())
                    .fold((0, None), |(count, _), fault| (count + 1, Some(fault)));
                if let (count, Some(fault)) = refused {
                    (0..count).for_each(|_| self.refuse("radiance", fault));
                }
            }
            Err(fault) => self.refuse("radiance", cause(rgb).unwrap_or(fault)),
        }
        if format.has_alpha() {
            self.add(self.film.colours(), alpha);
        }
    }

    fn splat(&mut self, raster: Vec2, rgb: [f32; 3]) {
        let colour = self.film.settings().pixel_format.convert(rgb);
        let outcome = match cause(rgb) {
            Some(fault) => Err(fault),
            None => (self.taps).spread(
                self.film,
                raster,
                &colour[..self.colours],
                self.first_colour,
            ),
        };
        match outcome {
            Ok(()) => self.bring(rgb, 1.0),
            Err(fault) => self.refuse("splat", fault),
        }
    }

    #[inline]
    fn channel(&mut self, index: usize, value: f32) {
        let alpha = usize::from(self.film.settings().pixel_format.has_alpha());
        self.add(self.film.colours() + alpha + index, value);
    }
}

impl TileSink for ExactTile<'_> {
    #[inline]
    fn begin_sample(&mut self, pixel: UVec2, weight: f32) {
        if pixel != self.pixel || self.samples == 0 {
            self.begin_pixel(pixel);
        }
        self.samples += 1;
        self.place = pixel.as_ivec2();
        self.weight = weight * self.dealt;
        self.spreading = false;
        if self.sums.len() > self.film.channels().len() {
            self.add(self.sums.len() - 1, 1.0);
        }
    }

    #[inline]
    fn begin_placed(&mut self, pixel: UVec2, placement: &FilmSample) {
        if self.spread.is_none() {
            return self.begin_sample(pixel, placement.weight);
        }
        self.begin_spread(pixel, placement);
    }

    fn select_group(&mut self, group: usize) {
        self.first_colour = 3 * group;
        self.colours = (self.film.colours() - self.first_colour).min(3);
    }

    fn radiance_alone(&mut self, rgb: [f32; 3], alpha: f32) {
        let spreading = std::mem::replace(&mut self.spreading, false);
        self.radiance(rgb, alpha);
        self.spreading = spreading;
    }
}

impl ExactTile<'_> {
    fn begin_spread(&mut self, pixel: UVec2, placement: &FilmSample) {
        let film = self.film;
        let (Some(spread), Some(footprint)) = (&mut self.spread, film.footprint()) else {
            return;
        };
        let place = pixel.as_ivec2();
        let within = place - film.settings().crop_offset.as_ivec2();
        let offset = placement.raster - place.as_vec2() - 0.5;
        spread.place(footprint, within, offset);
        let own = film.nearest(within);
        if own != self.pixel || self.samples == 0 {
            self.begin_pixel(own);
        }
        if own == pixel {
            self.samples += 1;
        }
        self.place = place;
        self.weight = placement.weight * self.dealt;
        self.spreading = true;
        let channels = film.channels().len();
        if self.sums.len() > channels {
            // `add` names channels where it refuses; weights are always sound.
            if let (Some(spread), Ok(term)) = (&mut self.spread, Term::new(self.weight)) {
                spread.add(channels, [term]);
            }
        }
    }

    /// Adds what pixels share to the film.
    fn end_tile(&mut self) {
        let Some(spread) = &mut self.spread else {
            return;
        };
        let film = self.film;
        let reach = IVec2::splat(film.rim() as i32);
        let origin = film.settings().crop_offset;
        let [from, to] = [self.from, self.to].map(|corner| (corner - origin).as_ivec2());
        let end = film.settings().crop_size.as_ivec2();
        // Other tiles reach the pixels around this one, and those at its sides.
        let low = IVec2::select(from.cmpgt(IVec2::ZERO), from + reach, from);
        let high = IVec2::select(to.cmplt(end), to - reach, to);
        let (alone, faults) = (self.alone, &mut self.faults);
        spread.deliver(|pixel, sums| {
            let inside = pixel.cmpge(low).all() && pixel.cmplt(high).all();
            let place = pixel.as_uvec2() + origin;
            film.deliver(place, alone && inside, sums, faults);
        });
    }

    #[cold]
    fn begin_pixel(&mut self, pixel: UVec2) {
        assert!(
            pixel.cmpge(self.from).all() && pixel.cmplt(self.to).all(),
            "pixel {pixel} is not in this tile"
        );
        self.end_pixel();
        self.pixel = pixel;
        (self.first, self.standing) = self.film.progress(pixel);
        self.dealt = self.film.deal_weight(pixel);
    }

    fn end_pixel(&mut self) {
        if self.samples > 0 {
            // Tiles around this one may add what their samples share with this pixel at any time.
            let alone = self.alone && self.spread.is_none();
            self.film
                .deliver(self.pixel, alone, &mut self.sums, &mut self.faults);
            let samples = self.first + self.samples;
            self.film.advance(self.pixel, samples, &self.standing);
            self.standing = DominantSample::default();
            self.samples = 0;
        }
    }
}

impl Drop for ExactTile<'_> {
    fn drop(&mut self) {
        self.end_pixel();
        self.end_tile();
        self.film.report(std::mem::take(&mut self.faults));
    }
}

/// The weighted colours in fixed point: all of them or none, so that one bad component does not
/// leave a sample half counted.
#[inline]
fn fixed(colour: [f32; 3], weight: f32) -> Result<[Fixed128; 3], InvalidValue> {
    let [x, y, z] = colour.map(|value| Fixed128::from_f32(value * weight));
    Ok([x?, y?, z?])
}

/// The fault of a colour before its conversion, which may turn one fault into another.
fn cause(rgb: [f32; 3]) -> Option<InvalidValue> {
    let sum: f32 = rgb.iter().map(|x| x * 0.0).sum();
    if sum == 0.0 {
        None
    } else if rgb.iter().any(|x| x.is_nan()) {
        Some(InvalidValue::NotANumber)
    } else {
        Some(InvalidValue::Infinite)
    }
}
