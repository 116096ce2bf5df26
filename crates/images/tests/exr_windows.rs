//! EXR pictures that fill a part of their window, and halves that overflowed.

use ::exr::math::Vec2;
use ::exr::prelude::*;
use etalon_images::{Raster, Samples, raster_file};
use std::io::Cursor;
use std::path::Path;

/// A picture of 2 × 1 grey pixels at (`x`, `y`) of a window of 3 × 2, decoded; its numbers, and what is said of it.
fn decoded(samples: FlatSamples, x: i32, y: i32) -> (Vec<f32>, Vec<String>) {
    let raster = raster(samples, x, y);
    let notes = raster.notes(false).map(str::to_owned).collect();
    (raster.to_floats(), notes)
}

fn raster(samples: FlatSamples, x: i32, y: i32) -> Raster {
    let mut attributes = LayerAttributes::named("grey");
    attributes.layer_position = Vec2(x, y);
    let channel = AnyChannel::new("Y", samples);
    let channels: SmallVec<[_; 4]> = core::iter::once(channel).collect();
    let channels = AnyChannels::sort(channels);
    let layer = Layer::new((2, 1), attributes, Encoding::UNCOMPRESSED, channels);
    let window = ImageAttributes::new(IntegerBounds::from_dimensions((3, 2)));
    let mut file = Cursor::new(Vec::new());
    let image = Image::from_layers(window, vec![layer]);
    let writing = image.write().non_parallel().to_buffered(&mut file);
    writing.expect("writes");
    let raster = raster_file::decode(file.get_ref(), Path::new("part.exr")).expect("a picture");
    assert_eq!([raster.width(), raster.height()], [3, 2]);
    raster
}

#[test]
fn pixels_stand_where_the_window_has_them() {
    let pair = || FlatSamples::F32(vec![1.0, 2.0]);
    let (found, notes) = decoded(pair(), 1, 1);
    assert_eq!(found, [0.0, 0.0, 0.0, 0.0, 1.0, 2.0]);
    assert!(
        notes
            .concat()
            .contains("its 2 × 1 pixels lie at (1, 1) of a picture of 3 × 2")
    );
    // What lies beyond the window is cut off.
    assert_eq!(decoded(pair(), -1, 0).0, [2.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
    assert_eq!(decoded(pair(), 0, 7).0, [0.0; 6]);
}

#[test]
fn infinite_halves_are_held() {
    let samples = FlatSamples::F16(vec![f16::INFINITY, f16::from_f32(0.5)]);
    let (found, notes) = decoded(samples, 0, 0);
    assert_eq!(found[..2], [65504.0, 0.5]);
    assert!(
        notes
            .concat()
            .contains("1 of its 16-bit numbers are infinite"),
        "{notes:?}"
    );
    // Floats that are infinite were so from the start: they are refused by their users.
    let (found, notes) = decoded(FlatSamples::F32(vec![f32::INFINITY, 0.5]), 0, 0);
    assert!(found[0].is_infinite() && !notes.concat().contains("infinite"));
}

#[test]
fn halves_stay_halves() {
    let values = [0.25, 3.0].map(f16::from_f32);
    let halves = raster(FlatSamples::F16(values.to_vec()), 0, 0);
    let bits = values.map(f16::to_bits);
    let expected = [bits[0], bits[1], 0, 0, 0, 0];
    assert_eq!(halves.samples(), &Samples::F16(expected.to_vec()));
    assert!(!halves.is_encoded());
    assert_eq!(halves.to_linear(), [0.25, 3.0, 0.0, 0.0, 0.0, 0.0]);
    let floats = raster(FlatSamples::F32(vec![0.25, 3.0]), 0, 0);
    assert!(matches!(floats.samples(), Samples::F32(_)));
}
