//! A density on the unit square that is constant in each cell of a grid: the row by the sums of
//! the rows, then the column within it.

use super::{PiecewiseConstant, TableError, check_weights};
use glam::{DVec2, UVec2, Vec2};

/// A piecewise constant density on [0, 1]².
#[derive(Clone, Debug)]
pub struct PiecewiseConstant2d {
    rows: PiecewiseConstant,
    /// One for each row; a row of no weight is uniform (and never chosen).
    columns: Vec<PiecewiseConstant>,
}

impl PiecewiseConstant2d {
    /// The density proportional to `weights`, row by row from y = 0, each of `width` cells.
    ///
    /// # Errors
    /// If the number of weights is no multiple of `width`, there are none, all are zero, or
    /// one is negative or not finite.
    pub fn new(weights: &[f64], width: usize) -> Result<Self, TableError> {
        check_weights(weights, 1)?;
        if width == 0 || !weights.len().is_multiple_of(width) {
            return Err(TableError::WrongShape {
                entries: weights.len(),
                needed: weights.len().next_multiple_of(width.max(1)).max(1),
            });
        }
        let sums: Vec<f64> = weights.chunks(width).map(|row| row.iter().sum()).collect();
        let rows = PiecewiseConstant::new(&sums)?;
        let columns = weights
            .chunks(width)
            .zip(&sums)
            .map(|(row, &sum)| {
                if sum > 0.0 {
                    PiecewiseConstant::new(row)
                } else {
                    PiecewiseConstant::new(&vec![1.0; width])
                }
            })
            .collect::<Result<_, _>>()?;
        Ok(Self { rows, columns })
    }

    /// Numbers of columns and rows.
    #[inline]
    pub fn size(&self) -> UVec2 {
        UVec2::new(self.columns[0].len() as u32, self.rows.len() as u32)
    }

    /// The mean of the weights: the integral over the square of the function they tabulate.
    #[inline]
    pub fn integral(&self) -> f64 {
        self.rows.integral() / f64::from(self.size().x)
    }

    /// A point of the square with this density.
    #[inline]
    pub fn sample(&self, u: Vec2) -> Vec2 {
        let (cell, place) = self.choose(u.as_dvec2());
        self.point_in(cell, place)
    }

    /// The point at `place` ∈ [0, 1)² of a cell, in single precision but never rounded out of
    /// its cell into another, whose density may be zero.
    #[inline]
    pub(super) fn point_in(&self, cell: UVec2, place: DVec2) -> Vec2 {
        let size = self.size().as_dvec2();
        let inside = |cell: f64, place: f64, size: f64| {
            let x = ((cell + place) / size) as f32;
            let back = f64::from(x) * size;
            if back < cell {
                x.next_up()
            } else if back >= cell + 1.0 {
                x.next_down()
            } else {
                x
            }
        };
        Vec2::new(
            inside(cell.x.into(), place.x, size.x),
            inside(cell.y.into(), place.y, size.y),
        )
    }

    /// The cell (column, row) in which `u` ∈ [0, 1)² falls, and where in it, in [0, 1)².
    #[inline]
    pub fn choose(&self, u: DVec2) -> (UVec2, DVec2) {
        let (row, y) = self.rows.choose(u.y);
        let (column, x) = self.columns[row].choose(u.x);
        (UVec2::new(column as u32, row as u32), DVec2::new(x, y))
    }

    /// The inverse of [`PiecewiseConstant2d::choose`].
    #[inline]
    pub fn unchoose(&self, cell: UVec2, place: DVec2) -> DVec2 {
        let columns = &self.columns[cell.y as usize];
        DVec2::new(
            columns.unchoose(cell.x as usize, place.x),
            self.rows.unchoose(cell.y as usize, place.y),
        )
    }

    /// The inverse of [`PiecewiseConstant2d::sample`].
    #[inline]
    pub fn invert(&self, point: Vec2) -> Vec2 {
        let size = self.size();
        let scaled = point.as_dvec2() * size.as_dvec2();
        let cell = scaled.as_uvec2().min(size - UVec2::ONE);
        self.unchoose(cell, scaled - cell.as_dvec2()).as_vec2()
    }

    /// The density at a point of the square, per unit of area.
    #[inline]
    pub fn density(&self, point: Vec2) -> f32 {
        let y = f64::from(point.y);
        let column = &self.columns[self.row(y)];
        (self.rows.density(y) * column.density(f64::from(point.x))) as f32
    }

    #[inline]
    fn row(&self, y: f64) -> usize {
        ((y * self.rows.len() as f64) as usize).min(self.rows.len() - 1)
    }
}
