//! Plane curves as profiles of surfaces: polylines, Bézier curves, Catmull–Rom splines, expressions of a parameter.
//!
//! All are kept as cubic pieces. A Catmull–Rom piece from p₁ to p₂ has the inner points p₁ + (p₂ − p₀)/6 and
//! p₂ − (p₃ − p₁)/6 (E. Catmull, R. Rom 1974, *A class of local interpolating splines*); at the ends of an open one
//! the missing neighbour is the end. A curve (x(t), y(t)) of expressions is cut until the cubic with its ends and
//! its derivatives there is within [`CLOSE`] of it.

pub(crate) mod cubic;
pub(crate) mod lengths;

use cubic::{Cubic, Vector};
use etalon_math::Dual;
use etalon_params::Params;
use glam::DVec2;

/// How far the pieces are from a curve of expressions, in parts of its size.
const CLOSE: f64 = 1e-7;

/// The most pieces of a curve of expressions: halvings of each of the first eight.
const DEEPEST: u32 = 10;

/// Pieces, one after another.
#[derive(Clone, Debug)]
pub(crate) struct Profile {
    pieces: Vec<Cubic>,
    /// Boxes of the binary tree over the pieces: a node, then the nodes of its first half, then those of its second.
    boxes: Vec<[DVec2; 2]>,
}

impl Profile {
    /// A sequence of one piece or more.
    pub(crate) fn new(pieces: Vec<Cubic>) -> Self {
        let mut boxes = Vec::with_capacity(2 * pieces.len());
        add_boxes(&pieces, &mut boxes);
        Self { pieces, boxes }
    }

    /// The pieces.
    pub(crate) fn pieces(&self) -> &[Cubic] {
        &self.pieces
    }

    /// Where it begins and ends.
    pub(crate) fn ends(&self) -> [DVec2; 2] {
        [self.pieces[0].0[0], self.pieces[self.pieces.len() - 1].0[3]]
    }

    /// Whether it ends where it begins.
    pub(crate) fn is_closed(&self) -> bool {
        let [first, last] = self.ends();
        first == last
    }

    /// A box that holds it.
    pub(crate) fn bounds(&self) -> [DVec2; 2] {
        self.boxes[0]
    }

    /// How far along the whole is the place `s` of a piece, from 0 to 1.
    pub(crate) fn part(&self, index: usize, s: f64) -> f64 {
        (index as f64 + s) / self.pieces.len() as f64
    }

    /// A place on it as a crossing keeps it: the piece's number from 1, negative if the normal is to be turned, and s.
    pub(crate) fn kept((index, s): (usize, f64), turned: bool) -> DVec2 {
        let number = index as f64 + 1.0;
        DVec2::new(if turned { -number } else { number }, s)
    }

    /// The same again: piece, s, and −1 if the normal is to be turned.
    pub(crate) fn place(&self, kept: DVec2) -> (usize, f64, f64) {
        let number = kept.x.abs().clamp(1.0, self.pieces.len() as f64);
        (number as usize - 1, kept.y, 1.0_f64.copysign(kept.x))
    }

    /// Points along it, `count` for each piece, and the last.
    pub(crate) fn points(&self, count: u32) -> impl Iterator<Item = DVec2> + '_ {
        let inner = move |piece: &'_ Cubic| {
            let piece = *piece;
            (0..count).map(move |k| piece.at(f64::from(k) / f64::from(count)))
        };
        self.pieces.iter().flat_map(inner).chain([self.ends()[1]])
    }

    /// Calls `visit` with the number of each piece in whose box, and in all above it, `meets` finds something.
    #[inline]
    pub(crate) fn search(&self, meets: impl Fn([DVec2; 2]) -> bool, mut visit: impl FnMut(usize)) {
        // Halves still to be looked at: node, first piece, one past the last.
        let mut waiting = [(0, 0, self.pieces.len()); 32];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let (node, first, end) = waiting[count];
            if !meets(self.boxes[node]) {
                continue;
            }
            if end - first == 1 {
                visit(first);
                continue;
            }
            let middle = first.midpoint(end);
            waiting[count] = (node + 2 * (middle - first), middle, end);
            waiting[count + 1] = (node + 1, first, middle);
            count += 2;
        }
    }
}

fn add_boxes(pieces: &[Cubic], boxes: &mut Vec<[DVec2; 2]>) -> [DVec2; 2] {
    let own = boxes.len();
    boxes.push([DVec2::ZERO; 2]);
    let bounds = if let [piece] = pieces {
        piece.bounds()
    } else {
        let (first, second) = pieces.split_at(pieces.len() / 2);
        let ([a, b], [c, d]) = (add_boxes(first, boxes), add_boxes(second, boxes));
        [a.min(c), b.max(d)]
    };
    boxes[own] = bounds;
    bounds
}

/// Reads `curve` (`linear`, `bezier`, `catmullrom` or `parametric`) and what it is made of.
pub(crate) fn from_params(params: &Params<'_>) -> Option<Profile> {
    let curves = ["linear", "bezier", "catmullrom", "parametric"];
    match params.choice("curve", "linear", &curves) {
        "parametric" => parametric(params),
        curve => through_points(params, curve),
    }
    .map(Profile::new)
}

