//! Claims about pictures, and the decision whether they hold: `cargo xtask validate`.
//!
//! A [`claim`] is a TOML file in `validation/claims`: a scene, an oracle (a closed form, a
//! reference by Mitsuba 3, or another estimator), and the estimators that must agree with it.
//! [`run`] renders and judges all of them, [`outcome`] corrects over the whole run, and
//! [`table`] and [`html`] tell people. [`fault`] plants faults to show that they are found.

pub mod claim;
pub mod closed_form;
pub mod fault;
pub mod folders;
pub mod html;
pub mod outcome;
pub mod reference;
pub mod run;
pub mod table;
