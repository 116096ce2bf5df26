//! The syntax of parameter lists: `"type name" value` or `"type name" [ values ]`, again and again.
//!
//! A mistake costs one parameter: it stays in the list as [`Values::Broken`], and what follows is read.

use super::mistakes::Mistakes;
use super::number::{self, excerpt};
use super::parameter::{ColorSpace, Parameter, ParameterType, Values};
use super::quoted::unescape;
use super::tokens::{Cursor, Token, TokenKind};
use super::value_syntax;
use etalon_params::{Diagnostic, Span, Spanned};

/// The most parameters of one entity; no entity of pbrt knows more than about thirty.
pub(crate) const MOST_PARAMETERS: usize = 256;

/// Reads parameters up to what is none.
pub(crate) fn parameters(
    cursor: &mut Cursor<'_>,
    mistakes: &mut Mistakes,
    color_space: ColorSpace,
) -> Vec<Parameter> {
    let mut list: Vec<Parameter> = Vec::new();
    while let Some(token) = cursor.peek() {
        if !matches!(token.kind, TokenKind::Quoted | TokenKind::Unterminated) {
            break;
        }
        cursor.next();
        let Some((kind, name)) = declaration(token, mistakes) else {
            value_syntax::skip(cursor);
            continue;
        };
        let known = kind.is_some();
        let kind = kind.unwrap_or(ParameterType::String);
        let values = match known {
            true => value_syntax::values(cursor, mistakes, kind, token),
            false => {
                value_syntax::skip(cursor);
                (Values::Broken, token.span)
            }
        };
        let parameter = Parameter::new(kind, name, token.span, values, color_space);
        if let Some(first) = list.iter().find(|other| other.name == parameter.name) {
            let message = format!("`{}` is given twice", excerpt(&parameter.name));
            mistakes.report(
                Diagnostic::error(token.span, message).related(first.declaration, "first here"),
            );
        } else if list.len() == MOST_PARAMETERS {
            let message = format!("there are more than {MOST_PARAMETERS} parameters");
            mistakes.give_up(Diagnostic::error(token.span, message));
        } else {
            list.push(parameter);
        }
        if mistakes.is_full() {
            break;
        }
    }
    list
}

/// The type and name of a declaration. Without a type, as it is unknown, the name is still worth having.
fn declaration(
    token: Token<'_>,
    mistakes: &mut Mistakes,
) -> Option<(Option<ParameterType>, String)> {
    let read = string(token).map_err(|mistake| mistakes.report(mistake));
    let text = read.ok()?.value;
    let mut words = text.split([' ', '\t']).filter(|word| !word.is_empty());
    let (Some(word), Some(name), None) = (words.next(), words.next(), words.next()) else {
        let message = format!("`\"{}\"` declares no parameter", excerpt(&text));
        let form = "a parameter is declared by its type and its name, such as `\"float radius\"`";
        mistakes.report(Diagnostic::error(token.span, message).help(form));
        return None;
    };
    let known = ParameterType::WORDS
        .iter()
        .find(|(known, _)| *known == word);
    if known.is_none() {
        let message = format!("`{}` is not a type of a parameter", excerpt(word));
        let unknown = Diagnostic::error(token.span, message);
        mistakes.report(match word {
            "color" => unknown.help("pbrt-v3 called `color` what is `rgb` in pbrt-v4"),
            "xyz" => unknown.help("pbrt-v4 has no `xyz` colours: use `rgb` or `spectrum`"),
            _ => unknown.suggest(word, ParameterType::WORDS.iter().map(|(known, _)| *known)),
        });
    }
    Some((known.map(|(_, kind)| *kind), name.to_owned()))
}

/// Whether a string looks like the declaration of a parameter rather than like a value.
pub(crate) fn is_declaration(text: &str) -> bool {
    let mut words = text.split([' ', '\t']).filter(|word| !word.is_empty());
    let first = words.next().unwrap_or_default();
    let is_type = ParameterType::WORDS
        .iter()
        .any(|(known, _)| *known == first);
    is_type && words.next().is_some()
}

/// The contents of a quoted string; anything else is a mistake.
pub(crate) fn string(token: Token<'_>) -> Result<Spanned<String>, Diagnostic> {
    let span = token.span;
    Err(match token.kind {
        TokenKind::Quoted => match unescape(token.text) {
            Ok(text) => {
                let value = text.into_owned();
                return Ok(Spanned { value, span });
            }
            Err(escape) => {
                let place = Span {
                    start: span.start + 1 + escape.start as u32,
                    end: span.start + 1 + escape.end as u32,
                    ..span
                };
                let message = format!("`{}` is not an escape", excerpt(&token.text[escape]));
                let accepted =
                    r#"accepted: \\ \" \' \n \t \r \b \f; a backslash itself is written `\\`"#;
                Diagnostic::error(place, message).help(accepted)
            }
        },
        TokenKind::Unterminated => Diagnostic::error(span, "the string does not end on its line")
            .help("its closing quotation mark is missing"),
        _ => {
            let found = excerpt(token.text);
            let message = format!("expected a string in quotes, found `{found}`");
            Diagnostic::error(span, message)
        }
    })
}

/// Why a token is not a number.
pub(crate) fn not_a_float(token: Token<'_>) -> Diagnostic {
    let message = match token.kind {
        TokenKind::Word => number::not_a_float(token.text),
        TokenKind::Quoted => format!("expected a number, found the string `{}`", quotation(token)),
        _ => format!("expected a number, found `{}`", excerpt(token.text)),
    };
    let diagnostic = Diagnostic::error(token.span, message);
    match token.text.contains(',') {
        true => diagnostic.help("numbers are separated by blanks"),
        false => diagnostic,
    }
}

/// A string token with its quotation marks, not too long.
pub(crate) fn quotation(token: Token<'_>) -> String {
    format!("\"{}\"", excerpt(token.text))
}

/// Whether a word begins the next directive: unlike all values but those of `ActiveTransform`, directives begin with a capital.
pub(crate) fn begins_directive(token: Token<'_>) -> bool {
    token.kind == TokenKind::Word
        && token.text.starts_with(|c: char| c.is_ascii_uppercase())
        && !matches!(token.text, "All" | "StartTime" | "EndTime")
}
