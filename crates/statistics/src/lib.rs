//! Exact accumulators, moments, hypothesis and equivalence tests, multiplicity
