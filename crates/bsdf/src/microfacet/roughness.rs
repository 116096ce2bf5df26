//! Reading the roughness of a microfacet model.

use crate::TextureSite;
use crate::inputs::non_negative;
use crate::microfacet::{Kind, LEAST_ALPHA, Microfacet};
use etalon_math::lane::Lane;
use etalon_params::Params;
use etalon_transport::{Build, TextureId, Textures};
use glam::Vec2;

/// The accepted values, for messages.
const ACCEPTED: &str = "0 or more (a roughness below 0.0001 acts as 0.0001)";

/// α with textures.
#[derive(Clone, Debug)]
pub(crate) struct Alphas {
    u: TextureId,
    v: TextureId,
}

impl Alphas {
    /// Reads `alpha`, or `alpha_u` and `alpha_v`, each with `prefix` before its name.
    pub(crate) fn from_params(
        params: &Params<'_>,
        build: &mut dyn Build,
        prefix: &str,
        default: f64,
    ) -> Option<Self> {
        let names = ["alpha", "alpha_u", "alpha_v"].map(|name| format!("{prefix}{name}"));
        let [both, u, v] = &names.each_ref().map(String::as_str);
        let anisotropic = params.has(u) || params.has(v);
        if anisotropic && params.has(both) {
            params.error_at(both, format!("give either `{both}` or `{u}` and `{v}`"));
            params.ignore(&[both, u, v]);
            return None;
        }
        if anisotropic {
            // A missing one of the two is reported by `texture`.
            return Some(Self {
                u: non_negative(params, build, (u, None), ACCEPTED)?,
                v: non_negative(params, build, (v, None), ACCEPTED)?,
            });
        }
        let alpha = non_negative(params, build, (both, Some(default)), ACCEPTED)?;
        Some(Self { u: alpha, v: alpha })
    }

    /// α along x and y at a point.
    #[inline]
    pub(crate) fn at<T: Textures>(&self, site: &TextureSite<'_, T>) -> Vec2 {
        Self::in_lanes::<f32, T>(|_| (self, site)).into()
    }

    /// The same at several points.
    #[inline]
    fn in_lanes<'m, 's, F: Lane, T: Textures + 's>(
        at: impl Fn(usize) -> (&'m Self, &'s TextureSite<'s, T>),
    ) -> [F; 2] {
        let along_x = F::from_fn(|i| {
            let (alphas, site) = at(i);
            site.number(alphas.u)
        });
        let along_y = F::from_fn(|i| {
            let (alphas, site) = at(i);
            match alphas.v == alphas.u {
                true => along_x.lane(i),
                false => site.number(alphas.v),
            }
        });
        [along_x, along_y]
    }
}

/// A textured roughness: `distribution` (beckmann), `alpha` (0.1) or `alpha_u` and `alpha_v`,
/// `sample_visible` (true), and `masking` (separable).
#[derive(Clone, Debug)]
pub struct Roughness {
    kind: Kind,
    alphas: Alphas,
    sample_visible: bool,
    correlated: bool,
}

impl Roughness {
    /// Reads the parameters of the type's documentation.
    pub fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let kind = kind(params);
        let sample_visible = params.boolean_or("sample_visible", true);
        let rules = ["separable", "correlated"];
        let correlated = params.choice("masking", rules[0], &rules) == rules[1];
        Some(Self {
            kind,
            alphas: Alphas::from_params(params, build, "", 0.1)?,
            sample_visible,
            correlated,
        })
    }

    /// The distribution at a point.
    #[inline]
    pub fn resolve<T: Textures>(&self, site: &TextureSite<'_, T>) -> Microfacet {
        Self::in_lanes(|_| (self, site))
    }

    /// The distributions at several points.
    #[inline]
    pub(crate) fn in_lanes<'m, 's, F: Lane, T: Textures + 's>(
        at: impl Fn(usize) -> (&'m Self, &'s TextureSite<'s, T>),
    ) -> Microfacet<F> {
        let alpha = Alphas::in_lanes(|i| {
            let (roughness, site) = at(i);
            (&roughness.alphas, site)
        });
        let distribution =
            Microfacet::in_lanes(|i| at(i).0.kind, alpha, |i| at(i).0.sample_visible);
        distribution.with_correlated(|i| at(i).0.correlated)
    }
}

/// A distribution whose roughness is one number, as `roughplastic` has it.
pub fn constant_from_params(params: &Params<'_>) -> Microfacet {
    let alpha = params.float_where("alpha", 0.1, ACCEPTED, |a| a >= 0.0 && a.is_finite());
    let sample_visible = params.boolean_or("sample_visible", true);
    Microfacet::new(
        kind(params),
        Vec2::splat((alpha as f32).max(LEAST_ALPHA)),
        sample_visible,
    )
}

/// Distributions of Mitsuba 0.6 that are not built: cosᵉ with e = 2/α² − 2, which no α makes one of the others.
const POWERS_OF_COSINES: [&str; 2] = ["as", "phong"];

fn kind(params: &Params<'_>) -> Kind {
    let named = params.string("distribution").unwrap_or_default();
    if POWERS_OF_COSINES
        .iter()
        .any(|name| name.eq_ignore_ascii_case(named))
    {
        let message = format!("the distribution `{named}` of Mitsuba 0.6 is not built");
        let help =
            "accepted: beckmann, ggx; `beckmann` with the same `alpha` comes near for small ones";
        params.error_with_help("distribution", &message, help);
        return Kind::Beckmann;
    }
    match params.choice("distribution", "beckmann", &["beckmann", "ggx"]) {
        "ggx" => Kind::Ggx,
        _ => Kind::Beckmann,
    }
}
