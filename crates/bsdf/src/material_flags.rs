//! Properties of a material that are known when it is loaded.

/// Properties of a material that are known when it is loaded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MaterialFlags {
    /// The largest number of lobes that it resolves into.
    pub lobes: usize,
    /// Whether it has a null interaction (`null`, `mask`, `thindielectric`).
    pub null: bool,
    /// Whether light may be transmitted.
    pub transmission: bool,
    /// Whether transmitted light may be refracted, as at a dielectric interface.
    pub refraction: bool,
    /// Whether a texture tilts its normals.
    pub tilted: bool,
    /// Non-reciprocal: valid for camera paths only (hair, where light leaves at another point than it enters).
    pub one_way: bool,
}

impl MaterialFlags {
    /// One lobe that only reflects.
    pub(crate) fn reflecting<T>(_: &T) -> Self {
        Self {
            lobes: 1,
            ..Self::default()
        }
    }

    /// The union of two materials' flags.
    pub(crate) fn with(self, other: Self) -> Self {
        Self {
            lobes: self.lobes + other.lobes,
            null: self.null || other.null,
            transmission: self.transmission || other.transmission,
            refraction: self.refraction || other.refraction,
            tilted: self.tilted || other.tilted,
            one_way: self.one_way || other.one_way,
        }
    }

    /// One lobe that reflects and refracts.
    pub(crate) fn refracting<T>(model: &T) -> Self {
        Self {
            transmission: true,
            refraction: true,
            ..Self::reflecting(model)
        }
    }
}
