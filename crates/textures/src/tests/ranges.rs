//! Shares in grids, indices beyond their tables, and spectra with steep edges.

use super::rules::{eval, object, parameter, rgb};
use super::*;
use etalon_params::{DVec3, SpectrumText};
use proptest::prelude::*;

/// A `.vol` file of one cell of three channels.
fn volume(rgb: [f32; 3]) -> Files {
    let mut bytes = b"VOL\x03".to_vec();
    bytes.extend([1, 1, 1, 1, 3].iter().flat_map(|n: &i32| n.to_le_bytes()));
    let corners = [0.0, 0.0, 0.0, 1.0, 1.0, 1.0];
    bytes.extend(
        corners
            .iter()
            .chain(&rgb)
            .flat_map(|x: &f32| x.to_le_bytes()),
    );
    let mut files = Files::default();
    files.0.insert("one.vol".into(), Arc::new(bytes));
    files
}

#[test]
fn shares_in_a_grid_keep_their_colour() {
    for rgb in [[0.99, 0.95, 0.9], [0.999, 0.5, 0.1], [0.2, 0.9, 0.97]] {
        let grid = node("gridvolume", vec![("filename", text("one.vol"))]);
        let one = One::new(&volume(rgb), &grid, SpectrumKind::Reflectance);
        // The spectrum of the same colour given by itself, to the bit, as its colour is.
        let alone = eval(
            Value::Rgb(DVec3::from_array(rgb.map(f64::from))),
            SpectrumKind::Reflectance,
        );
        assert_eq!(one.spectrum(0.5, 0.5), alone, "{rgb:?}");
    }
    // What may exceed 1 is as bright as it was.
    let grid = node("gridvolume", vec![("filename", text("one.vol"))]);
    let one = One::new(&volume([4.0, 2.0, 1.0]), &grid, SpectrumKind::Unbounded);
    let alone = eval(rgb(4.0, 2.0, 1.0), SpectrumKind::Unbounded);
    assert!(close(one.spectrum(0.5, 0.5), alone.to_array(), 1e-5));
}

/// Mutant rejected: an index of 0 beyond the ends of its table, as any other quantity has.
#[test]
fn a_table_of_an_index_goes_on_beyond_its_ends() {
    let table = |plugin: &str, inputs: &[(&'static str, &'static str)]| {
        let mut values = vec![("values", text("1.5, 1.5, 1.5"))];
        values.extend(inputs.iter().map(|&(name, value)| {
            let number = value.parse().map_or(text(value), Value::Float);
            (name, number)
        }));
        object(plugin, values)
    };
    for value in [
        Value::Spectrum(SpectrumText::Samples(vec![(500.0, 1.5), (510.0, 1.5)])),
        table("irregular", &[("wavelengths", "500, 505, 510")]),
        table(
            "regular",
            &[("wavelength_min", "500"), ("wavelength_max", "510")],
        ),
    ] {
        let found = eval(value.clone(), SpectrumKind::Index);
        assert_eq!(found, Vec4::splat(1.5), "{value:?}");
        assert_ne!(eval(value, SpectrumKind::Unbounded), found);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(6), ..ProptestConfig::default() })]

    #[test]
    fn steep_bands_are_not_below_zero(
        start in 3600_u32..8000,
        steps in proptest::collection::vec((1_u32..40, 0_u32..3), 2..12),
    ) {
        let mut wavelength = start;
        let mut pairs = Vec::new();
        for (step, value) in steps {
            pairs.push((f64::from(wavelength) / 10.0, f64::from(value)));
            wavelength += step;
        }
        let band = Value::Spectrum(SpectrumText::Samples(pairs.clone()));
        prop_assert!(parameter(Some(band), None, SpectrumKind::Emission).is_ok(), "{:?}", pairs);
        // And a negative value is found however narrow it is.
        let (at, _) = pairs[pairs.len() / 2];
        if (361.0..829.0).contains(&at) {
            let middle = pairs.len() / 2;
            pairs[middle].1 = -0.1;
            let band = Value::Spectrum(SpectrumText::Samples(pairs.clone()));
            prop_assert!(parameter(Some(band), None, SpectrumKind::Emission).is_err(), "{:?}", pairs);
        }
    }
}
