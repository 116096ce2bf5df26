//! Parts of a picture: a wrong shape hides in a mean.

/// Tiles along a side of a picture.
pub const TILES: u32 = 4;

/// The relative difference of a tile beyond which a program differs, unless [`crate::rules::Rules`] say otherwise.
pub const BOUND: f64 = 0.03;

/// The mean of a tile of a picture.
pub fn mean(means: &[f64], pixels: u32, [column, row]: [u32; 2]) -> f64 {
    let side = (pixels / TILES) as usize;
    let [left, top] = [column, row].map(|n| n as usize * side);
    let rows = (top..top + side).map(|y| &means[y * pixels as usize + left..][..side]);
    rows.flatten().sum::<f64>() / (side * side) as f64
}
