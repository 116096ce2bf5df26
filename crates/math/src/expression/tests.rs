//! Expressions against plain arithmetic, their errors, and that intervals enclose.

use super::*;
use proptest::prelude::*;

fn value(text: &str, at: [f64; 3]) -> f64 {
    let expression = Expression::parse(text, &["x", "y", "z"]);
    expression
        .unwrap_or_else(|e| panic!("{text}: {e:?}"))
        .eval(&at)
}

#[test]
fn expressions_mean_what_they_say() {
    let at = [0.5, -2.0, 3.0];
    for (text, expected) in [
        ("1 + 2 * x", 2.0),
        ("-x^2", -0.25),
        ("2^-1 + x", 1.0),
        ("x^y", 4.0),
        ("8^(1/3)", 2.0),
        ("(x - 1) * (x - 1)", 0.25),
        ("min(x, y) + max(x, abs(y))", 0.0),
        ("sqrt(x * x + y * y + z * z) ", 13.25_f64.sqrt()),
        ("tan(pi / 4) + exp(0) - ln(1)", 2.0),
        ("1.5e1 / z", 5.0),
        ("atan(1) * 4 - pi", 0.0),
        ("noise(1, 2, 3)", 0.0),
        ("1 - 2 - 3", -4.0),
        ("x", 0.5),
    ] {
        let found = value(text, at);
        assert!((found - expected).abs() < 1e-12, "{text} {found}");
    }
}

#[test]
fn mistakes_are_placed() {
    for (text, character, words) in [
        ("x + ", 5, "ends"),
        ("x + sine(y)", 5, "unknown name `sine`"),
        ("max(x)", 4, "takes 2 arguments, not 1"),
        ("(x", 3, "expected `)`"),
        ("x y", 3, "expected an operator"),
        ("1.2.3", 1, "not a number"),
        ("x + $", 5, "not `$`"),
        ("", 1, "ends"),
        (&"(".repeat(100), 65, "deep"),
        (&"-".repeat(100), 65, "deep"),
    ] {
        let error = Expression::parse(text, &["x", "y"]).expect_err(text);
        assert_eq!(error.character, character, "{text}: {error:?}");
        assert!(error.message.contains(words), "{text}: {error:?}");
    }
    let long: String = (0..300).map(|i| format!("+x*{i}.5")).collect();
    let error = Expression::parse(&format!("0{long}"), &["x"]).expect_err("too long");
    assert!(error.message.contains("256"), "{error:?}");
}

/// A piece in which an expression is defined nowhere has no values, and so no zero; the quotient by nothing has a sign.
#[test]
fn what_is_undefined_everywhere_has_no_zero() {
    let enclosed = |text: &str, low: f64, high: f64| {
        let expression = Expression::parse(text, &["x"]).expect("valid");
        expression.eval(&[Interval { low, high }])
    };
    for text in [
        "sqrt(x)",
        "x^1.5 - 1",
        "ln(x)",
        "2 * sqrt(x) + x / ln(x)",
        "max(x, sin(sqrt(x)))",
        "exp(sqrt(x))^-2",
        "abs(sqrt(x)) - 1",
    ] {
        assert!(enclosed(text, -2.0, -1.0).is_none(), "{text}");
        assert!(!enclosed(text, -2.0, 1.0).is_none(), "{text}");
        assert!(value(text, [-1.5, 0.0, 0.0]).is_nan(), "{text}");
    }
    // As of numbers, what is no number is not the greater.
    assert_eq!(
        enclosed("max(sqrt(x), x)", -2.0, -1.0),
        Interval {
            low: -2.0,
            high: -1.0
        }
    );
    assert!(enclosed("x / 0", -2.0, -1.0).high < 0.0 && enclosed("x / 0", 1.0, 2.0).low > 0.0);
    assert!(enclosed("x / 0", -1.0, 1.0).has_zero());
}

const SAMPLES: &[&str] = &[
    "x^2 + y^2 + z^2 - 1",
    "x^3 - 3*x*y^2 + z",
    "sin(3*x) * cos(y) + cos(9*z*x)",
    "exp(-x*x) / (1 + y^2) - z^-2",
    "sqrt(x^2 + y^2) * ln(2 + z^4)",
    "max(min(x, y), abs(z) - 0.5)",
    "noise(2*x, 2*y, 2*z) + 0.2 * atan(y*z)",
    "x^5 / (z - 0.3) + tan(y)",
    "(x*x + 0.1)^1.7",
    "max(sqrt(x), y) - x^1.5",
    "sqrt(z) + min(z, ln(y))",
];

proptest! {
    /// Along any piece of a line, values and slopes lie in the intervals.
    #[test]
    fn intervals_enclose(
        origin in prop::array::uniform3(-3.0..3.0f64),
        direction in prop::array::uniform3(-1.0..1.0f64),
        length in -6.0..0.5f64,
        inside in 0.0..1.0f64,
        which in 0..SAMPLES.len(),
    ) {
        let expression = Expression::parse(SAMPLES[which], &["x", "y", "z"]).expect("valid");
        let length = crate::float64::exp(length * 2.0);
        let piece = Interval { low: 0.0, high: length };
        let along: [Dual<Interval>; 3] = core::array::from_fn(|i| {
            let d = Interval::constant(direction[i]);
            Dual { value: Interval::constant(origin[i]).add(piece.mul(d)), slope: d }
        });
        let enclosed = expression.eval(&along);
        let t = length * inside;
        let at: [Dual<f64>; 3] = core::array::from_fn(|i| Dual {
            value: origin[i] + t * direction[i],
            slope: direction[i],
        });
        let found = expression.eval(&at);
        let holds = |interval: Interval, value: f64| {
            !value.is_finite() || {
                // The value itself is rounded.
                let off = 1e-9 * value.abs() + 1e-12;
                interval.low <= value + off && value - off <= interval.high
            }
        };
        prop_assert!(holds(enclosed.value, found.value), "{} {enclosed:?} {found:?}", SAMPLES[which]);
        prop_assert!(holds(enclosed.slope, found.slope), "{} {enclosed:?} {found:?}", SAMPLES[which]);
    }

    /// Slopes are those of the values.
    #[test]
    fn slopes_are_differences(at in prop::array::uniform3(0.2..2.0f64), which in 0..SAMPLES.len()) {
        let expression = Expression::parse(SAMPLES[which], &["x", "y", "z"]).expect("valid");
        let dual = expression.eval(&[
            Dual { value: at[0], slope: 1.0 },
            Dual { value: at[1], slope: 0.0 },
            Dual { value: at[2], slope: 0.0 },
        ]);
        let h = 1e-6;
        let shifted = |h: f64| expression.eval(&[at[0] + h, at[1], at[2]]);
        let slope = (shifted(h) - shifted(-h)) / (2.0 * h);
        // A kink lies between, or a pole near by.
        let kink = (shifted(h) - 2.0 * dual.value + shifted(-h)).abs() > 1e-9 * (1.0 + dual.value.abs());
        prop_assert!(kink || (slope - dual.slope).abs() < 1e-3 * (1.0 + slope.abs()));
    }
}
