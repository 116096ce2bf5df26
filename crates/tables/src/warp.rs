//! Functions on the unit square that depend on parameters, given by tables: bilinear in the square, linear in each
//! parameter; and sampling by them.
//!
//! With f(x, y; p) interpolated between nodes and scaled so that ∫f dx dy = 1 for each node of p, a point is made from
//! (u, v) by inverting the marginal and then the conditional distribution, both of which are interpolated too:
//!
//! ```text
//! ∫₀ʸ ∫₀¹ f(x', y') dx' dy' = v        ∫₀ˣ f(x', y) dx' / ∫₀¹ f(x', y) dx' = u
//! ```
//!
//! Both have a closed inverse, since f is linear along either axis of a cell.

use crate::BrdfTableError;
use crate::tensor_file::Tensor;
use glam::Vec2;

/// A function on [0, 1]² with `N` parameters.
#[derive(Clone, Debug)]
pub struct Warp<const N: usize> {
    width: usize,
    height: usize,
    parameters: [Vec<f32>; N],
    /// Nodes: by parameters, then y, then x.
    values: Vec<f32>,
    /// ∫₀ˣ along each row; empty if it is not to be sampled.
    conditional: Vec<f32>,
    /// ∫₀ʸ of the rows' integrals.
    marginal: Vec<f32>,
}

/// Slices of a table around the place of the parameters, with their weights.
#[derive(Clone, Copy, Debug)]
pub struct Slices {
    entries: [(usize, f32); 8],
    count: usize,
}

impl Slices {
    /// The slice of a table without parameters.
    pub const ONLY: Self = Self {
        entries: [(0, 1.0); 8],
        count: 1,
    };

    fn entries(&self) -> &[(usize, f32)] {
        &self.entries[..self.count]
    }

    /// The same for a parameter more, which varies fastest and has these nodes.
    #[inline]
    fn refined(&self, nodes: &[f32], value: f32) -> Self {
        let (index, fraction) = bracket(nodes, value);
        let mut refined = Self {
            entries: [(0, 0.0); 8],
            count: 0,
        };
        for &(slice, weight) in self.entries() {
            for (step, share) in [(0, 1.0 - fraction), (1, fraction)] {
                if share > 0.0 {
                    refined.entries[refined.count] =
                        (slice * nodes.len() + index + step, weight * share);
                    refined.count += 1;
                }
            }
        }
        refined
    }
}

/// The interval of increasing `nodes` that holds `value`, and where in it; beyond the ends, the end.
#[inline]
pub(crate) fn bracket(nodes: &[f32], value: f32) -> (usize, f32) {
    if nodes.len() < 2 {
        return (0, 0.0);
    }
    let index = nodes.partition_point(|&node| node <= value);
    let index = index.clamp(1, nodes.len() - 1) - 1;
    let fraction = (value - nodes[index]) / (nodes[index + 1] - nodes[index]);
    (index, fraction.clamp(0.0, 1.0))
}

/// Where the integral of the linear function from `a` to `b` on [0, 1] reaches `mass`.
#[inline]
fn root(a: f32, b: f32, mass: f32) -> f32 {
    let divisor = a + (a * a + 2.0 * (b - a) * mass).max(0.0).sqrt();
    if divisor > 0.0 {
        (2.0 * mass / divisor).clamp(0.0, 1.0)
    } else {
        0.5
    }
}

impl<const N: usize> Warp<N> {
    /// The function with the nodes of `tensor`: a dimension for each parameter, then y, then x.
    ///
    /// # Errors
    /// If the table's shape is not that of the parameters' nodes, or there is a single row or column.
    pub fn new(parameters: [Vec<f32>; N], tensor: Tensor) -> Result<Self, BrdfTableError> {
        let lengths: Vec<usize> = parameters.iter().map(Vec::len).collect();
        let [height, width] = tensor.shape[N..] else {
            return Err(BrdfTableError::new(format!(
                "a table of shape {:?} has not {N} parameters",
                tensor.shape
            )));
        };
        if tensor.shape[..N] != lengths[..] {
            return Err(BrdfTableError::new(format!(
                "a table has shape {:?}, which must begin with {lengths:?}",
                tensor.shape
            )));
        }
        if width < 2 || height < 2 {
            return Err(BrdfTableError::new(format!(
                "a table has {width} × {height} entries; 2 × 2 are needed"
            )));
        }
        Ok(Self {
            width,
            height,
            parameters,
            values: tensor.data,
            conditional: Vec::new(),
            marginal: Vec::new(),
        })
    }

    /// The same, scaled to densities and ready to be sampled. Negative entries count as zero, and slices without any
    /// mass as uniform.
    pub fn normalised(mut self) -> Self {
        let area = self.width * self.height;
        let hx = 1.0 / (self.width - 1) as f64;
        let hy = 1.0 / (self.height - 1) as f64;
        self.conditional = Vec::with_capacity(self.values.len());
        self.marginal = Vec::with_capacity(self.values.len() / self.width);
        for slice in self.values.chunks_exact_mut(area) {
            let mass: f64 = (0..self.height)
                .map(|y| {
                    let row = &slice[y * self.width..][..self.width];
                    let inner: f64 = row.iter().map(|&v| f64::from(v.max(0.0))).sum();
                    let ends = f64::from(row[0].max(0.0) + row[self.width - 1].max(0.0));
                    let edge = y == 0 || y == self.height - 1;
                    (inner - 0.5 * ends) * hx * hy * if edge { 0.5 } else { 1.0 }
                })
                .sum();
            let scale = if mass > 0.0 { 1.0 / mass } else { 0.0 };
            for value in slice.iter_mut() {
                *value = if mass > 0.0 {
                    (f64::from(value.max(0.0)) * scale) as f32
                } else {
                    1.0
                };
            }
            let (mut below, mut total_before) = (0.0, 0.0);
            for (y, row) in slice.chunks_exact(self.width).enumerate() {
                let mut sum = 0.0;
                self.conditional.push(0.0);
                for pair in row.windows(2) {
                    sum += 0.5 * hx * (f64::from(pair[0]) + f64::from(pair[1]));
                    self.conditional.push(sum as f32);
                }
                if y > 0 {
                    below += 0.5 * hy * (total_before + sum);
                }
                self.marginal.push(below as f32);
                total_before = sum;
            }
        }
        self
    }

