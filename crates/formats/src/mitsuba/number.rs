//! Numbers as Mitsuba's scene language writes them.
//!
//! Lists are separated by spaces, commas, tabs or line breaks, in any mixture. Floats take an
//! optional sign, digits with an optional point and an optional exponent, with white space
//! around them and nothing else behind them. `nan` and `inf`, which Mitsuba lets through, are
//! refused here: no parameter means anything with them.

use etalon_math::Expression;
use etalon_math::expression::ExpressionError;
use std::ops::Range;

/// Why a text is not a number that a scene can use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NotANumber {
    /// It does not have the form of a number.
    Malformed,
    /// It is `nan`, `inf` or too large for a double.
    NotFinite,
    /// An integer beyond 64 bits.
    TooLarge,
    /// A number beyond 32-bit floats, in which scenes are rendered.
    Beyond,
}

impl NotANumber {
    /// The mistake in `text`, as a sentence; `wanted` is `a number` or the like.
    pub(crate) fn message(self, text: &str, wanted: &str) -> String {
        let text = excerpt(text);
        match self {
            Self::Malformed => format!("`{text}` is not {wanted}"),
            Self::NotFinite => format!("`{text}` is not a finite number"),
            Self::TooLarge => format!("`{text}` does not fit into 64 bits"),
            Self::Beyond => format!("`{text}` is more than a 32-bit float can hold (3.4e38)"),
        }
    }
}

/// At most 60 characters of a text, so that a message stays one line.
pub(crate) fn excerpt(text: &str) -> String {
    let mut short: String = text.chars().take(60).collect();
    if short.len() < text.len() {
        short.push('…');
    }
    short.replace(['\n', '\r', '\t'], " ")
}

/// A float that is finite as one of 32 bits, too.
pub(crate) fn float(text: &str) -> Result<f64, NotANumber> {
    let text = text.trim();
    match text.parse::<f64>() {
        Ok(x) if (x as f32).is_finite() => Ok(x),
        Ok(x) if x.is_finite() => Err(NotANumber::Beyond),
        Ok(_) => Err(NotANumber::NotFinite),
        Err(_) => Err(NotANumber::Malformed),
    }
}

/// Whether a text that is no number may be meant for an expression: it has an operator, a parenthesis or a name of one.
pub(crate) fn is_computed(text: &str) -> bool {
    let has_operator = text
        .trim_start()
        .trim_start_matches(['-', '+'])
        .contains(['+', '-', '*', '/', '^', '(', ')']);
    has_operator || Expression::names().any(|name| text.trim() == name)
}

/// A number by an expression of constants, such as `2*pi`.
pub(crate) fn computed(text: &str) -> Result<f64, ExpressionError> {
    let value = Expression::parse(text, &[])?.eval::<f64>(&[]);
    if (value as f32).is_finite() {
        return Ok(value);
    }
    Err(ExpressionError {
        character: 1,
        message: format!("`{}` is {value}, not a finite number", excerpt(text.trim())),
        unknown: None,
    })
}

/// A 64-bit integer without anything behind it.
pub(crate) fn integer(text: &str) -> Result<i64, NotANumber> {
    use std::num::IntErrorKind::{NegOverflow, PosOverflow};
    text.trim()
        .parse::<i64>()
        .map_err(|error| match error.kind() {
            PosOverflow | NegOverflow => NotANumber::TooLarge,
            _ => NotANumber::Malformed,
        })
}

/// `true` or `false`, in any case.
pub(crate) fn boolean(text: &str) -> Option<bool> {
    if text.eq_ignore_ascii_case("true") {
        Some(true)
    } else if text.eq_ignore_ascii_case("false") {
        Some(false)
    } else {
        None
    }
}

/// The parts of a list with their byte ranges in `text`; empty parts are skipped.
pub(crate) fn tokens(text: &str) -> impl Iterator<Item = (Range<usize>, &str)> {
    let separator = |c: char| c == ',' || c.is_whitespace();
    let base = text.as_ptr() as usize;
    text.split(separator)
        .filter(|part| !part.is_empty())
        .map(move |part| {
            let start = part.as_ptr() as usize - base;
            (start..start + part.len(), part)
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floats_are_accepted_as_mitsuba_accepts_them() {
        // Each verified with Mitsuba 3.9.1's parser.
        let good = [
            ("1", 1.0),
            ("1.", 1.0),
            (".5", 0.5),
            ("+1", 1.0),
            ("-1", -1.0),
            ("1e3", 1e3),
            ("1E3", 1e3),
            (" 1 ", 1.0),
            ("1e-400", 0.0),
        ];
        for (text, value) in good {
            assert_eq!(float(text), Ok(value), "{text}");
        }
        for text in ["1e", "0x10", "1f", "1 2", "1,", "1_0", "1d", "", ".", "e5"] {
            assert_eq!(float(text), Err(NotANumber::Malformed), "{text}");
        }
        for text in ["inf", "nan", "-infinity", "1e400"] {
            assert_eq!(float(text), Err(NotANumber::NotFinite), "{text}");
        }
        assert_eq!(float("-1e39"), Err(NotANumber::Beyond));
        assert!(float("3.4e38").is_ok());
    }

    #[test]
    fn integers_and_booleans() {
        assert_eq!(integer(" -12 "), Ok(-12));
        assert_eq!(integer("1.0"), Err(NotANumber::Malformed));
        assert_eq!(integer("4x"), Err(NotANumber::Malformed));
        assert_eq!(integer("9223372036854775808"), Err(NotANumber::TooLarge));
        assert_eq!(boolean("TrUe"), Some(true));
        assert_eq!(boolean("FALSE"), Some(false));
        assert_eq!(boolean(" true"), None);
    }

    #[test]
    fn lists_take_any_mixture_of_separators() {
        let found: Vec<_> = tokens("0.1,,0.2,\t0.3\n4 ").collect();
        assert_eq!(
            found,
            [(0..3, "0.1"), (5..8, "0.2"), (10..13, "0.3"), (14..15, "4")]
        );
    }
}
