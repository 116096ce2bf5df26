//! Spectra and images that vary over surfaces
