//! Lights that are no surfaces (`lights.cpp`).
//!
//! | pbrt | Etalon | the spectrum times |
//! |---|---|---|
//! | point | `point` | scale, and Φ / 4π with a `power` Φ |
//! | goniometric | `goniometric`, with y and z exchanged | scale, and Φ / 4π times the mean of the image's numbers |
//! | projection | `projector` of that intensity | scale, and Φ over that of the image |
//! | spot | `spot`, with the falloff smooth in the cosine | scale, and Φ / 2π[(1 − cos b) + (cos b − cos c)/2] |
//! | distant | `directional`, from `from` to `to` | scale, and E with an `illuminance` E |
//! | infinite with `L` | `constant` | scale, and E / π |
//! | infinite with `filename` | `envmap` with the equal-area `mapping` | scale, and E over that of the image |
//!
//! Spectra are divided by their luminance, see `spectrum`. c is `coneangle`, b is `conedeltaangle` less.

use super::super::parameters::Parameters;
use super::super::scene::Light;
use super::Mapper;
use super::area_light::light_scale;
use super::node::{Draft, Given, given, vector, word};
use super::picture::{Picture, luminance};
use super::spectrum::Role;
use etalon_math::{equal_area, float64};
use etalon_params::{Class, DMat4, DVec3, Node, Value};
use glam::DVec4;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

impl<'a> Mapper<'a> {
    /// A light; `None` after a mistake.
    pub(crate) fn light(&mut self, light: &'a Light) -> Option<Arc<Node>> {
        let params = self.read(&light.entity);
        let params = &params;
        let to_world = self.still(&light.placement, "lights", params.entity.span);
        let found = match params.entity.kind {
            "point" => self.point(params, to_world),
            "spot" => self.spot(params, to_world),
            "distant" => self.distant(params, to_world),
            "infinite" => self.infinite(params, to_world),
            "goniometric" => self.goniometric(params, to_world),
            "projection" => self.projection(params, to_world),
            // All that pbrt knows are above.
            _ => None,
        };
        let medium = light.medium.map(|medium| self.medium(medium));
        params.finish();
        let draft = found?;
        Some(match medium {
            // What is infinitely far away is in no medium.
            Some(medium)
                if ["point", "spot", "goniometric", "projection"].contains(&params.entity.kind) =>
            {
                draft.child(medium?).node()
            }
            _ => draft.node(),
        })
    }

    /// The spectrum `name` times a factor, white if it is not given; `None` after a mistake.
    fn light_spectrum(
        &mut self,
        params: &Parameters<'a>,
        name: &str,
        factor: f64,
    ) -> Option<Given> {
        let value = match params.spectrum(name) {
            None if params.has(name) => return None,
            None => Self::white_light(factor),
            Some(value) => self.spectrum(params, name, value, Role::Emission(factor))?,
        };
        Some(given(value, params.span(name)))
    }

    fn point(&mut self, params: &Parameters<'a>, to_world: DMat4) -> Option<Draft> {
        let factor = light_scale(params) * quotient(params.float("power", -1.0), 4.0 * PI);
        let position = to_world.transform_point3(params.point3("from", DVec3::ZERO));
        let intensity = self.light_spectrum(params, "I", factor)?;
        let draft = Draft::of(params, Class::Emitter, "point");
        let draft = draft.from(params, "from", "position", vector(position));
        Some(draft.given("intensity", intensity))
    }

