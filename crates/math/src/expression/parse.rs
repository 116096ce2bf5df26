//! From text to operations.

use super::{Function, MOST, Operation};

/// A mistake in an expression.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExpressionError {
    /// Position, in characters from 1.
    pub character: usize,
    /// The message.
    pub message: String,
    /// A name that is not known, if that is what.
    pub unknown: Option<String>,
}

/// Names besides the variables.
pub(super) const NAMES: &[&str] = &[
    "abs", "atan", "cos", "exp", "ln", "max", "min", "noise", "pi", "sin", "sqrt", "tan",
];

/// Parentheses, signs and powers in one another.
const DEEPEST: usize = 64;

struct Parser<'a> {
    text: &'a str,
    /// The position of the parser (bytes).
    at: usize,
    variables: &'a [&'a str],
    operations: Vec<Operation>,
    depth: usize,
}

/// The operations, and which of them gives the result.
pub(super) fn parse(
    text: &str,
    variables: &[&str],
) -> Result<(Vec<Operation>, u32), ExpressionError> {
    let mut parser = Parser {
        text,
        at: 0,
        variables,
        operations: Vec::new(),
        depth: 0,
    };
    let result = parser.sum()?;
    match parser.peek() {
        None => Ok((parser.operations, result)),
        Some(other) => Err(parser.error(format!("expected an operator, not `{other}`"))),
    }
}

