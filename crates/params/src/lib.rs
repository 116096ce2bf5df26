//! The description tree: typed properties with source positions, used-marks and diagnostics
