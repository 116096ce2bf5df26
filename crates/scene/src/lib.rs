//! Compiles a description tree into an immutable scene
