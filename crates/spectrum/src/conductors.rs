//! Complex refractive indices n̂ = η − i k of named conductors, 360–830 nm.
//!
//! The numbers are measurements collected by refractiveindex.info (Polyanskiy 2024), one page per
//! name; `data/conductors.txt` names the page. Names are Mitsuba's where it has them. A name with
//! the suffix `_palik` is known where the page is the very measurement that Palik's handbook
//! reprints.

use crate::tabulated::{Irregular, Outside};
use crate::{Spectrum, SpectrumError};

/// The tables, written by `cargo xtask tables`.
const TABLE: &str = include_str!("../data/conductors.txt");

/// Names that mean another name's data: Palik's handbook quotes these pages.
const SAME: &[(&str, &str)] = &[("Cu_palik", "Cu"), ("d-C_palik", "d-C"), ("Hg_palik", "Hg")];

/// η and k of the conductor `name`, held constant beyond 360 and 830 nm; `None` without data.
/// Names are case-sensitive, as they are file names in Mitsuba.
pub fn lookup(name: &str) -> Option<(Spectrum, Spectrum)> {
    let name = SAME
        .iter()
        .find(|(other, _)| *other == name)
        .map_or(name, |(_, data)| data);
    let mut lines = TABLE.lines();
    lines.by_ref().find(|line| header(line) == Some(name))?;
    let mut columns: [Vec<f64>; 3] = Default::default();
    for line in lines.take_while(|line| !line.is_empty()) {
        for (column, word) in columns.iter_mut().zip(line.split(' ')) {
            column.push(word.parse().ok()?);
        }
    }
    let [wavelengths, eta, k] = &columns;
    Some((held(wavelengths, eta).ok()?, held(wavelengths, k).ok()?))
}

/// Names [`lookup`] knows.
pub fn names() -> impl Iterator<Item = &'static str> {
    TABLE
        .lines()
        .filter_map(header)
        .chain(SAME.iter().map(|(name, _)| *name))
}

/// The name in the line that begins a material.
fn header(line: &str) -> Option<&str> {
    line.strip_prefix('[')?
        .split_once(']')
        .map(|(name, _)| name)
}

/// `values` at `wavelengths`, held constant beyond them.
pub(crate) fn held(wavelengths: &[f64], values: &[f64]) -> Result<Spectrum, SpectrumError> {
    Irregular::with_outside(wavelengths, values, Outside::Hold).map(Spectrum::from)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::illuminants;

    /// Reflectance at normal incidence, seen under D65, as linear Rec. 709.
    fn colour(name: &str) -> [f64; 3] {
        let (eta, k) = lookup(name).expect("the conductor has data");
        let xyz = crate::cie::xyz(|lambda| {
            let (n, k) = (eta.eval_at(lambda), k.eval_at(lambda));
            let square = k * k;
            illuminants::d65(lambda) * ((n - 1.0) * (n - 1.0) + square)
                / ((n + 1.0) * (n + 1.0) + square)
        });
        crate::colour_space::xyz_to_rgb(xyz)
    }

    #[test]
    fn every_name_has_data() {
        assert!(names().count() >= 15);
        for name in names() {
            let (eta, k) = lookup(name).expect("names() lists what lookup knows");
            for lambda in [300.0, 360.0, 555.5, 830.0, 900.0] {
                assert!(eta.eval_at(lambda) > 0.0, "{name} at {lambda}");
                assert!(k.eval_at(lambda) >= 0.0, "{name} at {lambda}");
            }
        }
        assert_eq!(lookup("unobtainium"), None);
        assert_eq!(lookup("none"), None);
        assert_eq!(lookup("au"), None);
    }

    #[test]
    fn metals_have_their_colours() {
        let [r, g, b] = colour("Au");
        assert!(
            r > 0.95 && (0.7..0.85).contains(&g) && b < 0.45,
            "{r} {g} {b}"
        );
        let [r, g, b] = colour("Cu");
        assert!(r > 0.9 && g < 0.7 && b < 0.6, "{r} {g} {b}");
        let [r, g, b] = colour("Ag");
        assert!(r > 0.93 && g > 0.93 && b > 0.88, "{r} {g} {b}");
        // Diamond is nearly transparent: its Fresnel reflectance at n = 2.42 is 0.172.
        assert!(colour("d-C").iter().all(|c| (c - 0.172).abs() < 0.006));
    }

    #[test]
    fn values_are_the_published_ones() {
        // Hagemann, Gudat, Kunz 1975 as printed on the page, and Inagaki, Arakawa, Williams 1981.
        let (eta, k) = lookup("Hg").expect("mercury has data");
        let (n, k) = (eta.eval_at(619.92), k.eval_at(619.92));
        assert!((n - 1.9).abs() < 0.15 && (k - 5.17).abs() < 0.2, "{n} {k}");
    }
}
