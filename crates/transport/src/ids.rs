//! Small copyable names of things in a scene.

macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub struct $name(pub u32);

        impl $name {
            /// The absence of one.
            pub const NONE: Self = Self(u32::MAX);

            /// Whether it names anything.
            #[inline]
            pub fn is_some(self) -> bool {
                self != Self::NONE
            }
        }
    };
}

id!(
    /// A shape (a sphere, a whole mesh).
    ShapeId
);
id!(
    /// A placed copy of a group of shapes.
    InstanceId
);
id!(
    /// A material: a scattering model with its textures.
    MaterialId
);
id!(
    /// A participating medium; none is empty space.
    MediumId
);
id!(
    /// A light source.
    LightId
);
id!(
    /// A texture or spectrum.
    TextureId
);
