//! What reading a scene has in hand: sources, mistakes, parameters and the objects so far.

use super::draft::Draft;
use super::number::excerpt;
use super::substitute::{LONGEST_VALUE, MOST_INSERTED, Parameters, Substituted, Trouble};
use super::version::Version;
use crate::SearchPath;
use crate::document::{ReadOptions, SourceFile};
use etalon_params::{Diagnostic, FileId, Severity, Sources, Span};
use std::path::PathBuf;

/// After so many errors nothing more is read: the rest is seldom news.
const MOST_ERRORS: usize = 100;

/// How deep elements may nest.
pub(crate) const MOST_LEVELS: usize = 128;

/// How many XML files one scene may consist of.
pub(crate) const MOST_FILES: usize = 4096;

/// The state of reading one scene.
pub(crate) struct Reader<'o> {
    pub(crate) options: &'o ReadOptions,
    pub(crate) sources: Sources,
    pub(crate) diagnostics: Vec<Diagnostic>,
    pub(crate) parameters: Parameters,
    pub(crate) draft: Draft,
    pub(crate) files: Vec<SourceFile>,
    /// The files that are being read, outermost first, each with the `<include>` that led to it.
    pub(crate) chain: Vec<(PathBuf, Option<Span>)>,
    /// The folders of included files, searched last for what the scene refers to.
    pub(crate) included_folders: Vec<PathBuf>,
    /// Files of a version before 2.0.
    pub(crate) old_files: Vec<FileId>,
    /// The positions of harmless values that replace broken ones.
    pub(crate) stand_ins: Vec<Span>,
    errors: usize,
}

/// The file of an element.
pub(crate) struct File {
    pub(crate) id: FileId,
    pub(crate) version: Version,
    pub(crate) search: SearchPath,
}

impl<'o> Reader<'o> {
    pub(crate) fn new(options: &'o ReadOptions) -> Self {
        Self {
            options,
            sources: Sources::default(),
            diagnostics: Vec::new(),
            parameters: Parameters::new(&options.defines),
            draft: Draft::default(),
            files: Vec::new(),
            chain: Vec::new(),
            included_folders: Vec::new(),
            old_files: Vec::new(),
            stand_ins: Vec::new(),
            errors: 0,
        }
    }

    /// Records a message.
    pub(crate) fn report(&mut self, diagnostic: Diagnostic) {
        if self.is_full() {
            return;
        }
        if diagnostic.severity == Severity::Error {
            self.errors += 1;
        } else if self.diagnostics.len() > self.errors + MOST_ERRORS {
            return;
        }
        self.diagnostics.push(diagnostic);
        if self.is_full() {
            self.diagnostics.push(Diagnostic::error_nowhere(format!(
                "more than {MOST_ERRORS} mistakes; the rest of the scene was not looked at"
            )));
        }
    }

    /// Whether there were so many mistakes that reading should end.
    pub(crate) fn is_full(&self) -> bool {
        self.errors >= MOST_ERRORS
    }

    /// How many mistakes there were so far.
    pub(crate) fn mistakes(&self) -> usize {
        self.errors
    }

    /// Replaces `$name` in an attribute's value.
    pub(crate) fn substitute(
        &mut self,
        text: &str,
        span: Span,
        verbatim: bool,
    ) -> Option<Substituted> {
        let found = match self.parameters.substitute(text) {
            Ok(substituted) => return Some(substituted),
            Err(found) => found,
        };
        let name = &found.name;
        let place = if verbatim {
            let start = span.start + found.offset as u32;
            let end = start + 1 + name.len() as u32;
            Span { start, end, ..span }
        } else {
            span
        };
        let diagnostic = match found.trouble {
            Trouble::Broken => return None,
            Trouble::TooLong => Diagnostic::error(
                place,
                format!("with `${name}` this value would be longer than {LONGEST_VALUE} bytes"),
            )
            .help("values that contain each other's names double with every `<default>`"),
            Trouble::TooMuch => Diagnostic::error(
                place,
                format!(
                    "with `${name}` the parameters of this scene would stand for more than \
                     {MOST_INSERTED} bytes"
                ),
            )
            .help("values that contain each other's names double with every `<default>`"),
            Trouble::Undefined if name.is_empty() => {
                Diagnostic::error(place, format!("`$` without a name in `{}`", excerpt(text)))
                    .help(r"a dollar sign itself is written `\$`")
            }
            Trouble::Undefined => {
                let near = etalon_params::suggest::nearest(name, self.parameters.names());
                let help = match near {
                    Some(near) => format!("did you mean `${near}`?"),
                    None => {
                        format!("define it with `<default name=\"{name}\" …>` or `-D {name}=VALUE`")
                    }
                };
                Diagnostic::error(place, format!("undefined parameter `${name}`")).help(help)
            }
        };
        self.report(diagnostic);
        None
    }

    /// Reports the parameters of the command line that the scene does not use.
    pub(crate) fn report_unused_parameters(&mut self) {
        let messages: Vec<Diagnostic> = self
            .parameters
            .unused()
            .map(|name| {
                Diagnostic::error_nowhere(format!(
                    "the scene does not use the parameter `{name}` given by `-D`"
                ))
                .suggest(name, self.parameters.mentioned().filter(|m| *m != name))
            })
            .collect();
        messages.into_iter().for_each(|m| self.report(m));
    }
}
