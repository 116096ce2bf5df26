//! Mitsuba's `.vol` files as media take them: densities, shares of light, matrices; [`Volume`] reads the file itself.

use crate::pixels::Values;
use etalon_images::Volume;
use glam::{DAffine3, UVec3, Vec3};

/// The contents of a file.
#[derive(Debug)]
pub(crate) struct VolFile {
    /// Values along x, y and z.
    pub(crate) size: UVec3,
    /// The map from the unit cube to its box; `None` if the file's box has no volume.
    pub(crate) place: Option<DAffine3>,
    /// By z, y and x.
    pub(crate) values: Values,
    /// The last three of six channels: off-diagonal elements of symmetric matrices.
    pub(crate) beside: Option<Vec<[f32; 3]>>,
    /// Remarks about the file.
    pub(crate) notes: Vec<String>,
}

impl VolFile {
    /// Reads a file.
    ///
    /// # Errors
    /// What is wrong with it.
    pub(crate) fn read(bytes: &[u8]) -> Result<Self, String> {
        let volume = Volume::decode(bytes)?;
        if ![1, 3, 6].contains(&volume.channels) {
            let channels = volume.channels;
            return Err(format!(
                "it has {channels} channels, and 1, 3 or 6 are read"
            ));
        }
        let mut notes = Vec::new();
        if volume.behind > 0 {
            notes.push(behind(volume.behind));
        }
        let size = UVec3::from_array(volume.size.map(|side| side as u32));
        let mut beside = None;
        let mut values = match volume.channels {
            1 => Values::One(volume.samples),
            6 => {
                let halves = || volume.samples.as_chunks::<3>().0.iter().copied();
                beside = Some(halves().skip(1).step_by(2).collect());
                Values::Three(halves().step_by(2).collect())
            }
            _ => Values::Three(volume.samples.as_chunks::<3>().0.to_vec()),
        };
        notes.extend(refuse_bad(&mut values, size)?);
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
        let [low, high] = volume
            .bounds
            .map(|corner| Vec3::from_array(corner).as_dvec3());
        let has_box = low.is_finite() && high.is_finite() && low.cmplt(high).all();
        Ok(Self {
            size,
            place: has_box
                .then(|| DAffine3::from_translation(low) * DAffine3::from_scale(high - low)),
            values,
            beside,
            notes,
        })
    }
}

/// A note on bytes after the data of a file.
pub(crate) fn behind(count: usize) -> String {
    let (bytes, are) = match count {
        1 => ("byte", "is"),
        _ => ("bytes", "are"),
    };
    format!("{count} {bytes} behind its values {are} passed over")
}

/// Values so little below 0, as a share of the largest, are what compression leaves of 0.
const ROUNDING: f32 = 1e-5;

/// Refuses values that no density, albedo or emission has. Values slightly below 0, by rounding, become 0, with a note.
pub(crate) fn refuse_bad(values: &mut Values, size: UVec3) -> Result<Option<String>, String> {
    let (values, channels) = match values {
        Values::One(values) => (values.as_mut_slice(), 1),
        Values::Three(values) => (values.as_flattened_mut(), 3),
    };
    let largest = values.iter().fold(0.0_f32, |most, value| most.max(*value));
    let least = -ROUNDING * if largest > 0.0 { largest } else { 1.0 };
    let bad = |value: &f32| !(value.is_finite() && *value >= least);
    if let Some(index) = values.iter().position(bad) {
        let place = index / channels;
        let (x, y) = (size.x as usize, size.y as usize);
        return Err(format!(
            "the value at ({}, {}, {}) is {}, and values are finite and not below 0",
            place % x,
            place / x % y,
            place / x / y,
            values[index]
        ));
    }
    let (mut count, mut lowest) = (0, 0.0_f32);
    for value in values.iter_mut().filter(|value| **value < 0.0) {
        count += 1;
        lowest = lowest.min(*value);
        *value = 0.0;
    }
    Ok((count > 0).then(|| {
        format!("{count} of its values are a little below 0 (down to {lowest:e}), and count as 0")
    }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

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
        let place = read.place.expect("a box");
        assert_eq!(
            place.transform_point3(DVec3::ONE),
            DVec3::new(1.0, 2.0, 3.0)
        );
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
        says(b"VOX\x03", "shorter than a volume's header");
        says(&[&b"VOL\x02"[..], &[0; 44]].concat(), "version 2");
        says(&file([2, 1, 1, 1, 1], BOX, &[0.0]), "sample type is 2");
        // A header that claims more than a machine has costs nothing.
        says(
            &file([1, i32::MAX, i32::MAX, i32::MAX, 3], BOX, &[0.0]),
            "ends after 52 bytes of",
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
    }

    #[test]
    fn what_does_no_harm_is_told_and_passed_over() {
        let mut bytes = file(
            [1, 3, 1, 1, 1],
            [1.0, 0.0, 0.0, 0.0, 1.0, 1.0],
            &[2.0, -1e-9, 0.0],
        );
        bytes.push(0);
        let read = VolFile::read(&bytes).expect("usable");
        assert!(read.place.is_none(), "its box is turned inside out");
        assert_eq!(read.values, Values::One(vec![2.0, 0.0, 0.0]));
        assert_eq!(read.notes[0], "1 byte behind its values is passed over");
        assert!(read.notes[1].contains("down to -1e-9"), "{}", read.notes[1]);
    }
}
