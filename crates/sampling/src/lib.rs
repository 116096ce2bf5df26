//! Samplers, random streams, low-discrepancy sequences, warps, discrete and piecewise distributions
