//! `sdfgrid`: the zero set of a trilinearly interpolated grid; the solid is where it is negative.
//!
//! Between the eight corners of a cell the function is trilinear. Along a line from p to q in a cell it is a cubic,
//! whose Bernstein coefficients are means of its values at points with coordinates of p and q mixed,
//!
//! ```text
//! b₀ = f(p)   b₁ = (f(qx, py, pz) + f(px, qy, pz) + f(px, py, qz))/3   b₂ likewise   b₃ = f(q)
//! ```
//!
//! and whose changes of sign are isolated exactly; cells are walked one after another (J. Amanatides, A. Woo 1987, *A fast
//! voxel traversal algorithm*). Points on a face that two cells share have the same value in both, so that nothing
//! leaks. `normals`: `analytic` is the gradient, which jumps between cells; `smooth` blends those of the eight cells
//! around the nearest grid point (H. Hansson-Söderlund, A. Evans, T. Akenine-Möller 2022, *Ray tracing of signed
//! distance function grids*), for shading only.

use crate::shapes::analytic::crossing::{Crossing, Line};
use crate::shapes::analytic::placed::{OwnPoint, OwnShape, Placed};
use core::ops::ControlFlow;
use etalon_images::Volume;
use etalon_math::bernstein;
use etalon_params::Params;
use etalon_transport::Build;
use etalon_transport::file;
use glam::{DVec2, DVec3};

/// A function on a grid, in the unit cube.
#[derive(Clone, Debug)]
pub struct SdfGrid {
    /// Points along each axis: 2 at least.
    size: [usize; 3],
    samples: Vec<f32>,
    /// Whether the function changes its sign in a cell, or may.
    crossed: Vec<bool>,
    smooth: bool,
    closed: bool,
}

impl SdfGrid {
    /// Reads `filename`, `normals` (`smooth` or `analytic`), `flip_normals` and `to_world`.
    pub(crate) fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Placed<Self>> {
        let smooth = params.choice("normals", "smooth", &["smooth", "analytic"]) == "smooth";
        let what = "a volume file of one channel";
        let grid = file::read(params, build, what, |bytes| {
            Volume::decode(bytes).and_then(|volume| Self::new(volume, smooth))
        });
        Placed::from_params(params, grid)
    }

    fn new(volume: Volume, smooth: bool) -> Result<Self, String> {
        if volume.channels != 1 {
            return Err(format!("it has {} channels, not one", volume.channels));
        }
        if volume.size.into_iter().any(|size| size < 2) {
            return Err("it takes two points or more along each axis".into());
        }
        if volume.samples.iter().any(|sample| !sample.is_finite()) {
            return Err("some of its numbers are not finite".into());
        }
        let size = volume.size;
        let mut grid = Self {
            size,
            samples: volume.samples,
            crossed: Vec::new(),
            smooth,
            closed: true,
        };
        let cells = size.map(|n| n - 1);
        for z in 0..cells[2] {
            for y in 0..cells[1] {
                for x in 0..cells[0] {
                    let corners = grid.corners([x, y, z]);
                    let inside = corners.iter().filter(|f| **f < 0.0).count();
                    grid.crossed.push(inside > 0 && inside < 8);
                }
            }
        }
        if !grid.crossed.contains(&true) {
            return Err("its numbers do not change their sign anywhere".into());
        }
        let mut closed = true;
        for z in 0..size[2] {
            for y in 0..size[1] {
                for x in 0..size[0] {
                    let at = [x, y, z];
                    let border = (0..3).any(|i| at[i] == 0 || at[i] == cells[i]);
                    closed &= !border || grid.sample(at) >= 0.0;
                }
            }
        }
        grid.closed = closed;
        Ok(grid)
    }

    fn sample(&self, [x, y, z]: [usize; 3]) -> f64 {
        self.samples[(z * self.size[1] + y) * self.size[0] + x].into()
    }

    /// The corners of a cell: x first.
    #[inline]
    fn corners(&self, cell: [usize; 3]) -> [f64; 8] {
        core::array::from_fn(|i| {
            self.sample([
                cell[0] + (i & 1),
                cell[1] + (i >> 1 & 1),
                cell[2] + (i >> 2),
            ])
        })
    }

