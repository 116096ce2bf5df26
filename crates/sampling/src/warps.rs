//! Maps from the unit square to other domains, with their densities and inverses.
