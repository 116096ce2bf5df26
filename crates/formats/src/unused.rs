//! Vertices that no triangle uses.
//!
//! Scanners write them without harm, with positions that are no numbers.

use glam::Vec3;

/// Moves vertices whose position is not finite, and that no triangle uses, to where another one is.
/// If a triangle does use one, its number.
pub(crate) fn settle(positions: &mut [Vec3], triangles: &[[u32; 3]]) -> Result<(), usize> {
    if positions.iter().all(|p| p.is_finite()) {
        return Ok(());
    }
    let used = triangles.iter().flatten().map(|&i| i as usize);
    match used.filter(|&i| !positions[i].is_finite()).min() {
        Some(vertex) => return Err(vertex),
        None => {
            let first = triangles.first().map(|t| positions[t[0] as usize]);
            let elsewhere = first.unwrap_or_default();
            for p in positions.iter_mut().filter(|p| !p.is_finite()) {
                *p = elsewhere;
            }
        }
    }
    Ok(())
}
