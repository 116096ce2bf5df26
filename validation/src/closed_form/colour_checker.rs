//! The colour checker: 24 patches of measured reflectance ρ(λ) under a sky of spectral radiance
//! S(λ): L = ρ S, since nothing stands between patch and sky.
//!
//! C = M ∫ (x̄, ȳ, z̄) ρ S dλ / N by Simpson's rule on every nanometre (all tables are linear between
//! whole nanometres, so the integrand is cubic there and the rule exact).

use super::light::{known, rgb};
use super::spectra::{at, table};
use crate::claim::Claim;
use crate::folders;
use etalon_render::judge::ExactImage;

/// Patches in a row.
const COLUMNS: u32 = 6;
/// Rows of patches.
const ROWS: u32 = 4;

/// The picture of the patches. They must be of whole pixels.
pub fn picture(claim: &Claim, size: [u32; 2]) -> Result<ExactImage, String> {
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
