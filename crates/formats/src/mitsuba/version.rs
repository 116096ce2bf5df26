//! The version of a scene file.

/// The version of a scene file.
pub(crate) type Version = [u32; 3];

/// A version as the files write it: up to three numbers with points between them.
pub(crate) fn version(text: &str) -> Option<Version> {
    let mut version = [0; 3];
    for (place, number) in text.trim().split('.').enumerate() {
        *version.get_mut(place)? = number.parse().ok()?;
    }
    Some(version)
}

/// Whether the names of a file have to be upgraded.
pub(crate) fn is_old(version: Version) -> bool {
    version < [2, 0, 0]
}

/// Whether a file is of a version before 0.4.
pub(crate) fn is_ancient(version: Version) -> bool {
    version < [0, 4, 0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_up_to_three_numbers() {
        assert_eq!(version("3.0.0"), Some([3, 0, 0]));
        assert_eq!(version("0.6.0"), Some([0, 6, 0]));
        assert_eq!(version("0.5"), Some([0, 5, 0]));
        assert_eq!(version("3"), Some([3, 0, 0]));
        for text in ["", "3.", "3.0.0.0", "x", "3.-1.0"] {
            assert_eq!(version(text), None, "{text}");
        }
        assert!(is_old([1, 9, 9]) && !is_old([2, 0, 0]));
    }
}
