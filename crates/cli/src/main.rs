//! The `etalon` command line.
fn main() {}
