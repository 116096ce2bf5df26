//! Orthonormal frames in lanes.

use super::{Lane, Vector};

/// The frame of [`crate::Frame`], in lanes.
#[derive(Clone, Copy, Debug)]
pub struct LaneFrame<F: Lane> {
    /// First tangent.
    pub s: F::Vector,
    /// Second tangent.
    pub t: F::Vector,
    /// Normal.
    pub n: F::Vector,
}

impl<F: Lane> LaneFrame<F> {
    /// `frame(i)` in lane i.
    #[inline(always)]
    pub fn of_lanes<'f>(frame: impl Fn(usize) -> &'f crate::Frame) -> Self {
        let [s, t] = F::Vector::pairs_of_lanes(|i| [frame(i).s, frame(i).t]);
        let n = F::Vector::of_lanes(|i| frame(i).n);
        Self { s, t, n }
    }

    /// Any frames with these unit normals (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
    #[inline(always)]
    pub fn from_normal(n: F::Vector) -> Self {
        let [x, y, z] = n.xyz();
        let sign = F::ONE.copysign(z);
        let a = -F::ONE / (sign + z);
        let b = x * y * a;
        Self {
            s: F::Vector::from_xyz(sign * x * x * a + F::ONE, sign * b, -sign * x),
            t: F::Vector::from_xyz(b, sign + y * y * a, -y),
            n,
        }
    }

    /// Components of the world vector `v` in this frame.
    #[inline(always)]
    pub fn to_local(&self, v: F::Vector) -> F::Vector {
        let Self { s, t, n } = *self;
        F::Vector::from_xyz(s.dot_product(v), t.dot_product(v), n.dot_product(v))
    }

    /// The world vector whose components in this frame are `v`.
    #[inline(always)]
    pub fn to_world(&self, v: F::Vector) -> F::Vector {
        let [x, y, z] = v.xyz();
        self.s * x + self.t * y + self.n * z
    }
}
