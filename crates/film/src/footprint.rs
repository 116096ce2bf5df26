//! How much a sample counts for the pixels around it: the filter's density from a table.
//!
//! A density is evaluated for every row and column under the filter, for every sample, so it is
//! interpolated linearly between tabulated values. These are scaled so that the interpolated function
//! has the integral one: a constant picture is right in expectation, and the shape within 10⁻⁵.

use crate::Filter;

/// Cells of the table per pixel.
const CELLS: f64 = 512.0;

/// A filter's density over |x|.
#[derive(Clone, Debug)]
pub(crate) struct Footprint {
    radius: f32,
    per_pixel: f32,
    /// At equal steps over the radius, and one more: the density, and how much more it is at the next step.
    density: Box<[[f32; 2]]>,
    reach: u32,
    is_flat: bool,
}

impl Footprint {
    pub(crate) fn new(filter: &Filter) -> Self {
        let radius = filter.radius();
        let cells = (radius * CELLS).ceil().max(1.0);
        let step = radius / cells;
        // At the end itself a filter is zero by definition; what counts is the limit from inside.
        let inside = radius * (1.0 - 1e-12);
        let values: Vec<f64> = (0..=cells as u32)
            .map(|i| filter.eval((f64::from(i) * step).min(inside)))
            .collect();
        let ends = 0.5 * (values[0] + values[values.len() - 1]);
        let integral = 2.0 * step * (values.iter().sum::<f64>() - ends);
        let at = |i: usize| (values[i.min(values.len() - 1)] / integral) as f32;
        // Beyond the last, so that the cell of a distance that rounds up to the radius has two ends.
        let density: Vec<_> = (0..values.len())
            .map(|i| [at(i), at(i + 1) - at(i)])
            .collect();
        Self {
            radius: radius as f32,
            per_pixel: (cells / radius) as f32,
            is_flat: density.iter().all(|[value, _]| value.abs() < 11.0),
            density: density.into(),
            reach: (radius - 0.5).ceil().max(0.0) as u32,
        }
    }

    /// Whether products of two densities stay below 2⁷.
    #[inline]
    pub(crate) fn is_flat(&self) -> bool {
        self.is_flat
    }

    /// Reach of a sample beyond its own pixel (pixels).
    pub(crate) fn reach(&self) -> u32 {
        self.reach
    }

    /// f(x) / ∫f (pixel⁻¹).
    #[inline]
    fn density(&self, x: f32) -> f32 {
        let x = x.abs();
        if x > self.radius {
            return 0.0;
        }
        let place = x * self.per_pixel;
        let cell = place as u32;
        let [left, rise] = self.density[cell as usize];
        left + rise * (place - cell as f32)
    }

    /// Puts what a sample counts along one axis into `taps`, for the pixels that it reaches of those from `first` to
    /// `last`, counted from the sample's own; gives the first of them. `offset` is the sample's distance from its pixel's centre.
    #[inline]
    pub(crate) fn along(&self, offset: f32, [first, last]: [i32; 2], taps: &mut Vec<f32>) -> i32 {
        let first = first.max((offset - self.radius).ceil() as i32);
        let last = last.min((offset + self.radius).floor() as i32);
        let count = (last - first + 1).max(0) as usize;
        taps.resize(count, 0.0);
        for (pixel, tap) in (first..).zip(taps) {
            *tap = self.density(pixel as f32 - offset);
        }
        first
    }

    /// The share of a pixel's samples, evenly distributed over it, that counts for a pixel `0, 1, …, reach` away along
    /// one axis.
    pub(crate) fn shares(&self) -> Vec<f64> {
        const STEPS: u32 = 512;
        let place = |i: u32| ((f64::from(i) + 0.5) / f64::from(STEPS) - 0.5) as f32;
        (0..=self.reach)
            .map(|away| {
                let values = (0..STEPS).map(|i| f64::from(self.density(away as f32 - place(i))));
                values.sum::<f64>() / f64::from(STEPS)
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BoxFilter, CatmullRom, Gaussian, Lanczos, Mitchell, PixelFilter, Tent};

    /// Mutants: a table that ends at the radius with zero for `box`, one that is not normalised.
    #[test]
    fn the_table_is_the_filter() {
        let filters = [
            Filter::Box(BoxFilter),
            Filter::Tent(Tent::new(0.7).expect("valid")),
            Filter::Gaussian(Gaussian::new(0.5).expect("valid")),
            Filter::Mitchell(Mitchell::new(1.0 / 3.0, 1.0 / 3.0).expect("valid")),
            Filter::CatmullRom(CatmullRom),
            Filter::Lanczos(Lanczos::new(3).expect("valid")),
        ];
        for filter in filters {
            let (table, exact) = (Footprint::new(&filter), PixelFilter::new(filter));
            for i in 0..4000 {
                let x = f64::from(i) / 4000.0 * (filter.radius() - 1e-6);
                let difference = f64::from(table.density(x as f32)) - exact.density(x);
                assert!(difference.abs() < 2e-5, "{filter} at {x}: {difference}");
            }
            assert_eq!(table.density(filter.radius() as f32 + 1e-3), 0.0);
            let shares = table.shares();
            let all: f64 = shares[0] + 2.0 * shares[1..].iter().sum::<f64>();
            assert!((all - 1.0).abs() < 1e-5, "{filter}: {all}");
        }
    }
}
