//! The many spellings of "not a number" in text files.

/// Whether a word means NaN: `nan`, `-nan(ind)`, `1.#QNAN`, `-1.#IND00`.
pub(crate) fn is_nan(word: &[u8]) -> bool {
    let word = word.strip_prefix(b"-").unwrap_or(word);
    let word = word.strip_prefix(b"+").unwrap_or(word);
    word.get(..3)
        .is_some_and(|start| start.eq_ignore_ascii_case(b"nan"))
        || word.starts_with(b"1.#QNAN")
        || word.starts_with(b"1.#IND")
        || word.starts_with(b"1.#SNAN")
}
