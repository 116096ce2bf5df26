//! The syntax of a parameter's values.

use super::mistakes::Mistakes;
use super::number;
use super::parameter::{ParameterType, Values};
use super::parameter_syntax::{begins_directive, is_declaration, not_a_float, quotation, string};
use super::tokens::{Cursor, Token, TokenKind};
use etalon_params::{Diagnostic, Span, Spanned};

/// What values look like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Integers,
    Numbers,
    Booleans,
    Strings,
}

impl Form {
    /// A spectrum is either wavelengths and values, or a name; its first token tells.
    fn of(kind: ParameterType, first: Option<Token<'_>>) -> Self {
        match kind {
            ParameterType::Integer => Self::Integers,
            ParameterType::Bool => Self::Booleans,
            ParameterType::String | ParameterType::Texture => Self::Strings,
            ParameterType::Spectrum if first.is_some_and(|t| t.kind == TokenKind::Quoted) => {
                Self::Strings
            }
            _ => Self::Numbers,
        }
    }
}

/// Reads the values of the parameter that `declaration` declares, and says where they stand.
pub(crate) fn values(
    cursor: &mut Cursor<'_>,
    mistakes: &mut Mistakes,
    kind: ParameterType,
    declaration: Token<'_>,
) -> (Values, Span) {
    let first = cursor.peek();
    let opening = first.filter(|token| token.kind == TokenKind::Open);
    if opening.is_some() {
        cursor.next();
    }
    let form = Form::of(kind, cursor.peek());
    let is_value = |token: &Token<'_>| opening.is_some() || !follows_values(*token, form);
    let Some(first) = first.filter(is_value) else {
        let message = format!("{} has no value", quotation(declaration));
        mistakes.report(Diagnostic::error(declaration.span, message));
        return (Values::Broken, declaration.span);
    };
    let bracketed = opening.is_some();
    let mut are_sound = true;
    let read = match form {
        Form::Integers => {
            let integer = |cursor: &mut Cursor<'_>| cursor.word_by(number::integer);
            items(cursor, bracketed, integer).map(Values::Integers)
        }
        Form::Numbers => {
            let number = |cursor: &mut Cursor<'_>| cursor.word_by(number::float);
            items(cursor, bracketed, number).map(Values::Numbers)
        }
        Form::Booleans => items(cursor, bracketed, boolean).map(Values::Booleans),
        Form::Strings => {
            let text = |cursor: &mut Cursor<'_>| {
                let text = text(cursor)?;
                let empty = |mistake| {
                    mistakes.report(mistake);
                    are_sound = false;
                    Spanned {
                        value: String::new(),
                        span: first.span,
                    }
                };
                Some(text.unwrap_or_else(empty))
            };
            items(cursor, bracketed, text).map(Values::Strings)
        }
    };
    let Some(values) = read else {
        report_misfit(cursor, mistakes, form, opening);
        return (Values::Broken, first.span);
    };
    let end = cursor.here().end;
    let span = Span { end, ..first.span };
    if !bracketed {
        report_stray_values(cursor, mistakes);
    }
    if let Err(mistake) = check_count(kind, &values, declaration, span) {
        mistakes.report(mistake);
        are_sound = false;
    }
    match are_sound {
        true => (values, span),
        false => (Values::Broken, span),
    }
}

/// Skips whatever may be the values of a parameter that is not understood.
pub(crate) fn skip(cursor: &mut Cursor<'_>) {
    match cursor.peek() {
        Some(token) if token.kind == TokenKind::Open => {
            cursor.next();
            skip_to_closing(cursor);
        }
        Some(token) if !follows_values(token, Form::Numbers) => {
            cursor.next();
        }
        _ => {}
    }
}

