//! The description tree: the contents of a scene file, independent of their meaning.
//!
//! A [`Node`] is one object (`<bsdf type="diffuse">`), with typed [`Property`] values. Every node,
//! name and value keeps its [`Span`] in the [`Sources`], so that a mistake found much later can
//! still be shown with its file, line, column and a caret. A plugin reads its node through
//! [`Params`], which records every mistake in [`Diagnostics`] and marks the properties that were
//! read.

pub mod diagnostic;
mod expression;
pub mod field_of_view;
pub mod ignored;
pub mod node;
pub mod parameter_kind;
pub mod params;
pub mod plugins;
pub mod questions;
pub mod source;
pub mod suggest;
pub mod unbuilt;
pub mod unused;

pub use diagnostic::{Diagnostic, Diagnostics, Severity};
pub use glam::{DMat4, DVec3};
pub use node::{Class, Node, Property, Spanned, SpectrumText, Value};
pub use parameter_kind::ParameterKind;
pub use params::Params;
pub use source::{FileId, Sources, Span};
