//! Files of spectra: pairs of a wavelength in nanometres and a value.
//!
//! pbrt takes every number of the file for half of a pair (`util/spectrum.cpp`, `PiecewiseLinearSpectrum::Read`); files with one pair on
//! a line, as all known ones are, mean the same in Mitsuba.

use crate::SearchPath;
use crate::document::SourceFile;
use etalon_params::{Diagnostic, Span};
use etalon_spectrum::parse_spd;
use std::sync::Arc;

/// The largest file that is taken for a spectrum.
const MOST_BYTES: u64 = 64 << 20;

/// Why a file could not be read, without the place that names it.
#[derive(Debug)]
pub(crate) struct SpectrumFileMistake {
    message: String,
    help: Option<String>,
}

impl SpectrumFileMistake {
    /// The mistake at the place that names the file.
    pub(crate) fn at(self, span: Span) -> Diagnostic {
        let mistake = Diagnostic::error(span, self.message);
        match self.help {
            Some(help) => mistake.help(help),
            None => mistake,
        }
    }
}

/// The samples in the file `name`.
pub(crate) fn read(
    search: &SearchPath,
    name: &str,
) -> Result<(Vec<[f64; 2]>, SourceFile), SpectrumFileMistake> {
    let plain = |message| SpectrumFileMistake {
        message,
        help: None,
    };
    let path = search.find(name).ok_or_else(|| SpectrumFileMistake {
        message: format!("there is no spectrum `{name}`, and no file of that name"),
        help: Some(search.why_not(name)),
    })?;
    let bytes = crate::read_bounded(&path, MOST_BYTES)
        .map_err(|reason| plain(format!("cannot read `{name}`: {reason}")))?;
    let table = parse_spd(&String::from_utf8_lossy(&bytes))
        .map_err(|(line, why)| plain(format!("`{name}`, line {line}: {why}")))?;
    let pairs = table.wavelengths.into_iter().zip(table.values);
    let samples: Vec<[f64; 2]> = pairs.map(|(nm, value)| [nm, value]).collect();
    if samples
        .iter()
        .any(|[_, value]| !(*value as f32).is_finite())
    {
        let message = format!("a value of `{name}` is more than a 32-bit float can hold (3.4e38)");
        return Err(plain(message));
    }
    let bytes = Arc::new(bytes);
    Ok((samples, SourceFile { path, bytes }))
}