    #[inline]
    fn is_crossed(&self, [x, y, z]: [usize; 3]) -> bool {
        self.crossed[(z * (self.size[1] - 1) + y) * (self.size[0] - 1) + x]
    }

    /// Cells along each axis.
    fn resolution(&self) -> DVec3 {
        DVec3::from(self.size.map(|n| n as f64 - 1.0))
    }

    /// The cell that holds a point of the grid, and where in it.
    fn cell(&self, p: DVec3) -> ([usize; 3], DVec3) {
        let cell = core::array::from_fn(|i| (p[i].max(0.0) as usize).min(self.size[i] - 2));
        (cell, p - DVec3::from(cell.map(|c| c as f64)))
    }

    /// The gradient at a point of a cell, per cell.
    fn gradient(&self, cell: [usize; 3], at: DVec3) -> DVec3 {
        let f = self.corners(cell);
        let slope = |axis: usize| {
            let side = |end: f64| {
                let mut point = at;
                point[axis] = end;
                trilinear(&f, point)
            };
            side(1.0) - side(0.0)
        };
        DVec3::new(slope(0), slope(1), slope(2))
    }

    /// The blend of unit gradients around the grid point nearest to `p`.
    fn smooth_normal(&self, p: DVec3) -> DVec3 {
        let (cell, at) = self.cell(p);
        // The function on a plane of grid points across an axis, beside `p`.
        let plane = |axis: usize, index: i64| {
            let last = self.size[axis] as i64 - 1;
            let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
            let mut sum = 0.0;
            for corner in 0..4 {
                let mut point = cell;
                point[axis] = index.clamp(0, last) as usize;
                let mut weight = 1.0;
                for (i, other) in [b, c].into_iter().enumerate() {
                    let upper = corner >> i & 1;
                    point[other] += upper;
                    weight *= if upper == 1 {
                        at[other]
                    } else {
                        1.0 - at[other]
                    };
                }
                sum += weight * self.sample(point);
            }
            sum
        };
        let lowest: [i64; 3] = core::array::from_fn(|i| p[i].round() as i64 - 1);
        // The slope in the lower and in the upper of two cells, and how much the upper counts.
        let slopes: [[f64; 2]; 3] = core::array::from_fn(|axis| {
            let values = [0, 1, 2].map(|k| plane(axis, lowest[axis] + k));
            let scale = self.size[axis] as f64 - 1.0;
            [
                (values[1] - values[0]) * scale,
                (values[2] - values[1]) * scale,
            ]
        });
        let weights: [f64; 3] = core::array::from_fn(|axis| {
            let last = self.size[axis] as i64 - 2;
            if lowest[axis] < 0 {
                1.0
            } else if lowest[axis] >= last {
                0.0
            } else {
                p[axis] - lowest[axis] as f64 - 0.5
            }
        });
        let mut normal = DVec3::ZERO;
        for corner in 0..8_usize {
            let upper: [usize; 3] = core::array::from_fn(|i| corner >> i & 1);
            let weight: f64 = (0..3)
                .map(|i| [1.0 - weights[i], weights[i]][upper[i]])
                .product();
            let gradient = DVec3::new(
                slopes[0][upper[0]],
                slopes[1][upper[1]],
                slopes[2][upper[2]],
            );
            normal += weight * gradient.normalize_or_zero();
        }
        normal
    }

    /// The first change of sign beyond `after` on the way of a line, of grid units, through a cell.
    fn cross_cell(
        &self,
        cell: [usize; 3],
        [p, q]: [DVec3; 2],
        [first, last]: [f64; 2],
        after: f64,
    ) -> Option<Crossing> {
        let f = self.corners(cell);
        let corner = DVec3::from(cell.map(|c| c as f64));
        let (p, q) = (
            (p - corner).clamp(DVec3::ZERO, DVec3::ONE),
            (q - corner).clamp(DVec3::ZERO, DVec3::ONE),
        );
        let one = |from: DVec3, to: DVec3| {
            let mixed = (0..3).map(|axis| {
                let mut point = from;
                point[axis] = to[axis];
                trilinear(&f, point)
            });
            mixed.sum::<f64>() / 3.0
        };
        let cubic = [trilinear(&f, p), one(p, q), one(q, p), trilinear(&f, q)];
        bernstein::sign_changes(&cubic, 1e-9, |s, inside| {
            let t = first + s * (last - first);
            match t > after {
                true => ControlFlow::Break(Crossing::new(t, !inside)),
                false => ControlFlow::Continue(()),
            }
        })
    }
}

