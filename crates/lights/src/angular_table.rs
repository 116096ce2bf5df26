//! A function on the sphere between the nodes of a grid of angles.
//!
//! ```text
//! f(θ, φ) is bilinear in each cell,     ∫ f dω = Δφ ∫ g(θ) sin θ dθ,     g linear between the means of the cell's sides
//! ∫ g sin θ dθ = g₀ cos θ₀ − g₁ cos θ₁ + (g₁ − g₀)(sin θ₁ − sin θ₀)/(θ₁ − θ₀)
//! ```
//!
//! and 0 beyond the first and the last θ. Directions are chosen by cell, in proportion to these integrals, and uniformly by solid angle
//! within it: with a density that vanishes nowhere where f does not.

use core::f32::consts::TAU;
use etalon_math::{float, float64};
use etalon_sampling::discrete::PiecewiseConstant2d;
use glam::{DVec2, UVec2, Vec2, Vec3};

/// The table.
#[derive(Clone, Debug)]
pub(crate) struct AngularTable {
    /// Angles from +z (rad), increasing.
    theta: Vec<f32>,
    /// Their cosines.
    cos_theta: Vec<f32>,
    /// Angles around z (rad), from 0 to 2π.
    phi: Vec<f32>,
    /// Row after row of equal θ.
    values: Vec<f32>,
    cells: PiecewiseConstant2d,
}

impl AngularTable {
    /// The table with nodes at the angles `theta` and `phi` (rad), both increasing, the latter from 0 to 2π, and `values` not below 0, row after row of
    /// equal θ. `None` if all are 0.
    pub(crate) fn new(theta: &[f64], phi: &[f64], values: &[f64]) -> Option<Self> {
        let columns = phi.len();
        let mut masses = Vec::with_capacity(values.len());
        for (t, rows) in theta
            .windows(2)
            .zip(values.windows(2 * columns).step_by(columns))
        {
            let (above, below) = rows.split_at(columns);
            for (i, p) in phi.windows(2).enumerate() {
                let g = [above, below].map(|row| 0.5 * (row[i] + row[i + 1]));
                masses.push((p[1] - p[0]) * by_sine([t[0], t[1]], g).max(0.0));
            }
        }
        let cells = PiecewiseConstant2d::new(&masses, columns - 1).ok()?;
        let single = |numbers: &[f64]| numbers.iter().map(|x| *x as f32).collect();
        Some(Self {
            theta: single(theta),
            cos_theta: theta.iter().map(|t| float64::cos(*t) as f32).collect(),
            phi: single(phi),
            values: single(values),
            cells,
        })
    }

    /// ∫ f dω (exact).
    pub(crate) fn integral(&self) -> f64 {
        // The distribution has cells of equal area; each has its integral for a weight.
        let size = self.cells.size().as_dvec2();
        self.cells.integral() * size.x * size.y
    }

    /// The cosine of the angle from +z beyond which f is 0.
    pub(crate) fn cos_edge(&self) -> f32 {
        let columns = self.phi.len();
        let lit = self
            .values
            .chunks(columns)
            .rposition(|row| row.iter().any(|v| *v > 0.0));
        let beyond = lit.map_or(0, |row| row + 1).min(self.theta.len() - 1);
        self.cos_theta[beyond]
    }

    /// The cell of a unit direction, and where in it the direction is by its angles.
    fn locate(&self, direction: Vec3) -> Option<(UVec2, Vec2)> {
        let theta = float::atan2(direction.truncate().length(), direction.z);
        let around = float::atan2(direction.y, direction.x);
        let phi = if around < 0.0 { around + TAU } else { around };
        let (first, last) = (self.theta.first()?, self.theta.last()?);
        // A direction along the axis is within a table that begins, or ends, there.
        let slack = 4.0 * f32::EPSILON;
        if theta < first - slack || theta > last + slack {
            return None;
        }
        let cell = |nodes: &[f32], at: f32| {
            let above = nodes.partition_point(|node| *node <= at);
            let index = above.clamp(1, nodes.len() - 1) - 1;
            let part = (at - nodes[index]) / (nodes[index + 1] - nodes[index]);
            (index as u32, part.clamp(0.0, 1.0))
        };
        let ((i, x), (j, y)) = (cell(&self.phi, phi), cell(&self.theta, theta));
        Some((UVec2::new(i, j), Vec2::new(x, y)))
    }

    /// f in a unit direction.
    pub(crate) fn at(&self, direction: Vec3) -> f32 {
        let Some((cell, part)) = self.locate(direction) else {
            return 0.0;
        };
        let columns = self.phi.len();
        let start = cell.y as usize * columns + cell.x as usize;
        let row = |start: usize| {
            let (a, b) = (self.values[start], self.values[start + 1]);
            a + (b - a) * part.x
        };
        let (above, below) = (row(start), row(start + columns));
        above + (below - above) * part.y
    }

    /// The density per solid angle within a cell (sr⁻¹).
    fn density_in(&self, cell: UVec2) -> f32 {
        let (i, j) = (cell.x as usize, cell.y as usize);
        let angle = (self.phi[i + 1] - self.phi[i]) * (self.cos_theta[j] - self.cos_theta[j + 1]);
        let size = self.cells.size().as_vec2();
        let middle = (cell.as_vec2() + 0.5) / size;
        self.cells.density(middle) / (size.x * size.y * angle)
    }

    /// The density of [`AngularTable::sample`] (sr⁻¹).
    pub(crate) fn density(&self, direction: Vec3) -> f32 {
        (self.locate(direction)).map_or(0.0, |(cell, _)| self.density_in(cell))
    }

    /// A unit direction and its density (sr⁻¹).
    pub(crate) fn sample(&self, u: Vec2) -> (Vec3, f32) {
        let (cell, DVec2 { x, y }) = self.cells.choose(u.as_dvec2());
        let (i, j) = (cell.x as usize, cell.y as usize);
        let between = |ends: &[f32], part: f64| ends[0] + (ends[1] - ends[0]) * part as f32;
        let phi = between(&self.phi[i..i + 2], x);
        let cos = between(&self.cos_theta[j..j + 2], y);
        let (sin_phi, cos_phi) = float::sin_cos(phi);
        let sin = ((1.0 - cos) * (1.0 + cos)).max(0.0).sqrt();
        let direction = Vec3::new(cos_phi * sin, sin_phi * sin, cos);
        (direction, self.density_in(cell))
    }
}

/// ∫ g(θ) sin θ dθ over an interval with g linear.
fn by_sine([a, b]: [f64; 2], [g0, g1]: [f64; 2]) -> f64 {
    let width = b - a;
    if width < 1e-4 {
        // The closed form cancels; this errs by a part in 10⁹.
        return 0.5 * width * (g0 + g1) * float64::sin(0.5 * (a + b));
    }
    let (sin_a, cos_a) = float64::sin_cos(a);
    let (sin_b, cos_b) = float64::sin_cos(b);
    g0 * cos_a - g1 * cos_b + (g1 - g0) * (sin_b - sin_a) / width
}
