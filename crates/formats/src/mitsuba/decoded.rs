//! From the bytes of an XML file to its text.
//!
//! UTF-8 is the rule. UTF-16 is recognised by its byte order mark, and Latin-1 by the
//! declaration `encoding="ISO-8859-1"` (or `latin1`, `windows-1252`), as old exporters wrote it.

/// A text, or as much of it as could be read and what was wrong where.
pub(crate) struct Decoded {
    /// The text; positions in the scene refer to it.
    pub(crate) text: String,
    /// The byte offset in `text` at which the bytes are no text any more.
    pub(crate) broken_at: Option<usize>,
}

/// Decodes the bytes of an XML file.
pub(crate) fn decode(bytes: &[u8]) -> Decoded {
    let whole = |text: String| Decoded {
        text,
        broken_at: None,
    };
    match bytes {
        [0xff, 0xfe, rest @ ..] => utf16(rest, u16::from_le_bytes),
        [0xfe, 0xff, rest @ ..] => utf16(rest, u16::from_be_bytes),
        _ => {
            let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
            match std::str::from_utf8(bytes) {
                Ok(text) => whole(text.to_owned()),
                Err(_) if declares_latin1(bytes) => {
                    whole(bytes.iter().map(|&b| char::from(b)).collect())
                }
                Err(error) => Decoded {
                    text: String::from_utf8_lossy(bytes).into_owned(),
                    broken_at: Some(error.valid_up_to()),
                },
            }
        }
    }
}

fn utf16(bytes: &[u8], unit: impl Fn([u8; 2]) -> u16) -> Decoded {
    let units = bytes.chunks_exact(2).map(|pair| unit([pair[0], pair[1]]));
    let mut text = String::with_capacity(bytes.len() / 2);
    let mut broken_at = None;
    for character in char::decode_utf16(units) {
        if character.is_err() && broken_at.is_none() {
            broken_at = Some(text.len());
        }
        text.push(character.unwrap_or(char::REPLACEMENT_CHARACTER));
    }
    if bytes.len() % 2 == 1 && broken_at.is_none() {
        broken_at = Some(text.len());
    }
    Decoded { text, broken_at }
}

fn declares_latin1(bytes: &[u8]) -> bool {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(200)]).to_ascii_lowercase();
    head.starts_with("<?xml")
        && head.split("?>").next().is_some_and(|declaration| {
            ["iso-8859-1", "latin1", "windows-1252"]
                .iter()
                .any(|name| declaration.contains(name))
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_what_exporters_write() {
        assert_eq!(decode(b"\xef\xbb\xbf<a/>").text, "<a/>");
        assert_eq!(decode(b"\xff\xfe<\0\xe9\0").text, "<é");
        assert_eq!(decode(b"\xfe\xff\0<\0\xe9").text, "<é");
        let latin = decode(b"<?xml version='1.0' encoding='ISO-8859-1'?><!--\xe9-->");
        assert!(latin.text.ends_with("<!--é-->") && latin.broken_at.is_none());
    }

    #[test]
    fn says_where_bytes_are_no_text() {
        assert_eq!(decode(b"<a>\xe9</a>").broken_at, Some(3));
        assert_eq!(decode(b"\xff\xfe<\0\0\xd8").broken_at, Some(1));
        assert_eq!(decode(b"\xff\xfe<\0>").broken_at, Some(1));
    }
}
