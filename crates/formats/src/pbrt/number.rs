//! Numbers, and why a word is none.
//!
//! Most of a large file are the numbers of its meshes, so they are read from the bytes without a token for each. A number
//! whose digits fit into 53 bits and whose power of ten is at most 10²² is exact in two steps of `f64`, each of which is exact or
//! rounds once (Clinger, "How to Read Floating Point Numbers Accurately", 1990); others are left to the standard library.
//!
//! pbrt takes hexadecimal numbers, too; they are refused here, as are numbers beyond 32-bit floats, in which scenes are rendered.

/// Powers of ten that are exact in `f64`.
const POWERS_OF_TEN: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// The most digits that are sure to fit into 64 bits.
const MOST_DIGITS: usize = 19;

/// The number at the start of `bytes`, with its length; finite as a 32-bit float.
pub(crate) fn float(bytes: &[u8]) -> Option<(f64, usize)> {
    let mut at = usize::from(matches!(bytes.first(), Some(b'-' | b'+')));
    let mut digits = 0;
    let mut mantissa = 0u64;
    let integral = take_digits(bytes, &mut at, &mut mantissa, &mut digits);
    let mut exponent = 0i64;
    let mut fractional = 0;
    if bytes.get(at) == Some(&b'.') {
        at += 1;
        fractional = take_digits(bytes, &mut at, &mut mantissa, &mut digits);
        exponent -= fractional as i64;
    }
    if integral + fractional == 0 {
        return None;
    }
    if let Some(b'e' | b'E') = bytes.get(at) {
        let (written, length) = exponent_of(&bytes[at + 1..])?;
        exponent += written;
        at += 1 + length;
    }
    let is_exact = digits <= MOST_DIGITS && mantissa < 1 << 53;
    let power = POWERS_OF_TEN.get(exponent.unsigned_abs() as usize);
    let value = match power {
        Some(power) if is_exact => {
            let digits = mantissa as f64;
            let size = if exponent < 0 {
                digits / power
            } else {
                digits * power
            };
            if bytes[0] == b'-' { -size } else { size }
        }
        _ => std::str::from_utf8(&bytes[..at]).ok()?.parse().ok()?,
    };
    (value as f32).is_finite().then_some((value, at))
}

/// Reads digits into `mantissa`, and says how many there were. `significant` counts those after the leading zeros.
fn take_digits(bytes: &[u8], at: &mut usize, mantissa: &mut u64, significant: &mut usize) -> usize {
    let start = *at;
    while let Some(digit) = bytes.get(*at).map(|byte| byte.wrapping_sub(b'0'))
        && digit < 10
    {
        // Beyond 19 digits this wraps, and is not used.
        *mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit));
        *significant += usize::from(*significant > 0 || digit > 0);
        *at += 1;
    }
    *at - start
}

/// The digits of an exponent and their length; a huge one is cut where it is infinite or zero anyhow.
fn exponent_of(bytes: &[u8]) -> Option<(i64, usize)> {
    let sign = usize::from(matches!(bytes.first(), Some(b'-' | b'+')));
    let digits = bytes[sign..].iter().take_while(|b| b.is_ascii_digit());
    let (value, length) = digits.fold((0i64, 0), |(value, length), digit| {
        let next = value * 10 + i64::from(digit - b'0');
        (next.min(1 << 40), length + 1)
    });
    let signed = if bytes.first() == Some(&b'-') {
        -value
    } else {
        value
    };
    (length > 0).then_some((signed, sign + length))
}

/// The 32-bit integer at the start of `bytes`, with its length.
pub(crate) fn integer(bytes: &[u8]) -> Option<(i32, usize)> {
    let sign = usize::from(matches!(bytes.first(), Some(b'-' | b'+')));
    let mut at = sign;
    let mut value = 0i64;
    while let Some(digit) = bytes.get(at).map(|byte| byte.wrapping_sub(b'0'))
        && digit < 10
    {
        value = (value * 10 + i64::from(digit)).min(1 << 40);
        at += 1;
    }
    if bytes.first() == Some(&b'-') {
        value = -value;
    }
    let value = i32::try_from(value).ok()?;
    (at > sign).then_some((value, at))
}

