//! The line of a `curve`: through points, by formulas of t, or where a formula of x and y vanishes.

use crate::shapes::curve::joints::{Joint, Strand, refine, turned};
use crate::shapes::curve::{Fineness, contour};
use crate::shapes::profile::cubic::Cubic;
use crate::shapes::profile::{numbers, pieces_of, points};
use etalon_math::{Dual, Expression};
use etalon_params::Params;
use glam::{DVec2, DVec3};

/// Joints of each piece before any halving, so that what happens in its middle only is seen.
const PER_PIECE: usize = 4;

/// The same of a curve of formulas.
const PER_FORMULA: usize = 64;

/// Reads `curve` (`linear`, `bezier`, `catmullrom`, `parametric` or `implicit`), its points or formulas, and its width.
pub(super) fn from_params(params: &Params<'_>, fineness: Fineness) -> Option<Vec<Strand>> {
    let curves = ["linear", "bezier", "catmullrom", "parametric", "implicit"];
    let curve = params.choice("curve", "linear", &curves);
    let strands = match curve {
        "parametric" => parametric(params, fineness),
        "implicit" => implicit(params, fineness),
        curve => through_points(params, curve, fineness),
    }?;
    let strands: Vec<Strand> = (strands.into_iter())
        .filter_map(|strand| finished(strand, fineness))
        .collect();
    if strands.is_empty() {
        params.error("this curve has no length".to_owned());
        return None;
    }
    Some(strands)
}

/// A strand whose tangent jumps nowhere, and which returns to its first joint if it is closed; `None` if it has no length.
fn finished(Strand { mut joints, closed }: Strand, fineness: Fineness) -> Option<Strand> {
    let first = *joints.first()?;
    if joints.iter().all(|joint| joint.position == first.position) {
        return None;
    }
    if closed {
        joints.push(Joint { u: 1.0, ..first });
    }
    Some(Strand {
        joints: turned(&joints, fineness),
        closed,
    })
}

/// The width along a curve.
enum Width {
    /// A formula of u.
    Formula(Expression),
    /// Through widths at the points.
    Pieces(Vec<Cubic<f64>>),
}

impl Width {
    /// Reads `width` (0.02), a number or a formula of u.
    fn from_params(params: &Params<'_>) -> Option<Self> {
        params
            .number_or_expression("width", 0.02, &["u"])
            .map(Self::Formula)
    }

    /// NaN counts as 0.
    fn at(&self, u: f64) -> f64 {
        let width = match self {
            Self::Formula(formula) => formula.eval(&[u]),
            Self::Pieces(pieces) => {
                let (index, s) = place(u, pieces.len());
                pieces[index].at(s)
            }
        };
        if width > 0.0 && width.is_finite() {
            width
        } else {
            0.0
        }
    }
}

/// The piece, and the place on it, so far along.
fn place(u: f64, pieces: usize) -> (usize, f64) {
    let along = u * pieces as f64;
    let index = (along as usize).min(pieces - 1);
    (index, along - index as f64)
}

fn through_points(params: &Params<'_>, curve: &str, fineness: Fineness) -> Option<Vec<Strand>> {
    let closed = params.boolean_or("closed", false);
    let plane = params.has("profile");
    if plane && params.has("points") {
        let message = "`points` and `profile` both say where this curve runs";
        params.error_with_help(
            "profile",
            message,
            "`points` has three numbers each, `profile` two",
        );
        return None;
    }
    let points: Vec<DVec3> = if plane {
        let example = "pairs of numbers, such as `0.5 0, 0.7 1`";
        let point = |[x, y]: [f64; 2]| DVec3::new(x, y, 0.0);
        points(params, ("profile", example), curve, closed, point)
    } else {
        let example = "triples of numbers, such as `0 0 0, 0 1 0.5`, or pairs as `profile`";
        points(
            params,
            ("points", example),
            curve,
            closed,
            DVec3::from_array,
        )
    }?;
    let width = match params.has("widths") {
        true => Width::Pieces(widths(params, curve, closed, points.len())?),
        false => Width::from_params(params)?,
    };
    let pieces = pieces_of(curve, closed, &points);
    let count = pieces.len() as f64;
    let mut joints = Vec::new();
    for (index, piece) in pieces.iter().enumerate() {
        let at = |s: f64| {
            let u = (index as f64 + s) / count;
            Joint {
                u,
                position: piece.at(s),
                tangent: piece.tangent(s).normalize_or(DVec3::X),
                width: width.at(u),
            }
        };
        if piece.0.iter().all(|p| *p == piece.0[0]) {
            continue;
        }
        // Between points a formula may do anything.
        let for_width = match &width {
            Width::Formula(formula) if formula.has(0) => PER_FORMULA.div_ceil(pieces.len()),
            _ => 1,
        };
        let parts = for_width.max(if curve == "linear" { 1 } else { PER_PIECE });
        joints.push(at(0.0));
        for part in 0..parts {
            let [a, b] = [part, part + 1].map(|part| at(part as f64 / parts as f64));
            let mut between =
                |a: &Joint, b: &Joint| Some(at(0.5 * (a.u + b.u) * count - index as f64));
            refine([a, b], fineness, &mut between, &mut joints);
        }
    }
    Some(vec![Strand {
        closed: points.first() == points.last(),
        joints,
    }])
}

