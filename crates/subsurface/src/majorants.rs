//! A grid of upper bounds on a medium's extinction, and the way of a ray through it.
//!
//! The grid has two levels: blocks of 8³ cells, each with the largest of its cells. A ray goes from block to block, and
//! from cell to cell only within blocks that are not empty (J. Amanatides & A. Woo 1987, "A Fast Voxel Traversal
//! Algorithm for Ray Tracing"). Outside of the grid there is nothing.

use etalon_transport::Ray;
use glam::{IVec3, UVec3, Vec3};

/// A stretch of a ray, from the end of the one before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MajorantSegment {
    /// Where it ends (m along the ray).
    pub end: f32,
    /// σ̄ in it: not below the extinction of any lane (m⁻¹).
    pub majorant: f32,
    /// A part of that, below σ̄, which residual tracking treats in closed form; zero for all others (m⁻¹).
    pub control: f32,
}

/// Cells along each side of a block.
const BLOCK: u32 = 8;

/// Upper bounds of the extinction (m⁻¹) in the cells of a box.
#[derive(Clone, Debug, PartialEq)]
pub struct MajorantGrid {
    low: Vec3,
    high: Vec3,
    cells: Lattice,
    blocks: Lattice,
    /// Lower bounds in the same cells, if they are of use.
    controls: Option<Vec<f32>>,
}

/// Values in equal cells.
#[derive(Clone, Debug, PartialEq)]
struct Lattice {
    count: UVec3,
    /// Sides of a cell (m).
    side: Vec3,
    /// By z, y and x.
    values: Vec<f32>,
}

impl Lattice {
    fn place(&self, cell: IVec3) -> usize {
        let [x, y, z] = cell.to_array().map(|i| i as usize);
        let [columns, rows] = [self.count.x as usize, self.count.y as usize];
        (z * rows + y) * columns + x
    }

    fn at(&self, cell: IVec3) -> f32 {
        self.values[self.place(cell)]
    }
}

impl MajorantGrid {
    /// A grid of about `along` cells along the longest side of the box from `low` to `high`, with the bound that
    /// `most` knows for each cell.
    pub fn new(low: Vec3, high: Vec3, along: u32, most: impl Fn(Vec3, Vec3) -> f32) -> Self {
        let size = high - low;
        let parts = size / size.max_element() * along as f32;
        let blocks = (parts / BLOCK as f32).ceil().as_uvec3().max(UVec3::ONE);
        let count = if along <= 1 {
            UVec3::ONE
        } else {
            blocks * BLOCK
        };
        let blocks = count.map(|n| n.div_ceil(BLOCK));
        let side = size / count.as_vec3();
        let mut cells = Lattice {
            count,
            side,
            values: Vec::with_capacity((count.x * count.y * count.z) as usize),
        };
        let mut largest = vec![0.0_f32; (blocks.x * blocks.y * blocks.z) as usize];
        for z in 0..count.z {
            for y in 0..count.y {
                for x in 0..count.x {
                    let cell = UVec3::new(x, y, z);
                    let corner = low + side * cell.as_vec3();
                    let value = most(corner, corner + side);
                    cells.values.push(value);
                    let block = cell / BLOCK;
                    let place = (block.z * blocks.y + block.y) * blocks.x + block.x;
                    let largest = &mut largest[place as usize];
                    *largest = largest.max(value);
                }
            }
        }
        Self {
            low,
            high,
            cells,
            blocks: Lattice {
                count: blocks,
                side: size / blocks.as_vec3(),
                values: largest,
            },
            controls: None,
        }
    }

    /// The same with lower bounds, too, which `least` knows.
    #[must_use]
    pub fn with_controls(self, least: impl Fn(Vec3, Vec3) -> f32) -> Self {
        let Lattice { count, side, .. } = self.cells;
        let places = 0..self.cells.values.len() as u32;
        let control = |place: u32| {
            let cell = UVec3::new(
                place % count.x,
                place / count.x % count.y,
                place / count.x / count.y,
            );
            let corner = self.low + side * cell.as_vec3();
            // Not above the upper bound, in spite of rounding.
            let most = self.cells.at(cell.as_ivec3());
            least(corner, corner + side).clamp(0.0, 0.999 * most)
        };
        let controls = places.map(control).collect();
        Self {
            controls: Some(controls),
            ..self
        }
    }

