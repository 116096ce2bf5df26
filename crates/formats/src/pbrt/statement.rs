//! A directive with its arguments, as it stands in the file.

use super::directive::{Arguments, Directive};
use super::number;
use super::parameter::Parameter;
use super::parameter_syntax::{begins_directive, not_a_float, parameters, string};
use super::reader::Reader;
use super::tokens::{Cursor, Token, TokenKind};
use etalon_params::{Diagnostic, Span, Spanned};

/// A directive with its arguments.
#[derive(Debug)]
pub(crate) struct Statement {
    /// The directive's word.
    pub(crate) word: Span,
    /// The whole of it.
    pub(crate) span: Span,
    pub(crate) numbers: Vec<f64>,
    /// Names, types and words, in the order of the file.
    pub(crate) names: Vec<Spanned<String>>,
    pub(crate) parameters: Vec<Parameter>,
}

impl Statement {
    /// The name at a position; the arguments of a directive are checked before it is applied.
    pub(crate) fn name(&self, index: usize) -> Spanned<String> {
        let absent = || Spanned {
            value: String::new(),
            span: self.word,
        };
        self.names.get(index).cloned().unwrap_or_else(absent)
    }

    /// So many numbers.
    pub(crate) fn numbers<const N: usize>(&self) -> [f64; N] {
        std::array::from_fn(|i| self.numbers.get(i).copied().unwrap_or_default())
    }
}

/// Reads the arguments of a directive. `None` if they are not complete, which has been reported.
pub(crate) fn read(
    reader: &mut Reader<'_>,
    cursor: &mut Cursor<'_>,
    word: Token<'_>,
    directive: &Directive,
) -> Option<Statement> {
    let mut statement = Statement {
        word: word.span,
        span: word.span,
        numbers: Vec::new(),
        names: Vec::new(),
        parameters: Vec::new(),
    };
    if let Err(mistake) = arguments(cursor, directive, word, &mut statement) {
        reader.mistakes.report(mistake);
        return None;
    }
    if matches!(directive.arguments, Arguments::Entity | Arguments::Texture) {
        let space = reader.state.color_space;
        statement.parameters = parameters(cursor, &mut reader.mistakes, space);
    }
    statement.span.end = match statement.parameters.last() {
        Some(last) => last.span.end,
        None => cursor.here().end,
    };
    Some(statement)
}

/// Reads everything but parameters.
fn arguments(
    cursor: &mut Cursor<'_>,
    directive: &Directive,
    word: Token<'_>,
    statement: &mut Statement,
) -> Result<(), Diagnostic> {
    let missing = |what: &str| {
        let message = format!("`{}` needs {what}", directive.name);
        Diagnostic::error(word.span, message)
    };
    match directive.arguments {
        Arguments::None => {}
        Arguments::Numbers(count) => {
            let missing = || missing(&format!("{count} numbers"));
            numbers(cursor, count, &mut statement.numbers, missing)?;
        }
        Arguments::Matrix => {
            let wanted = "sixteen numbers in brackets";
            let open = cursor.peek();
            if open.is_none_or(|token| token.kind != TokenKind::Open) {
                return Err(missing(wanted));
            }
            numbers(cursor, 16, &mut statement.numbers, || missing(wanted))?;
        }
        Arguments::Word(accepted) => {
            let wanted = format!("one of `{}`", accepted.join("`, `"));
            let token = cursor.next().ok_or_else(|| missing(&wanted))?;
            if !accepted.contains(&token.text) || token.kind != TokenKind::Word {
                let found = number::excerpt(token.text);
                let message = format!("`{found}` cannot follow `{}`", directive.name);
                let mistake = Diagnostic::error(token.span, message);
                return Err(mistake.help(format!("accepted: {}", accepted.join(", "))));
            }
            statement.names.push(Spanned {
                value: token.text.to_owned(),
                span: token.span,
            });
        }
        Arguments::Name | Arguments::Entity => {
            let name = name(cursor, || missing("a string in quotes"))?;
            statement.names.push(name);
        }
        Arguments::Names => {
            let first = name(cursor, || missing("one string in quotes, or two"))?;
            statement.names.push(first);
            if cursor.peek().is_some_and(|t| t.kind == TokenKind::Quoted) {
                let second = name(cursor, || missing("a string"))?;
                statement.names.push(second);
            }
        }
        Arguments::Setting => {
            let option = name(cursor, || missing("a string in quotes and a value"))?;
            let value = cursor.next().ok_or_else(|| missing("a value"))?;
            let (value, span) = match value.kind {
                TokenKind::Word => (value.text.to_owned(), value.span),
                _ => (string(value)?.value, value.span),
            };
            statement.names.extend([option, Spanned { value, span }]);
        }
        Arguments::Texture => {
            for what in ["a name", "`\"float\"` or `\"spectrum\"`", "a type"] {
                statement.names.push(name(cursor, || missing(what))?);
            }
        }
    }
    Ok(())
}

/// A quoted string; if the directive ends before it, that is said at the directive.
fn name(
    cursor: &mut Cursor<'_>,
    missing: impl Fn() -> Diagnostic,
) -> Result<Spanned<String>, Diagnostic> {
    let token = cursor.peek().ok_or_else(&missing)?;
    if begins_directive(token) {
        return Err(missing());
    }
    cursor.next();
    string(token)
}

/// So many numbers, with brackets around them or without.
fn numbers(
    cursor: &mut Cursor<'_>,
    count: usize,
    list: &mut Vec<f64>,
    missing: impl Fn() -> Diagnostic,
) -> Result<(), Diagnostic> {
    let opening = cursor.peek().filter(|token| token.kind == TokenKind::Open);
    if opening.is_some() {
        cursor.next();
    }
    while list.len() < count {
        cursor.skip_blanks();
        if let Some(number) = cursor.word_by(number::float) {
            list.push(number);
            continue;
        }
        let token = cursor.peek().ok_or_else(&missing)?;
        let is_over = begins_directive(token) || token.kind == TokenKind::Close;
        return Err(match is_over {
            true => missing().related(token.span, format!("here are {} so far", list.len())),
            false => not_a_float(token),
        });
    }
    match (opening, cursor.peek()) {
        (None, _) => Ok(()),
        (Some(_), Some(token)) if token.kind == TokenKind::Close => {
            cursor.next();
            Ok(())
        }
        (Some(opening), Some(token)) => {
            let message = format!("expected `]` after {count} numbers");
            Err(Diagnostic::error(token.span, message).related(opening.span, "opened here"))
        }
        (Some(opening), None) => Err(Diagnostic::error(opening.span, "`[` is not closed")),
    }
}
