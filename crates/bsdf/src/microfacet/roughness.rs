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

/// A textured roughness: `distribution` (beckmann), `alpha` (0.1) or `alpha_u` and `alpha_v`,
/// `sample_visible` (true), and `masking` (separable).
#[derive(Clone, Debug)]
pub struct Roughness {
    kind: Kind,
    alpha_u: TextureId,
    alpha_v: TextureId,
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
        let anisotropic = params.has("alpha_u") || params.has("alpha_v");
        if anisotropic && params.has("alpha") {
            params.error_at("alpha", "give either `alpha` or `alpha_u` and `alpha_v`");
            params.ignore(&["alpha", "alpha_u", "alpha_v"]);
            return None;
        }
        let (alpha_u, alpha_v) = if anisotropic {
            // A missing one of the two is reported by `texture`.
            (
                non_negative(params, build, ("alpha_u", None), ACCEPTED)?,
                non_negative(params, build, ("alpha_v", None), ACCEPTED)?,
            )
        } else {
            let alpha = non_negative(params, build, ("alpha", Some(0.1)), ACCEPTED)?;
            (alpha, alpha)
        };
        Some(Self {
            kind,
            alpha_u,
            alpha_v,
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
        let along_x = F::from_fn(|i| {
            let (roughness, site) = at(i);
            site.number(roughness.alpha_u)
        });
        let along_y = F::from_fn(|i| {
            let (roughness, site) = at(i);
            match roughness.alpha_v == roughness.alpha_u {
                true => along_x.lane(i),
                false => site.number(roughness.alpha_v),
            }
        });
        let alpha = [along_x, along_y];
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
