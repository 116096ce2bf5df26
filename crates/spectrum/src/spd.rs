//! Spectra in files: `.spd` text and `.spb` binary, as Mitsuba 3 reads them.

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
    Ok(samples)
}

/// Reads `.spb` binary: the bytes "SPB", a little-endian 32-bit count n, n wavelengths in
/// nanometres and n values, each a little-endian 32-bit float.
///
/// # Errors
/// The offset of the offending byte and what is wrong there.
pub fn parse_spb(bytes: &[u8]) -> Result<Samples, (usize, String)> {
    let _ = bytes;
    Err((0, "not a binary spectrum".to_owned()))
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
