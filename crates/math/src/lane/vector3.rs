//! Points, directions and normals in lanes.

use super::{Lane, Select};
use core::fmt::Debug;
use core::ops::{Add, Mul, Neg, Sub};

/// Three coordinates, each in lanes: [`glam::Vec3`] for one number, [`Vector3`] for a vector of them. The order of operations is
/// that of `glam`, so that both have the same bits.
pub trait Vector<F: Lane>:
    Copy + Debug + Neg<Output = Self> + Add<Output = Self> + Sub<Output = Self> + Mul<F, Output = Self>
{
    /// The vector with these coordinates.
    fn from_xyz(x: F, y: F, z: F) -> Self;
    /// The coordinates.
    fn xyz(self) -> [F; 3];

    /// The same vector in every lane.
    #[inline(always)]
    fn broadcast(vector: glam::Vec3) -> Self {
        Self::from_xyz(F::splat(vector.x), F::splat(vector.y), F::splat(vector.z))
    }

    /// `vector(i)` in lane i.
    #[inline(always)]
    fn of_lanes(vector: impl Fn(usize) -> glam::Vec3) -> Self {
        let [x, y, z, ..] = F::columns(|i| {
            let [x, y, z] = vector(i).to_array();
            [x, y, z, 0.0, 0.0, 0.0, 0.0, 0.0]
        });
        Self::from_xyz(x, y, z)
    }

    /// Two vectors, `pair(i)` in lane i.
    #[inline(always)]
    fn pairs_of_lanes(pair: impl Fn(usize) -> [glam::Vec3; 2]) -> [Self; 2] {
        let [a, b, c, d, e, f, ..] = F::columns(|i| {
            let [[a, b, c], [d, e, f]] = pair(i).map(|vector| vector.to_array());
            [a, b, c, d, e, f, 0.0, 0.0]
        });
        [[a, b, c], [d, e, f]].map(|[x, y, z]| Self::from_xyz(x, y, z))
    }

    /// The vector in lane `index`.
    #[inline(always)]
    fn at_lane(self, index: usize) -> glam::Vec3 {
        let [x, y, z] = self.xyz();
        glam::Vec3::new(x.lane(index), y.lane(index), z.lane(index))
    }

    /// `yes` in the lanes where `mask` says yes, `no` in the others.
    #[inline(always)]
    fn choose(mask: F::Mask, yes: Self, no: Self) -> Self {
        let ([a, b, c], [d, e, f]) = (yes.xyz(), no.xyz());
        Self::from_xyz(mask.select(a, d), mask.select(b, e), mask.select(c, f))
    }

    /// The third coordinate; in a local frame, the cosine with the normal.
    #[inline(always)]
    fn z(self) -> F {
        let [_, _, z] = self.xyz();
        z
    }

    /// Scalar product: (x x' + y y') + z z'.
    #[inline(always)]
    fn dot_product(self, other: Self) -> F {
        let ([a, b, c], [d, e, f]) = (self.xyz(), other.xyz());
        a * d + b * e + c * f
    }

    /// The length.
    #[inline(always)]
    fn norm(self) -> F {
        self.dot_product(self).sqrt()
    }

    /// The vector brought to unit length.
    #[inline(always)]
    fn normalized(self) -> Self {
        self * (F::ONE / self.norm())
    }

    /// Every coordinate without its sign.
    #[inline(always)]
    fn magnitudes(self) -> Self {
        let [x, y, z] = self.xyz();
        Self::from_xyz(x.abs(), y.abs(), z.abs())
    }

    /// Whether all coordinates are 0.
    #[inline(always)]
    fn is_zero(self) -> F::Mask {
        let [x, y, z] = self.xyz();
        let zero = |coordinate| Lane::eq(coordinate, F::ZERO);
        zero(x) & zero(y) & zero(z)
    }

    /// Every coordinate divided by `divisor`.
    #[inline(always)]
    fn over(self, divisor: F) -> Self {
        let [x, y, z] = self.xyz();
        Self::from_xyz(x / divisor, y / divisor, z / divisor)
    }
}

impl Vector<f32> for glam::Vec3 {
    #[inline(always)]
    fn from_xyz(x: f32, y: f32, z: f32) -> Self {
        Self::new(x, y, z)
    }
    #[inline(always)]
    fn xyz(self) -> [f32; 3] {
        self.to_array()
    }
}

/// Three coordinates in vectors of numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vector3<F> {
    /// First coordinate.
    pub x: F,
    /// Second coordinate.
    pub y: F,
    /// Third coordinate; in a local frame, along the normal.
    pub z: F,
}

impl<F: Lane> Vector<F> for Vector3<F> {
    #[inline(always)]
    fn from_xyz(x: F, y: F, z: F) -> Self {
        Self { x, y, z }
    }
    #[inline(always)]
    fn xyz(self) -> [F; 3] {
        [self.x, self.y, self.z]
    }
}

impl<F: Lane> Add for Vector3<F> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::from_xyz(self.x + other.x, self.y + other.y, self.z + other.z)
    }
}

impl<F: Lane> Sub for Vector3<F> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::from_xyz(self.x - other.x, self.y - other.y, self.z - other.z)
    }
}

impl<F: Lane> Neg for Vector3<F> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self::from_xyz(-self.x, -self.y, -self.z)
    }
}

impl<F: Lane> Mul<F> for Vector3<F> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: F) -> Self {
        Self::from_xyz(self.x * factor, self.y * factor, self.z * factor)
    }
}
