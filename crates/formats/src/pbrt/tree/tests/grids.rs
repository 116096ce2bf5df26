//! Media in boxes of numbers.

use super::evaluated::Evaluated;
use super::*;
use etalon_images::Volume;
use etalon_math::noise::noise;
use etalon_transport::SpectrumKind;
use glam::{DVec3, Vec2, Vec3, Vec4};

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

/// Temperatures of cells, from which 100 K are taken away and which count thrice: of 500, 1500 K and 3000 K.
#[test]
fn media_glow_by_their_temperature() {
    let document = medium(
        r#""string type" "uniformgrid" "integer nx" 2 "float density" [ 1 1 ] "float temperature" [ 600 1100 ]
        "float temperatureoffset" 100 "float temperaturescale" 3 "float Lescale" 0.5"#,
    );
    let emission = Evaluated::of(&document, "emission", SpectrumKind::Emission);
    let lambda = Vec4::new(450.0, 550.0, 650.0, 750.0);
    // pbrt shows ∫ ȳ L dλ over nanometres, Etalon the luminance of what it has.
    let shown = 106.856_895 / etalon_spectrum::cie::luminance(|_| 1.0);
    for (x, temperature) in [(0.25, 1500.0_f64), (0.75, 3000.0)] {
        let law = |nm: f64| etalon_spectrum::blackbody::radiance(nm, temperature);
        // The maximum is looked for, 1 nm at a time.
        let most = (500..4000).map(|nm| law(nm.into())).fold(0.0, f64::max);
        let expected = lambda
            .to_array()
            .map(|nm| (0.5 * shown * law(nm.into()) / most) as f32);
        let found = emission.spectrum(Vec3::new(x, 0.5, 0.5), lambda);
        let off = (found / Vec4::from_array(expected) - 1.0).abs();
        assert!(
            off.max_element() < 1e-3,
            "{temperature} {found} {expected:?}"
        );
    }
    let both = "MakeNamedMedium \"m\" \"string type\" \"uniformgrid\" \"float density\" 1 \"float temperature\" 600 \"rgb Le\" [ 1 1 1 ]
        MediumInterface \"m\" \"\" Shape \"sphere\"";
    let said = world(both).lines();
    assert!(
        said.contains("either by `Le` or by its `temperature`"),
        "{said}"
    );
}

#[test]
fn files_glow_where_the_scene_says_so() {
    let text = |more: &str| {
        format!(
            "MakeNamedMedium \"m\" \"string type\" \"nanovdb\" \"string filename\" \"a.nvdb\" {more}
             MediumInterface \"m\" \"\" Material \"interface\" Shape \"sphere\""
        )
    };
    let hot = sound(&format!(
        "WorldBegin {}",
        text("\"float Lescale\" 2 \"string temperaturename\" \"heat\"")
    ));
    let shape = shown(&children(&hot.root).pop().expect("a shape"));
    for part in [
        "incandescence",
        "grid_name: string heat",
        "grid_name: string density",
    ] {
        assert!(shape.contains(part), "{part}: {shape}");
    }
    let unsaid = world(&text("")).lines();
    assert!(
        unsaid.contains("note") && unsaid.contains("Lescale"),
        "{unsaid}"
    );
    assert_eq!(world(&text("\"float Lescale\" 0")).lines(), "");
}

/// The density of a cloud against pbrt's loops, with Etalon's noise.
///
/// Mutants rejected: slopes not divided by the step, octaves that do not become finer, no decrease with the height.
#[test]
fn clouds_have_pbrts_density() {
    let text = r#"Translate 0.1 0.2 0.3 MakeNamedMedium "m" "string type" "cloud" "float density" 2 "float wispiness" 0.8 "float frequency" 4
        "point3 p0" [ 0 0 0 ] "point3 p1" [ 1 2 1 ] "spectrum sigma_s" [ 360 1 830 1 ] "spectrum sigma_a" [ 360 0 830 0 ]
        MediumInterface "m" "" Material "interface" Shape "sphere""#;
    let outcome = world(text);
    let document = outcome.document.expect("a document");
    let density = Evaluated::of(&document, "sigma_t", SpectrumKind::Unbounded);
    let mut between = 0;
    for i in 0..300 {
        let part = |k: f64| (f64::from(i) * k).fract();
        let p = DVec3::new(part(0.618), part(0.755) * 1.2, part(0.569));
        let mut q = 4.0 * p;
        let (mut omega, mut kappa) = (0.05 * 0.8, 10.0);
        for _ in 0..2 {
            let at = kappa * q;
            let slope = |axis: DVec3| (noise(at + 0.01 * axis) - noise(at)) / 0.01;
            q += omega * DVec3::new(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z));
            omega *= 0.5;
            kappa *= 1.99;
        }
        let mut sum = 0.0;
        for octave in 0..5 {
            sum += 0.5_f64.powi(octave + 1) * noise(1.99_f64.powi(octave) * q);
        }
        let high = ((1.0 - p.y) * 4.5 * 2.0 * sum).clamp(0.0, 1.0);
        let expected = (high + 2.0 * (0.5 - p.y).max(0.0)).clamp(0.0, 1.0);
        between += usize::from(expected > 0.01 && expected < 0.99);
        let position = (p + DVec3::new(0.1, 0.2, 0.3)).as_vec3();
        let found = f64::from(density.number(position, Vec2::ZERO));
        assert!((found - expected).abs() < 2e-3, "{p} {found} {expected}");
    }
    assert!(between > 50, "{between}");
    let lines = world(text).lines();
    assert!(lines.contains("other random numbers"), "{lines}");
}
