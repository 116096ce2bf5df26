//! `implicit` and others: the surface f(x, y, z) = 0 of a function (`shapes/analytic/field.rs`), in a box; the solid is where f is negative.
//!
//! Two ways to find where a line o + t·d meets it. **`certified`** (the default; D. Mitchell 1990, *Robust ray
//! intersection with interval arithmetic*): a piece [a, b] of the line is enclosed by interval arithmetic,
//!
//! ```text
//! F = f(o + [a, b]·d) ∩ (f(m) + F′·([a, b] − m)),   F′ ∋ d/dt f on [a, b],   m the middle
//! ```
//!
//! and skipped if F has no zero. If F′ has none, there is one crossing if the signs at a and b differ, and none if they
//! agree; it is found to the last digits. Otherwise the piece is halved, until it is shorter than `feature`: then the
//! signs decide. Only parts that a line crosses within less than `feature` can be missed. Poles, and points where f is
//! not defined (outside), widen the interval to everything.
//!
//! **`march`**: f is evaluated every `step`, and a crossing is where its sign has changed. Parts that a line crosses
//! within less than a step may be missed: thin parts fray, and outlines shrink by about step²/8 times the curvature.
//!
//! Both cut a line in the same way for every query, so that crossings alternate between in and out.

use crate::shapes::analytic::clip_box::{CURVED, ClipBox, FACES};
use crate::shapes::analytic::crossing::{Crossing, Line};
use crate::shapes::analytic::field::Field;
use crate::shapes::analytic::placed::{OwnPoint, OwnShape, Placed};
use crate::shapes::analytic::sign_changes::{OneParameter, refine, sign_changes};
use core::ops::ControlFlow;
use etalon_math::Dual;
use etalon_math::expression::Number;
use etalon_params::Params;
use glam::DVec3;

/// The method of finding crossings.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Method {
    /// Interval arithmetic, down to this length (m, in the shape's own space).
    Certified(f64),
    /// In steps of this length.
    March(f64),
}

/// The zero set of a function.
#[derive(Clone, Debug)]
pub struct Implicit {
    field: Field,
    clip: ClipBox,
    /// Whether the box's faces are no part of the surface.
    open: bool,
    method: Method,
}

/// f along a line.
struct Along<'a> {
    shape: &'a Implicit,
    line: &'a Line,
}

impl OneParameter for Along<'_> {
    fn eval<N: Number>(&self, t: N) -> N {
        let Line { origin, direction } = self.line;
        let at = |i: usize| t.scale(direction[i]).shift(origin[i]);
        self.shape.eval([at(0), at(1), at(2)])
    }
}

impl Implicit {
    /// Reads an expression, and the box from `min` to `max`.
    pub(crate) fn from_params(params: &Params<'_>) -> Option<Placed<Self>> {
        let clip = ClipBox::from_params(params);
        Self::of(params, (Field::expression(params), clip))
    }

    /// Reads the rest of a function's shape: `open` (false), `method` (`certified` or `march`), `feature` (10⁻⁴ of the
    /// box's diagonal) or `step` (10⁻² of it), `flip_normals` and `to_world`.
    pub(crate) fn of(
        params: &Params<'_>,
        (field, clip): (Option<Field>, Option<ClipBox>),
    ) -> Option<Placed<Self>> {
        let open = params.boolean_or("open", false);
        let diagonal = clip.map_or(1.0, |clip| (clip.high - clip.low).length());
        let what = "a positive length, 10⁻⁶ of the box's diagonal at least";
        let length = |name: &str, default: f64| {
            let fits = |x: f64| x >= 1e-6 * diagonal && x.is_finite();
            params.float_where(name, default * diagonal, what, fits)
        };
        let method = match params.choice("method", "certified", &["certified", "march"]) {
            "march" => Method::March(length("step", 1e-2)),
            _ => Method::Certified(length("feature", 1e-4)),
        };
        let shape = field.zip(clip).map(|(field, clip)| Self {
            field,
            clip,
            open,
            method,
        });
        Placed::from_params(params, shape)
    }

