//! What can be said of a material when it is loaded.

/// What a material can do, known when it is loaded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MaterialFlags {
    /// The most lobes it resolves into.
    pub lobes: usize,
    /// Whether light may go straight on (`null`, `mask`, `thindielectric`).
    pub null: bool,
    /// Whether light may reach the other side at all.
    pub transmission: bool,
    /// Whether light may be bent on its way to the other side, as by an interface of dielectrics.
    pub refraction: bool,
    /// Whether a texture tilts its normals.
    pub tilted: bool,
    /// Whether light leaves elsewhere than it came, which the model puts where the viewer looks: paths from the lights
    /// cannot have it.
    pub one_way: bool,
}

impl MaterialFlags {
    /// One lobe that reflects, whatever its parameters.
    pub(crate) fn reflecting<T>(_: &T) -> Self {
        Self {
            lobes: 1,
            ..Self::default()
        }
    }

    /// What a material can do that is this one or another from point to point, or both at once with all their lobes.
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

    /// One lobe that also refracts, whatever its parameters.
    pub(crate) fn refracting<T>(model: &T) -> Self {
        Self {
            transmission: true,
            refraction: true,
            ..Self::reflecting(model)
        }
    }
}
