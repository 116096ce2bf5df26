//! Surfaces that shine (`lights.cpp`, `DiffuseAreaLight`): `area`.
//!
//! Both emit on the side of the normal, or with `twosided` on both. The radiance is L divided by its luminance (not for an `rgb`, see `spectrum`), times `scale`; a
//! `power` Φ makes it Φ / (π A) times that, half of it on either side of two, in which A is the area of one sphere, disk, cylinder, triangle or patch: pbrt makes a light of each,
//! so a mesh of n triangles has n Φ. Of quadrics A is measured in their own space, before the CTM. The colour of an `rgb` does not count in
//! that either; of an image its mean luminance does. An image is looked up by (u, v), counted from the bottom, between its texels.
//!
//! Where a shape has holes (`alpha`), it does not shine: the radiance is multiplied by the share of it that is there.

use super::super::parameters::Parameters;
use super::super::scene::Entity;
use super::Mapper;
use super::node::{Draft, Given, given, word};
use super::picture::luminance;
use super::spectrum::Role;
use super::texture_kinds::mixed;
use super::textures::{Rows, times};
use etalon_params::{Class, Node, Value};
use std::f64::consts::PI;
use std::sync::Arc;

impl<'a> Mapper<'a> {
    /// The light of a shape, each of whose lights has the area `area`, if that is known; `None` after a mistake.
    pub(crate) fn area_light(
        &mut self,
        light: &'a Entity,
        area: Option<f64>,
        alpha: Option<&Given>,
    ) -> Option<Arc<Node>> {
        let params = self.read(light);
        let found = self.area_light_of(&params, area, alpha);
        params.finish();
        found
    }

    fn area_light_of(
        &mut self,
        params: &Parameters<'a>,
        area: Option<f64>,
        alpha: Option<&Given>,
    ) -> Option<Arc<Node>> {
        let scale = light_scale(params);
        let power = params.float("power", -1.0);
        let image = params.string("filename");
        let spectrum = params.spectrum("L");
        let twosided = params.boolean("twosided", false);
        if alpha.is_some_and(|alpha| matches!(alpha.value, Value::Float(x) if x <= 0.0)) {
            let what = "lights that are not seen (an `alpha` of 0 on what shines)";
            self.refuse_value(params, "L", what, "an `alpha` above 0, or a point light");
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
            let radiance = where_it_is(lit.value(), alpha);
            return Some(draft.given("radiance", radiance).node());
        }
        let radiance = match spectrum {
            None if params.has("L") => return None,
            None => Self::white_light(factor),
            Some(value) => self.spectrum(params, "L", value, Role::Emission(factor))?,
        };
        let radiance = where_it_is(given(radiance, params.span("L")), alpha);
        Some(draft.given("radiance", radiance).node())
    }
}

/// The radiance of a shape that has holes.
fn where_it_is(radiance: Given, alpha: Option<&Given>) -> Given {
    let Some(alpha) = alpha else {
        return radiance;
    };
    if let Value::Float(share) = alpha.value {
        return times(radiance, share);
    }
    // Within a texture, numbers and colours are no light by themselves.
    let span = radiance.span;
    let lamp = Draft::new(Class::Texture, "d65", span);
    let lit = match radiance.value {
        Value::Float(x) => lamp.plain("scale", Value::Float(x)).value(),
        Value::Rgb(rgb) => lamp.plain("color", Value::Rgb(rgb)).value(),
        other => given(other, span),
    };
    let dark = given(Value::Float(0.0), span);
    mixed(span, dark, lit, alpha.clone())
}

/// The `scale` of a light.
pub(crate) fn light_scale(params: &Parameters<'_>) -> f64 {
    params.float_where("scale", 1.0, "a finite number from 0 on", |scale| {
        scale >= 0.0 && scale.is_finite()
    })
}
