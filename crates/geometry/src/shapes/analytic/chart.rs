//! Uniform sampling by area on a surface that a chart covers once.
//!
//! ```text
//! A = ∫₀¹ ∫₀¹ J du dv,   J(u, v) = |∂p/∂u × ∂p/∂v|
//! ```
//!
//! u is sampled with the density m(u) = ∫ J dv, v with J(u, v) / m(u), both by inverting their integrals, so that the
//! density per area is constant under any map of the surface. In each of [`CELLS`]² cells J is a polynomial, cubic in u
//! and in v, through its values at Gauss points, which also give its integrals.

use etalon_math::Bracket;
use glam::DVec2;

/// Cells along u and along v.
const CELLS: usize = 16;

/// Points of Gauss's rule on [0, 1], and their weights.
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_7, 0.173_927_422_568_726_9),
    (0.330_009_478_207_571_9, 0.326_072_577_431_273_1),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_1),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_9),
];

/// Coefficients, from the constant up, of the cubics that are 1 at one of Gauss's points and 0 at the others.
const BASIS: [[f64; GAUSS.len()]; GAUSS.len()] = {
    let mut all = [[0.0; GAUSS.len()]; GAUSS.len()];
    let mut index = 0;
    while index < GAUSS.len() {
        // (x − a)(x − b)(x − c) / ((g − a)(g − b)(g − c)), multiplied out.
        let g = GAUSS[index].0;
        let [a, b, c] = [
            GAUSS[(index + 1) % 4].0,
            GAUSS[(index + 2) % 4].0,
            GAUSS[(index + 3) % 4].0,
        ];
        let scale = 1.0 / ((g - a) * (g - b) * (g - c));
        all[index] = [
            -a * b * c * scale,
            (a * b + b * c + a * c) * scale,
            -(a + b + c) * scale,
            scale,
        ];
        index += 1;
    }
    all
};

/// The coefficients of the cubic through values at Gauss's points.
fn cubic(values: [f64; GAUSS.len()]) -> [f64; GAUSS.len()] {
    core::array::from_fn(|power| {
        let [a, b, c, d] = BASIS.map(|basis| basis[power]);
        a * values[0] + b * values[1] + c * values[2] + d * values[3]
    })
}

/// The point in [0, 1] up to which the integral of a positive cubic is `target`.
fn inverse(target: f64, [c0, c1, c2, c3]: [f64; GAUSS.len()]) -> f64 {
    let mut bracket = Bracket::new(0.0, 1.0);
    let mut x = bracket.middle();
    for _ in 0..40 {
        let slope = ((c3 * x + c2) * x + c1) * x + c0;
        let off = (((c3 / 4.0 * x + c2 / 3.0) * x + c1 / 2.0) * x + c0) * x - target;
        bracket.cut(x, off > 0.0);
        let next = bracket.within(x - off / slope);
        if (next - x).abs() < 1e-10 {
            return next;
        }
        x = next;
    }
    x
}

/// Gauss's points along u or v.
const NODES: usize = CELLS * GAUSS.len();

/// J over the chart.
#[derive(Clone, Debug)]
pub(crate) struct Chart {
    /// ∫ m up to the end of each cell of u.
    upto: [f64; CELLS],
    /// J along v for each node of u.
    rows: Vec<Row>,
}

/// J at one u.
#[derive(Clone, Debug)]
struct Row {
    /// At each node of v.
    values: [f64; NODES],
    /// Integrals up to the end of each cell of v.
    upto: [f64; CELLS],
}

/// The position of node `index`.
fn node(index: usize) -> f64 {
    ((index / GAUSS.len()) as f64 + GAUSS[index % GAUSS.len()].0) / CELLS as f64
}

/// Integrals, up to the end of each cell, of the function with these values at the nodes.
fn integrals(values: &[f64; NODES]) -> [f64; CELLS] {
    let mut sum = 0.0;
    core::array::from_fn(|cell| {
        let parts = (values[cell * GAUSS.len()..].iter()).zip(GAUSS);
        sum += parts
            .map(|(value, (_, weight))| value * weight)
            .sum::<f64>()
            / CELLS as f64;
        sum
    })
}

