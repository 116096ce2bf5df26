//! `principled`: Burley's material of artists' parameters (see [`crate::models::disney`]), as Mitsuba has it.
//!
//! With m = metallic, t = spec_trans, b = (1 − m) t and GGX of α = roughness²:
//!
//! ```text
//! base          (1 − m)(1 − t) · f of [`crate::models::disney`], with the sheen's factor (1 − m)
//!               or, of `diffuse_model` `lambert`, colour/π (1 − F) in place of lerp(f_d, f_ss, flatness), as glTF 2.0 has it (appendix B.3.5)
//! reflected     F_p D G / (4 cos θo cos θi)
//!   front:      F_p = (1 − m)(1 − spec_tint) F + m S(colour) + (1 − m) spec_tint S(R0 · tint)
//!   back:       F_p = b F
//! transmitted   b √colour · (1 − F) …, see [`crate::models::roughdielectric`]
//! clear coat    ¼ clearcoat · S(0.04) · D₁ · G₁(α = ¼)
//! S(R)          = R + (1 − R)(1 − cos θd)⁵
//! D₁(m)         = (α² − 1) / (π ln α² (1 + (α² − 1) cos² θm)),   α = lerp(0.1, 0.001, clearcoat_gloss)
//! ```
//!
//! η is `eta`, or 2/(1 − √(0.08 specular)) − 1. A tint is the colour over its luminance
//! (a tabulated one over its mean). From behind only the
//! interface is seen. Directions are chosen by the base, the clear coat, or a visible normal, where reflection has the
//! probability 1 − b (1 − F).

mod model;

pub use model::Principled;

use crate::inputs::inputs;
use crate::models::disney::{self, is_used, sampling_rate};
use crate::{MaterialFlags, TextureSite};
use etalon_math::lane::{Lane, Spectral};
use etalon_params::Params;
use etalon_transport::{Build, Textures};
use glam::{Vec3, Vec4};

/// Parameters to test with (see [`crate::test_materials`]).
pub const EXEMPLARS: &[&str] = &[
    "principled",
    "principled base_color=t:400:0.1,700:0.8 metallic=f:0.7 specular=f:0.6 roughness=f:0.4 \
     spec_tint=f:0.4 anisotropic=f:0.5 sheen=f:0.3 sheen_tint=f:0.2 clearcoat=f:0.6 \
     clearcoat_gloss=f:0.1 spec_trans=f:0.4",
    "principled base_color=u:0.9 spec_trans=f:0.9 roughness=f:0.6 eta=f:1.4",
    "principled flatness=f:0.8 roughness=f:0.7 specular=f:0.2",
    "principled metallic=f:1 roughness=f:0.5 base_color=t:400:0.9,700:0.4",
    "principled diffuse_model=s:lambert roughness=f:0.8 metallic=f:0.3 sheen=f:0.2",
];

inputs! {
    /// Parameters, each of which may be a texture.
    Inputs;
    /// Their values at a point.
    Values {
        /// Colour of the base and of metals; squared, the colour of transmission.
        base_color: spectrum = 0.5,
        /// Roughness; α is its square.
        roughness: share = 0.5,
        /// How much the roughness differs along x and y.
        anisotropic: share = 0.0,
        /// The share of metal.
        metallic: share = 0.0,
        /// Transmitting share of the non-metal.
        spec_trans: share = 0.0,
        /// How much the base's colour tints the reflection.
        spec_tint: share = 0.0,
        /// Sheen.
        sheen: amount = 0.0,
        /// How much the base's colour tints the sheen.
        sheen_tint: share = 0.0,
        /// The share of a base that scatters below the surface.
        flatness: share = 0.0,
        /// The clear coat.
        clearcoat: amount = 0.0,
        /// How smooth the clear coat is.
        clearcoat_gloss: share = 0.0,
    }
}

/// `principled` in a scene file.
#[derive(Clone, Debug)]
pub struct Description {
    inputs: Inputs,
    eta: f32,
    transmits: bool,
    lambert: bool,
    /// Sampling rates of the base, the main interface and the clear coat.
    rates: Vec3,
}

