//! Crossings of a line with the surface of a shape that is intersected by a formula.

use glam::{DVec2, DVec3, Vec3};

/// The line o + t·d. The direction need not be a unit vector.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// o (m).
    pub origin: DVec3,
    /// d.
    pub direction: DVec3,
}

impl Line {
    /// The line of a ray.
    #[inline]
    pub(crate) fn of_ray(origin: Vec3, direction: Vec3) -> Self {
        Self {
            origin: origin.as_dvec3(),
            direction: direction.as_dvec3(),
        }
    }

    /// The point at parameter `t`.
    #[inline]
    pub(crate) fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }

    /// Whether it passes a box by, or has left it before `after`.
    pub(crate) fn misses(&self, bounds: [DVec3; 2], after: f64) -> bool {
        self.misses_by(self.direction.recip(), bounds, after)
    }

    /// The same, when 1/d is known.
    pub(crate) fn misses_by(&self, inverse: DVec3, [low, high]: [DVec3; 2], after: f64) -> bool {
        let (a, b) = (
            (low - self.origin) * inverse,
            (high - self.origin) * inverse,
        );
        // A line in the plane of a face gives NaN, which `min` and `max` pass over.
        let enters = a.min(b).max_element();
        let leaves = a.max(b).min_element();
        enters > leaves || leaves < after
    }
}

/// A crossing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The parameter on the line.
    pub t: f64,
    /// Whether the line goes into the volume that the surface bounds; of a surface that bounds none, whether it
    /// goes against the normal.
    pub enters: bool,
    /// The face of the shape, for materials by face.
    pub face: u32,
    /// Whether the face's own surface is crossed the other way: it has been carved out of a solid.
    pub carved: bool,
    /// Parameters of the point, if the shape found them on the way.
    pub uv: DVec2,
}

impl Crossing {
    /// One of a shape in one face, whose parameters are not known yet.
    #[inline]
    pub(crate) fn new(t: f64, enters: bool) -> Self {
        Self {
            t,
            enters,
            face: 0,
            carved: false,
            uv: DVec2::ZERO,
        }
    }

    /// The first beyond `after` of two crossings of a convex solid in ascending order, NaN if there is none.
    #[inline]
    pub(crate) fn of_convex([a, b]: [f64; 2], after: f64) -> Option<Self> {
        if a > after {
            Some(Self::new(a, true))
        } else if b > after {
            Some(Self::new(b, false))
        } else {
            None
        }
    }

    /// The one nearest to `t` of two crossings of a convex solid in ascending order, NaN if there is none; one at `t` if there are
    /// none.
    #[inline]
    pub(crate) fn nearest_of_convex([a, b]: [f64; 2], t: f64) -> Self {
        let [to_a, to_b] = [a, b].map(|crossing| (crossing - t).abs());
        if to_a <= to_b || b.is_nan() {
            Self::new(if a.is_nan() { t } else { a }, true)
        } else {
            Self::new(b, false)
        }
    }
}
