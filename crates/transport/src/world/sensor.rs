//! The sensor of a scene: which wavelengths a path has, and what they come to.

use etalon_spectrum::{SensorWeights, Wavelengths};

/// A sensor.
pub trait Sensor: Sync {
    /// Draws the wavelengths of a path.
    fn wavelengths(&self, u: f32) -> Wavelengths;

    /// What the sensor makes of the light at these wavelengths.
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
