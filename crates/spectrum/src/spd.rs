//! Spectra in text files, by custom named `.spd`.
//!
//! Mitsuba 3.9 reads every spectrum file as this text, also one named `.spb`.

use crate::{LAMBDA_MAX, LAMBDA_MIN};
use std::ops::Range;

/// The contents of a spectrum file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SpdTable {
    /// Ascending wavelengths (nm).
    pub wavelengths: Vec<f64>,
    /// As many values.
    pub values: Vec<f64>,
    /// The line that was taken for a header, from 1.
    pub header: Option<usize>,
}

/// Reads `.spd` text: on each line a wavelength in nanometres and a value, separated by white space
/// or a comma; `#` begins a comment; empty lines are skipped, and so is a first line without any
/// number. The wavelengths all ascend or all descend.
///
/// # Errors
/// The number of the offending line, from 1, and what is wrong with it.
pub fn parse_spd(text: &str) -> Result<SpdTable, (usize, String)> {
    let mut table = SpdTable::default();
    let mut last_line = 1;
    for (index, line) in text.split(line_end(text)).enumerate() {
        let number = index + 1;
        let content = line.trim_start_matches('\u{feff}');
        let content = content.split('#').next().unwrap_or_default();
        let words = || {
            let words = content.split(|c: char| c.is_whitespace() || c == ',');
            words.filter(|w| !w.is_empty())
        };
        let is_first = table.wavelengths.is_empty() && table.header.is_none();
        if is_first && words().next().is_some() && words().all(|w| w.parse::<f64>().is_err()) {
            table.header = Some(number);
            continue;
        }
        let mut words = words();
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
        push(&mut table, parse(first), parse(second)).map_err(|m| (number, m))?;
        last_line = number;
    }
    check_count(&table).map_err(|m| (last_line, m))?;
    if table.wavelengths[0] > table.wavelengths[1] {
        table.wavelengths.reverse();
        table.values.reverse();
    }
    check_unit(&table.wavelengths).map_err(|m| (last_line, m))?;
    Ok(table)
}

/// The line terminator: files of old Macintoshes have no line feed.
fn line_end(text: &str) -> char {
    if text.contains('\n') { '\n' } else { '\r' }
}

/// The bytes of a line of `text`, counted from 1, without its end.
pub fn line_range(text: &str, line: usize) -> Range<usize> {
    let mut start = 0;
    for (index, content) in text.split(line_end(text)).enumerate() {
        if index + 1 == line {
            return start..start + content.trim_end().len();
        }
        start += content.len() + 1;
    }
    text.len()..text.len()
}

/// Checks that ascending wavelengths are plausible in nanometres: a table without any visible wavelength is in another unit,
/// or useless.
///
/// # Errors
/// What is wrong with them, and the unit that they seem to be given in.
pub fn check_unit(wavelengths: &[f64]) -> Result<(), String> {
    let (&[first, ..], &[.., last]) = (wavelengths, wavelengths) else {
        return Ok(());
    };
    if last >= LAMBDA_MIN && first <= LAMBDA_MAX {
        return Ok(());
    }
    let sees =
        |nanometres: f64| last * nanometres >= LAMBDA_MIN && first * nanometres <= LAMBDA_MAX;
    let units = [("ångström", 0.1), ("micrometres", 1e3), ("metres", 1e9)];
    let unit = units.into_iter().find(|(_, nanometres)| sees(*nanometres));
    Err(format!(
        "the wavelengths go from {first} to {last} nm, none of which is visible ({LAMBDA_MIN} to \
         {LAMBDA_MAX} nm): they must be given in nanometres{}",
        unit.map_or_else(String::new, |(name, _)| format!(", not in {name}"))
    ))
}

/// Reads a file named `.spb`: the text of [`parse_spd`], as UTF-8.
///
/// # Errors
/// The offset of the first byte that is no text or of the offending line, and what is wrong there.
pub fn parse_spb(bytes: &[u8]) -> Result<SpdTable, (usize, String)> {
    let text = std::str::from_utf8(bytes).map_err(|e| {
        (
            e.valid_up_to(),
            "not text: expected a wavelength in nm and a value on each line".to_owned(),
        )
    })?;
    parse_spd(text).map_err(|(line, message)| (line_range(text, line).start, message))
}

/// A number, or what is wrong with `word`.
fn parse(word: &str) -> Result<f64, String> {
    match word.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(format!("\"{word}\" is not finite")),
        Err(_) => Err(format!("\"{word}\" is not a number")),
    }
}

/// Appends one sample if its wavelength continues the order of those before.
fn push(
    table: &mut SpdTable,
    wavelength: Result<f64, String>,
    value: Result<f64, String>,
) -> Result<(), String> {
    let wavelength = wavelength?;
    if !(wavelength > 0.0) {
        return Err(format!("the wavelength {wavelength} nm is not above 0"));
    }
    let follows = match table.wavelengths[..] {
        [] => true,
        [previous] => wavelength != previous,
        [first, second, ..] => {
            let previous = table.wavelengths[table.wavelengths.len() - 1];
            wavelength != previous && (wavelength > previous) == (second > first)
        }
    };
    if !follows {
        let previous = table.wavelengths[table.wavelengths.len() - 1];
        return Err(format!(
            "the wavelength {wavelength} nm does not follow {previous} nm: expected wavelengths that \
             all increase or all decrease"
        ));
    }
    table.wavelengths.push(wavelength);
    table.values.push(value?);
    Ok(())
}

