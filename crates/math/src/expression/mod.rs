//! Expressions of a scene file, such as `x^2 + y^2 + z^2 - 1`, in numbers, intervals, or either with a derivative.
//!
//! ```text
//! sum     = product { ("+" | "-") product }
//! product = signed { ("*" | "/") signed }
//! signed  = "-" signed | power
//! power   = atom [ "^" signed ]
//! atom    = number | name | name "(" sum { "," sum } ")" | "(" sum ")"
//! ```

pub mod interval;
pub mod number;
mod parse;

pub use interval::Interval;
pub use number::{Dual, Number};
pub use parse::ExpressionError;

/// An operation, on the results of earlier ones.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Operation {
    Constant(f64),
    Variable(u32),
    Add(u32, u32),
    /// Of a constant.
    Shift(u32, f64),
    Multiply(u32, u32),
    /// By a constant.
    Scale(u32, f64),
    Divide(u32, u32),
    Negate(u32),
    /// To a whole power.
    Power(u32, i32),
    Max(u32, u32),
    Of(Function, u32),
    Noise([u32; 3]),
}

/// A function of one variable.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Function {
    Sqrt,
    Exp,
    Ln,
    Sin,
    Cos,
    Atan,
}

/// The most operations of an expression.
const MOST: usize = 256;

/// An expression of some variables.
#[derive(Clone, Debug, PartialEq)]
pub struct Expression {
    operations: Vec<Operation>,
    result: u32,
}

impl Expression {
    /// Reads an expression of variables with these names.
    pub fn parse(text: &str, variables: &[&str]) -> Result<Self, ExpressionError> {
        parse::parse(text, variables).map(|(operations, result)| Self { operations, result })
    }

    /// The names of functions and constants.
    pub fn names() -> impl Iterator<Item = &'static str> {
        parse::NAMES.iter().copied()
    }

    /// Whether it has the variable number `index`.
    pub fn has(&self, index: usize) -> bool {
        (self.operations.iter())
            .any(|operation| matches!(*operation, Operation::Variable(i) if i as usize == index))
    }

    /// Its value.
    pub fn eval<N: Number>(&self, variables: &[N]) -> N {
        // A small stack for short expressions: initialising a large one would dominate.
        if self.operations.len() <= 32 {
            self.eval_within::<N, 32>(variables)
        } else {
            self.eval_within::<N, MOST>(variables)
        }
    }

    fn eval_within<N: Number, const SIZE: usize>(&self, variables: &[N]) -> N {
        let mut results = [N::constant(0.0); SIZE];
        for (index, operation) in self.operations.iter().enumerate() {
            let of = |i: u32| results[i as usize];
            results[index] = match *operation {
                Operation::Constant(value) => N::constant(value),
                Operation::Variable(i) => variables[i as usize],
                Operation::Add(a, b) => of(a).add(of(b)),
                Operation::Shift(a, c) => of(a).shift(c),
                Operation::Multiply(a, b) => of(a).mul(of(b)),
                Operation::Scale(a, c) => of(a).scale(c),
                Operation::Divide(a, b) => of(a).div(of(b)),
                Operation::Negate(a) => of(a).neg(),
                Operation::Power(a, n) => of(a).powi(n),
                Operation::Max(a, b) => {
                    let none = N::constant(0.0);
                    N::max_with(of(a), of(b), none, none).0
                }
                Operation::Of(function, a) => match function {
                    Function::Sqrt => of(a).sqrt(),
                    Function::Exp => of(a).exp(),
                    Function::Ln => of(a).ln(),
                    Function::Sin => of(a).sin(),
                    Function::Cos => of(a).cos(),
                    Function::Atan => of(a).atan(),
                },
                Operation::Noise(p) => N::noise(p.map(of)).0,
            };
        }
        results[self.result as usize]
    }
}

#[cfg(test)]
mod tests;
