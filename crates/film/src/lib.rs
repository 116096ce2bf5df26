//! Reconstruction filters, exact accumulation per pixel, tile means, replicates
