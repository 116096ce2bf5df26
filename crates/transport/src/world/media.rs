//! The participating media of a scene.

use crate::{Medium, MediumId, SurfaceInteraction, Vacuum};
use etalon_spectrum::Wavelengths;

/// Media by id.
pub trait Media: Sync {
    /// A medium at a path's wavelengths.
    type Medium<'w>: Medium
    where
        Self: 'w;

    /// The medium that the camera is in.
    fn around_camera(&self) -> MediumId;

    /// The medium of a path that enters it at the surface point `at`, over which its coefficients may vary; `None` for `at` is a
    /// point that is not on the surface. The path keeps it until it enters another. `None` in empty space.
    fn enter(
        &self,
        medium: MediumId,
        at: Option<&SurfaceInteraction>,
        wavelengths: &Wavelengths,
    ) -> Option<Self::Medium<'_>>;
}

/// The media of worlds that have none.
#[derive(Clone, Copy, Debug)]
pub struct NoMedia;

impl Media for NoMedia {
    type Medium<'w> = Vacuum;

    #[inline]
    fn around_camera(&self) -> MediumId {
        MediumId::NONE
    }

    #[inline]
    fn enter(
        &self,
        _: MediumId,
        _: Option<&SurfaceInteraction>,
        _: &Wavelengths,
    ) -> Option<Vacuum> {
        None
    }
}
