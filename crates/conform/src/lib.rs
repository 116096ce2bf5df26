//! Questions with known answers, to any renderer.
//!
//! A *question* is a small scene whose picture is known in closed form ([`questions`], [`truth`]). It is posed several times,
//! turned and grown at random ([`pose`]), as a [`scene`] that needs no reader of ours. A *driver* ([`driver`]) has another program render
//! it, each time with a seed of its own. What comes back is [`judge`]d by the statistics of replicates: it *agrees* with the
//! truth within a bound, *differs* from it, or is *undecided*; nothing is ever asked to be equal.

pub mod badge;
mod copies;
pub mod driver;
pub mod drivers;
pub mod folder;
pub mod job;
pub mod judge;
pub mod mitsuba_xml;
pub mod mode;
pub mod null_programs;
pub mod page;
pub mod pbrt_scene;
pub mod plan;
pub mod pose;
pub mod question;
pub mod questions;
pub mod refinement;
pub mod replicate;
pub mod report;
pub mod rules;
pub mod runner;
pub mod scene;
pub mod scene_format;
pub mod suite;
mod suspicion;
pub mod tier;
pub mod tile;
pub mod truth;