    fn spot(&mut self, params: &Parameters<'a>, to_world: DMat4) -> Option<Draft> {
        let degrees = "degrees above 0, at most 180";
        let cone = params.float_where("coneangle", 30.0, degrees, |c| c > 0.0 && c <= 180.0);
        let delta = params.float_where(
            "conedeltaangle",
            5.0,
            "degrees from 0 to `coneangle`",
            |d| (0.0..=cone).contains(&d),
        );
        let from = params.point3("from", DVec3::ZERO);
        let to = params.point3("to", DVec3::Z);
        let [end, start] = [cone, cone - delta].map(|angle| float64::cos(angle.to_radians()));
        let solid_angle = TAU * ((1.0 - start) + 0.5 * (start - end));
        let factor = light_scale(params) * quotient(params.float("power", -1.0), solid_angle);
        let intensity = self.light_spectrum(params, "I", factor)?;
        let Some(axis) = (to - from).try_normalize() else {
            params.error_at("to", "`from` and `to` of `spot` must differ");
            return None;
        };
        let (x, y) = axis.any_orthonormal_pair();
        let turned = DMat4::from_cols(
            x.extend(0.0),
            y.extend(0.0),
            axis.extend(0.0),
            from.extend(1.0),
        );
        let draft = Draft::of(params, Class::Emitter, "spot")
            .plain("to_world", Value::Transform(to_world * turned))
            .given("intensity", intensity)
            .from(params, "coneangle", "cutoff_angle", Value::Float(cone))
            .from(
                params,
                "conedeltaangle",
                "beam_width",
                Value::Float(cone - delta),
            );
        Some(draft.plain("falloff", word("smooth_in_cosine")))
    }

    fn distant(&mut self, params: &Parameters<'a>, to_world: DMat4) -> Option<Draft> {
        let factor = light_scale(params) * quotient(params.float("illuminance", -1.0), 1.0);
        let from = params.point3("from", DVec3::ZERO);
        let to = params.point3("to", DVec3::Z);
        let irradiance = self.light_spectrum(params, "L", factor)?;
        // pbrt's z axis of the light is at right angles to two others, and is carried along as a vector.
        let direction = to_world.transform_vector3(to - from).try_normalize();
        let Some(direction) = direction else {
            params.error_at("to", "`from` and `to` of `distant` must differ");
            return None;
        };
        let draft = Draft::of(params, Class::Emitter, "directional");
        let draft = draft.from(params, "to", "direction", vector(direction));
        Some(draft.given("irradiance", irradiance))
    }

    fn infinite(&mut self, params: &Parameters<'a>, to_world: DMat4) -> Option<Draft> {
        let scale = light_scale(params);
        let illuminance = params.float("illuminance", -1.0);
        if params.points3("portal").is_some() {
            let message = "portals guide no light here: the sky is seen through all openings";
            let help = "the picture is the same where the portal covers them all";
            self.note(params.span("portal"), message, help);
        }
        if let Some(filename) = params.string("filename") {
            return self.sky_image(params, (filename, scale, illuminance), to_world);
        }
        let factor = scale * quotient(illuminance, PI);
        let radiance = self.light_spectrum(params, "L", factor)?;
        let draft = Draft::of(params, Class::Emitter, "constant");
        Some(draft.given("radiance", radiance))
    }

    fn goniometric(&mut self, params: &Parameters<'a>, to_world: DMat4) -> Option<Draft> {
        let Some(filename) = params.string("filename") else {
            params.missing("string filename");
            return None;
        };
        let power = params.float("power", -1.0);
        let mut factor = light_scale(params);
        if power > 0.0 {
            let picture = self.picture(params, filename)?;
            let mean = picture.mean(|[r, g, b]| f64::from(r + g + b) / 3.0);
            factor *= power / (4.0 * PI * mean);
        }
        let intensity = self.light_spectrum(params, "I", factor)?;
        let exchanged = DMat4::from_cols(DVec4::X, DVec4::Z, DVec4::Y, DVec4::W);
        let draft = Draft::of(params, Class::Emitter, "goniometric")
            .plain("to_world", Value::Transform(to_world * exchanged))
            .from(params, "filename", "filename", word(filename))
            .plain("mapping", word("equalarea"));
        Some(draft.given("intensity", intensity))
    }

