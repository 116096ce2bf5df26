//! One-sided materials on either side of a surface.
//!
//! The side is that of the known direction, by the shading normal; the back is the mirror image of a front,
//!
//! ```text
//! f(ωo, ωi) = f_back(M ωo, M ωi)    from behind, with M (x, y, z) = (x, y, −z)
//! ```
//!
//! so that both see the light from their own front, and what lies along the tangents stays there. One material serves
//! both sides unless a second is given for the back. Mitsuba's plugin of that name.

use crate::{LobeList, Material, MaterialFlags, ShadingContext};
use etalon_math::Frame;
use etalon_params::{Class, Diagnostic, Params};
use etalon_transport::{Build, LaneKind, LegacyPhong, Textures};

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &[
    "twosided ( diffuse )",
    "twosided ( roughconductor alpha_u=f:0.2 alpha_v=f:0.5 ) ( diffuse reflectance=u:0.2 )",
];

/// `twosided` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    front: Box<Material>,
    back: Option<Box<Material>>,
}

impl Description {
    /// Reads one or two nested materials, which may let no light through unless
    /// `allow_transmission` (false).
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let allowed = params.boolean_or("allow_transmission", false);
        let (front, back) = if params.children(Class::Bsdf).len() > 1 {
            let [front, back] = Material::nested_or_classic::<2>(params, build)?;
            (front, Some(Box::new(back)))
        } else {
            let [front] = Material::nested_or_classic::<1>(params, build)?;
            (front, None)
        };
        let description = Self {
            front: Box::new(front),
            back,
        };
        if description.traits().transmission && !allowed {
            params.diagnostics.push(
                Diagnostic::error(
                    params.node.plugin.span,
                    "`twosided` takes materials that let no light through",
                )
                .help(
                    "put `mask` around `twosided`, not inside; drop `twosided` around a \
                     dielectric; or set `allow_transmission`",
                ),
            );
            return None;
        }
        Some(description)
    }

    /// The union of both sides' flags.
    pub fn traits(&self) -> MaterialFlags {
        let a = self.front.traits();
        let b = self.back.as_ref().map_or(a, |back| back.traits());
        MaterialFlags {
            lobes: a.lobes.max(b.lobes),
            ..a.with(b)
        }
    }

    /// The material of the side where `wo` lies, and its frame.
    fn side<T: Textures>(
        &self,
        site: &ShadingContext<'_, T>,
        frame: Frame,
    ) -> Option<(&Material, Frame)> {
        let cos = frame.n.dot(site.wo);
        if cos > 0.0 {
            Some((&self.front, frame))
        } else if cos < 0.0 {
            Some((self.back.as_ref().unwrap_or(&self.front), frame.mirrored()))
        } else {
            None
        }
    }

    /// The kind of both sides.
    pub(crate) fn lane_kind(&self) -> Option<LaneKind> {
        let plain = |side: &Material| match side {
            Material::TwoSided(_) => None,
            side => side.lane_kind(),
        };
        let kind = plain(&self.front)?;
        let mut sides = self.nested();
        sides.all(|side| plain(side) == Some(kind)).then_some(kind)
    }

    /// The material of the front or the back.
    #[inline]
    pub(crate) fn lane_side(&self, back: bool) -> &Material {
        match &self.back {
            Some(other) if back => other,
            _ => &self.front,
        }
    }

    /// Those of both sides.
    pub fn nested(&self) -> impl Iterator<Item = &Material> {
        std::iter::once(&self.front)
            .chain(&self.back)
            .map(|side| &**side)
    }

    /// The classic Phong material of the side where `wo` lies, if it is one.
    pub fn classic<T: Textures>(
        &self,
        site: &ShadingContext<'_, T>,
        frame: Frame,
    ) -> Option<LegacyPhong> {
        let (material, frame) = self.side(site, frame)?;
        material.classic(site, frame)
    }

    /// The material of the side where `wo` lies; none for a direction in the surface itself.
    pub fn flatten<'a, T: Textures>(
        &'a self,
        site: &ShadingContext<'_, T>,
        frame: Frame,
        weight: f32,
        into: &mut LobeList<'a>,
    ) {
        if let Some((material, frame)) = self.side(site, frame) {
            material.flatten(site, frame, weight, into);
        }
    }
}