/// Reads `widths`, one for each point.
fn widths(
    params: &Params<'_>,
    curve: &str,
    closed: bool,
    points: usize,
) -> Option<Vec<Cubic<f64>>> {
    let mut widths = numbers(params, "widths", "a width for each point")?;
    if params.has("width") {
        let message = "`width` and `widths` both say how wide this curve is";
        params.error_with_help("width", message, "`widths` has a number for each point");
        return None;
    }
    // A closed curve comes back to its first point by itself.
    if closed && widths.len() + 1 == points {
        widths.push(widths[0]);
    }
    if widths.len() != points || widths.iter().any(|width| *width < 0.0) {
        let message = format!("`widths` has {} numbers for {points} points", widths.len());
        let help = "accepted: as many numbers as there are points, none below 0";
        params.error_with_help("widths", &message, help);
        return None;
    }
    Some(pieces_of(curve, closed, &widths))
}

/// Reads `x`, `y` and `z` (0), formulas of t, and the least and greatest t, `from` (0) and `to` (1).
fn parametric(params: &Params<'_>, fineness: Fineness) -> Option<Vec<Strand>> {
    let width = Width::from_params(params);
    for name in ["x", "y"] {
        if !params.has(name) {
            params.missing(name, "a formula of t, such as `cos(2*pi*t)`");
        }
    }
    let [x, y] = ["x", "y"].map(|name| params.expression(name, &["t"]));
    let z = params.number_or_expression("z", 0.0, &["t"]);
    let first = params.float_or("from", 0.0);
    let what = "a finite number above `from`";
    let last = params.float_where("to", 1.0, what, |to| to > first && to.is_finite());
    let (formulas, width) = ([x?, y?, z?], width?);
    let at = |u: f64| {
        let t = first + (last - first) * u;
        let slope = last - first;
        let [x, y, z] = (formulas.each_ref()).map(|f| f.eval(&[Dual { value: t, slope }]));
        Joint {
            u,
            position: DVec3::new(x.value, y.value, z.value),
            tangent: DVec3::new(x.slope, y.slope, z.slope),
            width: width.at(u),
        }
    };
    // At a cusp, the direction of a place near by.
    let directed = |u: f64| {
        let joint = at(u);
        let near = || at(u + (0.5 - u) * 1e-6).tangent.try_normalize();
        let tangent = joint.tangent.try_normalize().or_else(near)?;
        joint
            .position
            .is_finite()
            .then_some(Joint { tangent, ..joint })
    };
    let mut failed = None;
    let mut sound = |u: f64| {
        let joint = directed(u);
        if joint.is_none() {
            failed.get_or_insert(first + (last - first) * u);
        }
        joint
    };
    let mut joints = Vec::from_iter(sound(0.0));
    for part in 0..PER_FORMULA {
        let [a, b] = [part, part + 1].map(|part| sound(part as f64 / PER_FORMULA as f64));
        if let Some((a, b)) = a.zip(b) {
            let mut between = |a: &Joint, b: &Joint| sound(0.5 * (a.u + b.u));
            refine([a, b], fineness, &mut between, &mut joints);
        }
    }
    if let Some(t) = failed {
        let message = format!("the curve is not defined, or has no direction, at t = {t}");
        params.error_at("x", message);
        return None;
    }
    // Close gaps left by rounding.
    let size = joints
        .iter()
        .map(|joint| joint.position.distance(joints[0].position));
    let size = size.fold(0.0, f64::max);
    let (start, end) = (joints[0].position, joints.len() - 1);
    let closed = joints[end].position.distance(start) <= 1e-9 * size;
    if closed {
        joints[end].position = start;
    }
    Some(vec![Strand { joints, closed }])
}

