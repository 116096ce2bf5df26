//! Media in boxes of numbers.

use super::*;
use etalon_images::Volume;

fn medium(text: &str) -> Document {
    let text = format!(
        "WorldBegin MakeNamedMedium \"m\" {text} MediumInterface \"m\" \"\" Material \"interface\" Shape \"sphere\""
    );
    sound(&text)
}

/// pbrt's cells stand in a volume file with a layer of zeros around them, x fastest, where pbrt has the box.
#[test]
fn densities_stand_in_the_document() {
    let document = medium(
        r#""string type" "uniformgrid" "integer nx" 2 "integer ny" 1 "integer nz" 3 "float density" [ 1 2 3 4 5 6 ]
        "point3 p0" [ 0 0 0 ] "point3 p1" [ 2 4 3 ] "float g" 0.3 "float scale" 5"#,
    );
    let volume = Volume::decode(&document.embedded[&0]).expect("a volume");
    assert_eq!((volume.size, volume.channels), ([4, 3, 5], 1));
    assert_eq!(volume.samples[12 + 4 + 1..12 + 4 + 3], [1.0, 2.0]);
    assert_eq!(volume.samples[3 * 12 + 4 + 2], 6.0);
    assert_eq!(volume.samples.iter().sum::<f32>(), 21.0);
    let shape = children(&document.root).pop().expect("a shape");
    let within = shown(&shape);
    // Each cell is 1 × 4 × 1.
    assert!(
        within.contains(
            "transform 4.000000e0 0.000000e0 0.000000e0 0.000000e0 0.000000e0 1.200000e1"
        ),
        "{within}"
    );
    assert!(within.contains("g: float 3.000000e-1"), "{within}");
    // 5 (1 + 1).
    assert!(within.contains("scale: float 1.000000e1"), "{within}");
}

#[test]
fn colours_are_extinction_and_albedo() {
    let document = medium(
        r#""string type" "rgbgrid" "integer nx" 2 "rgb sigma_a" [ 1 0 1 0 0 0 ] "rgb sigma_s" [ 1 2 3 4 5 6 ] "rgb Le" [ 1 1 1 0 0 0 ]"#,
    );
    let samples = |index: usize| {
        let volume = Volume::decode(&document.embedded[&index]).expect("a volume");
        assert_eq!((volume.size, volume.channels), ([4, 3, 3], 3));
        let first = 3 * (12 + 4 + 1);
        volume.samples[first..first + 6].to_vec()
    };
    assert_eq!(samples(0), [2.0, 2.0, 4.0, 4.0, 5.0, 6.0]);
    assert_eq!(samples(1), [0.5, 1.0, 0.75, 1.0, 1.0, 1.0]);
    assert_eq!(samples(2), [1.0, 1.0, 1.0, 0.0, 0.0, 0.0]);
}

#[test]
fn grids_that_do_not_fit() {
    let lines = |parameters: &str| {
        let text = format!(
            "MakeNamedMedium \"m\" \"string type\" \"uniformgrid\" {parameters} MediumInterface \"m\" \"\" Shape \"sphere\""
        );
        world(&text).lines()
    };
    let few = lines("\"integer nx\" 2 \"float density\" [ 1 2 3 ]");
    assert!(
        few.contains("there are 3 `density` for 2 × 1 × 1 cells"),
        "{few}"
    );
    let many = lines(
        "\"integer nx\" 2147483647 \"integer ny\" 2147483647 \"integer nz\" 2147483647 \"float density\" [ 1 ]",
    );
    assert!(many.contains("there are 1 `density`"), "{many}");
    let negative = lines("\"float density\" [ -1 ]");
    assert!(
        negative.contains("`density` of `uniformgrid` cannot be -1"),
        "{negative}"
    );
    assert!(lines("").contains("needs the parameter"), "{}", lines(""));
}