/// Interpolates eight corners; exactly theirs at them.
#[inline]
fn trilinear(f: &[f64; 8], p: DVec3) -> f64 {
    let rest = DVec3::ONE - p;
    let x = [0, 2, 4, 6].map(|i| f[i] * rest.x + f[i + 1] * p.x);
    let y = [0, 2].map(|i| x[i] * rest.y + x[i + 1] * p.y);
    y[0] * rest.z + y[1] * p.z
}

impl OwnShape for SdfGrid {
    fn next_crossing(&self, line: &Line, after: f64, before: f64) -> Option<Crossing> {
        let resolution = self.resolution();
        let line = Line {
            origin: line.origin * resolution,
            direction: line.direction * resolution,
        };
        let (o, d) = (line.origin, line.direction);
        // The interval of the line in the grid.
        let (mut t, mut end) = (f64::NEG_INFINITY, f64::INFINITY);
        let mut entered = None;
        for axis in 0..3 {
            if d[axis] == 0.0 {
                if !(o[axis] >= 0.0 && o[axis] <= resolution[axis]) {
                    return None;
                }
                continue;
            }
            let planes = [-o[axis] / d[axis], (resolution[axis] - o[axis]) / d[axis]];
            let (enters, leaves) = (planes[0].min(planes[1]), planes[0].max(planes[1]));
            if enters > t {
                (t, entered) = (enters, Some(axis));
            }
            end = end.min(leaves);
        }
        if !(t < end) || end <= after {
            return None;
        }
        // On the face that it comes through, the coordinate is a whole number.
        let at = |t: f64, face: Option<(usize, f64)>| {
            let mut p = line.at(t);
            if let Some((axis, coordinate)) = face {
                p[axis] = coordinate;
            }
            p
        };
        let side = |axis: usize| if d[axis] > 0.0 { 0.0 } else { resolution[axis] };
        let mut p = at(t, entered.map(|axis| (axis, side(axis))));
        let mut cell: [usize; 3] = core::array::from_fn(|i| {
            let floor = p[i].clamp(0.0, resolution[i]).floor() as usize;
            floor.min(self.size[i] - 2)
        });
        loop {
            let faces: [f64; 3] = core::array::from_fn(|i| cell[i] as f64 + f64::from(d[i] > 0.0));
            let exits: [f64; 3] = core::array::from_fn(|i| match d[i] == 0.0 {
                true => f64::INFINITY,
                false => (faces[i] - o[i]) / d[i],
            });
            let axis = (0..3)
                .min_by(|&a, &b| exits[a].total_cmp(&exits[b]))
                .unwrap_or(0);
            let next = exits[axis].max(t);
            let q = at(next, Some((axis, faces[axis])));
            if next > after && self.is_crossed(cell) {
                let crossing = self.cross_cell(cell, [p, q], [t, next], after);
                if crossing.is_some() {
                    return crossing;
                }
            }
            let moved = if d[axis] > 0.0 {
                cell[axis]
                    .checked_add(1)
                    .filter(|&c| c < self.size[axis] - 1)
            } else {
                cell[axis].checked_sub(1)
            };
            cell[axis] = moved?;
            (t, p) = (next, q);
            if t >= before {
                return None;
            }
        }
    }

    fn surface_at(&self, p: DVec3, _: &Crossing) -> OwnPoint {
        let resolution = self.resolution();
        let (cell, at) = self.cell(p * resolution);
        let gradient = self.gradient(cell, at) * resolution;
        let normal = gradient.normalize_or(DVec3::Z);
        let [dp_du, dp_dv] = {
            let u = normal.any_orthonormal_vector();
            [u, normal.cross(u)]
        };
        OwnPoint {
            position: p,
            normal,
            uv: DVec2::ZERO,
            dp_du,
            dp_dv,
        }
    }

    fn shading_normal(&self, p: DVec3) -> Option<DVec3> {
        self.smooth
            .then(|| self.smooth_normal(p * self.resolution()))
    }

    fn bounds(&self) -> [DVec3; 2] {
        [DVec3::ZERO, DVec3::ONE]
    }

    fn is_closed(&self) -> bool {
        self.closed
    }
}
