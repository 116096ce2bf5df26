//! Where a 2-D texture is looked up (`textures.h`: `UVMapping`, `SphericalMapping`, `CylindricalMapping`, `PlanarMapping`).
//!
//! ```text
//! uv            (s, t) = (uscale u + udelta, vscale v + vdelta)
//! spherical     (s, t) = (θ/π, φ/2π)
//! cylindrical   (s, t) = (½ + atan2(y, x)/2π, z)
//! planar        (s, t) = (udelta + v1 · p, vdelta + v2 · p)
//! ```
//!
//! p = (x, y, z) is the place in the texture's space. All but the first are Etalon's `projected`, which has φ from 0 to 2π: its u and v are
//! exchanged, its z axis is turned by half a turn, or its space is the one whose first axes are v1 and v2.

use super::super::parameters::Parameters;
use super::super::placement::Placement;
use super::Mapper;
use super::node::{Draft, Given, given, word};
use super::placement::placed;
use super::textures::Rows;
use etalon_params::{Class, DMat4, DVec3, Value};
use glam::{DMat3, DVec4};

/// How (s, t) follow from the place.
pub(crate) struct Coordinates {
    /// From (u, v) of the surface, or of what it is projected from, to (s, t).
    from_uv: DMat4,
    /// The mapping of `projected`, with its `to_world`.
    projection: Option<(&'static str, DMat4)>,
    /// Whether s and t lie between 0 and 1 wherever u and v do.
    pub(crate) within_unit: bool,
}

impl Coordinates {
    /// The `to_uv` of a texture, if it is needed; `squares` multiplies the coordinates of the pattern.
    pub(crate) fn to_uv(&self, params: &Parameters<'_>, rows: Rows, squares: f64) -> Option<Given> {
        let turned = match rows {
            Rows::FromBottom => DMat4::IDENTITY,
            Rows::FromTop => Rows::turned(),
        };
        let whole = turned * DMat4::from_scale((squares, squares, 1.0).into()) * self.from_uv;
        let moved = whole != DMat4::IDENTITY;
        moved.then(|| given(Value::Transform(whole), params.entity.span))
    }

    /// From (s, t) back to (u, v); `None` after a mistake.
    pub(crate) fn back_to_uv(&self, params: &Parameters<'_>) -> Option<DMat4> {
        if self.from_uv.determinant() == 0.0 {
            let name = if params.float("uscale", 1.0) == 0.0 {
                "uscale"
            } else {
                "vscale"
            };
            params.refuse(name, 0, "numbers other than 0");
            return None;
        }
        Some(self.from_uv.inverse())
    }

    /// s (0) or t (1) as a formula of u and v.
    pub(crate) fn formula(&self, which: usize) -> String {
        let row = self.from_uv.row(which);
        match (row.x, row.y, row.w) {
            (1.0, 0.0, 0.0) => "u".to_owned(),
            (0.0, 1.0, 0.0) => "v".to_owned(),
            (a, b, c) => format!("(({a})*u + ({b})*v + ({c}))"),
        }
    }

    /// Whether the surface's own u and v are looked at.
    pub(crate) fn is_projected(&self) -> bool {
        self.projection.is_some()
    }

    /// The texture of u and v by the coordinates that it is projected from.
    pub(crate) fn projected(&self, params: &Parameters<'_>, texture: Given) -> Given {
        let (Some((mapping, to_world)), Value::Object(node)) = (self.projection, &texture.value)
        else {
            return texture;
        };
        let draft = Draft::of(params, Class::Texture, "projected")
            .from(params, "mapping", "mapping", word(mapping))
            .child(node.clone());
        let to_world = given(Value::Transform(to_world), texture.span);
        placed(draft, to_world).value()
    }
}

impl Mapper<'_> {
    /// The coordinates of a 2-D texture; `None` after a mistake.
    pub(crate) fn coordinates(
        &self,
        params: &Parameters<'_>,
        placement: &Placement,
    ) -> Option<Coordinates> {
        let mappings = ["uv", "spherical", "cylindrical", "planar"];
        let mapping = params.choice("mapping", mappings[0], &mappings);
        let moved = |at: [&str; 2]| {
            let [s, t] = at.map(|name| params.float(name, 0.0));
            DMat4::from_translation(DVec3::new(s, t, 0.0))
        };
        if mapping == "uv" {
            let [s, t] = ["uscale", "vscale"].map(|name| params.float(name, 1.0));
            let from_uv = moved(["udelta", "vdelta"]) * DMat4::from_scale(DVec3::new(s, t, 1.0));
            return Some(Coordinates {
                from_uv,
                projection: None,
                within_unit: from_uv == DMat4::IDENTITY,
            });
        }
        let to_world = self.still(placement, "textures", params.entity.span);
        let (from_uv, to_world) = match mapping {
            "spherical" => {
                let exchanged = DMat4::from_cols(DVec4::Y, DVec4::X, DVec4::Z, DVec4::W);
                (exchanged, to_world)
            }
            "cylindrical" => {
                let half_a_turn = DMat4::from_scale(DVec3::new(-1.0, -1.0, 1.0));
                (DMat4::IDENTITY, to_world * half_a_turn)
            }
            _ => {
                let [v1, v2] = [("v1", DVec3::X), ("v2", DVec3::Y)]
                    .map(|(name, default)| params.vector3(name, default));
                let across = v1.cross(v2);
                if across == DVec3::ZERO || !across.is_finite() {
                    params.error_at("v2", "`v1` and `v2` of a planar mapping span no plane");
                    return None;
                }
                // Its rows are v1 and v2, and what they do not tell.
                let from_place = DMat3::from_cols(v1, v2, across).transpose();
                (
                    moved(["udelta", "vdelta"]),
                    to_world * DMat4::from_mat3(from_place.inverse()),
                )
            }
        };
        Some(Coordinates {
            from_uv,
            projection: Some((mapping, to_world)),
            within_unit: mapping == "spherical",
        })
    }
}