impl Description {
    /// Reads [`Inputs`], `eta` or `specular` (0.5), `diffuse_model` (burley), and the rates `diffuse_reflectance_sampling_rate`,
    /// `main_specular_sampling_rate` and `clearcoat_sampling_rate` (1).
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let rate = |name: &str| sampling_rate(params, name);
        let rates = Vec3::new(
            rate("diffuse_reflectance_sampling_rate"),
            rate("main_specular_sampling_rate"),
            rate("clearcoat_sampling_rate"),
        );
        let transmits = is_used(params, "spec_trans");
        let eta = if params.has("eta") {
            if params.has("specular") {
                params.error_at("specular", "give either `eta` or `specular`");
                params.ignore(&["specular"]);
            }
            let positive = |eta: f64| eta > 0.0 && eta.is_finite();
            params.float_where("eta", 1.5, "a positive finite number", positive)
        } else {
            let accepted = "a number from 0 to below 12.5";
            let fits = |s: f64| (0.0..12.5).contains(&s);
            let specular = params.float_where("specular", 0.5, accepted, fits);
            // A transmitting material needs an interface.
            let least = if transmits { 1e-3 } else { 0.0 };
            2.0 / (1.0 - (0.08 * specular.max(least)).sqrt()) - 1.0
        };
        Some(Self {
            inputs: Inputs::from_params(params, build),
            eta: if transmits && eta == 1.0 {
                1.001
            } else {
                eta as f32
            },
            transmits,
            lambert: params.choice("diffuse_model", "burley", &["burley", "lambert"]) == "lambert",
            rates,
        })
    }

    /// Its flags.
    pub fn flags(&self) -> MaterialFlags {
        match self.transmits {
            true => MaterialFlags::refracting(self),
            false => MaterialFlags::reflecting(self),
        }
    }

    /// The model at a point.
    #[inline]
    pub fn resolve<T: Textures>(&self, site: &TextureSite<'_, T>) -> Principled {
        let at = self.inputs.at(site);
        let tinted = at.spec_tint > 0.0 || at.sheen_tint > 0.0;
        let tint = disney::tint(site, self.inputs.base_color, at.base_color, tinted);
        let dielectric = 1.0 - at.metallic;
        let spec_trans = if self.transmits { at.spec_trans } else { 0.0 };
        let diffuse = dielectric * (1.0 - spec_trans);
        let rates = Vec3::new(diffuse, 1.0, 0.25 * at.clearcoat) * self.rates;
        let total = rates.element_sum();
        Principled {
            colour: at.base_color,
            tint,
            alpha: disney::microfacet(at.roughness, at.anisotropic).alpha,
            eta: self.eta,
            metallic: at.metallic,
            through: dielectric * spec_trans,
            tinted: dielectric * at.spec_tint,
            roughness: at.roughness,
            flatness: at.flatness,
            lambert: f32::from(u8::from(self.lambert)),
            sheen: dielectric * at.sheen,
            sheen_tint: at.sheen_tint,
            clearcoat: at.clearcoat,
            coat_alpha: 0.1 + at.clearcoat_gloss * (0.001 - 0.1),
            base_probability: if total > 0.0 { rates.x / total } else { 0.0 },
            coat_probability: if total > 0.0 { rates.z / total } else { 0.0 },
        }
    }

    /// Whether light may be transmitted.
    pub(crate) fn transmits(&self) -> bool {
        self.transmits
    }

    /// The models at several points.
    #[inline]
    pub(crate) fn in_lanes<'m, 's, F: Lane, T: Textures + 's>(
        at: impl Fn(usize) -> (&'m Self, &'s TextureSite<'s, T>),
    ) -> Principled<F> {
        let each = F::array(|i| {
            let (description, site) = at(i);
            description.resolve(site)
        });
        let each = each.as_ref();
        let spectrum = |of: fn(&Principled) -> Vec4| F::Spectrum::of_lanes(|i| of(&each[i]));
        let number = |of: fn(&Principled) -> f32| F::from_fn(|i| of(&each[i]));
        Principled {
            colour: spectrum(|one| one.colour),
            tint: spectrum(|one| one.tint),
            alpha: [number(|one| one.alpha[0]), number(|one| one.alpha[1])],
            eta: number(|one| one.eta),
            metallic: number(|one| one.metallic),
            through: number(|one| one.through),
            tinted: number(|one| one.tinted),
            roughness: number(|one| one.roughness),
            flatness: number(|one| one.flatness),
            lambert: number(|one| one.lambert),
            sheen: number(|one| one.sheen),
            sheen_tint: number(|one| one.sheen_tint),
            clearcoat: number(|one| one.clearcoat),
            coat_alpha: number(|one| one.coat_alpha),
            base_probability: number(|one| one.base_probability),
            coat_probability: number(|one| one.coat_probability),
        }
    }
}
