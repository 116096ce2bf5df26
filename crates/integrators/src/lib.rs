//! Estimators of light transport, one file each, and the render loop
