//! The feed, the layers, and what the server refuses.
