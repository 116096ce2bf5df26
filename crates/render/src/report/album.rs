//! The pictures of a page, as numbers: each is stored once, however many rows show it.
//!
//! A picture is a script of type `text/plain`, which no browser runs: planes one after the other,
//! each row after row, as little-endian binary16 ([`super::half`]) in base64. Exposure is then a
//! matter of the page: the numbers are the linear ones of the file, to eleven bits.

use super::half;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use etalon_film::RenderedImage;
use etalon_images::Image;
use maud::{Markup, PreEscaped, html};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// Pictures by the hash of their contents.
#[derive(Default)]
pub struct Album {
    stored: BTreeMap<String, Stored>,
}

struct Stored {
    size: [usize; 2],
    planes: usize,
    exponent: i32,
    base64: String,
}

/// Weights of the luminance of linear sRGB (ITU-R BT.709).
const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// The share of the mean that keeps a relative difference finite where a picture is black.
pub const FLOOR: f64 = 0.05;

impl Album {
    /// Nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Stores an image's colour and says its name; `None` for an image without colour.
    pub fn add(&mut self, image: &Image) -> Option<String> {
        let planes = image.colour()?.planes.concat();
        let size = [image.width(), image.height()];
        Some(self.store(size, 3, &planes))
    }

    /// Stores the relative difference of two images' luminance,
    /// (a − b) / (|b| + 5 % of b's mean); `None` if it makes no sense.
    pub fn add_difference(&mut self, first: &Image, second: &Image) -> Option<String> {
        let (a, b) = (luminance(first)?, luminance(second)?);
        if (first.width(), first.height()) != (second.width(), second.height()) {
            return None;
        }
        let finite = || b.iter().copied().filter(|x| x.is_finite());
        let mean = finite().map(f64::abs).sum::<f64>() / (finite().count().max(1) as f64);
        let floor = if mean > 0.0 { FLOOR * mean } else { 1.0 };
        let relative = |(a, b): (&f64, &f64)| ((a - b) / (b.abs() + floor)) as f32;
        let plane: Vec<f32> = a.iter().zip(&b).map(relative).collect();
        Some(self.store([first.width(), first.height()], 1, &plane))
    }

    /// Stores the difference of the green (or only) channel over its standard error; `None` unless
    /// one of the two pictures has standard errors.
    pub fn add_deviation(
        &mut self,
        first: &RenderedImage,
        second: &RenderedImage,
    ) -> Option<String> {
        let (a, b) = (&first.image, &second.image);
        if (a.width(), a.height()) != (b.width(), b.height()) {
            return None;
        }
        let name = ["G", "Y"]
            .into_iter()
            .find(|name| first.standard_error(name).is_some())?;
        let (x, s) = (a.channel(name)?, first.standard_error(name)?);
        let y: Cow<'_, [f32]> = match b.channel(name) {
            Some(y) => y.into(),
            None if name == "G" => b.colour()?.planes.into_iter().nth(1)?,
            None => luminance(b)?.into_iter().map(|y| y as f32).collect(),
        };
        let t = second.standard_error(name);
        let plane: Vec<f32> = (0..x.len())
            .map(|i| {
                let apart = f64::from(x[i]) - f64::from(y[i]);
                let t = t.map_or(0.0, |t| f64::from(t[i]));
                let error = (f64::from(s[i]).powi(2) + t * t).sqrt();
                if error > 0.0 {
                    (apart / error) as f32
                } else {
                    0.0
                }
            })
            .collect();
        Some(self.store([a.width(), a.height()], 1, &plane))
    }

    fn store(&mut self, size: [usize; 2], planes: usize, values: &[f32]) -> String {
        let exponent = half::exponent(values);
        let bytes: Vec<u8> = values
            .iter()
            .flat_map(|v| half::encode(*v, exponent).to_le_bytes())
            .collect();
        let mut hasher = blake3::Hasher::new();
        hasher.update(format!("{size:?} {planes} {exponent}").as_bytes());
        hasher.update(&bytes);
        let name = format!("p{}", &hasher.finalize().to_hex()[..16]);
        self.stored.entry(name.clone()).or_insert_with(|| Stored {
            size,
            planes,
            exponent,
            base64: STANDARD.encode(&bytes),
        });
        name
    }

    /// How many pictures there are.
    pub fn len(&self) -> usize {
        self.stored.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.stored.is_empty()
    }

    /// All pictures, to be put into the page once.
    pub fn markup(&self) -> Markup {
        html! {
            @for (name, picture) in &self.stored {
                script type="text/plain" id=(name) data-width=(picture.size[0])
                    data-height=(picture.size[1]) data-planes=(picture.planes)
                    data-exponent=(picture.exponent) { (PreEscaped(&picture.base64)) }
            }
        }
    }
}

fn luminance(image: &Image) -> Option<Vec<f64>> {
    let colour = image.colour()?;
    let of = |i: usize| {
        let parts = colour.planes.iter().zip(LUMINANCE);
        parts
            .map(|(plane, weight)| weight * f64::from(plane[i]))
            .sum()
    };
    Some((0..image.width() * image.height()).map(of).collect())
}

/// The exposure, in stops, that brings all but the brightest hundredth of an image below white.
pub fn exposure(image: &Image) -> f64 {
    let Some(mut values) = luminance(image) else {
        return 0.0;
    };
    values.retain(|x| x.is_finite() && *x > 0.0);
    values.sort_by(f64::total_cmp);
    let Some(bright) = values.get(values.len().saturating_sub(1 + values.len() / 100)) else {
        return 0.0;
    };
    let stops = -etalon_math::float64::log2(*bright) - 0.15;
    // A tenth of a stop, as the slider has it.
    ((10.0 * stops).round() / 10.0).clamp(-24.0, 24.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(values: &[f32]) -> Image {
        Image::new(values.len(), 1).with("Y", values.to_vec())
    }

    #[test]
    fn equal_pictures_are_stored_once() {
        let mut album = Album::new();
        let first = album.add(&grey(&[1.0, 2.0])).expect("colour");
        assert_eq!(album.add(&grey(&[1.0, 2.0])), Some(first.clone()));
        assert_ne!(album.add(&grey(&[2.0, 4.0])), Some(first), "another scale");
        assert_eq!(album.len(), 2);
        let html = album.markup().into_string();
        assert_eq!(html.matches("<script type=\"text/plain\"").count(), 2);
        // 1 and 2 as 2¹³ and 2¹⁴: 7000 and 7400, the low byte first, three times.
        let bytes = [0x00, 0x70, 0x00, 0x74].repeat(3);
        assert!(html.contains(&STANDARD.encode(bytes)), "{html}");
        assert!(html.contains("data-exponent=\"-13\""), "{html}");
    }

    #[test]
    fn sizes_that_differ_have_no_difference() {
        let mut album = Album::new();
        let (one, two) = (grey(&[1.0]), grey(&[1.0, 2.0]));
        assert!(album.add_difference(&one, &two).is_none());
        assert!(album.add_difference(&two, &two).is_some());
        assert!(album.add(&Image::new(1, 1)).is_none());
    }

    #[test]
    fn exposure_brings_the_bright_below_white() {
        assert!((exposure(&grey(&[8.0; 64])) + 3.1).abs() < 0.11);
        assert!(exposure(&grey(&[0.0, f32::NAN])) == 0.0);
        // One pixel in two hundred may burn out.
        let mut values = vec![0.5; 200];
        values[7] = 1e6;
        assert!((exposure(&grey(&values)) - 0.9).abs() < 0.11);
    }
}
