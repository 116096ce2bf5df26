//! Number types of expressions: numbers, intervals, and either with a derivative.

use crate::float64;
use crate::noise;
use glam::DVec3;

/// An arithmetic.
pub trait Number: Copy {
    /// A constant.
    fn constant(value: f64) -> Self;
    /// a + b.
    fn add(self, b: Self) -> Self;
    /// a + c.
    fn shift(self, c: f64) -> Self {
        self.add(Self::constant(c))
    }
    /// a · c.
    fn scale(self, c: f64) -> Self {
        self.mul(Self::constant(c))
    }
    /// a · b.
    fn mul(self, b: Self) -> Self;
    /// a / b.
    fn div(self, b: Self) -> Self;
    /// −a.
    fn neg(self) -> Self;
    /// aⁿ.
    fn powi(self, n: i32) -> Self;
    /// √a.
    fn sqrt(self) -> Self;
    /// eᵃ.
    fn exp(self) -> Self;
    /// The natural logarithm.
    fn ln(self) -> Self;
    /// Sine.
    fn sin(self) -> Self;
    /// Cosine.
    fn cos(self) -> Self;
    /// Arc tangent.
    fn atan(self) -> Self;
    /// The greater of a and b, and which of `da` and `db` belongs to it: both together where it may be either.
    fn max_with(a: Self, b: Self, da: Self, db: Self) -> (Self, Self);
    /// The noise at a point, and its gradient.
    fn noise(p: [Self; 3]) -> (Self, [Self; 3]);
}

impl Number for f64 {
    fn constant(value: f64) -> Self {
        value
    }
    fn add(self, b: Self) -> Self {
        self + b
    }
    fn mul(self, b: Self) -> Self {
        self * b
    }
    fn div(self, b: Self) -> Self {
        self / b
    }
    fn neg(self) -> Self {
        -self
    }
    fn powi(self, n: i32) -> Self {
        let power = (0..n.unsigned_abs()).fold(1.0, |power, _| power * self);
        if n < 0 { 1.0 / power } else { power }
    }
    fn sqrt(self) -> Self {
        self.sqrt()
    }
    fn exp(self) -> Self {
        float64::exp(self)
    }
    fn ln(self) -> Self {
        float64::ln(self)
    }
    fn sin(self) -> Self {
        float64::sin(self)
    }
    fn cos(self) -> Self {
        float64::cos(self)
    }
    fn atan(self) -> Self {
        float64::atan(self)
    }
    fn max_with(a: Self, b: Self, da: Self, db: Self) -> (Self, Self) {
        if a >= b { (a, da) } else { (b, db) }
    }
    fn noise(p: [Self; 3]) -> (Self, [Self; 3]) {
        let (value, gradient) = noise::noise_and_gradient(DVec3::from(p));
        (value, gradient.to_array())
    }
}

/// A value and its derivative by one parameter.
#[derive(Clone, Copy, Debug)]
pub struct Dual<N> {
    /// The value.
    pub value: N,
    /// The derivative.
    pub slope: N,
}

impl<N: Number> Dual<N> {
    /// f(a), where f has this value and derivative at a.
    fn chain(self, value: N, derivative: N) -> Self {
        Self {
            value,
            slope: derivative.mul(self.slope),
        }
    }
}

impl<N: Number> Number for Dual<N> {
    fn constant(value: f64) -> Self {
        Self {
            value: N::constant(value),
            slope: N::constant(0.0),
        }
    }
    fn add(self, b: Self) -> Self {
        Self {
            value: self.value.add(b.value),
            slope: self.slope.add(b.slope),
        }
    }
    fn shift(self, c: f64) -> Self {
        Self {
            value: self.value.shift(c),
            slope: self.slope,
        }
    }
    fn scale(self, c: f64) -> Self {
        Self {
            value: self.value.scale(c),
            slope: self.slope.scale(c),
        }
    }
    fn mul(self, b: Self) -> Self {
        Self {
            value: self.value.mul(b.value),
            slope: self.slope.mul(b.value).add(self.value.mul(b.slope)),
        }
    }
    fn div(self, b: Self) -> Self {
        let value = self.value.div(b.value);
        let slope = self.slope.add(value.mul(b.slope).neg()).div(b.value);
        Self { value, slope }
    }
    fn neg(self) -> Self {
        Self {
            value: self.value.neg(),
            slope: self.slope.neg(),
        }
    }
    fn powi(self, n: i32) -> Self {
        if n == 0 {
            return Self::constant(1.0);
        }
        let derivative = N::constant(n.into()).mul(self.value.powi(n - 1));
        self.chain(self.value.powi(n), derivative)
    }
    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.chain(root, N::constant(0.5).div(root))
    }
    fn exp(self) -> Self {
        let value = self.value.exp();
        self.chain(value, value)
    }
    fn ln(self) -> Self {
        self.chain(self.value.ln(), N::constant(1.0).div(self.value))
    }
    fn sin(self) -> Self {
        self.chain(self.value.sin(), self.value.cos())
    }
    fn cos(self) -> Self {
        self.chain(self.value.cos(), self.value.sin().neg())
    }
    fn atan(self) -> Self {
        let square = N::constant(1.0).add(self.value.powi(2));
        self.chain(self.value.atan(), N::constant(1.0).div(square))
    }
    fn max_with(a: Self, b: Self, da: Self, db: Self) -> (Self, Self) {
        let (value, slope) = N::max_with(a.value, b.value, a.slope, b.slope);
        let (_, d_value) = N::max_with(a.value, b.value, da.value, db.value);
        let (_, d_slope) = N::max_with(a.value, b.value, da.slope, db.slope);
        let derivative = Self {
            value: d_value,
            slope: d_slope,
        };
        (Self { value, slope }, derivative)
    }
    /// The gradient has no derivative of its own; nothing needs it.
    fn noise(p: [Self; 3]) -> (Self, [Self; 3]) {
        let (value, gradient) = N::noise(p.map(|x| x.value));
        let terms = [0, 1, 2].map(|i| gradient[i].mul(p[i].slope));
        let slope = terms[0].add(terms[1]).add(terms[2]);
        let gradient = gradient.map(|value| Self {
            value,
            slope: N::constant(f64::NAN),
        });
        (Self { value, slope }, gradient)
    }
}