impl Parser<'_> {
    fn error(&self, message: impl Into<String>) -> ExpressionError {
        ExpressionError {
            character: self.text[..self.at].chars().count() + 1,
            message: message.into(),
            unknown: None,
        }
    }

    /// The next character that is no space.
    fn peek(&mut self) -> Option<char> {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
        self.text[self.at..].chars().next()
    }

    fn accept(&mut self, character: char) -> bool {
        let found = self.peek() == Some(character);
        if found {
            self.at += character.len_utf8();
        }
        found
    }

    fn expect(&mut self, character: char) -> Result<(), ExpressionError> {
        if self.accept(character) {
            return Ok(());
        }
        Err(match self.peek() {
            Some(other) => self.error(format!("expected `{character}`, not `{other}`")),
            None => self.error(format!("expected `{character}`, but the expression ends")),
        })
    }

    /// The result of an operation; of equal ones there is one.
    fn push(&mut self, operation: Operation) -> Result<u32, ExpressionError> {
        let operation = self.with_constants(operation);
        if let Some(known) = self.operations.iter().position(|known| *known == operation) {
            return Ok(known as u32);
        }
        if self.operations.len() == MOST {
            return Err(self.error(format!("more than {MOST} operations")));
        }
        self.operations.push(operation);
        Ok(self.operations.len() as u32 - 1)
    }

    /// The same operation, quicker where an operand is constant.
    fn with_constants(&self, operation: Operation) -> Operation {
        let constant = |i: u32| match self.operations[i as usize] {
            Operation::Constant(value) => Some(value),
            _ => None,
        };
        match operation {
            Operation::Negate(a) => constant(a).map(|c| Operation::Constant(-c)),
            Operation::Add(a, b) => match (constant(a), constant(b)) {
                (_, Some(c)) => Some(Operation::Shift(a, c)),
                (Some(c), None) => Some(Operation::Shift(b, c)),
                (None, None) => None,
            },
            Operation::Multiply(a, b) => match (constant(a), constant(b)) {
                (_, Some(c)) => Some(Operation::Scale(a, c)),
                (Some(c), None) => Some(Operation::Scale(b, c)),
                (None, None) => None,
            },
            _ => None,
        }
        .unwrap_or(operation)
    }

    fn sum(&mut self) -> Result<u32, ExpressionError> {
        let mut left = self.product()?;
        loop {
            if self.accept('+') {
                let right = self.product()?;
                left = self.push(Operation::Add(left, right))?;
            } else if self.accept('-') {
                let right = self.product()?;
                let right = self.push(Operation::Negate(right))?;
                left = self.push(Operation::Add(left, right))?;
            } else {
                return Ok(left);
            }
        }
    }

    fn product(&mut self) -> Result<u32, ExpressionError> {
        let mut left = self.signed()?;
        loop {
            if self.accept('*') {
                let right = self.signed()?;
                // Intervals know that a square is not negative.
                left = self.push(if left == right {
                    Operation::Power(left, 2)
                } else {
                    Operation::Multiply(left, right)
                })?;
            } else if self.accept('/') {
                let right = self.signed()?;
                left = self.push(Operation::Divide(left, right))?;
            } else {
                return Ok(left);
            }
        }
    }

    fn signed(&mut self) -> Result<u32, ExpressionError> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(self.error(format!("nested more than {DEEPEST} deep")));
        }
        let value = if self.accept('-') {
            let value = self.signed()?;
            self.push(Operation::Negate(value))
        } else {
            self.power()
        };
        self.depth -= 1;
        value
    }

    fn power(&mut self) -> Result<u32, ExpressionError> {
        let base = self.atom()?;
        if !self.accept('^') {
            return Ok(base);
        }
        let exponent = self.signed()?;
        let constant = match self.operations[exponent as usize] {
            Operation::Constant(value) => Some(value),
            _ => None,
        };
        if let Some(n) = constant.filter(|n| n.fract() == 0.0 && n.abs() <= 64.0) {
            return self.push(Operation::Power(base, n as i32));
        }
        let logarithm = self.push(Operation::Of(Function::Ln, base))?;
        let product = self.push(Operation::Multiply(exponent, logarithm))?;
        self.push(Operation::Of(Function::Exp, product))
    }

    fn atom(&mut self) -> Result<u32, ExpressionError> {
        match self.peek() {
            Some('(') => {
                self.at += 1;
                let value = self.sum()?;
                self.expect(')')?;
                Ok(value)
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() => self.named(),
            Some(c) => Err(self.error(format!("expected a number, a name or `(`, not `{c}`"))),
            None => Err(self.error("expected a number, a name or `(`, but the expression ends")),
        }
    }

    fn number(&mut self) -> Result<u32, ExpressionError> {
        let rest = &self.text[self.at..];
        let mut end = 0;
        let mut exponent = false;
        for (index, c) in rest.char_indices() {
            let sign_of_exponent =
                exponent && matches!(c, '+' | '-') && rest[..index].ends_with(['e', 'E']);
            if c.is_ascii_digit() || c == '.' || sign_of_exponent {
            } else if matches!(c, 'e' | 'E') && !exponent {
                exponent = true;
            } else {
                break;
            }
            end = index + 1;
        }
        match rest[..end].parse::<f64>() {
            Ok(value) if value.is_finite() => {
                self.at += end;
                self.push(Operation::Constant(value))
            }
            _ => Err(self.error(format!("`{}` is not a number", &rest[..end]))),
        }
    }

    fn named(&mut self) -> Result<u32, ExpressionError> {
        let rest = &self.text[self.at..];
        let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_');
        let name = &rest[..end.unwrap_or(rest.len())];
        if let Some(index) = self.variables.iter().position(|known| *known == name) {
            self.at += name.len();
            return self.push(Operation::Variable(index as u32));
        }
        if !NAMES.contains(&name) {
            return Err(ExpressionError {
                unknown: Some(name.to_owned()),
                ..self.error(format!("unknown name `{name}`"))
            });
        }
        self.at += name.len();
        if name == "pi" {
            return self.push(Operation::Constant(core::f64::consts::PI));
        }
        let place = self.at;
        self.expect('(')?;
        let mut given = vec![self.sum()?];
        while self.accept(',') {
            given.push(self.sum()?);
        }
        self.expect(')')?;
        let wanted = match name {
            "max" | "min" => 2,
            "noise" => 3,
            _ => 1,
        };
        if given.len() != wanted {
            self.at = place;
            let message = format!("`{name}` takes {wanted} arguments, not {}", given.len());
            return Err(self.error(message));
        }
        self.call(name, &given)
    }

    fn call(&mut self, name: &str, given: &[u32]) -> Result<u32, ExpressionError> {
        let a = given[0];
        let function = match name {
            "max" => return self.push(Operation::Max(a, given[1])),
            "noise" => return self.push(Operation::Noise([a, given[1], given[2]])),
            "abs" => {
                let negative = self.push(Operation::Negate(a))?;
                return self.push(Operation::Max(a, negative));
            }
            "min" => {
                let [a, b] = [a, given[1]].map(|x| self.push(Operation::Negate(x)));
                let greater = self.push(Operation::Max(a?, b?))?;
                return self.push(Operation::Negate(greater));
            }
            "tan" => {
                let sine = self.push(Operation::Of(Function::Sin, a))?;
                let cosine = self.push(Operation::Of(Function::Cos, a))?;
                return self.push(Operation::Divide(sine, cosine));
            }
            "atan" => Function::Atan,
            "cos" => Function::Cos,
            "exp" => Function::Exp,
            "ln" => Function::Ln,
            "sin" => Function::Sin,
            _ => Function::Sqrt,
        };
        self.push(Operation::Of(function, a))
    }
}
