//! Spreading a splat with the film's filter.
//!
//! A splat at raster position x adds colour · f(xᵢ − x) · f(yⱼ − y) / (∫f)² to every pixel whose
//! centre (xᵢ, yⱼ) lies within the filter's radius on both axes. Its expectation is the same
//! integral that camera samples placed by the filter estimate.

use crate::{ExactFilm, PixelFilter};
use etalon_statistics::InvalidValue;
use glam::{UVec2, Vec2};

/// The pixels that one splat reaches along each axis; kept to be used again.
#[derive(Debug, Default)]
pub(crate) struct Taps {
    x: Vec<f32>,
    y: Vec<f32>,
}

impl Taps {
    /// Adds the splat to the film's colours from `first` on, within the crop window.
    pub(crate) fn spread(
        &mut self,
        film: &ExactFilm,
        raster: Vec2,
        colours: &[f32],
        first: usize,
    ) -> Result<(), InvalidValue> {
        if !raster.is_finite() {
            return Err(if raster.is_nan() {
                InvalidValue::NotANumber
            } else {
                InvalidValue::Infinite
            });
        }
        let settings = film.settings();
        let (origin, size) = (settings.crop_offset, settings.crop_size);
        let left = along(film.filter(), raster.x, origin.x, size.x, &mut self.x);
        let top = along(film.filter(), raster.y, origin.y, size.y, &mut self.y);
        let mut outcome = Ok(());
        for (row, fy) in self.y.iter().enumerate() {
            for (column, fx) in self.x.iter().enumerate() {
                let pixel = UVec2::new(left + column as u32, top + row as u32);
                let weight = fx * fy;
                let mut terms = [0.0; 3];
                for (term, colour) in terms.iter_mut().zip(colours) {
                    *term = colour * weight;
                }
                let added = film.splat(pixel, &terms[..colours.len()], first);
                outcome = outcome.and(added);
            }
        }
        outcome
    }
}

/// Puts the filter's values at the pixels around `x` that exist into `taps`; gives the first of
/// these pixels, counted from the crop's `origin`.
fn along(filter: &PixelFilter, x: f32, origin: u32, size: u32, taps: &mut Vec<f32>) -> u32 {
    taps.clear();
    // Pixel i has its centre at i + ½. In double precision these differences are exact.
    let x = f64::from(x) - f64::from(origin);
    let radius = filter.filter().radius();
    // The box's interval is open on one side: only the pixel that contains x is reached.
    let first = (x - radius - 0.5).floor() + 1.0;
    let last = (x + radius - 0.5).floor();
    let first = first.max(0.0);
    let last = last.min(f64::from(size) - 1.0);
    if !(first <= last) {
        return 0;
    }
    let mut centre = first + 0.5;
    while centre < last + 1.0 {
        taps.push(filter.density(x - centre) as f32);
        centre += 1.0;
    }
    first as u32
}
