//! Strands of hair as Mitsuba 0.6 has them.
//!
//! - text: `x y z` on each line, an empty line between strands;
//! - binary: the word `BINARY_HAIR`, the number of points as u32, and x, y, z of each as f32, all little-endian; a strand begins with a
//!   number that is +∞.
//!
//! A point that bends a strand by less than a threshold makes way for the next, so that straight parts are one segment.

use super::control_points::{ControlPoint, ControlPoints, fits};
use etalon_math::float64;
use glam::DVec3;

const MAGIC: &[u8] = b"BINARY_HAIR";

/// Strands under construction.
struct Strands {
    all: Vec<(Vec<ControlPoint>, usize)>,
    strand: Vec<ControlPoint>,
    radius: f64,
    cos_straight: f64,
}

impl Strands {
    fn add(&mut self, position: DVec3) {
        let point = ControlPoint {
            position,
            radius: self.radius,
        };
        if let [.., before, last] = self.strand.as_slice() {
            let onward = (position - last.position).normalize_or_zero();
            let along = (last.position - before.position).normalize_or_zero();
            if onward.dot(along) > self.cos_straight {
                self.strand.pop();
            }
        }
        self.strand.push(point);
    }

    /// Ends a strand at a line. A point alone is nothing.
    fn end(&mut self, line: usize) {
        let strand = std::mem::take(&mut self.strand);
        if strand.len() > 1 {
            self.all.push((strand, line));
        }
    }
}

/// Reads a file: strands of this radius, without points that bend them by less than an angle (rad). The error names the place.
pub(super) fn parse(bytes: &[u8], radius: f64, straight: f64) -> Result<ControlPoints, String> {
    let mut strands = Strands {
        all: Vec::new(),
        strand: Vec::new(),
        radius,
        // Nothing is straighter than a straight line.
        cos_straight: if straight > 0.0 {
            float64::cos(straight)
        } else {
            1.0
        },
    };
    match bytes.strip_prefix(MAGIC) {
        Some(rest) => binary(rest, &mut strands)?,
        None => text(bytes, &mut strands)?,
    }
    if strands.all.is_empty() {
        return Err("it has no strand of two points".to_owned());
    }
    Ok(ControlPoints {
        strands: strands.all,
        header: None,
    })
}

fn text(bytes: &[u8], strands: &mut Strands) -> Result<(), String> {
    let text = String::from_utf8_lossy(bytes);
    let text = text
        .trim_start_matches('\u{feff}')
        .replace("\r\n", "\n")
        .replace('\r', "\n");
    for (index, line) in text.lines().enumerate() {
        if line.trim().is_empty() {
            strands.end(index + 1);
            continue;
        }
        let numbers: Vec<Option<f64>> = line
            .split_whitespace()
            .map(|word| word.parse().ok())
            .collect();
        match numbers[..] {
            [Some(x), Some(y), Some(z)] if [x, y, z].into_iter().all(fits) => {
                strands.add(DVec3::new(x, y, z));
            }
            _ => {
                let (line, number) = (line.trim(), index + 1);
                return Err(format!("line {number}: `{line}` is no point `x y z`"));
            }
        }
    }
    strands.end(text.lines().count());
    Ok(())
}

fn binary(bytes: &[u8], strands: &mut Strands) -> Result<(), String> {
    let Some((count, rest)) = bytes.split_first_chunk::<4>() else {
        return Err("it ends before the number of its points".to_owned());
    };
    let count = u32::from_le_bytes(*count) as usize;
    let mut numbers = rest
        .as_chunks::<4>()
        .0
        .iter()
        .map(|four| f32::from_le_bytes(*four));
    for point in 1..=count {
        let missing = || format!("it ends before point {point} of {count}");
        let mut x = numbers.next().ok_or_else(missing)?;
        if x == f32::INFINITY {
            strands.end(point);
            x = numbers.next().ok_or_else(missing)?;
        }
        let (y, z) = (
            numbers.next().ok_or_else(missing)?,
            numbers.next().ok_or_else(missing)?,
        );
        if ![x, y, z].into_iter().all(f32::is_finite) {
            return Err(format!("point {point} is ({x}, {y}, {z})"));
        }
        strands.add(DVec3::new(x.into(), y.into(), z.into()));
    }
    strands.end(count);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two strands, the first with a straight middle, the second bent by a right angle.
    const TEXT: &str = "0 0 0\n0 0 1\n0 0 2\n\n\n5 0 0\r\n5 0 1\r\n6 0 1\r\n";

    fn encoded() -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        bytes.extend(6_u32.to_le_bytes());
        let numbers = [
            f32::INFINITY,
            0.0,
            0.0,
            0.0,
            0.0,
            0.0,
            1.0,
            0.0,
            0.0,
            2.0,
            f32::INFINITY,
            5.0,
            0.0,
            0.0,
            5.0,
            0.0,
            1.0,
            6.0,
            0.0,
            1.0,
        ];
        bytes.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
        bytes
    }

    #[test]
    fn both_formats_say_the_same() {
        for bytes in [TEXT.as_bytes().to_vec(), encoded()] {
            let points = |straight: f64| {
                let file = parse(&bytes, 0.1, straight).unwrap_or_else(|why| panic!("{why}"));
                let strands = file.strands.into_iter();
                strands.map(|(strand, _)| strand).collect::<Vec<_>>()
            };
            let whole = points(0.0);
            assert_eq!(whole.iter().map(Vec::len).collect::<Vec<_>>(), [3, 3]);
            assert_eq!(whole[1][2].position, DVec3::new(6.0, 0.0, 1.0));
            assert_eq!(whole[0][0].radius, 0.1);
            let joined = points(0.02);
            assert_eq!(joined.iter().map(Vec::len).collect::<Vec<_>>(), [2, 3]);
            assert_eq!(joined[0][1].position, DVec3::new(0.0, 0.0, 2.0));
        }
    }

    #[test]
    fn broken_files_say_where() {
        let said = |bytes: &[u8]| parse(bytes, 1.0, 0.0).err().unwrap_or_default();
        assert_eq!(said(b"0 0 0\n0 1\n"), "line 2: `0 1` is no point `x y z`");
        assert!(said(b"0 0 0\n0 1 1e39\n").starts_with("line 2: "));
        assert_eq!(said(b"0 0 0\n\n1 1 1\n"), "it has no strand of two points");
        let whole = encoded();
        for length in MAGIC.len()..whole.len() {
            assert!(
                said(&whole[..length]).starts_with("it ends before"),
                "{length}"
            );
        }
        let mut broken = whole;
        let end = broken.len();
        broken[end - 4..].copy_from_slice(&f32::NAN.to_le_bytes());
        assert_eq!(said(&broken), "point 6 is (6, 0, NaN)");
    }
}
