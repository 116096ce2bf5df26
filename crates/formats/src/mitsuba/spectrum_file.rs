//! `<spectrum filename="…">`: tabulated spectra in files of their own.

use super::attribute::Attributes;
use super::reader::{File, Reader};
use crate::document::SourceFile;
use etalon_params::{Diagnostic, Span, SpectrumText};
use etalon_spectrum::spd::line_range;
use etalon_spectrum::{SpdTable, parse_spb, parse_spd};
use std::sync::Arc;

/// The largest file that is taken for a spectrum.
const MOST_BYTES: u64 = 64 << 20;

/// Reads the file that the attribute `filename` names.
pub(crate) fn read(
    reader: &mut Reader<'_>,
    file: &File,
    attributes: &Attributes<'_>,
) -> Option<SpectrumText> {
    let attribute = attributes.required("filename");
    let name = attribute.text.as_ref();
    let Some(path) = file.search.find(name) else {
        reader.report(
            attribute
                .error_whole(format!("the file `{name}` was not found"))
                .help(file.search.why_not(name)),
        );
        return None;
    };
    let bytes = match crate::read_bounded(&path, MOST_BYTES) {
        Ok(bytes) => bytes,
        Err(reason) => {
            reader.report(attribute.error_whole(format!("cannot read `{name}`: {reason}")));
            return None;
        }
    };
    let is_binary = path
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("spb"));
    let text = String::from_utf8_lossy(&bytes);
    let mut at_line = |line| {
        let file = reader.sources.add(path.to_string_lossy(), text.as_ref());
        let range = line_range(&text, line);
        Span {
            file,
            start: range.start as u32,
            end: range.end as u32,
        }
    };
    let parsed = if is_binary {
        parse_spb(&bytes).map_err(|(offset, message)| {
            attribute.error_whole(format!("`{name}`, byte {offset}: {message}"))
        })
    } else {
        parse_spd(&text).map_err(|(line, message)| {
            Diagnostic::error(at_line(line), message)
                .related(attribute.span, "the file is named here")
        })
    };
    if let Ok(SpdTable {
        header: Some(line), ..
    }) = parsed
    {
        let message = "this line holds no number: it is taken for a header";
        let note = Diagnostic::note(at_line(line), message);
        reader.report(note.related(attribute.span, "the file is named here"));
    }
    reader.files.push(SourceFile {
        path,
        bytes: Arc::new(bytes),
    });
    match parsed {
        Ok(SpdTable { values, .. }) if values.iter().any(|value| !(*value as f32).is_finite()) => {
            let message =
                format!("a value of `{name}` is more than a 32-bit float can hold (3.4e38)");
            reader.report(attribute.error_whole(message));
            None
        }
        Ok(table) => Some(SpectrumText::Samples(
            table.wavelengths.into_iter().zip(table.values).collect(),
        )),
        Err(diagnostic) => {
            reader.report(diagnostic);
            None
        }
    }
}
