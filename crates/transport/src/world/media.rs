//! The participating media of a scene.

use crate::{
    Coefficients, DiffusionProfile, Medium, MediumId, NoProfile, SurfaceInteraction, Vacuum,
};
use etalon_spectrum::Wavelengths;

/// Media by id.
pub trait Media: Sync {
    /// A medium at a path's wavelengths.
    type Medium<'w>: Medium
    where
        Self: 'w;

    /// The medium that the camera is in.
    fn around_camera(&self) -> MediumId;

    /// A medium; `None` in empty space.
    fn medium(&self, medium: MediumId, wavelengths: &Wavelengths) -> Option<Self::Medium<'_>>;

    /// Whether no light enters a medium through null surfaces, so that light sampling in it is futile. `false` is a safe
    /// answer.
    fn is_dark(&self, medium: MediumId) -> bool;

    /// The coefficients of a homogeneous medium for a path that enters it at the surface point `at`; they may vary over
    /// the surface. The path keeps them for [`Media::entered`]. `None` for other media.
    fn entry(
        &self,
        medium: MediumId,
        at: &SurfaceInteraction,
        wavelengths: &Wavelengths,
    ) -> Option<Coefficients>;

    /// The medium of a path that entered it with these coefficients ([`Media::entry`]).
    fn entered(
        &self,
        medium: MediumId,
        coefficients: Coefficients,
        wavelengths: &Wavelengths,
    ) -> Option<Self::Medium<'_>>;

    /// The diffusion profile that replaces random walks in a medium below the surface point `at`, if it has one.
    fn diffusion(
        &self,
        medium: MediumId,
        at: &SurfaceInteraction,
        wavelengths: &Wavelengths,
    ) -> Option<impl DiffusionProfile>;
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
    fn medium(&self, _: MediumId, _: &Wavelengths) -> Option<Vacuum> {
        None
    }

    #[inline]
    fn is_dark(&self, _: MediumId) -> bool {
        false
    }

    #[inline]
    fn entry(&self, _: MediumId, _: &SurfaceInteraction, _: &Wavelengths) -> Option<Coefficients> {
        None
    }

    #[inline]
    fn entered(&self, _: MediumId, _: Coefficients, _: &Wavelengths) -> Option<Vacuum> {
        None
    }

    #[inline]
    fn diffusion(
        &self,
        _: MediumId,
        _: &SurfaceInteraction,
        _: &Wavelengths,
    ) -> Option<impl DiffusionProfile> {
        None::<NoProfile>
    }
}
