//! The media of a scene.

use super::Parts;
use crate::scene_tables::SceneTables;
use crate::space::Space;
use etalon_spectrum::Wavelengths;
use etalon_subsurface::MediumAtWavelengths;
use etalon_transport::{Coefficients, DiffusionProfile, Media, MediumId, SurfaceInteraction};

impl Media for Parts {
    type Medium<'w> = MediumAtWavelengths<'w, SceneTables>;

    #[inline]
    fn around_camera(&self) -> MediumId {
        self.camera_medium
    }

    #[inline]
    fn medium(&self, medium: MediumId, wavelengths: &Wavelengths) -> Option<Self::Medium<'_>> {
        self.space
            .media
            .at(medium, &self.space.lookup, wavelengths.lambda)
    }

    #[inline]
    fn is_dark(&self, medium: MediumId) -> bool {
        self.space.media.is_dark(medium)
    }

    #[inline]
    fn entry(
        &self,
        medium: MediumId,
        at: &SurfaceInteraction,
        wavelengths: &Wavelengths,
    ) -> Option<Coefficients> {
        (self.space.media).entry(medium, &self.space.lookup, at, wavelengths.lambda)
    }

    #[inline]
    fn entered(
        &self,
        medium: MediumId,
        coefficients: Coefficients,
        wavelengths: &Wavelengths,
    ) -> Option<Self::Medium<'_>> {
        let Space { media, lookup, .. } = &self.space;
        media.entered(medium, coefficients, lookup, wavelengths.lambda)
    }

    #[inline]
    fn diffusion(
        &self,
        medium: MediumId,
        at: &SurfaceInteraction,
        wavelengths: &Wavelengths,
    ) -> Option<impl DiffusionProfile> {
        (self.space.media).profile(medium, &self.space.lookup, at, wavelengths.lambda)
    }
}
