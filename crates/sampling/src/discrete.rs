//! Discrete distributions and piecewise tables.
