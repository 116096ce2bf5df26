//! A shading normal that a texture tilts, as `normalmap` and `bumpmap` do.
//!
//! Directions are in the frame of the surface; n is the tilted normal there, and the model's own frame is
//! built around it. Light from ωi counts where both normals see it on the same side, and there only
//!
//! ```text
//! G(ωi) = 2 / (1 + √(1 + α² tan² θi)),   α² = min(tan² θn / 8, 1)
//! ```
//!
//! which takes the hard edge from its terminator (A. Conty Estevez, P. Lecocq, C. Stein, A microfacet-based shadowing
//! function to solve the bump terminator problem, Ray Tracing Gems, 2019). A normal that the viewer sees from
//! behind is turned about the surface's, n → (−x, −y, z) (V. Schüssler et al., Microfacet-based normal mapping, 2017, as
//! Mitsuba has it; not for `plastic`, which has both a discrete and a continuous lobe). Both rules distinguish light from
//! viewer, so importance is scattered by the adjoint.
//!
//! A relief has two sides, for any nested material: the side behind n has the normal −n, and so has the back of `twosided`
//! inside a map. Around a map, the back of `twosided` is the mirror image of the front.

use crate::{LobeList, Material, MaterialFlags, ShadingContext};
use etalon_math::Frame;
use etalon_params::Params;
use etalon_transport::{Build, LegacyPhong, Textures};
use glam::Vec3;

/// A tilted normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tilt {
    /// n (unit, in the surface's frame).
    pub normal: Vec3,
    /// Whether a normal that is not seen is turned.
    pub flips: bool,
    /// Whether G counts.
    pub shadows: bool,
}

impl Tilt {
    /// A normal of any length; that of the surface if it has no direction.
    pub fn new(normal: Vec3, flips: bool, shadows: bool) -> Self {
        Self {
            normal: normal.try_normalize().unwrap_or(Vec3::Z),
            flips,
            shadows,
        }
    }

    /// The model's frame, in the surface's, for a viewer in the direction `view`.
    #[inline]
    pub fn frame(&self, view: Vec3) -> Frame {
        let n = self.normal;
        if self.flips && view.z * view.dot(n) <= 0.0 {
            self.turned()
        } else {
            Frame::from_normal_and_tangent(n, Vec3::X)
        }
    }

    fn turned(&self) -> Frame {
        let n = self.normal;
        Frame::from_normal_and_tangent(Vec3::new(-n.x, -n.y, n.z), Vec3::X)
    }

    /// The model's frame for viewers who see the normal, and for those who do not.
    pub fn both(&self) -> [Frame; 2] {
        [
            Frame::from_normal_and_tangent(self.normal, Vec3::X),
            self.turned(),
        ]
    }

    /// Shadowing of light from `light`, with the model's frame `seen`.
    #[inline]
    pub fn shadowing(&self, seen: &Frame, light: Vec3) -> f32 {
        if !(light.z * light.dot(seen.n) > 0.0) {
            return 0.0;
        }
        if !self.shadows {
            return 1.0;
        }
        let tan_squared = |v: Vec3| (1.0 - v.z * v.z).max(0.0) / (v.z * v.z);
        let alpha_squared = (0.125 * tan_squared(seen.n)).min(1.0);
        2.0 / (1.0 + (1.0 + alpha_squared * tan_squared(light)).sqrt())
    }
}

/// A nested material whose normals are tilted: what `normalmap` and `bumpmap` share.
#[derive(Clone, Debug)]
pub(crate) struct Tilted {
    flips: bool,
    shadows: bool,
    nested: Box<Material>,
}

impl Tilted {
    /// Reads `flip_invalid_normals`, `use_shadowing_function` and the nested material.
    pub(crate) fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let flips = params.boolean_or("flip_invalid_normals", true);
        let shadows = params.boolean_or("use_shadowing_function", true);
        let [nested] = Material::nested_or_classic::<1>(params, build)?;
        if nested.traits().tilted {
            let name = &params.node.plugin.value;
            let message = format!("`{name}` cannot hold another material that tilts normals");
            params.error(message);
            return None;
        }
        Some(Self {
            flips,
            shadows,
            nested: Box::new(nested),
        })
    }

    /// The flags of the nested material.
    pub(crate) fn traits(&self) -> MaterialFlags {
        MaterialFlags {
            tilted: true,
            ..self.nested.traits()
        }
    }

    /// The nested material.
    pub(crate) fn nested(&self) -> &Material {
        &self.nested
    }

    /// The nested classic Phong material with the normal `normal`, of any length, in `frame`. Light counts by its angle with the
    /// tilted normal alone, without G, as the model has it.
    pub(crate) fn classic<T: Textures>(
        &self,
        site: &ShadingContext<'_, T>,
        frame: Frame,
        normal: Vec3,
    ) -> Option<LegacyPhong> {
        let tilt = Tilt::new(normal, self.flips, self.shadows);
        let seen = tilt.frame(frame.to_local(site.wo)).n;
        (self.nested).classic(site, Frame::from_normal(frame.to_world(seen)))
    }

    /// The nested material's lobes with the normal `normal`, of any length, in `frame`.
    pub(crate) fn flatten<'a, T: Textures>(
        &'a self,
        site: &ShadingContext<'_, T>,
        frame: Frame,
        weight: f32,
        normal: Vec3,
        into: &mut LobeList<'a>,
    ) {
        let tilt = Tilt::new(normal, self.flips, self.shadows);
        into.tilted(tilt, frame, |into| {
            self.nested.flatten(site, frame, weight, into)
        });
    }
}
