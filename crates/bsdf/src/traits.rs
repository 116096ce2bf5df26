//! What can be said of a material when it is loaded.

/// What a material can do, known when it is loaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MaterialFlags {
    /// The most lobes it resolves into.
    pub lobes: usize,
    /// Whether light may go straight on (`null`, `mask`, `thindielectric`).
    pub null: bool,
    /// Whether light may reach the other side at all.
    pub transmission: bool,
    /// Whether a texture tilts its normals.
    pub tilted: bool,
}

impl MaterialFlags {
    /// One lobe that reflects, whatever its parameters.
    pub(crate) fn reflecting<T>(_: &T) -> Self {
        Self {
            lobes: 1,
            null: false,
            transmission: false,
            tilted: false,
        }
    }

    /// One lobe that also transmits, whatever its parameters.
    pub(crate) fn refracting<T>(model: &T) -> Self {
        Self {
            transmission: true,
            ..Self::reflecting(model)
        }
    }
}
