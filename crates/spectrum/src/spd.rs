//! Spectra in text files, by custom named `.spd`.
//!
//! Mitsuba 3.9 reads every spectrum file as this text whatever its name, `.spb` included.

/// Wavelengths (nm) and values, of equal length.
pub type Samples = (Vec<f64>, Vec<f64>);

/// Reads `.spd` text: on each line a wavelength in nanometres and a value, separated by white space
/// or a comma; `#` begins a comment; empty lines are skipped.
///
/// # Errors
/// The number of the offending line, from 1, and what is wrong with it.
pub fn parse_spd(text: &str) -> Result<Samples, (usize, String)> {
    let mut samples = (Vec::new(), Vec::new());
    let mut last_line = 1;
    for (index, line) in text.lines().enumerate() {
        let number = index + 1;
        let content = line.split('#').next().unwrap_or_default();
        let mut words = content
            .split(|c: char| c.is_whitespace() || c == ',')
            .filter(|w| !w.is_empty());
        let Some(first) = words.next() else { continue };
        let Some(second) = words.next() else {
            return Err((
                number,
                format!("\"{first}\" stands alone: expected a wavelength in nm and a value"),
            ));
        };
        if let Some(third) = words.next() {
            return Err((
                number,
                format!(
                    "\"{third}\" is one number too many: expected a wavelength in nm and a value"
                ),
            ));
        }
        push(&mut samples, parse(first), parse(second)).map_err(|m| (number, m))?;
        last_line = number;
    }
    check_count(&samples).map_err(|m| (last_line, m))?;
    check_unit(&samples.0).map_err(|m| (last_line, m))?;
    Ok(samples)
}

/// Whether ascending wavelengths can be meant in nanometres: a table that ends below 100 nm is
/// zero wherever there is light, and one that ends between 0.1 and 100 is given in micrometres.
///
/// # Errors
/// What is wrong with the last of them.
pub fn check_unit(wavelengths: &[f64]) -> Result<(), String> {
    match wavelengths.last() {
        Some(&last) if last < 100.0 => Err(format!(
            "the wavelengths end at {last} nm, where nothing is visible: they must be given in \
             nanometres{}",
            if last >= 0.1 {
                ", not in micrometres"
            } else {
                ""
            }
        )),
        _ => Ok(()),
    }
}

/// Reads a file named `.spb`: the text of [`parse_spd`], as UTF-8.
///
/// # Errors
/// The offset of the first byte that is no text or of the offending line, and what is wrong there.
pub fn parse_spb(bytes: &[u8]) -> Result<Samples, (usize, String)> {
    let text = std::str::from_utf8(bytes).map_err(|e| {
        (
            e.valid_up_to(),
            "not text: expected a wavelength in nm and a value on each line".to_owned(),
        )
    })?;
    parse_spd(text).map_err(|(line, message)| {
        let before = text.split_inclusive('\n').take(line - 1);
        (before.map(str::len).sum(), message)
    })
}

/// A number, or what is wrong with `word`.
fn parse(word: &str) -> Result<f64, String> {
    match word.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(format!("\"{word}\" is not finite")),
        Err(_) => Err(format!("\"{word}\" is not a number")),
    }
}

/// Appends one sample if its wavelength is above the last.
fn push(
    samples: &mut Samples,
    wavelength: Result<f64, String>,
    value: Result<f64, String>,
) -> Result<(), String> {
    let wavelength = wavelength?;
    if !(wavelength > 0.0) {
        return Err(format!("the wavelength {wavelength} nm is not above 0"));
    }
    if let Some(&previous) = samples.0.last()
        && wavelength <= previous
    {
        return Err(format!(
            "the wavelength {wavelength} nm does not follow {previous} nm: expected increasing wavelengths"
        ));
    }
    samples.0.push(wavelength);
    samples.1.push(value?);
    Ok(())
}

/// Refuses spectra that cannot be interpolated.
fn check_count(samples: &Samples) -> Result<(), String> {
    match samples.0.len() {
        0 | 1 => Err("expected two or more wavelengths".to_owned()),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn text_as_found_in_the_wild_is_read() {
        let text = "# head\n\n 400\t0.25 # first\r\n500.5, 1e-1\n+600 -2\n";
        let expected = (vec![400.0, 500.5, 600.0], vec![0.25, 0.1, -2.0]);
        assert_eq!(parse_spd(text), Ok(expected));
    }

    #[test]
    fn mistakes_are_named_with_their_line() {
        for (text, line, part) in [
            ("400 1\n500\n", 2, "stands alone"),
            ("400 1\n#\n500 1 2\n", 3, "\"2\""),
            ("400 1\nx 2\n", 2, "\"x\""),
            ("400 1\n500 inf\n", 2, "not finite"),
            ("400 nan\n", 1, "not finite"),
            ("400 1\n400 2\n", 2, "increasing"),
            ("500 1\n400 2\n", 2, "increasing"),
            ("0 1\n400 2\n", 1, "above 0"),
            ("400 1\n", 1, "two or more"),
            ("", 1, "two or more"),
        ] {
            let (found, message) = parse_spd(text).expect_err(text);
            assert_eq!(found, line, "{text:?}: {message}");
            assert!(message.contains(part), "{text:?}: {message}");
        }
    }

    #[test]
    fn spb_is_text_with_byte_offsets() {
        let expected = (vec![400.0, 500.0], vec![1.0, 2.0]);
        assert_eq!(parse_spb(b"400 1\n500 2\n"), Ok(expected));
        assert_eq!(parse_spb(b"400 1\r\nx 2\n").map_err(|e| e.0), Err(7));
        assert_eq!(parse_spb(b"400 1\n\xff").map_err(|e| e.0), Err(6));
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 256, failure_persistence: None,
            rng_seed: proptest::test_runner::RngSeed::Fixed(2), ..ProptestConfig::default() })]

        #[test]
        fn no_text_panics(text in "[ -~\\n\\t#,.eE0-9+-]{0,80}") {
            let lines = text.lines().count().max(1);
            match parse_spd(&text) {
                Ok((wavelengths, values)) => prop_assert_eq!(wavelengths.len(), values.len()),
                Err((line, _)) => prop_assert!((1..=lines).contains(&line)),
            }
        }

        #[test]
        fn what_is_printed_is_read_back(start in 100.0_f64..500.0, steps in proptest::collection::vec((0.01_f64..50.0, -1e3_f64..1e3), 2..20)) {
            let mut wavelength = start;
            let mut expected = (Vec::new(), Vec::new());
            let mut text = String::new();
            for (step, value) in steps {
                wavelength += step;
                expected.0.push(wavelength);
                expected.1.push(value);
                text += &format!("{wavelength} {value}\n");
            }
            prop_assert_eq!(parse_spd(&text), Ok(expected));
        }
    }
}
