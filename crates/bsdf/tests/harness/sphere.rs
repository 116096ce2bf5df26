//! The sphere in cells of equal area, and quadrature over them.

use core::f32::consts::TAU;
use etalon_bsdf::quadrature::gauss_legendre;
use etalon_math::float64;
use glam::Vec3;

/// Cells along the axis and around it. The horizon is a boundary.
const ROWS: usize = 32;
const COLUMNS: usize = 32;

/// How many cells there are.
pub(crate) const CELLS: usize = ROWS * COLUMNS;

/// The cell that contains a direction.
pub(crate) fn cell(w: Vec3) -> usize {
    let row = (0.5 * (w.z + 1.0) * ROWS as f32) as usize;
    let turns = etalon_math::float::atan2(w.y, w.x) / TAU;
    let column = ((turns - turns.floor()) * COLUMNS as f32) as usize;
    row.min(ROWS - 1) * COLUMNS + column.min(COLUMNS - 1)
}

/// The integral of `f` over each cell (sr), by Gauss–Legendre quadrature with `points` nodes in
/// either angle.
pub(crate) fn integrate<const N: usize>(
    points: usize,
    f: impl Fn(Vec3) -> [f32; N],
) -> Vec<[f64; N]> {
    let nodes = gauss_legendre(points);
    let azimuths: Vec<(f32, f32)> = (0..COLUMNS)
        .flat_map(|column| nodes.iter().map(move |(x, _)| column as f64 + x))
        .map(|x| etalon_math::float::sin_cos_turns((x / COLUMNS as f64) as f32))
        .collect();
    let latitude = |row: usize| float64::acos(1.0 - 2.0 * row as f64 / ROWS as f64);
    let mut cells = vec![[0.0; N]; CELLS];
    for row in 0..ROWS {
        let (low, high) = (latitude(row), latitude(row + 1));
        for (x, weight) in &nodes {
            let (sin, cos) = float64::sin_cos(low + x * (high - low));
            let strip = sin * weight * (high - low) * 2.0 * core::f64::consts::PI / COLUMNS as f64;
            // Row 0 is at the bottom.
            let (radius, z) = (sin as f32, -cos as f32);
            for (j, (sin, cos)) in azimuths.iter().enumerate() {
                let value = f(Vec3::new(radius * cos, radius * sin, z));
                let cell = &mut cells[row * COLUMNS + j / points];
                for (sum, v) in cell.iter_mut().zip(value) {
                    *sum += f64::from(v) * strip * nodes[j % points].1;
                }
            }
        }
    }
    cells
}

/// The sum over all cells.
pub(crate) fn total<const N: usize>(cells: &[[f64; N]]) -> [f64; N] {
    cells.iter().fold([0.0; N], |mut sum, cell| {
        sum.iter_mut().zip(cell).for_each(|(s, c)| *s += c);
        sum
    })
}
