//! The address of a sample, as the command line names it.

/// A sample to be drawn again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ReplayAddress {
    /// Column and row of its pixel, which may lie around the film.
    pub pixel: [i32; 2],
    /// Its replicate.
    pub replicate: u32,
    /// Its number within pixel and replicate.
    pub sample: u32,
}

/// The address of a sample.
pub(crate) fn parse_replay(text: &str) -> Result<ReplayAddress, String> {
    let address = || {
        let mut words = text.split(',').map(str::trim);
        let address = ReplayAddress {
            pixel: [words.next()?.parse().ok()?, words.next()?.parse().ok()?],
            replicate: words.next()?.parse().ok()?,
            sample: words.next()?.parse().ok()?,
        };
        words.next().is_none().then_some(address)
    };
    address().ok_or_else(|| {
        "expected four numbers, such as 12,7,0,3: column, row, replicate, sample".to_owned()
    })
}