/// Refuses spectra that cannot be interpolated.
fn check_count(table: &SpdTable) -> Result<(), String> {
    match table.wavelengths.len() {
        0 | 1 => Err("expected two or more wavelengths".to_owned()),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn table(wavelengths: &[f64], values: &[f64]) -> SpdTable {
        SpdTable {
            wavelengths: wavelengths.to_vec(),
            values: values.to_vec(),
            header: None,
        }
    }

    #[test]
    fn text_as_found_in_the_wild_is_read() {
        let text = "# head\n\n 400\t0.25 # first\r\n500.5, 1e-1\n+600 -2\n";
        let expected = table(&[400.0, 500.5, 600.0], &[0.25, 0.1, -2.0]);
        assert_eq!(parse_spd(text), Ok(expected.clone()));
        let same = |text: &str| {
            assert_eq!(parse_spd(text), Ok(expected.clone()), "{text:?}");
        };
        same("\u{feff}400 0.25\n500.5 0.1\n600 -2\n");
        same("400 0.25\r500.5 0.1\r600 -2\r");
        same("\u{feff}# head\r600 -2\r500.5 0.1\r400 0.25");
        for (text, line) in [
            ("wavelength (nm), n\n400 0.25\n500.5 0.1\n600 -2\n", 1),
            (
                "\u{feff}# head\n\"wl\" \"value\"\r\n600 -2\n500.5 0.1\n400 0.25",
                2,
            ),
        ] {
            let headed = SpdTable {
                header: Some(line),
                ..expected.clone()
            };
            assert_eq!(parse_spd(text), Ok(headed), "{text:?}");
        }
    }

    #[test]
    fn only_tables_of_what_is_visible_are_in_nanometres() {
        for (wavelengths, unit) in [
            ([4000.0, 7000.0], "ångström"),
            ([3600.0, 10_000.0], "ångström"),
            ([0.4, 0.7], "micrometres"),
            ([4e-7, 7e-7], "metres"),
            ([100.0, 300.0], "must be given in nanometres"),
            ([1000.0, 2000.0], "must be given in nanometres"),
        ] {
            let message = check_unit(&wavelengths).expect_err(unit);
            assert!(message.ends_with(unit), "{message}");
        }
        for seen in [
            [100.0, 360.0],
            [830.0, 4000.0],
            [200.0, 7000.0],
            [500.0, 501.0],
        ] {
            assert_eq!(check_unit(&seen), Ok(()), "{seen:?}");
        }
    }

    #[test]
    fn mistakes_are_named_with_their_line() {
        for (text, line, part) in [
            ("400 1\n500\n", 2, "stands alone"),
            ("400 1\n#\n500 1 2\n", 3, "\"2\""),
            ("400 1\nx 2\n", 2, "\"x\""),
            ("400 1\n500 inf\n", 2, "not finite"),
            ("400 nan\n", 1, "not finite"),
            ("400 1\n400 2\n", 2, "all increase"),
            ("500 1\n400 2\n450 2\n", 3, "all increase"),
            ("400 1\n500 2\n500 2\n", 3, "all increase"),
            ("nm value\nnm value\n400 2\n", 2, "\"nm\""),
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
        let expected = table(&[400.0, 500.0], &[1.0, 2.0]);
        assert_eq!(parse_spb(b"400 1\n500 2\n"), Ok(expected));
        assert_eq!(parse_spb(b"400 1\r\nx 2\n").map_err(|e| e.0), Err(7));
        assert_eq!(parse_spb(b"400 1\rx 2\r").map_err(|e| e.0), Err(6));
        assert_eq!(parse_spb(b"400 1\n\xff").map_err(|e| e.0), Err(6));
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 256, failure_persistence: None,
            rng_seed: proptest::test_runner::RngSeed::Fixed(2), ..ProptestConfig::default() })]

        #[test]
        fn no_text_panics(text in "[ -~\\n\\t#,.eE0-9+-]{0,80}") {
            let lines = text.split('\n').count();
            match parse_spd(&text) {
                Ok(table) => prop_assert_eq!(table.wavelengths.len(), table.values.len()),
                Err((line, _)) => prop_assert!((1..=lines).contains(&line)),
            }
        }

        #[test]
        fn what_is_printed_is_read_back(start in 361.0_f64..770.0, steps in proptest::collection::vec((0.01_f64..50.0, -1e3_f64..1e3), 2..20)) {
            let mut wavelength = start;
            let mut expected = SpdTable::default();
            let mut text = String::new();
            for (step, value) in steps {
                wavelength += step;
                expected.wavelengths.push(wavelength);
                expected.values.push(value);
                text += &format!("{wavelength} {value}\n");
            }
            prop_assert_eq!(parse_spd(&text), Ok(expected));
        }
    }
}
