//! What tests change files with.

/// Numbers as of chance, always the same (Marsaglia 2003, xorshift).
pub(crate) struct Numbers(pub(crate) u64);

impl Numbers {
    /// One from 0 to below `end`.
    pub(crate) fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as usize % end.max(1)
    }
}

/// How many changed files a test reads: `ETALON_CHANGED_FILES`, if that is set.
pub(crate) fn changed_files(default: u32) -> u32 {
    let count = std::env::var("ETALON_CHANGED_FILES");
    let count = count.ok().and_then(|count| count.parse().ok());
    count.unwrap_or(default)
}
