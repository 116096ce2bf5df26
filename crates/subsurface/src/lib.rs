//! Phase functions, media and subsurface scattering