    /// An image thrown along +z, the right way round for who looks along with it; `fov` spans its shorter side.
    fn projection(&mut self, params: &Parameters<'a>, to_world: DMat4) -> Option<Draft> {
        let Some(filename) = params.string("filename") else {
            params.missing("string filename");
            return None;
        };
        let degrees = "degrees above 0, below 180";
        let fov = params.float_where("fov", 90.0, degrees, |fov| fov > 0.0 && fov < 180.0);
        let power = params.float("power", -1.0);
        let mut factor = light_scale(params);
        if power > 0.0 {
            let picture = self.picture(params, filename)?;
            factor *= power / thrown_power(&picture, fov);
        }
        let span = params.span("filename");
        let picture = Draft::new(Class::Texture, "bitmap", span)
            .plain("filename", word(filename))
            .plain("filter_type", word("nearest"))
            .plain("wrap_mode", word("clamp"));
        let lit = Draft::new(Class::Texture, "d65", span)
            .child(picture.node())
            .plain("scale", Value::Float(factor));
        // x of Mitsuba's spaces runs to the left.
        let mirrored = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
        Some(
            Draft::of(params, Class::Emitter, "projector")
                .plain("to_world", Value::Transform(to_world * mirrored))
                .from(params, "fov", "fov", Value::Float(fov))
                .plain("fov_axis", word("smaller"))
                .plain("profile", word("intensity"))
                .given("irradiance", lit.value()),
        )
    }

    /// An image at infinity, times a factor, or so that it has an illuminance if that is above 0.
    fn sky_image(
        &mut self,
        params: &Parameters<'a>,
        (filename, scale, illuminance): (&str, f64, f64),
        to_world: DMat4,
    ) -> Option<Draft> {
        if params.has("L") {
            params.ignore(&["L"]);
            params.error_at("filename", "a light has either `L` or `filename`");
            return None;
        }
        let scale = match illuminance > 0.0 {
            true => scale * illuminance / self.illuminance_of_map(params, filename)?,
            false => scale,
        };
        let draft = Draft::of(params, Class::Emitter, "envmap")
            .from(params, "filename", "filename", word(filename))
            .plain("mapping", word("equalarea"))
            .from(params, "scale", "scale", Value::Float(scale));
        let still = to_world == DMat4::IDENTITY;
        Some(if still {
            draft
        } else {
            draft.plain("to_world", Value::Transform(to_world))
        })
    }

    /// What pbrt takes for the illuminance of a square map upon a surface that faces +z: Σ Y cos θ over the pixels above the horizon, each
    /// of which counts for 2π over the number of all pixels (the solid angle that it has is twice that).
    fn illuminance_of_map(&mut self, params: &Parameters<'a>, filename: &str) -> Option<f64> {
        let Picture { width, rgb } = self.picture(params, filename)?;
        let side = width as f64;
        let above = rgb.iter().enumerate().map(|(i, &rgb)| {
            let place = [i % width, i / width].map(|c| ((c as f64 + 0.5) / side) as f32);
            let up = equal_area::to_direction::<f32>(place).z;
            luminance(rgb) * f64::from(up.max(0.0))
        });
        let illuminance = above.sum::<f64>() * TAU / rgb.len() as f64;
        if illuminance > 0.0 {
            return Some(illuminance);
        }
        let message =
            format!("`{filename}` is black above its horizon, and cannot have an illuminance");
        params.error_at("illuminance", message);
        None
    }
}

/// Σ Y cos³ θ over the pixels of a thrown picture, each of which has an equal part of its area on the plane z = 1.
fn thrown_power(picture: &Picture, fov: f64) -> f64 {
    let size = [picture.width, picture.rgb.len() / picture.width].map(|side| side as f64);
    let half = float64::tan(0.5 * fov.to_radians());
    let shorter = size[0].min(size[1]);
    let halves = size.map(|side| half * side / shorter);
    let pixels = picture.rgb.iter().enumerate().map(|(i, &rgb)| {
        let at = [i % picture.width, i / picture.width];
        let place = |k: usize| halves[k] * (2.0 * (at[k] as f64 + 0.5) / size[k] - 1.0);
        let [x, y] = [place(0), place(1)];
        let cos2 = 1.0 / (1.0 + x * x + y * y);
        luminance(rgb) * cos2 * cos2.sqrt()
    });
    4.0 * halves[0] * halves[1] * pixels.sum::<f64>() / picture.rgb.len() as f64
}

/// A quantity over what it is for a spectrum of luminance 1; 1 if it is not asked for.
fn quotient(wanted: f64, unit: f64) -> f64 {
    if wanted > 0.0 { wanted / unit } else { 1.0 }
}
