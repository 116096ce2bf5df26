//! Claims, their references, the decision, its null runs and what is kept of a run.
//!
//! One binary, as each takes its time to link; one concern per file.

mod claims;
mod decision;
mod load;
mod null_runs;
mod pairs;
mod povray;
mod references;
mod state;
mod stills;
mod transparent;
