//! Mitsuba's `.vol` files, version 3: a grid of 32-bit floats.
//!
//! Little-endian: `VOL`, 3; the encoding (1: 32-bit floats), the size along x, y and z and the number of channels, as 32-bit
//! integers; the lower and the upper corner of the grid's box; then the values by z, y, x and channel.

use crate::pixels::Values;
use glam::{DAffine3, DVec3, UVec3, Vec3};

/// What a file holds.
#[derive(Debug)]
pub(crate) struct VolFile {
    /// Values along x, y and z.
    pub(crate) size: UVec3,
    /// Where its box is: what the unit cube becomes.
    pub(crate) place: DAffine3,
    /// By z, y and x.
    pub(crate) values: Values,
    /// Of six channels the last three: of symmetric matrices what is beside the diagonal.
    pub(crate) beside: Option<Vec<[f32; 3]>>,
}

/// Length of what stands before the values (bytes).
const HEADER: usize = 48;

impl VolFile {
    /// Reads a file. Memory is taken for what is there, whatever the header says.
    ///
    /// # Errors
    /// What is wrong with it.
    pub(crate) fn read(bytes: &[u8]) -> Result<Self, String> {
        let Some((header, data)) = bytes.split_at_checked(HEADER) else {
            return Err(format!(
                "it has {} bytes, fewer than the header of a .vol file",
                bytes.len()
            ));
        };
        if header[..3] != *b"VOL" {
            return Err("it does not begin with `VOL`".to_owned());
        }
        if header[3] != 3 {
            return Err(format!("it has version {}, and 3 is read", header[3]));
        }
        let word = |i: usize| [header[i], header[i + 1], header[i + 2], header[i + 3]];
        let integer = |i: usize| i32::from_le_bytes(word(4 + 4 * i));
        let corner = |i: usize| {
            let number = |k: usize| f64::from(f32::from_le_bytes(word(24 + 4 * (i + k))));
            DVec3::new(number(0), number(1), number(2))
        };
        if integer(0) != 1 {
            return Err(format!(
                "its encoding is {}, and 1 (32-bit floats) is read",
                integer(0)
            ));
        }
        let sides = [1, 2, 3].map(integer);
        let channels = integer(4);
        if sides.iter().any(|&side| side < 1) || ![1, 3, 6].contains(&channels) {
            let [x, y, z] = sides;
            return Err(format!(
                "it claims {x} × {y} × {z} values of {channels} channels; 1, 3 or 6 are read"
            ));
        }
        let expected =
            sides.iter().map(|&side| side as u128).product::<u128>() * channels as u128 * 4;
        if expected != data.len() as u128 {
            return Err(format!(
                "its header claims {expected} bytes of values, and there are {}",
                data.len()
            ));
        }
        let bounds = [corner(0), corner(3)];
        if !(bounds[0].is_finite() && bounds[0].cmplt(bounds[1]).all() && bounds[1].is_finite()) {
            return Err("its box is empty or not finite".to_owned());
        }
        let (floats, _) = data.as_chunks::<4>();
        let floats = floats.iter().map(|bytes| f32::from_le_bytes(*bytes));
        let size = UVec3::from_array(sides.map(|side| side as u32));
        let mut beside = None;
        let values = match channels {
            1 => Values::One(floats.collect()),
            6 => {
                let floats: Vec<f32> = floats.collect();
                let halves = || floats.as_chunks::<3>().0.iter().copied();
                beside = Some(halves().skip(1).step_by(2).collect());
                Values::Three(halves().step_by(2).collect())
            }
            _ => {
                let floats: Vec<f32> = floats.collect();
                Values::Three(floats.as_chunks::<3>().0.to_vec())
            }
        };
        refuse_bad(&values, size)?;
        // No number beside the diagonal of a sound matrix is larger than those on it.
        if let (Values::Three(diagonal), Some(beside)) = (&values, &beside) {
            let bad = |(d, b): (&[f32; 3], &[f32; 3])| {
                let bound = |i: usize, j: usize| (d[i] * d[j]).sqrt() * 1.001 + 1e-6;
                let bounds = [bound(0, 1), bound(0, 2), bound(1, 2)];
                !b.iter()
                    .zip(bounds)
                    .all(|(value, bound)| value.abs() <= bound)
            };
            if let Some(index) = diagonal.iter().zip(beside).position(bad) {
                return Err(format!(
                    "number {index} of its matrices (xx, yy, zz, xy, xz, yz) has a negative eigenvalue, or is not finite"
                ));
            }
        }
        let [low, high] = bounds;
        Ok(Self {
            size,
            place: DAffine3::from_translation(low) * DAffine3::from_scale(high - low),
            values,
            beside,
        })
    }
}

