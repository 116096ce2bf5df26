//! The encoding of a PNG file's samples by its metadata, if it is not sRGB.
//!
//! Samples are always decoded as sRGB, as in Mitsuba. By the PNG specification (third
//! edition, 4.3) the chunk cICP goes before iCCP, that before sRGB, and that before gAMA with cHRM.

/// A sentence about a file that says that its samples are not sRGB.
pub(crate) fn note(bytes: &[u8]) -> Option<String> {
    let what = if let Some(data) = chunk(bytes, b"cICP") {
        // ITU-T H.273: primaries of BT.709, and the transfer function of sRGB.
        match data {
            [1, 13, ..] => return None,
            [primaries, transfer, ..] => {
                format!("cICP chunk (primaries {primaries}, transfer function {transfer})")
            }
            _ => return None,
        }
    } else if let Some(name) = chunk(bytes, b"iCCP").and_then(other_profile) {
        format!("colour profile, \"{name}\",")
    } else if chunk(bytes, b"sRGB").is_some() {
        return None;
    } else if let Some(&[a, b, c, d]) = chunk(bytes, b"gAMA")
        && !(40_000..=50_000).contains(&u32::from_be_bytes([a, b, c, d]))
    {
        let gamma = f64::from(u32::from_be_bytes([a, b, c, d])) / 100_000.0;
        let linear = if gamma == 1.0 { ", linear samples" } else { "" };
        format!("gAMA chunk ({gamma}{linear})")
    } else {
        let primaries = chunk(bytes, b"cHRM")?.as_chunks::<4>().0;
        let stored = primaries.iter().map(|&word| u32::from_be_bytes(word));
        // The white and the primaries of sRGB, in units of 10⁻⁵.
        let srgb = [
            31_270, 32_900, 64_000, 33_000, 30_000, 60_000, 15_000, 6_000,
        ];
        if stored.zip(srgb).all(|(a, b)| a.abs_diff(b) <= 200) {
            return None;
        }
        "cHRM chunk".to_owned()
    };
    Some(format!(
        "by its {what} its samples are not encoded as sRGB, but they are decoded as if they were"
    ))
}

/// The name of a colour profile, if it is one of something else than sRGB. Many programs embed
/// sRGB by names of their own.
fn other_profile(profile: &[u8]) -> Option<String> {
    const OTHERS: [&str; 8] = [
        "p3", "adobe", "prophoto", "2020", "2100", "aces", "linear", "wide",
    ];
    let name = profile.iter().take_while(|&&b| b != 0);
    let name: String = name.map(|&b| char::from(b)).collect();
    let lower = name.to_lowercase();
    OTHERS
        .iter()
        .any(|other| lower.contains(other))
        .then_some(name)
}

/// The data of the first chunk of a kind, if it stands before the pixels.
fn chunk<'a>(bytes: &'a [u8], kind: &[u8; 4]) -> Option<&'a [u8]> {
    let mut rest = bytes.get(8..)?;
    loop {
        let (length, after) = rest.split_first_chunk::<4>()?;
        let (found, after) = after.split_first_chunk::<4>()?;
        let length = usize::try_from(u32::from_be_bytes(*length)).ok()?;
        if found == kind {
            return after.get(..length);
        }
        if found == b"IDAT" {
            return None;
        }
        rest = after.get(length.checked_add(4)?..)?;
    }
}