/// What is wrong with a word in place of a number, as a sentence.
pub(crate) fn not_a_float(word: &str) -> String {
    let shown = excerpt(word);
    let is_written_as_number = word.bytes().any(|byte| byte.is_ascii_digit())
        && word
            .bytes()
            .all(|byte| byte.is_ascii_digit() || b"+-.eE".contains(&byte));
    match word.parse::<f64>() {
        Ok(_) if is_written_as_number => {
            format!("`{shown}` is more than a 32-bit float can hold (3.4e38)")
        }
        Ok(_) => format!("`{shown}` is not a finite number"),
        Err(_) => format!("`{shown}` is not a number"),
    }
}

/// The same in place of an integer.
pub(crate) fn not_an_integer(word: &str) -> String {
    let shown = excerpt(word);
    let digits = word.strip_prefix(['-', '+']).unwrap_or(word);
    if !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit()) {
        format!("`{shown}` does not fit into 32 bits")
    } else {
        format!("`{shown}` is not an integer")
    }
}

/// At most 60 characters of a text, so that a message stays one line.
pub(crate) fn excerpt(text: &str) -> String {
    let mut short: String = text.chars().take(60).collect();
    if short.len() < text.len() {
        short.push('…');
    }
    short.replace(|c: char| c.is_control(), " ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn floats_as_pbrt_takes_them() {
        let good = [
            ("1", 1.0),
            ("1.", 1.0),
            (".5", 0.5),
            ("+1", 1.0),
            ("-0", -0.0),
            ("1e3", 1e3),
            ("1E-3", 1e-3),
            ("4.37114e-8", 4.37114e-8),
            ("0.1000000000000000055511151231257827", 0.1),
            (
                "123456789012345678901234567890",
                123456789012345678901234567890.0,
            ),
            ("1e-400", 0.0),
            ("0e999999999999999999999", 0.0),
        ];
        for (text, value) in good {
            assert_eq!(float(text.as_bytes()), Some((value, text.len())), "{text}");
        }
        for text in [
            "", "-", ".", "e5", "1e", "1e+", "inf", "nan", "x", "1e39", "-1e400",
        ] {
            assert_eq!(float(text.as_bytes()), None, "{text}");
        }
        assert_eq!(float(b"1 2"), Some((1.0, 1)));
        assert_eq!(
            float(b"0x10"),
            Some((0.0, 1)),
            "what follows is no part of it"
        );
    }

    #[test]
    fn integers_have_32_bits() {
        assert_eq!(integer(b"-2147483648 "), Some((i32::MIN, 11)));
        assert_eq!(integer(b"+7]"), Some((7, 2)));
        for text in ["", "-", "x", "2147483648", "99999999999999999999999"] {
            assert_eq!(integer(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn what_is_wrong_is_said() {
        assert_eq!(not_a_float("1,"), "`1,` is not a number");
        assert_eq!(not_a_float("inf"), "`inf` is not a finite number");
        let large = "`1e39` is more than a 32-bit float can hold (3.4e38)";
        assert_eq!(not_a_float("1e39"), large);
        assert_eq!(not_an_integer("1.5"), "`1.5` is not an integer");
        assert_eq!(
            not_an_integer("-3000000000"),
            "`-3000000000` does not fit into 32 bits"
        );
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            rng_seed: proptest::test_runner::RngSeed::Fixed(1),
            failure_persistence: None,
            ..ProptestConfig::default()
        })]

        /// The two steps give the bits of the standard library.
        #[test]
        fn floats_agree_with_the_standard_library(text in "[-+]?[0-9]{0,12}[.]?[0-9]{1,12}(e[-+]?[0-9]{1,2})?") {
            let expected: f64 = text.parse().expect("a number");
            let found = float(text.as_bytes());
            match (expected as f32).is_finite() {
                true => prop_assert_eq!(found.map(|(x, n)| (x.to_bits(), n)), Some((expected.to_bits(), text.len()))),
                false => prop_assert_eq!(found, None),
            }
        }
    }
}
