//! How far apart two images are, pixel by pixel: figures that people quote, which decide nothing.
//!
//! The noise of both images counts in them: only against a converged reference are they the first image's own errors
//! ([`etalon_statistics::metrics`]).

use etalon_images::Image;
use etalon_statistics::Picture;
use etalon_statistics::flip::{PIXELS_PER_DEGREE, hdr_flip};
use etalon_statistics::metrics::{EPSILON, mse, rel_mse, smape};
use serde::Serialize;

/// Errors of an image against another.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PixelErrors {
    /// Mean squared error.
    pub mse: f64,
    /// The same relative to r² + 0.01.
    pub rel_mse: f64,
    /// Symmetric mean absolute error, from 0 to 1.
    pub smape: f64,
    /// Mean of HDR-ꟻLIP, from 0 to 1, on a screen of 3840 pixels and 0.7 m, 0.7 m away; `None` beside a reference that is black in half of
    /// its pixels.
    pub flip: Option<f64>,
}

impl PixelErrors {
    /// Those of an image against a reference of the same size; `None` if one of them has no colours or is not finite.
    pub fn of(image: &Image, reference: &Image) -> Option<Self> {
        let interleaved = |image: &Image| -> Option<Vec<f32>> {
            let [r, g, b] = image.colour()?.planes;
            let pixels = r.iter().zip(g.iter()).zip(b.iter());
            Some(pixels.flat_map(|((r, g), b)| [*r, *g, *b]).collect())
        };
        let (values, others) = (interleaved(image)?, interleaved(reference)?);
        let test = Picture::new(&values, image.width(), image.height()).ok()?;
        let reference = Picture::new(&others, reference.width(), reference.height()).ok()?;
        Some(Self {
            mse: mse(&test, &reference).ok()?,
            rel_mse: rel_mse(&test, &reference, EPSILON).ok()?,
            smape: smape(&test, &reference, EPSILON).ok()?,
            flip: hdr_flip(&test, &reference, PIXELS_PER_DEGREE)
                .ok()
                .map(|map| map.iter().sum::<f64>() / map.len() as f64),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_those_of_their_formulas() {
        let image = |value: f32| {
            let mut image = Image::new(2, 1);
            for name in ["R", "G", "B"] {
                image.push(name, vec![value, 1.0]);
            }
            image
        };
        let errors = PixelErrors::of(&image(3.0), &image(2.0)).expect("colours");
        assert!((errors.mse - 0.5).abs() < 1e-12);
        assert!((errors.rel_mse - 0.5 / 4.01).abs() < 1e-12);
        assert!((errors.smape - 0.5 / 5.01).abs() < 1e-12);
        assert!(errors.flip.is_some_and(|flip| (0.0..1.0).contains(&flip)));
        assert_eq!(PixelErrors::of(&Image::new(2, 1), &image(1.0)), None);
    }
}
