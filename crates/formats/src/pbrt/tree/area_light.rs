//! Surfaces that shine (`lights.cpp`, `DiffuseAreaLight`): `area`.
//!
//! Both emit on the side of the normal, or with `twosided` on both. The radiance is L divided by its luminance (not for an `rgb`, see `spectrum`), times `scale`; a
//! `power` Φ makes it Φ / (π A) times that, half of it on either side of two, in which A is the area of one sphere, disk, cylinder, triangle or patch: pbrt makes a light of each,
//! so a mesh of n triangles has n Φ. Of quadrics A is measured in their own space, before the CTM. The colour of an `rgb` does not count in
//! that either; of an image its mean luminance does. An image is looked up by (u, v), counted from the bottom, between its texels.

use super::super::parameters::Parameters;
use super::super::scene::Entity;
use super::Mapper;
use super::node::{Draft, given, word};
use super::picture::luminance;
use super::spectrum::Role;
use super::textures::Rows;
use etalon_params::{Class, Node, Value};
use std::f64::consts::PI;
use std::sync::Arc;

impl<'a> Mapper<'a> {
    /// The light of a shape, each of whose lights has the area `area`, if that is known; `None` after a mistake.
    pub(crate) fn area_light(
        &mut self,
        light: &'a Entity,
        area: Option<f64>,
        has_alpha: bool,
    ) -> Option<Arc<Node>> {
        let params = self.read(light);
        let found = self.area_light_of(&params, area, has_alpha);
        params.finish();
        found
    }

    fn area_light_of(
        &mut self,
        params: &Parameters<'a>,
        area: Option<f64>,
        has_alpha: bool,
    ) -> Option<Arc<Node>> {
        let scale = light_scale(params);
        let power = params.float("power", -1.0);
        let image = params.string("filename");
        let spectrum = params.spectrum("L");
        let twosided = params.boolean("twosided", false);
        if has_alpha {
            self.refuse_value(params, "L", "shapes with `alpha` that shine", "no `alpha`");
            return None;
        }
        let mut factor = scale;
        if power > 0.0 {
            let Some(area) = area.filter(|area| *area > 0.0) else {
                let what = "`power` of shapes whose parts differ in area";
                let accepted =
                    "`scale`, or a sphere, a disk, a cylinder or triangles of the same area";
                self.refuse_value(params, "power", what, accepted);
                return None;
            };
            let sides = if twosided { 2.0 } else { 1.0 };
            let mean = match image {
                Some(filename) => self.picture(params, filename)?.mean(luminance),
                None => 1.0,
            };
            factor *= power / (PI * area * sides * mean);
        }
        let mut draft = Draft::of(params, Class::Emitter, "area");
        if twosided {
            draft = draft.from(params, "twosided", "twosided", Value::Boolean(true));
        }
        if let Some(filename) = image {
            if params.has("L") {
                params.error_at("filename", "a light has either `L` or `filename`");
                return None;
            }
            let span = params.span("filename");
            let picture = Draft::new(Class::Texture, "bitmap", span)
                .plain("filename", word(filename))
                .plain("wrap_mode", word("clamp"))
                .plain("to_uv", Value::Transform(Rows::turned()));
            // An image alone would not be multiplied by the white of its colours.
            let lit = Draft::new(Class::Texture, "d65", span)
                .child(picture.node())
                .plain("scale", Value::Float(factor));
            return Some(draft.given("radiance", lit.value()).node());
        }
        let radiance = match spectrum {
            None if params.has("L") => return None,
            None => Self::white_light(factor),
            Some(value) => self.spectrum(params, "L", value, Role::Emission(factor))?,
        };
        let radiance = given(radiance, params.span("L"));
        Some(draft.given("radiance", radiance).node())
    }
}

/// The `scale` of a light.
pub(crate) fn light_scale(params: &Parameters<'_>) -> f64 {
    params.float_where("scale", 1.0, "a finite number from 0 on", |scale| {
        scale >= 0.0 && scale.is_finite()
    })
}