    /// The corners of its box.
    pub fn bounds(&self) -> [Vec3; 2] {
        [self.low, self.high]
    }

    /// The largest of all.
    pub fn largest(&self) -> f32 {
        self.blocks
            .values
            .iter()
            .fold(0.0, |most, value| most.max(*value))
    }

    /// The interval of the ray within the grid, up to `t_max` (m).
    fn crossing(&self, ray: &Ray, t_max: f32) -> Option<[f32; 2]> {
        let inverse = ray.direction.recip();
        let (a, b) = (
            (self.low - ray.origin) * inverse,
            (self.high - ray.origin) * inverse,
        );
        // Rays within a side's plane are not a number there; `min` and `max` leave those out.
        let from = a.min(b).max_element().max(0.0);
        let to = a.max(b).min_element().min(t_max);
        (from < to).then_some([from, to])
    }
}

/// Stretches of a ray with their majorants.
#[derive(Clone, Debug)]
pub enum Segments<'a> {
    /// One.
    Constant(Option<MajorantSegment>),
    /// Those of a grid.
    Grid(GridSegments<'a>),
}

impl<'a> Segments<'a> {
    /// The same all along.
    pub fn constant(majorant: f32, control: f32) -> Self {
        Self::Constant(Some(MajorantSegment {
            end: f32::INFINITY,
            majorant,
            control,
        }))
    }

    /// Through a grid.
    #[inline]
    pub fn through(grid: &'a MajorantGrid, ray: &Ray, t_max: f32) -> Self {
        let Some([from, to]) = grid.crossing(ray, t_max) else {
            return Self::constant(0.0, 0.0);
        };
        let blocks = Walk::new(grid, &grid.blocks, ray, from, to);
        Self::Grid(GridSegments {
            grid,
            ray: *ray,
            before: (from > 0.0).then_some(from),
            blocks,
            cells: None,
        })
    }
}

impl Iterator for Segments<'_> {
    type Item = MajorantSegment;

    #[inline]
    fn next(&mut self) -> Option<MajorantSegment> {
        match self {
            Self::Constant(segment) => segment.take(),
            Self::Grid(grid) => grid.next(),
        }
    }
}

/// A ray's way through a grid.
#[derive(Clone, Debug)]
pub struct GridSegments<'a> {
    grid: &'a MajorantGrid,
    ray: Ray,
    /// Where the ray enters the grid, until that segment has been returned.
    before: Option<f32>,
    blocks: Walk,
    cells: Option<Walk>,
}

/// A stretch without anything.
fn empty(end: f32) -> MajorantSegment {
    MajorantSegment {
        end,
        majorant: 0.0,
        control: 0.0,
    }
}

impl GridSegments<'_> {
    /// A stretch through a cell.
    #[inline]
    fn cell(&self, cell: IVec3, end: f32) -> MajorantSegment {
        let place = self.grid.cells.place(cell);
        let controls = self.grid.controls.as_ref();
        MajorantSegment {
            end,
            majorant: self.grid.cells.values[place],
            control: controls.map_or(0.0, |controls| controls[place]),
        }
    }

    #[inline]
    fn next(&mut self) -> Option<MajorantSegment> {
        if let Some(end) = self.before.take() {
            return Some(empty(end));
        }
        loop {
            if let Some(cells) = &mut self.cells {
                if let Some((cell, _, end)) = cells.next() {
                    return Some(self.cell(cell, end));
                }
                self.cells = None;
            }
            let (block, begin, end) = self.blocks.next()?;
            if self.grid.blocks.at(block) == 0.0 {
                return Some(empty(end));
            }
            if self.grid.cells.count == UVec3::ONE {
                return Some(self.cell(block, end));
            }
            self.cells = Some(Walk::new(
                self.grid,
                &self.grid.cells,
                &self.ray,
                begin,
                end,
            ));
        }
    }
}

/// From cell to cell along a ray.
#[derive(Clone, Debug)]
struct Walk {
    cell: IVec3,
    last: IVec3,
    step: IVec3,
    /// Distance at which the ray leaves the cell along each axis (m), and its increment per step.
    leaves: Vec3,
    stride: Vec3,
    t: f32,
    end: f32,
}

