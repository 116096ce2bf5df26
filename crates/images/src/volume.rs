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
    /// Bytes after the numbers that the header does not account for.
    pub behind: usize,
}

/// Whether these bytes begin like an OpenVDB file.
fn is_openvdb(bytes: &[u8]) -> bool {
    bytes.starts_with(b" BDV\0\0\0\0")
}

impl Volume {
    /// The contents of a file that [`Self::decode`] reads.
    pub fn encode(&self) -> Vec<u8> {
        let mut bytes = b"VOL\x03".to_vec();
        let [x, y, z] = self.size;
        for word in [1, x, y, z, self.channels] {
            bytes.extend((word as i32).to_le_bytes());
        }
        let corners = self.bounds.as_flattened();
        for number in corners.iter().chain(&self.samples) {
            bytes.extend(number.to_le_bytes());
        }
        bytes
    }

    /// Reads a volume, or reports a mistake. Memory is allocated in proportion to the data, not by the header.
    pub fn decode(bytes: &[u8]) -> Result<Self, String> {
        let broken = |reason: String| Err(reason);
        if is_openvdb(bytes) {
            return broken(
                "it is an OpenVDB file; NanoVDB files are read: `nanovdb_convert in.vdb out.nvdb` makes one".into(),
            );
        }
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
        if sizes.contains(&0) {
            return broken(format!(
                "its size is {} × {} × {} with {} channels, and is 1 or more",
                word(2),
                word(3),
                word(4),
                word(5)
            ));
        }
        let wanted = 48 + 4 * sizes.iter().map(|&size| size as u128).product::<u128>();
        if (bytes.len() as u128) < wanted {
            return broken(format!("it ends after {} bytes of {wanted}", bytes.len()));
        }
        let wanted = wanted as usize;
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
            behind: bytes.len() - wanted,
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
        assert_eq!(volume.encode(), file([2, 3, 4, 1], 24));
    }

    #[test]
    fn mistakes() {
        let message = |bytes: &[u8]| Volume::decode(bytes).expect_err("broken");
        assert!(message(b"VOL").contains("48 bytes"));
        assert!(message(&[0; 60]).contains("begin with `VOL`"));
        assert!(message(&file([2, 3, 4, 1], 23)).contains("ends after 140 bytes of 144"));
        assert!(message(&file([-2, 3, 4, 1], 0)).contains("-2 × 3 × 4"));
        let huge = i32::MAX;
        assert!(message(&file([huge; 4], 0)).contains("ends after 48 bytes of"));
        assert!(message(b" BDV\0\0\0\0").contains("nanovdb_convert"));
        let behind = Volume::decode(&[file([2, 3, 4, 1], 24), vec![7]].concat()).expect("read");
        assert_eq!((behind.samples.len(), behind.behind), (24, 1));
        let mut other = file([1; 4], 1);
        other[4] = 2;
        assert!(message(&other).contains("sample type is 2"));
    }
}
