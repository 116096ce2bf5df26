//! The file that a plugin is read from.

use crate::{AssetError, Build};
use etalon_params::{Diagnostic, Params, Span};

/// The source position of a plugin's file name.
pub fn span_of_filename(params: &Params<'_>) -> Span {
    params
        .property("filename")
        .map_or(params.node.plugin.span, |p| p.span)
}

/// Records why a file cannot be had.
pub fn report(params: &Params<'_>, error: AssetError) {
    let mut diagnostic = Diagnostic::error(span_of_filename(params), error.message);
    diagnostic.help = error.help;
    params.diagnostics.push(diagnostic);
}

/// Reads `filename`, which is needed and holds `what`, and makes something of its bytes; `None` after a mistake.
pub fn read<T>(
    params: &Params<'_>,
    build: &mut dyn Build,
    what: &str,
    decode: impl FnOnce(&[u8]) -> Result<T, String>,
) -> Option<T> {
    if !params.has("filename") {
        params.missing("filename", what);
    }
    let filename = params.string("filename")?;
    let read = build.assets().bytes(filename).and_then(|bytes| {
        decode(&bytes).map_err(|reason| AssetError {
            message: format!("`{filename}` cannot be used: {reason}"),
            help: None,
        })
    });
    read.map_err(|error| report(params, error)).ok()
}

/// Whether Mitsuba 0.6's `gamma` says that the values are linear: 1 does; 0 and below leave it to
/// the file, and so does 2.2, which is close to what files of integers hold.
pub fn is_linear(params: &Params<'_>) -> bool {
    let accepted = "1 (linear), 2.2 or -1 (as the file's format says)";
    let gamma = params.float_where("gamma", -1.0, accepted, |gamma| {
        gamma <= 0.0 || gamma == 1.0 || gamma == 2.2
    });
    if gamma == 2.2 {
        params.diagnostics.push(Diagnostic::note(
            params
                .property("gamma")
                .map_or(params.node.plugin.span, |p| p.span),
            "a `gamma` of 2.2 is read as sRGB, which is close to it",
        ));
    }
    gamma == 1.0
}