/// Reads one value, or values up to the closing bracket. `None` if something else stands there: the cursor is before it.
fn items<T>(
    cursor: &mut Cursor<'_>,
    bracketed: bool,
    mut read: impl FnMut(&mut Cursor<'_>) -> Option<T>,
) -> Option<Box<[T]>> {
    if !bracketed {
        cursor.skip_blanks()?;
        return Some(Box::new([read(cursor)?]));
    }
    let mut list = Vec::new();
    while cursor.skip_blanks()? != b']' {
        list.push(read(cursor)?);
    }
    cursor.next();
    Some(list.into_boxed_slice())
}

fn boolean(cursor: &mut Cursor<'_>) -> Option<bool> {
    let token = cursor.peek().filter(|t| t.kind == TokenKind::Word)?;
    let value = match token.text {
        "true" => true,
        "false" => false,
        _ => return None,
    };
    cursor.next();
    Some(value)
}

/// A string, or what is wrong with it; the cursor is behind it in either case.
fn text(cursor: &mut Cursor<'_>) -> Option<Result<Spanned<String>, Diagnostic>> {
    let token = cursor.peek().filter(|t| t.kind == TokenKind::Quoted)?;
    cursor.next();
    Some(string(token))
}

/// Whether a token cannot be a value of this form, but may follow one: a directive, or the next parameter.
fn follows_values(token: Token<'_>, form: Form) -> bool {
    match token.kind {
        TokenKind::Quoted => form != Form::Strings && is_declaration(token.text),
        TokenKind::Close => true,
        _ => begins_directive(token),
    }
}

/// Reports the token in front of the cursor, which is no value, and moves to where the next parameter may be.
fn report_misfit(
    cursor: &mut Cursor<'_>,
    mistakes: &mut Mistakes,
    form: Form,
    opening: Option<Token<'_>>,
) {
    let token = cursor.peek();
    let unclosed =
        |token: &Token<'_>| token.kind == TokenKind::Open || follows_values(*token, form);
    if let Some(opening) = opening
        && token.as_ref().is_none_or(unclosed)
    {
        let diagnostic = Diagnostic::error(opening.span, "`[` is not closed");
        mistakes.report(match token {
            Some(token) => diagnostic.related(token.span, "expected a value or `]` here"),
            None => diagnostic,
        });
        if token.is_some_and(|token| token.kind == TokenKind::Open) {
            cursor.next();
            skip_to_closing(cursor);
        }
        return;
    }
    let Some(token) = token else {
        return;
    };
    cursor.next();
    mistakes.report(misfit(token, form));
    if opening.is_some() {
        skip_to_closing(cursor);
    }
}

/// Why a token is no value of this form.
fn misfit(token: Token<'_>, form: Form) -> Diagnostic {
    let quoted = token.kind == TokenKind::Quoted;
    match (form, quoted) {
        (Form::Numbers, _) => not_a_float(token),
        (Form::Integers, false) => {
            Diagnostic::error(token.span, number::not_an_integer(token.text))
        }
        (Form::Integers, true) => {
            let message = format!(
                "expected an integer, found the string `{}`",
                quotation(token)
            );
            Diagnostic::error(token.span, message)
        }
        (Form::Booleans, true) if matches!(token.text, "true" | "false") => {
            let message = format!("expected a bool, found the string `{}`", quotation(token));
            let help = format!(
                "pbrt-v4 writes `{}` without quotes, unlike pbrt-v3",
                token.text
            );
            Diagnostic::error(token.span, message).help(help)
        }
        (Form::Booleans, _) => {
            let message = format!("`{}` is not a bool", number::excerpt(token.text));
            Diagnostic::error(token.span, message).help("accepted: true, false")
        }
        (Form::Strings, _) => match string(token) {
            Err(diagnostic) => diagnostic,
            Ok(_) => Diagnostic::error(token.span, "this string does not belong here"),
        },
    }
}

/// Reports words after the only value that a parameter without brackets can have, and moves past them.
fn report_stray_values(cursor: &mut Cursor<'_>, mistakes: &mut Mistakes) {
    let mut is_said = false;
    while let Some(token) = cursor.peek() {
        let is_stray = token.kind == TokenKind::Word && !begins_directive(token);
        if !is_stray {
            return;
        }
        cursor.next();
        if !is_said {
            let message = format!(
                "`{}` follows a value that stands without brackets",
                number::excerpt(token.text)
            );
            mistakes.report(
                Diagnostic::error(token.span, message).help("several values are written in `[ ]`"),
            );
        }
        is_said = true;
    }
}

/// Moves past the closing bracket, or to what shows that there is none.
fn skip_to_closing(cursor: &mut Cursor<'_>) {
    while let Some(token) = cursor.peek() {
        let closes = token.kind == TokenKind::Close;
        if !closes && follows_values(token, Form::Numbers) {
            return;
        }
        cursor.next();
        if closes {
            return;
        }
    }
}

/// Whether the numbers make up whole values: points, colours, pairs of wavelength and value.
fn check_count(
    kind: ParameterType,
    values: &Values,
    declaration: Token<'_>,
    span: Span,
) -> Result<(), Diagnostic> {
    let Values::Numbers(numbers) = values else {
        return Ok(());
    };
    let (each, wanted) = match kind {
        ParameterType::Spectrum => (2, "pairs of a wavelength (nm) and a value".to_owned()),
        _ => {
            let each = kind.numbers_per_value();
            (each, format!("{each} for each {}", kind.name()))
        }
    };
    if numbers.len().is_multiple_of(each) {
        return Ok(());
    }
    let message = format!(
        "{} has {} numbers, which is not a multiple of {each}",
        quotation(declaration),
        numbers.len()
    );
    Err(Diagnostic::error(span, message).help(format!("accepted: {wanted}")))
}
