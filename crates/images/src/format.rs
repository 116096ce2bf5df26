//! The kinds of picture files, recognised by their content.

/// The kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Portable Network Graphics.
    Png,
    /// JPEG.
    Jpeg,
    /// Windows bitmap.
    Bmp,
    /// Truevision TGA.
    Tga,
    /// Netpbm: portable bit, grey, pixel and arbitrary maps.
    Pnm,
    /// Radiance RGBE.
    Hdr,
    /// Portable float map.
    Pfm,
    /// OpenEXR.
    Exr,
}

impl Format {
    /// All of them, for messages.
    pub const NAMES: &'static str = "PNG, JPEG, BMP, TGA, PNM, Radiance HDR, PFM and OpenEXR";

    /// The format of a file with this content.
    #[must_use]
    pub fn of(bytes: &[u8]) -> Option<Self> {
        const BEGINNINGS: [(&[u8], Format); 6] = [
            (b"\x89PNG\r\n\x1a\n", Format::Png),
            (b"\xff\xd8\xff", Format::Jpeg),
            (b"BM", Format::Bmp),
            (b"PF", Format::Pfm),
            (b"Pf", Format::Pfm),
            (b"\x76\x2f\x31\x01", Format::Exr),
        ];
        let begins = |(beginning, _): &&(&[u8], Self)| bytes.starts_with(beginning);
        if let Some((_, format)) = BEGINNINGS.iter().find(begins) {
            return Some(*format);
        }
        match bytes {
            [b'P', b'1'..=b'7', space, ..] if space.is_ascii_whitespace() || *space == b'#' => {
                Some(Self::Pnm)
            }
            // "#?RADIANCE", as the format has it, or the name of another program.
            [b'#', b'?', rest @ ..] if rest.iter().take(128).any(|&b| b == b'\n') => {
                Some(Self::Hdr)
            }
            _ => is_tga(bytes).then_some(Self::Tga),
        }
    }
}

/// How the pointers begin that git LFS keeps in place of large files.
const LFS_POINTER: &[u8] = b"version https://git-lfs.github.com/spec/";

/// What to say of a file that is only a pointer of git LFS to what was meant, as in a repository whose large files were not fetched.
#[must_use]
pub fn lfs_pointer(bytes: &[u8]) -> Option<&'static str> {
    bytes
        .starts_with(LFS_POINTER)
        .then_some("it is a pointer of git LFS to the file; `git lfs pull` fetches that")
}

/// Whether a file begins as a TGA file does, which has no mark at its head: every field must make
/// sense.
fn is_tga(bytes: &[u8]) -> bool {
    let Some(head) = bytes.first_chunk::<18>() else {
        return false;
    };
    let word = |at: usize| u16::from_le_bytes([head[at], head[at + 1]]);
    let (map, kind, map_length, map_bits) = (head[1], head[2], word(5), head[7]);
    let (width, height, bits, flags) = (word(12), word(14), head[16], head[17]);
    let mapped = map == 0 || map == 1 && map_length > 0 && [15, 16, 24, 32].contains(&map_bits);
    let pixels = match kind {
        1 | 9 => map == 1 && [8, 16].contains(&bits),
        2 | 10 => [15, 16, 24, 32].contains(&bits),
        3 | 11 => [8, 16].contains(&bits),
        _ => false,
    };
    // Bits 6 and 7 of the flags were for interleaved rows, and are 0.
    mapped && pixels && width > 0 && height > 0 && flags & 0xc0 == 0
}

impl std::fmt::Display for Format {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Png => "PNG",
            Self::Jpeg => "JPEG",
            Self::Bmp => "BMP",
            Self::Tga => "TGA",
            Self::Pnm => "PNM",
            Self::Hdr => "Radiance HDR",
            Self::Pfm => "PFM",
            Self::Exr => "OpenEXR",
        })
    }
}
