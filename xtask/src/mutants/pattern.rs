//! Source text found by its tokens, whatever its layout and whatever its identifiers are called today.
//!
//! A mutant states the text it replaces as it was when somebody wrote it. White space never matters. If
//! the text itself is gone, the file is searched for the same tokens under *one other set of names*: a
//! one-to-one renaming of identifiers. A refactoring that renames `passage` to `transmittance`, or moves
//! the text to another file, leaves the mutant applicable, and its replacement is renamed alike.

use std::collections::HashMap;
use std::ops::Range;

/// Words that no renaming changes.
const KEYWORDS: [&str; 24] = [
    "as", "break", "const", "continue", "else", "enum", "false", "fn", "for", "if", "impl", "in",
    "let", "loop", "match", "mut", "pub", "return", "self", "Self", "struct", "true", "use",
    "while",
];

/// A token of Rust, near enough: a word, or a single other character. Where it stands.
fn tokens(text: &str) -> Vec<Range<usize>> {
    let in_word = |c: char| c.is_alphanumeric() || c == '_';
    let mut tokens: Vec<Range<usize>> = Vec::new();
    let mut last_was_word = false;
    for (at, c) in text.char_indices() {
        let end = at + c.len_utf8();
        match tokens.last_mut() {
            Some(token) if last_was_word && in_word(c) && token.end == at => token.end = end,
            _ if c.is_whitespace() => {}
            _ => tokens.push(at..end),
        }
        last_was_word = in_word(c);
    }
    tokens
}

fn is_identifier(word: &str) -> bool {
    word.starts_with(|c: char| c.is_alphabetic() || c == '_') && !KEYWORDS.contains(&word)
}

/// Where a text was found, and what its identifiers are called there.
#[derive(Debug)]
pub(crate) struct Found<'a> {
    /// From its first token to its last.
    pub(crate) place: Range<usize>,
    names: HashMap<&'a str, &'a str>,
}

impl<'a> Found<'a> {
    /// `text` with the identifiers of the place.
    pub(crate) fn renamed(&self, text: &'a str) -> String {
        let mut renamed = String::new();
        let mut end = 0;
        for token in tokens(text) {
            let word = &text[token.clone()];
            renamed.push_str(&text[end..token.start]);
            renamed.push_str(self.names.get(word).copied().unwrap_or(word));
            end = token.end;
        }
        renamed.push_str(&text[end..]);
        renamed
    }

    /// The identifiers that have another name there, as `old -> new`.
    pub(crate) fn changes(&self) -> Vec<String> {
        let changed = self.names.iter().filter(|(old, new)| old != new);
        let mut changes: Vec<String> = changed
            .map(|(old, new)| format!("{old} -> {new}"))
            .collect();
        changes.sort_unstable();
        changes
    }
}

/// All places of `source` where `text` stands: as it is, or `renamed`.
pub(crate) fn find<'a>(source: &'a str, text: &'a str, renamed: bool) -> Vec<Found<'a>> {
    let (all, wanted) = (tokens(source), tokens(text));
    if wanted.is_empty() {
        return Vec::new();
    }
    let at = |window: &[Range<usize>]| {
        let mut names: HashMap<&str, &str> = HashMap::new();
        let mut taken: HashMap<&str, &str> = HashMap::new();
        for (here, there) in wanted.iter().zip(window) {
            let (old, new) = (&text[here.clone()], &source[there.clone()]);
            let alike = if renamed && is_identifier(old) {
                is_identifier(new)
                    && *names.entry(old).or_insert(new) == new
                    && *taken.entry(new).or_insert(old) == old
            } else {
                old == new
            };
            if !alike {
                return None;
            }
        }
        let place = window.first()?.start..window.last()?.end;
        Some(Found { place, names })
    };
    all.windows(wanted.len()).filter_map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOURCE: &str = "fn survive(&mut self, q: f32) {\n    self.beta *=\n        q.recip();\n    self.r_u *= q;\n}\n";

    #[test]
    fn layout_does_not_matter() {
        let found = find(SOURCE, "self.beta *= q.recip();", false);
        assert_eq!(found.len(), 1);
        assert_eq!(
            &SOURCE[found[0].place.clone()],
            "self.beta *=\n        q.recip();"
        );
        // Mutant rejected: words that are glued together.
        assert!(find(SOURCE, "selfbeta *= q.recip();", false).is_empty());
    }

    #[test]
    fn one_renaming_is_found_and_applied_to_the_replacement() {
        let text = "self.value *= chance.recip();";
        assert!(find(SOURCE, text, false).is_empty());
        let found = find(SOURCE, text, true);
        // `recip` is an identifier, too, and `self.r_u *= q;` has fewer tokens.
        assert_eq!(found.len(), 1);
        assert_eq!(
            found[0].renamed("self.value *= 1.0 + chance;"),
            "self.beta *= 1.0 + q;"
        );
        assert_eq!(found[0].changes(), ["chance -> q", "value -> beta"]);
    }

    #[test]
    fn names_are_renamed_one_to_one() {
        // Mutants rejected: two names become one, or one becomes two.
        assert!(find("a * a", "x * y", true).is_empty());
        assert!(find("a * b", "x * x", true).is_empty());
        assert_eq!(find("a * b", "x * y", true).len(), 1);
        assert!(find("a * self", "x * y", true).is_empty());
    }
}