    #[inline]
    fn eval<N: Number>(&self, p: [N; 3]) -> N {
        self.field.eval(p)
    }

    fn value(&self, p: DVec3) -> f64 {
        self.eval(p.to_array())
    }

    fn gradient(&self, p: DVec3) -> DVec3 {
        let slope = |along: DVec3| {
            let at: [Dual<f64>; 3] = core::array::from_fn(|i| Dual {
                value: p[i],
                slope: along[i],
            });
            self.eval(at).slope
        };
        DVec3::new(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z))
    }

    /// The unit normal at a point of the surface. At a pole the gradient points inside, and where f begins to be
    /// defined there may be none: then it is that of a place near by.
    fn normal(&self, p: DVec3) -> DVec3 {
        let near = 1e-6 * (self.clip.high - self.clip.low).length();
        let around = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
        let normal = self.gradient(p).try_normalize().or_else(|| {
            around
                .map(|axis| self.gradient(p + axis * near))
                .find_map(DVec3::try_normalize)
        });
        let normal = normal.unwrap_or(DVec3::Z);
        let [out, inside] = [near, -near].map(|off| self.value(p + normal * off) < 0.0);
        if out && !inside { -normal } else { normal }
    }

    /// The first crossing of the surface between `first` and `last` that is beyond `after`, if it is before `before`.
    fn curved_crossing(
        &self,
        line: &Line,
        (first, last): (f64, f64),
        (after, before): (f64, f64),
    ) -> Option<(f64, bool)> {
        let along = Along { shape: self, line };
        let length = line.direction.length();
        match self.method {
            Method::March(step) => {
                let count = ((last - first) * length / step).ceil().clamp(1.0, 1e7);
                let at = |k: f64| first + (last - first) * (k / count).min(1.0);
                let skipped = ((after - first) / (last - first) * count).floor() - 1.0;
                let mut k = skipped.clamp(0.0, count);
                let mut inside = along.is_inside(at(k));
                while k < count && at(k) < before {
                    let next = along.is_inside(at(k + 1.0));
                    if next != inside {
                        let t = refine(&along, at(k), at(k + 1.0), inside);
                        if t > after {
                            return Some((t, next));
                        }
                    }
                    (k, inside) = (k + 1.0, next);
                }
                None
            }
            Method::Certified(feature) => {
                let skip = |a: f64, b: f64| b <= after || a >= before;
                let span = (first, last);
                sign_changes(&along, span, feature / length, skip, |t, inside| {
                    if t > after {
                        ControlFlow::Break((t, !inside))
                    } else {
                        ControlFlow::Continue(())
                    }
                })
            }
        }
    }
}

impl OwnShape for Implicit {
    fn next_crossing(&self, line: &Line, after: f64, before: f64) -> Option<Crossing> {
        let [first, last] = self.clip.cut(line)?;
        let along = Along { shape: self, line };
        let at_face = |(t, face): (f64, u32), enters: bool| {
            (!self.open && t > after && along.is_inside(t)).then(|| Crossing {
                face,
                ..Crossing::new(t, enters)
            })
        };
        if let Some(entered) = at_face(first, true) {
            return Some(entered);
        }
        let met = self.curved_crossing(line, (first.0, last.0), (after, before));
        if let Some((t, enters)) = met {
            return Some(Crossing {
                face: CURVED,
                ..Crossing::new(t, enters)
            });
        }
        at_face(last, false)
    }

    fn surface_at(&self, p: DVec3, crossing: &Crossing) -> OwnPoint {
        if let Some(point) = self.clip.face(crossing.face, p) {
            return point;
        }
        // It is on the surface to the last digits already.
        self.clip.curved(p, self.normal(p))
    }

    fn bounds(&self) -> [DVec3; 2] {
        [self.clip.low, self.clip.high]
    }

    fn is_closed(&self) -> bool {
        !self.open
    }

    fn faces(&self) -> u32 {
        FACES
    }
}