    /// The slices around a place of the parameters.
    #[inline]
    pub fn slices(&self, place: [f32; N]) -> Slices {
        let mut slices = Slices::ONLY;
        for (nodes, value) in self.parameters.iter().zip(place) {
            slices = slices.refined(nodes, value);
        }
        slices
    }

    /// The slices around a place whose last parameter has another value than in `slices`, which are those of a table
    /// without it.
    #[inline]
    pub fn with_last(&self, slices: &Slices, value: f32) -> Slices {
        slices.refined(&self.parameters[N - 1], value)
    }

    /// An entry at `index` of each slice, interpolated.
    #[inline]
    fn blend(table: &[f32], stride: usize, index: usize, slices: &Slices) -> f32 {
        (slices.entries().iter())
            .map(|&(slice, weight)| table[slice * stride + index] * weight)
            .sum()
    }

    #[inline]
    fn value(&self, slices: &Slices, index: usize) -> f32 {
        Self::blend(&self.values, self.width * self.height, index, slices)
    }

    #[inline]
    fn cumulative(&self, slices: &Slices, index: usize) -> f32 {
        Self::blend(&self.conditional, self.width * self.height, index, slices)
    }

    #[inline]
    fn below(&self, slices: &Slices, row: usize) -> f32 {
        Self::blend(&self.marginal, self.height, row, slices)
    }

    /// The cell of a point of the square, and where in it.
    #[inline]
    fn locate(&self, point: Vec2) -> ([usize; 2], Vec2) {
        let cells = Vec2::new((self.width - 1) as f32, (self.height - 1) as f32);
        let place = point.clamp(Vec2::ZERO, Vec2::ONE) * cells;
        let cell = place.floor().min(cells - 1.0);
        ([cell.x as usize, cell.y as usize], place - cell)
    }

    /// The function at a point of the square.
    #[inline]
    pub fn eval(&self, point: Vec2, slices: &Slices) -> f32 {
        let ([x, y], t) = self.locate(point);
        let first = y * self.width + x;
        let mix = |index: usize| {
            self.value(slices, index) * (1.0 - t.x) + self.value(slices, index + 1) * t.x
        };
        mix(first) * (1.0 - t.y) + mix(first + self.width) * t.y
    }

    /// A point of the square with this density, for `u` ∈ [0, 1)², and the density there.
    pub fn sample(&self, u: Vec2, slices: &Slices) -> (Vec2, f32) {
        let (w, h) = (self.width, self.height);
        let y = search(h - 1, |row| self.below(slices, row) <= u.y);
        let totals = [y, y + 1].map(|row| self.cumulative(slices, row * w + w - 1));
        let mass = (u.y - self.below(slices, y)) * (h - 1) as f32;
        let ty = root(totals[0], totals[1], mass);
        let mix = |table: &dyn Fn(usize) -> f32, x: usize| {
            table(y * w + x) * (1.0 - ty) + table((y + 1) * w + x) * ty
        };
        let cumulative = |index: usize| self.cumulative(slices, index);
        let value = |index: usize| self.value(slices, index);
        let target = u.x * mix(&cumulative, w - 1);
        let x = search(w - 1, |column| mix(&cumulative, column) <= target);
        let (a, b) = (mix(&value, x), mix(&value, x + 1));
        let tx = root(a, b, (target - mix(&cumulative, x)) * (w - 1) as f32);
        let point = Vec2::new(
            (x as f32 + tx) / (w - 1) as f32,
            (y as f32 + ty) / (h - 1) as f32,
        );
        (point, a + (b - a) * tx)
    }

    /// The inverse of [`Warp::sample`], and the density at the point.
    pub fn invert(&self, point: Vec2, slices: &Slices) -> (Vec2, f32) {
        let w = self.width;
        let ([x, y], t) = self.locate(point);
        let mix = |table: &dyn Fn(usize) -> f32, x: usize| {
            table(y * w + x) * (1.0 - t.y) + table((y + 1) * w + x) * t.y
        };
        let cumulative = |index: usize| self.cumulative(slices, index);
        let value = |index: usize| self.value(slices, index);
        let (a, b) = (mix(&value, x), mix(&value, x + 1));
        let along = t.x * (a + 0.5 * (b - a) * t.x) / (w - 1) as f32;
        let total = mix(&cumulative, w - 1);
        let u = if total > 0.0 {
            (mix(&cumulative, x) + along) / total
        } else {
            point.x
        };
        let totals = [y, y + 1].map(|row| self.cumulative(slices, row * w + w - 1));
        let up = t.y * (totals[0] + 0.5 * (totals[1] - totals[0]) * t.y);
        let v = self.below(slices, y) + up / (self.height - 1) as f32;
        (Vec2::new(u, v), a + (b - a) * t.x)
    }
}

/// The last of the cells 0 … `cells` − 1 at whose beginning `holds` is true, or the first.
#[inline]
fn search(cells: usize, holds: impl Fn(usize) -> bool) -> usize {
    let (mut low, mut high) = (0, cells);
    while high - low > 1 {
        let middle = (low + high) / 2;
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}
