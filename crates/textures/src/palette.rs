//! Pixels of 3 × 8 bits as the numbers of their colours, whose spectra are stored once each.
//!
//! A colour's number is its rank among those that occur, so 24 bits hold it, and it takes the place of the pixel. A picture of
//! 16 million pixels has some hundred thousand colours: their spectra are a small part of it, and look-ups find them in a cache.

use crate::coded::{At, Coded, triple};
use crate::recalled::is_heavy;
use etalon_spectrum::RgbCoefficients;

/// An image of colours.
#[derive(Clone, Debug, PartialEq)]
pub struct Palette {
    /// Three bytes for each pixel, the lowest first.
    numbers: Vec<u8>,
    /// Coefficients of the spectra, by number.
    colours: Vec<[f32; 3]>,
}

/// Bits in a word of the set of colours that occur.
const WORD: usize = 64;

/// 8-bit components as one number.
#[inline]
fn joined([low, middle, high]: [u8; 3]) -> usize {
    usize::from(low) | usize::from(middle) << 8 | usize::from(high) << 16
}

impl Palette {
    /// The colours of three channels; the pixels themselves, if there are so many colours that their spectra would
    /// weigh too much.
    pub(crate) fn new(pixels: Coded<u8>) -> Result<Self, Coded<u8>> {
        let mut occurs = vec![0_u64; (1 << 24) / WORD];
        for pixel in pixels.samples.chunks_exact(3) {
            let colour = joined([pixel[0], pixel[1], pixel[2]]);
            occurs[colour / WORD] |= 1 << (colour % WORD);
        }
        // How many occur before each word, of which there are at most 2²⁴.
        let mut before = Vec::with_capacity(occurs.len());
        let mut count = 0_u32;
        for word in &occurs {
            before.push(count);
            count += word.count_ones();
        }
        if is_heavy(count as usize, &pixels) {
            return Err(pixels);
        }
        let Coded {
            samples: mut numbers,
            values,
            ..
        } = pixels;
        let mut colours = Vec::with_capacity(count as usize);
        for (index, word) in occurs.iter().enumerate() {
            let mut rest = *word;
            while rest != 0 {
                let colour = index * WORD + rest.trailing_zeros() as usize;
                let rgb = [0, 8, 16].map(|shift| values[colour >> shift & 0xff]);
                colours.push(RgbCoefficients::from_rgb(rgb).0);
                rest &= rest - 1;
            }
        }
        for pixel in numbers.chunks_exact_mut(3) {
            let colour = joined([pixel[0], pixel[1], pixel[2]]);
            let lower = occurs[colour / WORD] & ((1 << (colour % WORD)) - 1);
            let number = before[colour / WORD] + lower.count_ones();
            pixel.copy_from_slice(&number.to_le_bytes()[..3]);
        }
        Ok(Self { numbers, colours })
    }

    /// Memory of pixels and colours (bytes).
    pub(crate) fn bytes(&self) -> usize {
        self.numbers.len() + size_of_val(&self.colours[..])
    }
}

impl At<[f32; 3]> for Palette {
    /// The coefficients of a pixel's spectrum.
    #[inline(always)]
    fn at(&self, index: usize) -> [f32; 3] {
        self.colours[joined(triple(&self.numbers, index))]
    }
}
