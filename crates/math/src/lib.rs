//! Frames, transforms, densities with their measure, error bounds, polynomial roots
