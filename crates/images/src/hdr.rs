//! Radiance pictures: RGBE, one shared exponent per pixel (Ward 1991), run-length encoded.
//!
//! A pixel (r, g, b, e) with e > 0 is (r, g, b) · 2^(e − 136), with an error of at most about 1 % of
//! the brightest channel.

use crate::losses::Losses;
use crate::{Error, Image, write_atomically};
use std::io::{self, Write};
use std::path::Path;

/// Writes the colour of an image.
///
/// Each channel is rounded to the nearest step. Negative samples and NaN become 0, samples above
/// 2¹²⁷ · 255/128 (+∞ among them) the greatest there is; the result counts them.
///
/// # Errors
/// [`Error::Unsupported`] for an image without colour, [`Error::Write`] where the operating
/// system refuses.
pub fn write(path: &Path, image: &Image) -> Result<Losses, Error> {
    let colour = image.needed_colour(path)?;
    let planes = colour.planes.each_ref().map(|plane| &**plane);
    write_atomically(path, |file| encode(file, image, planes))
        .map_err(|source| Error::write(path, source))
}

fn encode(file: &mut impl Write, image: &Image, [r, g, b]: [&[f32]; 3]) -> io::Result<Losses> {
    let (width, height) = (image.width(), image.height());
    write!(
        file,
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n"
    )?;
    let mut losses = Losses::default();
    let mut row = Vec::with_capacity(width);
    let mut plane = Vec::with_capacity(width);
    for y in 0..height {
        row.clear();
        for pixel in y * width..(y + 1) * width {
            row.push(rgbe([r[pixel], g[pixel], b[pixel]], &mut losses));
        }
        // Rows of other lengths cannot be distinguished from old-style runs.
        if (8..0x8000).contains(&width) {
            file.write_all(&[2, 2, (width >> 8) as u8, width as u8])?;
            for component in 0..4 {
                plane.clear();
                plane.extend(row.iter().map(|pixel| pixel[component]));
                write_runs(file, &plane)?;
            }
        } else {
            for pixel in &row {
                file.write_all(pixel)?;
            }
        }
    }
    Ok(losses)
}

/// The shared-exponent form of a pixel.
fn rgbe(colour: [f32; 3], losses: &mut Losses) -> [u8; 4] {
    // The greatest pixel is (255, …) · 2^(255 − 136).
    let greatest = 255.0 * f64::from_bits((1023 + 119) << 52);
    let colour = colour.map(|x| {
        losses.not_finite += usize::from(!x.is_finite());
        losses.negative += usize::from(x < 0.0 && x.is_finite());
        losses.too_bright += usize::from(f64::from(x) > greatest && x.is_finite());
        // NaN becomes 0 here, whichever operand `max` prefers.
        if x > 0.0 {
            f64::from(x).min(greatest)
        } else {
            0.0
        }
    });
    let brightest = colour.into_iter().fold(0.0, f64::max);
    // 2^(exponent − 1) ≤ brightest < 2^exponent; a float widened to double is never subnormal.
    let mut exponent = (brightest.to_bits() >> 52) as i32 - 1022;
    let step = |exponent: i32| f64::from_bits(((1023 + exponent - 8) as u64) << 52);
    if brightest == 0.0 || exponent < -127 {
        return [0; 4];
    }
    if brightest / step(exponent) >= 255.5 {
        exponent += 1;
    }
    // Only the greatest pixels of all would need a step beyond the last exponent.
    let exponent = exponent.min(127);
    let [r, g, b] = colour.map(|x| (x / step(exponent) + 0.5).min(255.0) as u8);
    [r, g, b, (exponent + 128) as u8]
}

/// One component of a row: runs of at least four equal bytes as (128 + length, byte), anything
/// else as (length, bytes).
fn write_runs(file: &mut impl Write, bytes: &[u8]) -> io::Result<()> {
    let run_at = |start: usize| {
        let equal = |b: &&u8| **b == bytes[start];
        bytes[start..].iter().take(127).take_while(equal).count()
    };
    let mut start = 0;
    while start < bytes.len() {
        let run = run_at(start);
        if run >= 4 {
            file.write_all(&[128 + run as u8, bytes[start]])?;
            start += run;
            continue;
        }
        let mut end = start + run;
        while end < bytes.len() && run_at(end) < 4 {
            end += 1;
        }
        for literal in bytes[start..end].chunks(128) {
            file.write_all(&[literal.len() as u8])?;
            file.write_all(literal)?;
        }
        start = end;
    }
    Ok(())
}
