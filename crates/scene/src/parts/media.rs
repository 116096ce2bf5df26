//! The media of a scene.

use super::Parts;
use crate::scene_tables::SceneTables;
use etalon_spectrum::Wavelengths;
use etalon_subsurface::MediumAtWavelengths;
use etalon_transport::{Media, MediumId, SurfaceInteraction};

impl Media for Parts {
    type Medium<'w> = MediumAtWavelengths<'w, SceneTables>;

    #[inline]
    fn around_camera(&self) -> MediumId {
        self.camera_medium
    }

    #[inline]
    fn enter(
        &self,
        medium: MediumId,
        at: Option<&SurfaceInteraction>,
        wavelengths: &Wavelengths,
    ) -> Option<Self::Medium<'_>> {
        (self.space.media).enter(medium, at, &self.space.lookup, wavelengths.lambda)
    }
}
