//! The colour checker: 24 patches of measured reflectance ρ(λ) under a sky of spectral radiance
//! S(λ): L = ρ S, since nothing stands between patch and sky.
//!
//! C = M ∫ (x̄, ȳ, z̄) ρ S dλ / N by Simpson's rule on every nanometre (all tables are linear between
//! whole nanometres, so the integrand is cubic there and the rule exact).

use super::light::{known, rgb};
use crate::claim::Claim;
use crate::folders;
use etalon::judge::Known;
use std::path::Path;

/// Patches in a row.
const COLUMNS: u32 = 6;
/// Rows of patches.
const ROWS: u32 = 4;

/// The picture of the patches. They must be of whole pixels.
pub fn picture(claim: &Claim, size: [u32; 2]) -> Result<Known, String> {
    if !size[0].is_multiple_of(COLUMNS) || !size[1].is_multiple_of(ROWS) {
        return Err("the patches of the colour checker must be of whole pixels".to_owned());
    }
    let folder = folders::scenes().join("colour-checker");
    let light = table(&folder.join(claim.text("illuminant")?))?;
    let patches = folder.join("patches");
    let entries = std::fs::read_dir(&patches).map_err(|e| format!("{}: {e}", patches.display()))?;
    let mut paths: Vec<_> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .collect();
    paths.sort();
    let mut colours = Vec::new();
    for path in &paths {
        let reflectance = table(path)?;
        colours.push(rgb(|l| at(&light, l) * at(&reflectance, l)));
    }
    if colours.len() != (COLUMNS * ROWS) as usize {
        return Err(format!("{} patches instead of 24", colours.len()));
    }
    Ok(known(size, |column, row| {
        let patch = row * ROWS / size[1] * COLUMNS + column * COLUMNS / size[0];
        colours[patch as usize]
    }))
}

/// Reads pairs of wavelength (nm) and value, one a line.
fn table(path: &Path) -> Result<Vec<[f64; 2]>, String> {
    let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
    text.lines()
        .filter(|line| !line.starts_with('#') && !line.trim().is_empty())
        .map(|line| {
            let numbers: Result<Vec<f64>, _> = line.split_whitespace().map(str::parse).collect();
            match numbers.as_deref() {
                Ok(&[lambda, value]) => Ok([lambda, value]),
                _ => Err(format!("{}: `{line}` is not two numbers", path.display())),
            }
        })
        .collect()
}

/// Linear interpolation.
fn at(table: &[[f64; 2]], lambda: f64) -> f64 {
    let next = table.partition_point(|[l, _]| *l <= lambda);
    let (Some(&[l0, v0]), Some(&[l1, v1])) = (table.get(next.saturating_sub(1)), table.get(next))
    else {
        return table.last().map_or(0.0, |[_, value]| *value);
    };
    v0 + (v1 - v0) * (lambda - l0) / (l1 - l0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_linear_between_their_rows() {
        let table = [[400.0, 1.0], [410.0, 3.0], [500.0, 0.0]];
        assert_eq!(at(&table, 400.0), 1.0);
        assert_eq!(at(&table, 405.0), 2.0);
        assert_eq!(at(&table, 410.0), 3.0);
        assert_eq!(at(&table, 500.0), 0.0);
    }
}