/// Reads `x` and `y`, expressions of t, and the least and greatest t, `from` (0) and `to` (1).
fn parametric(params: &Params<'_>) -> Option<Vec<Cubic>> {
    let read = |name: &str| {
        if !params.has(name) {
            params.missing(name, "an expression of t, such as `cos(2*pi*t)`");
        }
        params.expression(name, &["t"])
    };
    let [x, y] = ["x", "y"].map(read);
    let first = params.float_or("from", 0.0);
    let what = "a finite number above `from`";
    let last = params.float_where("to", 1.0, what, |to| to > first && to.is_finite());
    let (x, y) = x.zip(y)?;
    let at = |t: f64| {
        let [x, y] = [&x, &y].map(|f| {
            f.eval(&[Dual {
                value: t,
                slope: 1.0,
            }])
        });
        (DVec2::new(x.value, y.value), DVec2::new(x.slope, y.slope))
    };
    let points = (0..=256).map(|k| at(first + (last - first) * f64::from(k) / 256.0).0);
    let [low, high] = points.fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[l, h], p| {
        [l.min(p), h.max(p)]
    });
    let size = (high - low).max_element();
    let mut pieces = Vec::new();
    let mut ends = (0..8).map(|k| [k, k + 1].map(|k| first + (last - first) * f64::from(k) / 8.0));
    if let Err(t) = ends.try_for_each(|ends| fit(&at, ends, size, 0, &mut pieces)) {
        let message = format!("the curve is not defined, or has no direction, at t = {t}");
        params.error_at("x", message);
        return None;
    }
    snap(&mut pieces, 1e-9 * size);
    Some(pieces)
}

/// Adds the pieces of a curve between two parameters, or says where it cannot be followed.
fn fit(
    at: &impl Fn(f64) -> (DVec2, DVec2),
    [a, b]: [f64; 2],
    size: f64,
    depth: u32,
    pieces: &mut Vec<Cubic>,
) -> Result<(), f64> {
    let [(start, from), (end, to)] = [a, b].map(at);
    let cubic = Cubic::hermite([start, end], [from * (b - a), to * (b - a)]);
    for (t, p) in [(a, start + from), (b, end + to)] {
        if !p.is_finite() {
            return Err(t);
        }
    }
    let mut off = [0.25, 0.5, 0.75]
        .into_iter()
        .map(|s| (cubic.at(s) - at(a + (b - a) * s).0).length());
    if depth == DEEPEST || off.all(|off| off <= CLOSE * size) {
        pieces.push(cubic);
        return Ok(());
    }
    let middle = 0.5 * (a + b);
    fit(at, [a, middle], size, depth + 1, pieces)?;
    fit(at, [middle, b], size, depth + 1, pieces)
}

/// Closes what rounding left open, and puts ends on the axis that are next to it.
fn snap(pieces: &mut [Cubic], near: f64) {
    let last = pieces.len() - 1;
    let (first, end) = (pieces[0].0[0], pieces[last].0[3]);
    if first.distance(end) <= near {
        pieces[last].0[3] = first;
    }
    for point in pieces.iter_mut().flat_map(|piece| &mut piece.0) {
        if point.x.abs() <= near {
            point.x = 0.0;
        }
    }
}

/// Reads `profile`, pairs of numbers, and `closed` (false).
fn through_points(params: &Params<'_>, curve: &str) -> Option<Vec<Cubic>> {
    let closed = params.boolean_or("closed", false);
    let example = "pairs of numbers, such as `0.5 0, 0.7 1`";
    let points = points(
        params,
        ("profile", example),
        curve,
        closed,
        DVec2::from_array,
    )?;
    Some(pieces_of(curve, closed, &points))
}

/// Reads the points that a curve of a kind goes through, each of so many numbers; a closed one ends where it begins.
pub(crate) fn points<const N: usize, V: Vector>(
    params: &Params<'_>,
    (name, example): (&str, &str),
    curve: &str,
    closed: bool,
    point: impl Fn([f64; N]) -> V,
) -> Option<Vec<V>> {
    let numbers = numbers(params, name, example)?;
    let (chunks, rest) = numbers.as_chunks::<N>();
    let mut points: Vec<V> = chunks.iter().map(|chunk| point(*chunk)).collect();
    let pieces = |n: usize| match curve {
        "bezier" => n >= 4 && n % 3 == 1,
        _ => n >= 2,
    };
    if closed && curve == "bezier" && points.first() != points.last() {
        let message =
            format!("a closed `bezier` curve must end where it begins: `{name}` does not");
        params.error_at(name, message);
        return None;
    }
    if !rest.is_empty() || !pieces(points.len()) {
        let wanted = match curve {
            "bezier" => "4, 7, 10, … points: ends of pieces with two inner points between",
            _ => "two points or more",
        };
        let message = format!(
            "`{name}` has {} numbers; a `{curve}` one takes {wanted}, {N} numbers each",
            numbers.len(),
        );
        params.error_at(name, message);
        return None;
    }
    if closed && curve != "bezier" && points.first() != points.last() {
        points.push(points[0]);
    }
    Some(points)
}

/// Reads finite numbers, separated by blanks and commas, from a string that is needed.
pub(crate) fn numbers(params: &Params<'_>, name: &str, what: &str) -> Option<Vec<f64>> {
    if !params.has(name) {
        params.missing(name, what);
    }
    let text = params.string(name)?;
    let words = text.split(|c: char| c == ',' || c.is_whitespace());
    let mut numbers = Vec::new();
    for word in words.filter(|word| !word.is_empty()) {
        match word.parse::<f64>() {
            Ok(number) if number.is_finite() => numbers.push(number),
            _ => {
                let message = format!("`{word}` in `{name}` is not a finite number");
                params.error_at(name, message);
                return None;
            }
        }
    }
    Some(numbers)
}

/// The pieces of a curve of a kind through points.
pub(crate) fn pieces_of<V: Vector>(curve: &str, closed: bool, points: &[V]) -> Vec<Cubic<V>> {
    let last = points.len() - 1;
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
                Cubic::hermite([a, b], [(b - before) * 0.5, (after - a) * 0.5])
            })
            .collect(),
        _ => (points.windows(2))
            .map(|pair| Cubic::straight(pair[0], pair[1]))
            .collect(),
    }
}
