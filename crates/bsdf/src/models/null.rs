//! An interface that light crosses as if it were not there: f = 1 in the direction −wo only.
//!
//! It separates media without scattering. Mitsuba's plugin of that name.

use crate::{LobeList, MaterialFlags, ShadingContext};
use etalon_math::Frame;
use etalon_params::Params;
use etalon_transport::{Build, Textures};
use glam::Vec4;

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &["null"];

/// `null` in a scene file; it has no parameters.
#[derive(Clone, Debug)]
pub struct Description;

impl Description {
    /// Reads nothing.
    pub fn from_params(_: &Params<'_>, _: &mut dyn Build) -> Option<Self> {
        Some(Self)
    }

    /// Nothing but passing light.
    pub fn traits(&self) -> MaterialFlags {
        MaterialFlags {
            null: true,
            transmission: true,
            ..MaterialFlags::default()
        }
    }

    /// All of the share `weight` passes.
    pub fn flatten<T: Textures>(
        &self,
        _: &ShadingContext<'_, T>,
        _: Frame,
        weight: f32,
        into: &mut LobeList<'_>,
    ) {
        into.pass(Vec4::splat(weight), weight);
    }
}
