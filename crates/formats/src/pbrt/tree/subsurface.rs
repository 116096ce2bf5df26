//! Subsurface scattering (`materials.cpp`, `SubsurfaceMaterial`).
//!
//! pbrt draws light's exit from a tabulated profile behind a dielectric boundary; Etalon's `randomwalk` follows the light itself, in
//! the same matter behind the same boundary. It stands in with a note. Matter is given by name, by σₐ and σₛ (whole milk by default), or
//! by the colour of a thick piece and the mean free path; `scale` multiplies the coefficients.

use super::super::parameters::Parameters;
use super::Mapper;
use super::dielectrics::between_vacuum;
use super::materials::Surface;
use super::node::{Draft, Given, given, word};
use super::spectrum::Role;
use super::textures::times;
use etalon_params::{Class, DVec3, Value};

/// σₐ and σₛ by default, those of whole milk (linear Rec. 709, per unit of length).
const MILK: [DVec3; 2] = [
    DVec3::new(0.0011, 0.0024, 0.014),
    DVec3::new(2.55, 3.21, 3.77),
];

impl<'a> Mapper<'a> {
    /// Matter below a boundary; `None` after a mistake.
    pub(crate) fn subsurface(&mut self, params: &Parameters<'a>) -> Option<Surface> {
        let index = self.single_index(params, "eta", 1.33);
        let alpha = self.single_alpha(params, "");
        let scale = params.float("scale", 1.0);
        let g = params.float("g", 0.0);
        let draft = Draft::of(params, Class::Subsurface, "randomwalk");
        let draft = self.matter(params, draft, scale)?;
        if ["normalmap", "displacement"]
            .iter()
            .any(|name| params.has(name))
        {
            let what = "`subsurface` with turned normals";
            self.refuse_value(params, "normalmap", what, "none");
        }
        if g != 0.0 {
            self.refuse_value(params, "g", "`subsurface` of an uneven phase function", "0");
            return None;
        }
        let draft = match alpha? {
            None => draft.plain("boundary", word("smooth")),
            Some(alpha) => draft
                .plain("boundary", word("rough"))
                .plain("distribution", word("ggx"))
                .given("alpha", alpha),
        };
        let draft = between_vacuum(draft, index?);
        let message = "`randomwalk` stands in for pbrt's `subsurface`";
        self.note(
            params.entity.span,
            message,
            "it follows light below the surface instead of a profile",
        );
        Some(Surface {
            bsdf: None,
            subsurface: Some(draft.node()),
        })
    }

    /// Adds what matter is: a name, coefficients, or a colour.
    fn matter(&mut self, params: &Parameters<'a>, draft: Draft, scale: f64) -> Option<Draft> {
        let scaled = |draft: Draft| draft.from(params, "scale", "scale", Value::Float(scale));
        if let Some(material) = params.string("name") {
            let draft = draft.from(params, "name", "material", word(material));
            return Some(scaled(draft));
        }
        if params.has("reflectance") && !params.has("sigma_a") {
            let colour = self.colour(params, "reflectance", 1.0, Role::Reflectance);
            let free = self.colour(params, "mfp", 1.0, Role::Unbounded);
            let free = times(free?, scale);
            return Some(draft.given("albedo", colour?).given("mean_free_path", free));
        }
        if params.has("sigma_a") != params.has("sigma_s") {
            let name = if params.has("sigma_a") {
                "sigma_a"
            } else {
                "sigma_s"
            };
            params.error_at(name, "`sigma_a` and `sigma_s` need each other");
            params.ignore(&["sigma_a", "sigma_s"]);
            return None;
        }
        let [absorbed, scattered] = self.coefficients(params, MILK.map(Value::Rgb))?;
        let draft = draft.given("sigma_a", absorbed);
        Some(scaled(draft.given("sigma_s", scattered)))
    }

    /// σₐ and σₛ, or what they are by default; `None` after a mistake.
    pub(crate) fn coefficients(
        &mut self,
        params: &Parameters<'a>,
        defaults: [Value; 2],
    ) -> Option<[Given; 2]> {
        let mut part = |name: &str, default: Value| match self.colour_if_given(
            params,
            name,
            Role::Unbounded,
        ) {
            None if params.has(name) => None,
            None => Some(given(default, params.entity.span)),
            found => found,
        };
        let [absorbed, scattered] = defaults;
        let (absorbed, scattered) = (part("sigma_a", absorbed), part("sigma_s", scattered));
        Some([absorbed?, scattered?])
    }
}
