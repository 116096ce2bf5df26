//! "Did you mean …?"

/// The candidate nearest to `word` by edit distance (insert, delete, replace, swap of
/// neighbours), if it is near enough to be a plausible slip: at most a third of its length.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let length = word.chars().count();
    let most = |c: &str| (c.chars().count().max(length) / 3).max(1);
    candidates
        .into_iter()
        // The distance is at least the difference in length, and takes time and memory in proportion to both lengths.
        .filter(|c| c.chars().count().abs_diff(length) <= most(c))
        .map(|c| {
            (
                strsim::osa_distance(&word.to_lowercase(), &c.to_lowercase()),
                c,
            )
        })
        .filter(|(d, c)| *d <= most(c))
        .min_by_key(|(d, _)| *d)
        .map(|(_, c)| c)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_slips_and_refuses_strangers() {
        let names = ["diffuse", "dielectric", "conductor"];
        assert_eq!(nearest("difuse", names), Some("diffuse"));
        assert_eq!(nearest("Dielectirc", names), Some("dielectric"));
        assert_eq!(nearest("plastic", ["perspective"]), None);
        assert_eq!(nearest("bvh", ["bush", "bose"]), None);
    }
}
