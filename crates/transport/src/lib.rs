//! Nouns and contracts of light transport; no implementation
