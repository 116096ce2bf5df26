//! The slab over a base, as a scene describes it and at a point.

use crate::ShadingContext;
use crate::inputs::non_negative;
use crate::interface::relative_index::{RelativeIndex, number_from_params};
use crate::layers::interface::Interface;
use crate::layers::numbers::place_key;
use crate::microfacet::roughness::Alphas;
use etalon_params::Params;
use etalon_transport::{Build, SpectrumKind, TextureId, Textures};
use glam::{Vec2, Vec4};

/// The default of `int_ior`.
const INTERIOR: &str = "bk7";

/// A slab with textures.
#[derive(Clone, Debug)]
pub(crate) struct SlabDescription {
    /// The slab's index of refraction.
    pub(crate) interior: f64,
    eta: f32,
    alphas: Alphas,
    thickness: TextureId,
    albedo: TextureId,
    g: f32,
    max_depth: u16,
    samples: u16,
}

impl SlabDescription {
    /// Reads `int_ior` (bk7) and `ext_ior` (air); the interface's `alpha`, or `alpha_u` and `alpha_v` (0: smooth); the optical
    /// `thickness` of what is inside (0.01), its `albedo` (0) and `g` (0); and of the walks their `max_depth` (10) and
    /// `samples` (1).
    pub(crate) fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let eta = RelativeIndex::constant_from_params(params, INTERIOR)? as f32;
        let interior = number_from_params(params, "int_ior", INTERIOR)?;
        let alphas = Alphas::from_params(params, build, "", 0.0);
        let what = "0 or more";
        let thickness = non_negative(params, build, ("thickness", Some(0.01)), what);
        let albedo = build.texture(params, "albedo", Some(0.0), SpectrumKind::Reflectance);
        let g = params.float_where("g", 0.0, "a number between -1 and 1", |g| g.abs() < 1.0) as f32;
        let count = |name: &str, default: u16| {
            let number = params.integer_or(name, i64::from(default));
            match u16::try_from(number) {
                Ok(count @ 1..) => count,
                _ => {
                    params.refuse(name, number, &format!("1 … {}", u16::MAX));
                    default
                }
            }
        };
        Some(Self {
            interior,
            eta,
            max_depth: count("max_depth", 10),
            samples: count("samples", 1),
            alphas: alphas?,
            thickness: thickness?,
            albedo,
            // Near 0 the inverse distribution function loses digits.
            g: if g.abs() < 1e-3 { 0.0 } else { g },
        })
    }

    /// The slab at a point.
    pub(crate) fn resolve<T: Textures>(&self, site: &ShadingContext<'_, T>) -> Slab {
        Slab {
            interface: Interface {
                eta: self.eta,
                alpha: self.alphas.at(site),
            },
            thickness: site.number(self.thickness).max(0.0),
            albedo: site.spectrum(self.albedo).clamp(Vec4::ZERO, Vec4::ONE),
            g: self.g,
            max_depth: self.max_depth,
            samples: self.samples,
            key: place_key(site.vertex.position, site.lambda),
        }
    }
}

/// A slab at a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slab {
    pub(crate) interface: Interface,
    /// Extinction times thickness.
    pub(crate) thickness: f32,
    /// The share of what collides inside that is scattered, per lane.
    pub(crate) albedo: Vec4,
    /// Mean cosine of scattering.
    pub(crate) g: f32,
    /// The most events inside of a walk.
    pub(crate) max_depth: u16,
    /// The walks that a value is the mean of.
    pub(crate) samples: u16,
    /// The key of the place and the wavelengths.
    pub(crate) key: u64,
}

impl Slab {
    /// Whether its inside scatters.
    #[inline]
    pub(crate) fn scatters(&self) -> bool {
        self.thickness > 0.0 && self.albedo.max_element() > 0.0
    }

    /// The roughness of what a base of roughness `base` shows outside, nearly: slopes of the base turn light by η times as much
    /// outside as inside, and the interface turns it twice by η − 1 times its own.
    #[inline]
    pub(crate) fn seen_alpha(&self, base: Vec2) -> Vec2 {
        let Interface { eta, alpha } = self.interface;
        let turned = (eta - 1.0) * alpha;
        let squared = eta * eta * base * base + 2.0 * turned * turned;
        Vec2::new(squared.x.sqrt(), squared.y.sqrt()).clamp(Vec2::splat(1e-3), Vec2::ONE)
    }
}
