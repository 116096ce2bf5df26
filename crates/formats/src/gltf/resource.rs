//! What a `uri` names: bytes that stand in it (RFC 2397), or a file beside the scene.

use base64::Engine;
use base64::alphabet;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

/// What a `uri` names.
#[derive(Debug, PartialEq)]
pub(crate) enum Resource {
    /// Bytes.
    Bytes(Vec<u8>),
    /// The name of a file.
    File(String),
}

impl Resource {
    /// Reads a `uri`, or says why it cannot be.
    pub(crate) fn of(uri: &str) -> Result<Self, String> {
        if let Some(data) = uri.strip_prefix("data:") {
            return bytes(data).map(Self::Bytes);
        }
        let scheme = uri.split_once("://").map(|(scheme, _)| scheme);
        match scheme {
            None => {}
            Some("file") => {
                let name = decoded(uri.trim_start_matches("file://"));
                return text(name).map(Self::File);
            }
            Some(scheme) => return Err(format!("files are not fetched by `{scheme}:`")),
        }
        text(decoded(uri)).map(Self::File)
    }
}

fn bytes(data: &str) -> Result<Vec<u8>, String> {
    let (kind, data) = data
        .split_once(',')
        .ok_or("the data URI has no comma before its data")?;
    if !kind.ends_with(";base64") {
        return Ok(decoded(data));
    }
    // Padding is often left out.
    let config =
        GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent);
    let engine = GeneralPurpose::new(&alphabet::STANDARD, config);
    let bytes = engine.decode(data);
    bytes.map_err(|error| format!("the data URI is no base64: {error}"))
}

fn text(bytes: Vec<u8>) -> Result<String, String> {
    String::from_utf8(bytes).map_err(|_| "the name of the file is no UTF-8 text".to_owned())
}

/// With `%20` and the like as what they stand for.
fn decoded(text: &str) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        let byte = after.get(..2).and_then(hexadecimal);
        let (byte, after) = match (first, byte) {
            (b'%', Some(byte)) => (byte, &after[2..]),
            _ => (first, after),
        };
        bytes.push(byte);
        rest = after;
    }
    bytes
}

fn hexadecimal(digits: &[u8]) -> Option<u8> {
    if !digits.iter().all(u8::is_ascii_hexdigit) {
        return None;
    }
    u8::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok()
}

#[cfg(test)]
mod tests {
    use super::Resource;

    #[test]
    fn data_and_names_are_told_apart() {
        let file = |name: &str| Ok(Resource::File(name.to_owned()));
        let data = |bytes: &[u8]| Ok(Resource::Bytes(bytes.to_vec()));
        assert_eq!(Resource::of("a%20b/%C3%A9.bin"), file("a b/é.bin"));
        assert_eq!(Resource::of("100%.png"), file("100%.png"));
        assert_eq!(Resource::of("data:image/png;base64,aGk="), data(b"hi"));
        assert_eq!(Resource::of("data:;base64,aGk"), data(b"hi"));
        assert_eq!(Resource::of("data:,h%69"), data(b"hi"));
        for refused in [
            "data:;base64,a*b",
            "data:nothing",
            "https://a.b/c.bin",
            "%ff",
        ] {
            assert!(Resource::of(refused).is_err(), "{refused}");
        }
    }
}
