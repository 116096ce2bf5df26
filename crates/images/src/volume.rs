//! Mitsuba's volume files: numbers on a grid.
//!
//! `VOL`, the version 3, then in little-endian 32-bit words: the sample type (1: float), the size along x, y and z, the
//! number of channels, the box's corners (six floats), and the samples, channels first, then x, y and z.

/// Samples on a grid of points.
#[derive(Clone, Debug, PartialEq)]
pub struct Volume {
    /// Points along x, y and z: 1 at least.
    pub size: [usize; 3],
    /// Numbers at each point: 1 at least.
    pub channels: usize,
    /// The corners of the box that the file names.
    pub bounds: [[f32; 3]; 2],
    /// All numbers.
    pub samples: Vec<f32>,
}

/// The most numbers that are read (2 GiB).
const MOST: u64 = 1 << 29;

impl Volume {
    /// Reads a volume, or says what is wrong with it.
    pub fn decode(bytes: &[u8]) -> Result<Self, String> {
        let broken = |reason: String| Err(reason);
        let Some(header) = bytes.get(..48) else {
            return broken("it is shorter than a volume's header of 48 bytes".into());
        };
        if header[..3] != *b"VOL" {
            return broken("it does not begin with `VOL`".into());
        }
        if header[3] != 3 {
            return broken(format!("it has version {}, not 3", header[3]));
        }
        let word = |index: usize| {
            let bytes: [u8; 4] = core::array::from_fn(|k| header[4 * index + k]);
            i32::from_le_bytes(bytes)
        };
        if word(1) != 1 {
            return broken(format!(
                "its sample type is {}; only 1, 32-bit floats, can be read",
                word(1)
            ));
        }
        let sizes = [2, 3, 4, 5].map(|index| usize::try_from(word(index)).unwrap_or(0));
        let count = (sizes.iter()).try_fold(1_u64, |n, &size| n.checked_mul(size as u64));
        let count = count.filter(|count| (1..=MOST).contains(count));
        let Some(count) = count else {
            return broken(format!(
                "its size {} × {} × {} with {} channels is not between 1 and {MOST} numbers",
                word(2),
                word(3),
                word(4),
                word(5)
            ));
        };
        let wanted = 48 + 4 * count as usize;
        if bytes.len() < wanted {
            return broken(format!("it ends after {} bytes of {wanted}", bytes.len()));
        }
        let float = |index: usize| f32::from_bits(word(index) as u32);
        let corner = |first: usize| core::array::from_fn(|axis| float(first + axis));
        let samples = bytes[48..wanted]
            .chunks_exact(4)
            .map(|four| f32::from_le_bytes(core::array::from_fn(|k| four[k])));
        Ok(Self {
            size: [sizes[0], sizes[1], sizes[2]],
            channels: sizes[3],
            bounds: [corner(6), corner(9)],
            samples: samples.collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(size: [i32; 4], count: usize) -> Vec<u8> {
        let mut bytes = b"VOL\x03".to_vec();
        for word in [1].into_iter().chain(size) {
            bytes.extend(word.to_le_bytes());
        }
        for x in [0.0_f32, 0.0, 0.0, 1.0, 2.0, 3.0] {
            bytes.extend(x.to_le_bytes());
        }
        bytes.extend((0..count).flat_map(|k| (k as f32).to_le_bytes()));
        bytes
    }

    #[test]
    fn a_volume_is_read() {
        let volume = Volume::decode(&file([2, 3, 4, 1], 24)).expect("a volume");
        assert_eq!((volume.size, volume.channels), ([2, 3, 4], 1));
        assert_eq!(volume.bounds, [[0.0; 3], [1.0, 2.0, 3.0]]);
        assert_eq!(volume.samples[23], 23.0);
    }

    #[test]
    fn mistakes() {
        let message = |bytes: &[u8]| Volume::decode(bytes).expect_err("broken");
        assert!(message(b"VOL").contains("48 bytes"));
        assert!(message(&[0; 60]).contains("begin with `VOL`"));
        assert!(message(&file([2, 3, 4, 1], 23)).contains("ends after 140 bytes of 144"));
        assert!(message(&file([-2, 3, 4, 1], 0)).contains("-2 × 3 × 4"));
        let huge = i32::MAX;
        assert!(message(&file([huge; 4], 0)).contains("numbers"));
        let mut other = file([1; 4], 1);
        other[4] = 2;
        assert!(message(&other).contains("sample type is 2"));
    }
}
