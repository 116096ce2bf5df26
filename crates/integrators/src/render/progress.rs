//! Watching a render, and stopping it.

/// Watches a render.
pub trait Progress: Sync {
    /// A tile is done, with so many samples.
    fn tile_done(&self, samples: u64);
    /// Whether to stop, as soon as the samples are finished that have been begun.
    fn cancelled(&self) -> bool;
}

/// A watcher that does not care.
impl Progress for () {
    fn tile_done(&self, _: u64) {}
    fn cancelled(&self) -> bool {
        false
    }
}
