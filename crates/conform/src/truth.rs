//! Pictures that are known: without rendering them, in double precision, or, where there is no closed form, as references with a
//! standard error.

pub mod absorption;
#[cfg(test)]
pub(crate) mod by_definition;
pub mod coverage;
pub mod delta_lights;
pub mod form_factors;
pub mod furnace;
pub mod integrating_sphere;
pub mod interfaces;
pub mod irradiance;
pub mod mirror_room;
pub mod pixels;
pub mod polygon_lights;
pub mod reference;
pub mod rough_metal;
pub mod sky;
pub mod slab;
pub mod thin_lens;

/// A grey picture: the mean of each pixel, row by row, the top row first.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Rows and columns.
    pub pixels: u32,
    /// The means.
    pub means: Vec<f64>,
    /// The standard error of the mean of all, as a share of it; 0 where all is known.
    pub error: f64,
}

impl Picture {
    /// The same everywhere.
    pub fn even(pixels: u32, value: f64) -> Self {
        Self::exact(pixels, vec![value; (pixels * pixels) as usize])
    }

    /// Of means that are known.
    pub fn exact(pixels: u32, means: Vec<f64>) -> Self {
        Self {
            pixels,
            means,
            error: 0.0,
        }
    }

    /// The means over pixels of a function of the place on the film: x from −1 at the left to 1 at the right, y from −1 at the
    /// bottom to 1 at the top.
    pub fn of(pixels: u32, value: impl Fn(f64, f64) -> f64) -> Self {
        let at = |index: u32| [index % pixels, index / pixels];
        let means = (0..pixels * pixels).map(|i| pixels::mean([pixels; 2], at(i), &value));
        Self::exact(pixels, means.collect())
    }

    /// As [`Picture::of`], with parts × parts in each pixel: for functions with kinks.
    pub fn of_parts(pixels: u32, parts: u32, value: impl Fn(f64, f64) -> f64) -> Self {
        let at = |index: u32| [index % pixels, index / pixels];
        let mean = |i| pixels::mean_of_cells([pixels; 2], at(i), parts, &value);
        Self::exact(pixels, (0..pixels * pixels).map(mean).collect())
    }

    /// The brightest pixel.
    pub fn brightest(&self) -> f64 {
        self.means.iter().copied().fold(0.0, f64::max)
    }

    /// The mean of all pixels.
    pub fn mean(&self) -> f64 {
        self.means.iter().sum::<f64>() / self.means.len() as f64
    }
}
