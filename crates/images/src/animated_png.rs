//! Pictures that follow each other, as one animated PNG that repeats for ever (the `acTL` and `fcTL` chunks of the PNG
//! specification, third edition 2025).

use crate::{Error, write_atomically};
use std::io;
use std::path::Path;

/// What all frames have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnimationFormat {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Whether a pixel has a fourth byte.
    pub alpha: bool,
    /// How many there are.
    pub frames: u32,
    /// How many follow each other in a second, from 1/600 to 60000.
    pub rate: f64,
}

/// Writes frames of eight-bit sRGB, which `frame` gives by their numbers from 0.
///
/// # Errors
/// [`Error::Write`] where `frame` or the operating system refuses, or a frame has not as many bytes as the format says.
pub fn write_animated_png(
    path: &Path,
    format: AnimationFormat,
    mut frame: impl FnMut(u32) -> io::Result<Vec<u8>>,
) -> Result<(), Error> {
    let invalid = |error: png::EncodingError| match error {
        png::EncodingError::IoError(source) => source,
        other => io::Error::new(io::ErrorKind::InvalidInput, other.to_string()),
    };
    write_atomically(path, |file| {
        let mut encoder = png::Encoder::new(file, format.width, format.height);
        encoder.set_color(match format.alpha {
            true => png::ColorType::Rgba,
            false => png::ColorType::Rgb,
        });
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        let [numerator, denominator] = delay(format.rate);
        let mut animate = || {
            encoder.set_animated(format.frames, 0)?;
            encoder.set_frame_delay(numerator, denominator)
        };
        animate().map_err(invalid)?;
        let mut writer = encoder.write_header().map_err(invalid)?;
        for number in 0..format.frames {
            writer.write_image_data(&frame(number)?).map_err(invalid)?;
        }
        writer.finish().map_err(invalid)
    })
    .map_err(|source| Error::write(path, source))
}

/// The seconds between two frames, as numerator and denominator.
fn delay(rate: f64) -> [u16; 2] {
    // Whole rates and those of television (24000/1001) are exact.
    let scales = [1.0, 1001.0, 100.0, 10.0];
    let exact = scales.into_iter().find(|scale| {
        let product = rate * scale;
        product <= 65535.0 && (product - product.round()).abs() < 1e-3 && product >= 1.0
    });
    let scale = exact.unwrap_or(if rate < 1.0 { 100.0 } else { 1.0 });
    [
        scale as u16,
        (rate * scale).round().clamp(1.0, 65535.0) as u16,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn delays() {
        assert_eq!(delay(24.0), [1, 24]);
        assert_eq!(delay(24000.0 / 1001.0), [1001, 24000]);
        assert_eq!(delay(12.5), [100, 1250]);
        assert_eq!(delay(0.5), [100, 50]);
    }

    #[test]
    fn frames_come_back() {
        let folder = std::env::temp_dir().join(format!("etalon-movie-{}", std::process::id()));
        std::fs::create_dir_all(&folder).expect("a folder");
        let path = folder.join("movie.png");
        let format = AnimationFormat {
            width: 3,
            height: 2,
            alpha: false,
            frames: 4,
            rate: 24.0,
        };
        let bytes = |number: u32| vec![10 * number as u8 + 1; 18];
        write_animated_png(&path, format, |number| Ok(bytes(number))).expect("written");
        let file = std::io::BufReader::new(std::fs::File::open(&path).expect("it is there"));
        let mut reader = png::Decoder::new(file).read_info().expect("a PNG");
        let animation = reader.info().animation_control.expect("it is animated");
        assert_eq!((animation.num_frames, animation.num_plays), (4, 0));
        for number in 0..4 {
            let mut read = vec![0; 18];
            reader.next_frame(&mut read).expect("a frame");
            assert_eq!(read, bytes(number));
            let control = reader.info().frame_control.expect("it has a duration");
            assert_eq!((control.delay_num, control.delay_den), (1, 24));
        }
        // A frame of another size leaves nothing behind.
        let other = folder.join("other.png");
        assert!(write_animated_png(&other, format, |_| Ok(vec![0; 17])).is_err());
        assert!(!other.exists());
        std::fs::remove_dir_all(&folder).expect("removed");
    }
}
