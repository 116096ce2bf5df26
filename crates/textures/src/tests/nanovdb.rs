//! A NanoVDB file by another program, and broken ones.

use super::*;

/// 12 × 5 × 9 values 1 + i + j/16 + k/256 among zeros, 0.25 m apart, the first at (−1, 0.5, 2): written by NVIDIA Warp 1.19,
/// with zip.
const RAMP: &[u8] = include_bytes!("ramp.nvdb");

/// The same without compression.
fn plain() -> Vec<u8> {
    let (grids, _) = stored(&Bytes(RAMP)).expect("sound");
    let grid = inflated(&grids[0]).expect("sound");
    let mut bytes = RAMP[..RAMP.len() - grids[0].bytes.len() - 8].to_vec();
    bytes[16 + 8..16 + 16].copy_from_slice(&(grid.len() as u64).to_le_bytes());
    bytes[16 + 168] = 0;
    bytes[14] = 0;
    bytes.extend(grid);
    bytes
}

#[test]
fn another_programs_file_has_its_values_in_their_places() {
    for file in [RAMP.to_vec(), plain()] {
        let read = read(&file, None).expect("sound");
        assert_eq!(read.size, UVec3::new(16, 8, 16));
        let Values::One(values) = &read.values else {
            panic!("one channel")
        };
        for (index, value) in values.iter().enumerate() {
            let [i, j, k] = [index % 16, index / 16 % 8, index / 128];
            let inside = i < 12 && j < 5 && k < 9;
            let ramp = 1.0 + i as f32 + j as f32 / 16.0 + k as f32 / 256.0;
            assert_eq!(*value, if inside { ramp } else { 0.0 });
        }
        // Values are in the middle of their cells.
        let first = DVec3::new(0.5 / 16.0, 0.5 / 8.0, 0.5 / 16.0);
        let place = read.place.expect("a place");
        let off = place.transform_point3(first) - DVec3::new(-1.0, 0.5, 2.0);
        assert!(off.length() < 1e-6, "{off}");
        let last = place.transform_point3(DVec3::ONE - first);
        assert!(
            (last - DVec3::new(2.75, 2.25, 5.75)).length() < 1e-6,
            "{last}"
        );
    }
}

#[test]
fn whatever_is_wrong_is_said() {
    let sound = plain();
    // Nodes are large, and nearly all of them is not needed: prefixes near what is.
    let data = sound.len() - stored(&Bytes(&sound)).expect("sound").0[0].bytes.len();
    for length in (0..data + 1000).chain((0..64).map(|i| i * sound.len() / 64)) {
        assert!(read(&sound[..length], None).is_err(), "{length}");
    }
    let says = |change: &dyn Fn(&mut Vec<u8>), words: &str| {
        let mut bytes = sound.clone();
        change(&mut bytes);
        let reason = read(&bytes, None).map(|_| ()).expect_err("wrong");
        assert!(reason.contains(words), "{reason}");
    };
    let to_root = Bytes(&sound).u64(data + GRID + 24).expect("there");
    let root = data + GRID + to_root as usize;
    let put = |bytes: &mut Vec<u8>, at: usize, with: &[u8]| {
        bytes[at..at + with.len()].copy_from_slice(with)
    };
    says(&|b| put(b, 8, &(33_u32 << 21).to_le_bytes()), "version 33");
    says(&|b| put(b, 16 + 32, &[6]), "holds vectors");
    says(&|b| put(b, 16 + 168, &[2]), "Blosc");
    says(
        &|b| put(b, 16 + 8, &u64::MAX.to_le_bytes()),
        "claims 18446744073709551615 bytes",
    );
    // A box of terabytes, one that ends before it begins, and a node beyond the end.
    says(
        &|b| put(b, root + 12, &i32::MAX.to_le_bytes().repeat(3)),
        "at most 134217728",
    );
    says(&|b| put(b, root + 12, &i32::MIN.to_le_bytes()), "empty");
    says(
        &|b| put(b, root + ROOT + 8, &i64::MAX.to_le_bytes()),
        "beyond its end",
    );
    says(
        &|b| put(b, data + 296 + 88, &f64::NAN.to_le_bytes()),
        "no place",
    );
    assert!(read(&sound, Some("smoke")).is_err_and(|reason| reason.contains("no grid `smoke`")));
}

#[test]
fn what_does_no_harm_is_told_and_passed_over() {
    let mut bytes = plain();
    let data = bytes.len() - stored(&Bytes(&bytes)).expect("sound").0[0].bytes.len();
    // What stands outside of all nodes that are there is the background.
    let root = data + GRID + Bytes(&bytes).u64(data + GRID + 24).expect("there") as usize;
    let first = (data..bytes.len() - 4)
        .find(|&at| at > root && Bytes(&bytes).f32(at).is_ok_and(|x| x == 1.0 + 1.0 / 256.0));
    let first = first.expect("the second value of the ramp");
    bytes[first..first + 4].copy_from_slice(&(-1e-7_f32).to_le_bytes());
    bytes.extend([0; 8]);
    let read = read(&bytes, None).expect("usable");
    assert_eq!(read.notes.len(), 2, "{:?}", read.notes);
    assert!(read.notes[0].contains("down to -1e-7"), "{}", read.notes[0]);
    assert_eq!(read.notes[1], "8 bytes behind its values are passed over");
    let Values::One(values) = &read.values else {
        panic!("one channel")
    };
    assert!(values.iter().all(|value| *value >= 0.0));
}

#[test]
fn what_a_file_holds_is_told() {
    let text = summary(RAMP).expect("sound");
    assert!(
        text.contains("32-bit floats") && text.contains("compressed with zip"),
        "{text}"
    );
    // The grid alone, as it lies in memory.
    let (grids, _) = stored(&Bytes(RAMP)).expect("sound");
    let bare = inflated(&grids[0]).expect("sound");
    let said = read(&bare, None).map(|_| ()).expect_err("no file");
    assert!(said.contains("without the header of a file"), "{said}");
}
