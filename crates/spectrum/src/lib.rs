//! Wavelengths, spectra, colour matching, illuminants, RGB to spectrum, refractive indices