/// Refuses values that no density, albedo or emission has.
pub(crate) fn refuse_bad(values: &Values, size: UVec3) -> Result<(), String> {
    let bad = |value: &f32| !(value.is_finite() && *value >= 0.0);
    let (found, channels) = match values {
        Values::One(values) => (values.iter().position(bad), 1),
        Values::Three(values) => (values.as_flattened().iter().position(bad), 3),
    };
    let Some(index) = found else { return Ok(()) };
    let value = match values {
        Values::One(values) => values[index],
        Values::Three(values) => Vec3::from_array(values[index / 3])[index % 3],
    };
    let place = index / channels;
    let (x, y) = (size.x as usize, size.y as usize);
    Err(format!(
        "the value at ({}, {}, {}) is {value}, and values are finite and not below 0",
        place % x,
        place / x % y,
        place / x / y
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(integers: [i32; 5], corners: [f32; 6], values: &[f32]) -> Vec<u8> {
        let mut bytes = b"VOL\x03".to_vec();
        bytes.extend(integers.iter().flat_map(|n| n.to_le_bytes()));
        bytes.extend(corners.iter().chain(values).flat_map(|x| x.to_le_bytes()));
        bytes
    }

    const BOX: [f32; 6] = [0.0, 0.0, 0.0, 1.0, 2.0, 3.0];

    #[test]
    fn a_file_is_read_in_its_order() {
        let read = VolFile::read(&file([1, 3, 1, 2, 1], BOX, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
        let read = read.expect("sound");
        assert_eq!(read.size, UVec3::new(3, 1, 2));
        let corner = read.place.transform_point3(DVec3::ONE);
        assert_eq!(corner, DVec3::new(1.0, 2.0, 3.0));
        assert_eq!(read.values, Values::One(vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
    }

    #[test]
    fn whatever_is_wrong_is_said() {
        let sound = file([1, 1, 1, 2, 3], BOX, &[0.5; 6]);
        assert!(VolFile::read(&sound).is_ok());
        for length in 0..sound.len() {
            assert!(VolFile::read(&sound[..length]).is_err(), "{length}");
        }
        let says = |bytes: &[u8], words: &str| {
            let reason = VolFile::read(bytes).expect_err("wrong");
            assert!(reason.contains(words), "{reason}");
        };
        says(b"VOX\x03", "fewer than the header");
        says(&[&b"VOL\x02"[..], &[0; 44]].concat(), "version 2");
        says(&file([2, 1, 1, 1, 1], BOX, &[0.0]), "encoding is 2");
        // A header that claims more than a machine has costs nothing.
        says(
            &file([1, i32::MAX, i32::MAX, i32::MAX, 3], BOX, &[0.0]),
            "claims",
        );
        says(&file([1, 1, -1, 1, 1], BOX, &[0.0]), "1 × -1 × 1");
        says(&file([1, 1, 1, 1, 2], BOX, &[0.0; 2]), "2 channels");
        let flake = [1.0, 0.5, 0.25, -0.7, 0.5, 0.3];
        let read = VolFile::read(&file([1, 1, 1, 1, 6], BOX, &flake)).expect("sound");
        assert_eq!(read.values, Values::Three(vec![[1.0, 0.5, 0.25]]));
        assert_eq!(read.beside, Some(vec![[-0.7, 0.5, 0.3]]));
        let worse = [1.0, 0.5, 0.25, -0.8, 0.5, 0.3];
        says(&file([1, 1, 1, 1, 6], BOX, &worse), "negative eigenvalue");
        says(&file([1, 2, 1, 1, 1], BOX, &[0.0, -1.0]), "(1, 0, 0) is -1");
        says(
            &file([1, 1, 1, 2, 3], BOX, &[0.0, 0.0, 0.0, 0.0, f32::NAN, 0.0]),
            "(0, 0, 1) is NaN",
        );
        says(&file([1, 1, 1, 1, 1], [0.0; 6], &[0.0]), "box is empty");
    }
}
