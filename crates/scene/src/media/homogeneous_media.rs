//! Which media are homogeneous.

use crate::media::SceneMedia;
use etalon_subsurface::{Homogeneous, MediumDescription};
use etalon_transport::MediumId;

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
}
