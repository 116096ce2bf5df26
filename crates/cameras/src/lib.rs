//! Cameras: each makes rays and can be connected to