impl Walk {
    #[inline]
    fn new(grid: &MajorantGrid, lattice: &Lattice, ray: &Ray, from: f32, to: f32) -> Self {
        let last = lattice.count.as_ivec3() - 1;
        let place = (ray.at(from) - grid.low) / lattice.side;
        let cell = place.floor().as_ivec3().clamp(IVec3::ZERO, last);
        let forward = ray.direction.cmpgt(Vec3::ZERO);
        let step = IVec3::select(forward, IVec3::ONE, IVec3::NEG_ONE);
        let edge = (cell + IVec3::select(forward, IVec3::ONE, IVec3::ZERO)).as_vec3();
        let inverse = ray.direction.recip();
        let leaves = (grid.low + edge * lattice.side - ray.origin) * inverse;
        let still = ray.direction.cmpeq(Vec3::ZERO);
        Self {
            cell,
            last,
            step,
            leaves: Vec3::select(still, Vec3::INFINITY, leaves),
            stride: (lattice.side * inverse).abs(),
            t: from,
            end: to,
        }
    }

    /// A cell, and where the ray enters and leaves it (m).
    #[inline]
    fn next(&mut self) -> Option<(IVec3, f32, f32)> {
        if !(self.t < self.end) {
            return None;
        }
        let (cell, begin) = (self.cell, self.t);
        let leave = self.leaves.min_element();
        let axis = self
            .leaves
            .to_array()
            .iter()
            .position(|t| *t == leave)
            .unwrap_or(0);
        self.cell[axis] += self.step[axis];
        self.leaves[axis] += self.stride[axis];
        // Beyond the last cell nothing is left but what rounding made of the end.
        let outside = self.cell[axis] < 0 || self.cell[axis] > self.last[axis];
        self.t = if outside {
            self.end
        } else {
            leave.clamp(begin, self.end)
        };
        Some((cell, begin, self.t))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A density, and a bound of it over a box: a bump that is nowhere steeper than 1 m⁻².
    fn density(p: Vec3) -> f32 {
        (1.0 - (p - 0.3).length()).max(0.0)
    }

    fn bound(low: Vec3, high: Vec3) -> f32 {
        let least = (low - 0.3).max(0.3 - high).max(Vec3::ZERO).length();
        (1.0 - least).max(0.0)
    }

    proptest! {
        /// Stretches cover the ray in order, hold the density down wherever the grid is, and are empty where it is not.
        #[test]
        fn stretches_cover_the_ray(
            origin in prop::array::uniform3(-3.0_f32..3.0),
            direction in prop::array::uniform3(-1.0_f32..1.0),
            flat in 0_usize..4,
            along in prop::sample::select(vec![1_u32, 7, 40]),
            t_max in prop::sample::select(vec![0.5_f32, 4.0, f32::INFINITY]),
        ) {
            let mut direction = Vec3::from_array(direction);
            if flat < 3 {
                direction[flat] = 0.0;
            }
            prop_assume!(direction.length() > 0.1);
            let ray = Ray::new(Vec3::from_array(origin), direction.normalize(), 0.0);
            let low = Vec3::new(-1.0, -0.8, -0.9);
            let grid = MajorantGrid::new(low, Vec3::splat(1.5), along, bound);
            let segments: Vec<_> = Segments::through(&grid, &ray, t_max).collect();
            prop_assert!(segments.len() < 500);
            let mut begin = 0.0;
            for segment in &segments {
                prop_assert!(segment.end >= begin, "{segments:?}");
                for k in 0..8 {
                    let t = begin + (segment.end.min(t_max).min(20.0) - begin) * (k as f32 + 0.5) / 8.0;
                    let p = ray.at(t);
                    // Rounding may find a point just outside of the cell.
                    let inside = p.cmpgt(low + 1e-4).all() && p.cmplt(Vec3::splat(1.5 - 1e-4)).all();
                    if inside {
                        prop_assert!(density(p) <= segment.majorant + 1e-3, "{p} {segment:?}");
                    }
                }
                begin = segment.end;
            }
            // Nothing is left over within the grid.
            let end = segments.last().map_or(0.0, |segment| segment.end);
            if end < t_max {
                let p = ray.at(end + 1e-3);
                let inside = p.cmpgt(low + 2e-3).all() && p.cmplt(Vec3::splat(1.498)).all();
                prop_assert!(!inside, "{p} {segments:?}");
            }
        }
    }
}