/// Reads `function`, a formula of x and y, and the box in which its zeros are looked for: from `min` (−1, −1) to `max`
/// (1, 1), in `resolution` (256) cells along each side.
fn implicit(params: &Params<'_>, fineness: Fineness) -> Option<Vec<Strand>> {
    let width = Width::from_params(params);
    if !params.has("function") {
        params.missing("function", "a formula of x and y, such as `x^2 + y^2 - 1`");
    }
    let function = params.expression("function", &["x", "y"]);
    let [low, high] = [("min", -1.0), ("max", 1.0)].map(|(name, default)| {
        let corner = params.vector(name).unwrap_or(DVec3::splat(default));
        corner.truncate()
    });
    let asked = params.integer_or("resolution", 256);
    let cells = (usize::try_from(asked).ok()).filter(|n| (4..=4096).contains(n));
    if cells.is_none() {
        params.refuse("resolution", asked, "a whole number from 4 to 4096");
    }
    if !(low.cmplt(high).all() && low.is_finite() && high.is_finite()) {
        params.error_at(
            "max",
            "`max` must be above `min` in x and y, and both finite",
        );
        return None;
    }
    let (function, width, cells) = (function?, width?, cells?);
    let value = |p: DVec2| function.eval(&[p.x, p.y]);
    let gradient = |p: DVec2| {
        let along = |x: f64, y: f64| {
            let at = |value: f64, slope: f64| Dual { value, slope };
            function.eval(&[at(p.x, x), at(p.y, y)]).slope
        };
        DVec2::new(along(1.0, 0.0), along(0.0, 1.0))
    };
    let lines = contour::lines(&value, [low, high], cells);
    if lines.is_empty() {
        let message =
            "`function` does not change its sign between `min` and `max`: there is no curve";
        params.error_at("function", message);
        return None;
    }
    let cell = (high - low).max_element() / cells as f64;
    let strands = lines.into_iter().map(|(mut points, closed)| {
        if closed {
            points.push(points[0]);
        }
        let mut length = 0.0;
        let lengths: Vec<f64> = (points.windows(2))
            .map(|pair| {
                length += pair[0].distance(pair[1]);
                length
            })
            .collect();
        let joint = |position: DVec2, onward: DVec2, u: f64| {
            let across = gradient(position)
                .perp()
                .normalize_or(onward.normalize_or(DVec2::X));
            Joint {
                u,
                position: position.extend(0.0),
                tangent: (across * 1.0_f64.copysign(across.dot(onward))).extend(0.0),
                width: width.at(u),
            }
        };
        let last = points.len() - 1;
        let at = |index: usize| {
            let onward = points[(index + 1).min(last)] - points[index.saturating_sub(1)];
            let before = if index > 0 { lengths[index - 1] } else { 0.0 };
            joint(points[index], onward, before / length)
        };
        // Between two joints: the zero nearest to their middle, by Newton's method.
        let mut between = |a: &Joint, b: &Joint| {
            let chord = (b.position - a.position).truncate();
            let middle = (0.5 * (a.position + b.position)).truncate();
            let mut p = middle;
            for _ in 0..4 {
                let slope = gradient(p);
                p -= slope * (value(p) / slope.length_squared());
            }
            let near = p.distance(middle) <= 0.5 * chord.length() && chord.length() > 1e-3 * cell;
            near.then(|| joint(p, chord, 0.5 * (a.u + b.u)))
        };
        let mut joints = Vec::from_iter((last > 0).then(|| at(0)));
        for index in 0..last {
            refine(
                [at(index), at(index + 1)],
                fineness,
                &mut between,
                &mut joints,
            );
        }
        Strand { joints, closed }
    });
    Some(strands.collect())
}
