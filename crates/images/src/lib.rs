//! Pixel buffers; reading and writing EXR, PNG, JPEG and HDR, bounded against hostile files
