//! Claims about pictures, and the decision whether they hold: `cargo xtask validate`.
//!
//! A [`claim`] is a TOML file in `validation/claims`: a scene, an oracle (a closed form, a
//! reference by Mitsuba 3, another estimator, a rate of convergence, …), and the estimators that
//! must agree with it. [`tasks`] says which comparisons a run consists of, [`run`] renders and judges one of them, [`outcome`] looks at all until they
//! are decided and corrects over the whole run, and [`table`], [`json`] and [`html`] tell people.
//! [`fault`] plants faults to show that they are found.

pub mod accumulate;
mod batch_cache;
mod batches;
pub mod claim;
pub mod closed_form;
pub mod convergence;
pub mod edges;
pub mod fault;
pub mod folders;
pub mod html;
pub mod invariance;
pub mod json;
pub mod look;
pub mod matrix;
pub mod noise;
pub mod null_runs;
pub mod outcome;
pub mod pixelwise;
pub mod povray;
pub mod program;
pub mod read;
pub mod reference;
pub mod rendering;
pub mod run;
pub mod state;
pub mod table;
pub mod tasks;
pub mod tier;
