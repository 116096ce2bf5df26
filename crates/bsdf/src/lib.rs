//! Scattering models, one file each, and their resolution at a hit
