//! Shapes, instances and accelerators