impl Chart {
    /// That of a surface with the area element J(u, v).
    pub(crate) fn new(element: impl Fn(DVec2) -> f64) -> Self {
        let row = |u: usize| {
            let values = core::array::from_fn(|v| element(DVec2::new(node(u), node(v))));
            Row {
                upto: integrals(&values),
                values,
            }
        };
        let rows: Vec<Row> = (0..NODES).map(row).collect();
        let marginal = core::array::from_fn(|u| rows[u].upto[CELLS - 1]);
        Self {
            upto: integrals(&marginal),
            rows,
        }
    }

    /// A.
    pub(crate) fn area(&self) -> f64 {
        self.upto[CELLS - 1]
    }

    /// (u, v) of a point chosen uniformly by area with two numbers in [0, 1).
    pub(crate) fn sample(&self, numbers: DVec2) -> DVec2 {
        let rows = |cell: usize| &self.rows[cell * GAUSS.len()..][..GAUSS.len()];
        let (cell, x) = placed(&self.upto, numbers.x, |cell, i| {
            rows(cell)[i].upto[CELLS - 1]
        });
        // The rows at u, interpolated.
        let rows = rows(cell);
        let [a, b, c, d] = BASIS.map(|[c0, c1, c2, c3]| ((c3 * x + c2) * x + c1) * x + c0);
        let at_u = |of: &dyn Fn(&Row) -> f64| {
            a * of(&rows[0]) + b * of(&rows[1]) + c * of(&rows[2]) + d * of(&rows[3])
        };
        let upto = core::array::from_fn(|cell| at_u(&|row| row.upto[cell]));
        let (row_cell, y) = placed(&upto, numbers.y, |cell, j| {
            at_u(&|row| row.values[cell * GAUSS.len() + j])
        });
        DVec2::new(cell as f64 + x, row_cell as f64 + y) / CELLS as f64
    }
}

/// The cell, and the place in it, below which the part `number` of an integral lies, given the integral up to the end of
/// each cell and the values in a cell at Gauss's points.
fn placed(upto: &[f64; CELLS], number: f64, value: impl Fn(usize, usize) -> f64) -> (usize, f64) {
    let wanted = number * upto[CELLS - 1];
    let cell = upto.partition_point(|upto| *upto <= wanted);
    let cell = cell.min(CELLS - 1);
    let before = if cell > 0 { upto[cell - 1] } else { 0.0 };
    let values: [f64; GAUSS.len()] = core::array::from_fn(|i| value(cell, i));
    let within = inverse((wanted - before) * CELLS as f64, cubic(values));
    (cell, within)
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;
    use etalon_math::float64::{ln, sin};

    /// The area of a sphere is 4 π, that of the saddle z = x y over the unit square 1.280789…, by Simpson's rule on 2000² cells.
    #[test]
    fn areas_are_integrals() {
        let sphere = Chart::new(|uv| 2.0 * PI * PI * sin(PI * uv.y));
        assert!((sphere.area() - 4.0 * PI).abs() < 1e-9, "{}", sphere.area());
        let saddle = Chart::new(|uv| (1.0 + uv.length_squared()).sqrt());
        assert!(
            (saddle.area() - 1.280_789_271_1).abs() < 1e-8,
            "{}",
            saddle.area()
        );
    }

    /// The share of points in each part of the square is that of the area in it, by the midpoint rule (10⁻⁴). The mutant that is uniform in
    /// (u, v) is off by a tenth of the whole.
    #[test]
    fn points_are_uniform_by_area() {
        let element = |uv: DVec2| (0.1 + 3.0 * uv.x * uv.x + ln(1.0 + 5.0 * uv.y)).powi(2);
        let chart = Chart::new(element);
        let side = 400;
        let middle = |i: usize| (i as f64 + 0.5) / side as f64;
        let (mut found, mut expected) = ([0.0; 16], [0.0; 16]);
        let part = |uv: DVec2| (4.0 * uv.x) as usize * 4 + (4.0 * uv.y) as usize;
        for i in 0..side {
            for j in 0..side {
                let at = DVec2::new(middle(i), middle(j));
                found[part(chart.sample(at))] += 1.0 / (side * side) as f64;
                expected[part(at)] += element(at) / chart.area() / (side * side) as f64;
            }
        }
        for (found, expected) in found.into_iter().zip(expected) {
            // A row of points may fall on either side of an edge.
            assert!(
                (found - expected).abs() < 4.0 / side as f64 * expected.max(0.05),
                "{found} {expected}"
            );
        }
    }
}
