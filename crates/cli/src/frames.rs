//! The frames of an animation: which there are, what their files are called, and which seed each has.

use etalon_sampling::hash::derived_key;
use std::path::{Path, PathBuf};

/// Frames with consecutive numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameRange {
    /// The first.
    pub first: u32,
    /// The last, not before `first`.
    pub last: u32,
}

/// One of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Its number.
    pub number: u32,
    /// The frames that it belongs to.
    pub of: FrameRange,
    /// The moment that its shutter counts from (units of scene time).
    pub time: f64,
}

impl FrameRange {
    /// `A..B`, both included, or `A` alone.
    ///
    /// # Errors
    /// One sentence.
    pub fn parse(text: &str) -> Result<Self, String> {
        let (first, last) = text.split_once("..").unwrap_or((text, text));
        let number = |text: &str| text.trim().parse().ok();
        let (Some(first), Some(last)) = (number(first), number(last)) else {
            return Err("expected the first and the last frame, such as 1..24".to_owned());
        };
        if first > last {
            return Err(format!(
                "there is no frame from {first} to {last}; expected the first and the last, such as 1..24"
            ));
        }
        Ok(Self { first, last })
    }

    /// How many there are.
    pub fn count(self) -> u64 {
        u64::from(self.last - self.first) + 1
    }
}

impl Frame {
    /// What stands before its bar.
    pub fn label(&self) -> String {
        let place = self.number - self.of.first + 1;
        format!("frame {place} of {}  ", self.of.count())
    }

    /// The seed of this frame, where `seed` is that of the scene: others for other frames.
    pub fn seed(&self, seed: u64) -> u64 {
        derived_key(seed, self.number)
    }
}

/// The path with the number in place of the last run of `#`, or before the extension.
pub fn numbered(path: &Path, number: u32) -> PathBuf {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let numbered = match name.rfind('#') {
        Some(end) => {
            let before = name[..=end].trim_end_matches('#');
            let width = end + 1 - before.len();
            format!("{before}{number:0width$}{}", &name[end + 1..])
        }
        None => match name.rsplit_once('.') {
            Some((stem, extension)) => format!("{stem}.{number:04}.{extension}"),
            None => format!("{name}.{number:04}"),
        },
    };
    path.with_file_name(numbered)
}

/// The frame that a list lacks: its numbers, the last in each name, go in steps, and one step is longer than the
/// shortest. Names that differ in more than their numbers are no sequence.
pub fn lacking(files: &[PathBuf]) -> Option<PathBuf> {
    let mut sequence: Option<(PathBuf, usize)> = None;
    let mut numbers = Vec::new();
    for file in files {
        let name = file.file_name()?.to_str()?;
        let is_digit = |c: char| c.is_ascii_digit();
        let end = name.rfind(is_digit)? + 1;
        let digits = &name[name[..end].trim_end_matches(is_digit).len()..end];
        let before = &name[..end - digits.len()];
        let pattern = file.with_file_name(format!("{before}#{}", &name[end..]));
        let (of, width) = sequence.get_or_insert((pattern.clone(), digits.len()));
        if pattern != *of {
            return None;
        }
        *width = (*width).min(digits.len());
        numbers.push(digits.parse::<u32>().ok()?);
    }
    numbers.sort_unstable();
    numbers.dedup();
    let step = numbers.windows(2).map(|pair| pair[1] - pair[0]).min()?;
    let gap = numbers.windows(2).find(|pair| pair[1] - pair[0] > step)?;
    let (pattern, width) = sequence?;
    let pattern = pattern.to_string_lossy().replace('#', &"#".repeat(width));
    Some(numbered(Path::new(&pattern), gap[0] + step))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges() {
        let range = |first, last| Ok(FrameRange { first, last });
        assert_eq!(FrameRange::parse("1..24"), range(1, 24));
        assert_eq!(FrameRange::parse("7"), range(7, 7));
        assert_eq!(FrameRange::parse("0..0").map(FrameRange::count), Ok(1));
        for (text, words) in [
            ("5..3", "there is no frame from 5 to 3"),
            ("..3", "expected the first and the last frame"),
            ("-1..3", "expected"),
            ("a..b", "expected"),
        ] {
            let message = FrameRange::parse(text).expect_err("no range");
            assert!(message.contains(words), "{message}");
        }
    }

    #[test]
    fn names() {
        for (pattern, name) in [
            ("a/out.exr", "a/out.0007.exr"),
            ("a/out.######.exr", "a/out.000007.exr"),
            ("#/f#.png", "#/f7.png"),
            ("out", "out.0007"),
        ] {
            assert_eq!(numbered(Path::new(pattern), 7), Path::new(name));
        }
    }

    #[test]
    fn a_gap_in_a_list_is_found() {
        let lacking = |names: &[&str]| {
            let files: Vec<PathBuf> = names.iter().map(PathBuf::from).collect();
            lacking(&files).map(|file| file.display().to_string())
        };
        let found = |name: &str| Some(name.to_owned());
        assert_eq!(
            lacking(&["d/a.0001.exr", "d/a.0002.exr", "d/a.0004.exr"]),
            found("d/a.0003.exr")
        );
        assert_eq!(
            lacking(&["a8.exr", "a9.exr", "a10.exr", "a12.exr"]),
            found("a11.exr")
        );
        // Every other frame, back and forth, another shot, one frame, and names without numbers.
        assert_eq!(lacking(&["a0.exr", "a2.exr", "a4.exr"]), None);
        assert_eq!(
            lacking(&["a1.exr", "a2.exr", "a3.exr", "a2.exr", "a1.exr"]),
            None
        );
        assert_eq!(lacking(&["a1.exr", "a2.exr", "b4.exr"]), None);
        assert_eq!(lacking(&["a1.exr"]), None);
        assert_eq!(lacking(&["a.exr", "b.exr"]), None);
    }

    #[test]
    fn every_frame_has_its_seed() {
        let of = FrameRange { first: 0, last: 99 };
        let seeds = (0..100).map(|number| {
            Frame {
                number,
                of,
                time: 0.0,
            }
            .seed(3)
        });
        let mut seeds: Vec<u64> = seeds.collect();
        seeds.sort_unstable();
        seeds.dedup();
        assert_eq!(seeds.len(), 100);
    }
}
