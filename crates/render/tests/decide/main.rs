//! Comparisons decided together: doubts, and means whose replicates are too far from normal.

mod doubt;
mod tails;
