//! `<spectrum filename="…">`: tabulated spectra in files of their own.

use super::SourceFile;
use super::attribute::Attributes;
use super::reader::{File, Reader};
use etalon_params::{Diagnostic, Span, SpectrumText};
use etalon_spectrum::{parse_spb, parse_spd};
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
    let parsed = if is_binary {
        parse_spb(&bytes).map_err(|(offset, message)| {
            attribute.error_whole(format!("`{name}`, byte {offset}: {message}"))
        })
    } else {
        let text = String::from_utf8_lossy(&bytes);
        parse_spd(&text).map_err(|(line, message)| {
            let id = reader.sources.add(path.to_string_lossy(), text.as_ref());
            let (start, end) = line_range(&text, line);
            Diagnostic::error(
                Span {
                    file: id,
                    start,
                    end,
                },
                message,
            )
            .related(attribute.span, "the file is named here")
        })
    };
    reader.files.push(SourceFile {
        path,
        bytes: Arc::new(bytes),
    });
    match parsed {
        Ok((_, values)) if values.iter().any(|value| !(*value as f32).is_finite()) => {
            let message =
                format!("a value of `{name}` is more than a 32-bit float can hold (3.4e38)");
            reader.report(attribute.error_whole(message));
            None
        }
        Ok((wavelengths, values)) => Some(SpectrumText::Samples(
            wavelengths.into_iter().zip(values).collect(),
        )),
        Err(diagnostic) => {
            reader.report(diagnostic);
            None
        }
    }
}

/// The bytes of a line, counted from 1.
fn line_range(text: &str, line: usize) -> (u32, u32) {
    let mut start = 0;
    for (number, content) in text.split('\n').enumerate() {
        if number + 1 == line {
            return (start as u32, (start + content.trim_end().len()) as u32);
        }
        start += content.len() + 1;
    }
    (text.len() as u32, text.len() as u32)
}
