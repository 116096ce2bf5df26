//! Claims, references and the report of `cargo xtask validate`
