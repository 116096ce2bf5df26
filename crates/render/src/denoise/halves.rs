//! What a denoiser is given: two independent halves of a picture, their noise, and features of the first surface.

use super::Plane;
use crate::features::{FEATURES, HALF};
use etalon_film::{RenderedImage, STANDARD_ERROR};
use etalon_sampling::ReplicateKind;

/// How many numbers describe the first surface.
pub(super) const NUMBERS: usize = 7;

/// What is the least difference of these numbers that means anything: of albedo and normal; that of the depth is relative.
const LEAST: [f32; NUMBERS] = [0.02, 0.02, 0.02, 0.04, 0.04, 0.04, 0.005];

/// A picture in halves.
pub(super) struct Halves {
    /// Width and height (pixels).
    pub(super) size: [usize; 2],
    /// The names of the colours: three, or one, which is the first of a pixel's three.
    pub(super) colours: Vec<String>,
    /// The picture.
    pub(super) whole: Plane,
    /// The means of either half of its replicates.
    pub(super) halves: [Plane; 2],
    /// The variance of the picture's pixels; that of a half is twice it.
    pub(super) variance: Plane,
    /// Albedo, normal and depth.
    pub(super) features: Vec<[f32; NUMBERS]>,
    /// The variance of these, and besides what differences mean nothing, squared.
    pub(super) blur: Vec<[f32; NUMBERS]>,
}

impl Halves {
    /// Of a picture that was rendered with features.
    ///
    /// # Errors
    /// If it lacks what a filter needs, in a sentence.
    pub(super) fn of(picture: &RenderedImage) -> Result<Self, String> {
        let metadata = picture.metadata.as_ref();
        let metadata = metadata.ok_or("it is no image of Etalon's")?;
        if metadata.denoised.is_some() {
            return Err("it is denoised already".to_owned());
        }
        let again = "render it with `--features`";
        if metadata.features.is_none() {
            return Err(format!("it has no features: {again}, to its end"));
        }
        if metadata.replicate_kind != ReplicateKind::Independent {
            return Err(format!("its replicates depend on each other: {again}"));
        }
        let colours: Vec<String> = metadata.colours().iter().map(|&n| n.to_owned()).collect();
        if !matches!(colours.len(), 1 | 3) {
            return Err("it is a picture of bands, and colours are denoised".to_owned());
        }
        let image = &picture.image;
        let size = [image.width(), image.height()];
        let plane = |of: &str, name: &str| -> Result<&[f32], String> {
            let name = format!("{of}{name}");
            let plane = image.channel(&name);
            plane.ok_or_else(|| format!("it has no channel `{name}`: {again}"))
        };
        let planes = |of: &str| -> Result<Plane, String> {
            let mut pixels = vec![[0.0; 3]; size[0] * size[1]];
            for (c, name) in colours.iter().enumerate() {
                for (pixel, value) in pixels.iter_mut().zip(plane(of, name)?) {
                    pixel[c] = *value;
                }
            }
            Ok(pixels)
        };
        let (whole, half) = (planes("")?, planes(HALF)?);
        let mut variance = planes(STANDARD_ERROR)?;
        for error in variance.iter_mut().flatten() {
            *error *= *error;
        }
        let twice = whole.iter().zip(&half);
        let other = twice
            .map(|(m, a)| std::array::from_fn(|c| 2.0 * m[c] - a[c]))
            .collect();
        let mut features = vec![[0.0; NUMBERS]; size[0] * size[1]];
        let mut blur = vec![[0.0; NUMBERS]; size[0] * size[1]];
        for (i, name) in FEATURES.iter().enumerate() {
            let values = plane("", name)?;
            let errors = plane(STANDARD_ERROR, name)?;
            for (pixel, (value, error)) in values.iter().zip(errors).enumerate() {
                features[pixel][i] = *value;
                let least = if i == NUMBERS - 1 {
                    LEAST[i] * value
                } else {
                    LEAST[i]
                };
                blur[pixel][i] = error * error + least * least;
            }
        }
        let finite = |plane: &Plane| plane.iter().flatten().all(|value| value.is_finite());
        if !finite(&whole) || !finite(&variance) {
            return Err("it has pixels that are not finite".to_owned());
        }
        Ok(Self {
            size,
            colours,
            whole,
            halves: [half, other],
            variance,
            features,
            blur,
        })
    }
}
