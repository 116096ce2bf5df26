//! Plane curves in cubic pieces, as profiles of surfaces: polylines, Bézier curves, Catmull–Rom splines.
//!
//! ```text
//! c(s) = (1−s)³ c₀ + 3 (1−s)² s c₁ + 3 (1−s) s² c₂ + s³ c₃,   0 ≤ s ≤ 1
//! ```
//!
//! A Catmull–Rom piece from p₁ to p₂ has the inner points p₁ + (p₂ − p₀)/6 and p₂ − (p₃ − p₁)/6 (E. Catmull, R. Rom
//! 1974, *A class of local interpolating splines*); at the ends of an open one the missing neighbour is the end.

use etalon_math::expression::Number;
use etalon_params::Params;
use glam::DVec2;

/// A piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cubic(pub(crate) [DVec2; 4]);

impl Cubic {
    /// A coordinate: 0 or 1. At the ends exactly that of the end.
    #[inline]
    pub(crate) fn coordinate<N: Number>(&self, axis: usize, s: N) -> N {
        let rest = N::constant(1.0).add(s.neg());
        let [c0, c1, c2, c3] = self.0.map(|c| N::constant(c[axis]));
        let three = N::constant(3.0);
        let (s2, rest2) = (s.powi(2), rest.powi(2));
        let outer = rest2.mul(rest).mul(c0).add(s2.mul(s).mul(c3));
        let inner = rest.mul(c1).add(s.mul(c2)).mul(three.mul(s.mul(rest)));
        outer.add(inner)
    }

    /// The point at `s`.
    pub(crate) fn at(&self, s: f64) -> DVec2 {
        DVec2::new(self.coordinate(0, s), self.coordinate(1, s))
    }

    /// dc/ds.
    pub(crate) fn tangent(&self, s: f64) -> DVec2 {
        let [a, b, c] = [0, 1, 2].map(|i| self.0[i + 1] - self.0[i]);
        let rest = 1.0 - s;
        3.0 * (rest * rest * a + 2.0 * rest * s * b + s * s * c)
    }

    /// A box that holds it: that of its points.
    pub(crate) fn bounds(&self) -> [DVec2; 2] {
        let [a, b, c, d] = self.0;
        [a.min(b).min(c).min(d), a.max(b).max(c).max(d)]
    }
}

/// Reads `profile`, pairs of numbers, `curve` (`linear`, `bezier` or `catmullrom`) and `closed` (false).
pub(crate) fn from_params(params: &Params<'_>) -> Option<Vec<Cubic>> {
    let curve = params.choice("curve", "linear", &["linear", "bezier", "catmullrom"]);
    let closed = params.boolean_or("closed", false);
    let Some(text) = params.string("profile") else {
        if !params.has("profile") {
            params.missing("profile", "pairs of numbers, such as `0.5 0, 0.7 1`");
        }
        return None;
    };
    let mut numbers = Vec::new();
    for word in text
        .split([',', ' ', '\n', '\t', '\r'])
        .filter(|word| !word.is_empty())
    {
        match word.parse::<f64>() {
            Ok(number) if number.is_finite() => numbers.push(number),
            _ => {
                params.error_at(
                    "profile",
                    format!("`{word}` in `profile` is not a finite number"),
                );
                return None;
            }
        }
    }
    let mut points: Vec<DVec2> = (numbers.chunks_exact(2))
        .map(|pair| DVec2::new(pair[0], pair[1]))
        .collect();
    let pieces = |n: usize| match curve {
        "bezier" => n >= 4 && n % 3 == 1,
        _ => n >= 2,
    };
    if closed && curve == "bezier" && points.first() != points.last() {
        let message = "a closed `bezier` profile must end where it begins";
        params.error_at("profile", message);
        return None;
    }
    if numbers.len() % 2 == 1 || !pieces(points.len()) {
        let wanted = match curve {
            "bezier" => "4, 7, 10, … points: ends of pieces with two inner points between",
            _ => "two points or more",
        };
        let message = format!(
            "`profile` has {} numbers; a `{curve}` one takes {wanted}, two numbers each",
            numbers.len()
        );
        params.error_at("profile", message);
        return None;
    }
    if closed && curve != "bezier" && points.first() != points.last() {
        points.push(points[0]);
    }
    Some(pieces_of(curve, closed, &points))
}

fn pieces_of(curve: &str, closed: bool, points: &[DVec2]) -> Vec<Cubic> {
    let last = points.len() - 1;
    let straight = |pair: &[DVec2]| {
        let (a, b) = (pair[0], pair[1]);
        Cubic([a, a.lerp(b, 1.0 / 3.0), a.lerp(b, 2.0 / 3.0), b])
    };
    match curve {
        "bezier" => (0..last / 3)
            .map(|i| Cubic(core::array::from_fn(|k| points[3 * i + k])))
            .collect(),
        "catmullrom" => (0..last)
            .map(|i| {
                let before = match i {
                    0 if closed => points[last - 1],
                    0 => points[0],
                    _ => points[i - 1],
                };
                let after = match i + 2 {
                    next if next <= last => points[next],
                    _ if closed => points[1],
                    _ => points[last],
                };
                let (a, b) = (points[i], points[i + 1]);
                Cubic([a, a + (b - before) / 6.0, b - (after - a) / 6.0, b])
            })
            .collect(),
        _ => points.windows(2).map(straight).collect(),
    }
}
