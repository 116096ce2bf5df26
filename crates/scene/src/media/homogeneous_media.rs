//! Homogeneous media: coefficients at the point of entry, and diffusion profiles.

use crate::media::SceneMedia;
use etalon_subsurface::{Homogeneous, MediumAtWavelengths, MediumDescription, ProfileAt};
use etalon_transport::{Coefficients, MediumId, SurfaceInteraction, Textures};
use glam::Vec4;

impl SceneMedia {
    /// A medium, if it is homogeneous.
    pub(crate) fn homogeneous(&self, medium: MediumId) -> Option<&Homogeneous> {
        match self.media.get(self.filling(medium).0 as usize)? {
            MediumDescription::Homogeneous(medium) => Some(medium),
            MediumDescription::Heterogeneous(_) => None,
        }
    }

    /// Whether something holds of any homogeneous medium.
    pub fn any_homogeneous(&self, holds: impl Fn(&Homogeneous) -> bool) -> bool {
        let holds = |medium: &MediumDescription| match medium {
            MediumDescription::Homogeneous(medium) => holds(medium),
            MediumDescription::Heterogeneous(_) => false,
        };
        self.media.iter().any(holds)
    }

    /// The coefficients for paths that enter a medium at a point of its surface, if that is all to know of it.
    #[inline]
    pub fn entry(
        &self,
        medium: MediumId,
        textures: &impl Textures,
        at: &SurfaceInteraction,
        lambda: Vec4,
    ) -> Option<Coefficients> {
        let medium = self.homogeneous(medium)?;
        (!medium.emits()).then(|| medium.coefficients(textures, &at.into(), lambda))
    }

    /// The diffusion profile of a medium below a point, if it has one.
    pub fn profile<'a>(
        &'a self,
        medium: MediumId,
        textures: &impl Textures,
        at: &SurfaceInteraction,
        lambda: Vec4,
    ) -> Option<ProfileAt<'a>> {
        self.homogeneous(medium)?
            .profile(textures, &at.into(), lambda)
    }

    /// A medium at four wavelengths (nm), for a path that entered it where it has these coefficients.
    #[inline]
    pub fn entered<'a, T: Textures>(
        &'a self,
        medium: MediumId,
        coefficients: Coefficients,
        textures: &'a T,
        lambda: Vec4,
    ) -> Option<MediumAtWavelengths<'a, T>> {
        let medium = self.homogeneous(medium)?;
        let medium = medium.entered(coefficients, textures, lambda);
        Some(MediumAtWavelengths::Homogeneous(medium))
    }
}
