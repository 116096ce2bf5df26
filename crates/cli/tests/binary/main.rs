//! The binary from outside: what users type and what they get.
//!
//! One concern per file; [`workshop`] is the folder they work in.

mod adaptive;
mod bad_files;
mod bad_scenes;
mod blocks;
mod command_line;
mod compare;
mod conform;
mod convert;
mod denoise;
mod determinism;
mod docs;
mod docs_pages;
mod docs_plugins;
mod estimators;
mod estimators_length;
mod failure;
mod farm;
mod field_scenes;
mod frames;
mod framing;
mod gltf;
mod info;
mod integrators;
mod interrupt;
mod media;
mod merge;
mod mutations;
mod outputs;
mod pbrt;
mod preview;
mod render;
mod replay;
mod replicates;
mod resume;
mod spectral;
mod statistics;
mod strategies;
mod subsurface;
mod target;
mod trouble;
mod whitted;
mod workshop;
mod write_guard;
