//! The sensor of a scene: the distribution of wavelengths, and their weights for the film's channels.

use etalon_spectrum::{SensorWeights, Wavelengths};

/// A sensor.
pub trait Sensor: Sync {
    /// Draws the wavelengths of a path.
    fn wavelengths(&self, u: f32) -> Wavelengths;

    /// The weights of light at these wavelengths for the film's channels.
    fn weights(&self, wavelengths: &Wavelengths) -> SensorWeights;
}

impl Sensor for etalon_spectrum::Sensor {
    #[inline]
    fn wavelengths(&self, u: f32) -> Wavelengths {
        self.sample(u)
    }

    #[inline]
    fn weights(&self, wavelengths: &Wavelengths) -> SensorWeights {
        Self::weights(self, wavelengths)
    }
}
