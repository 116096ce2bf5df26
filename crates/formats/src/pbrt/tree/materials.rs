//! Materials (`materials.cpp`): dispatch, the matte ones, mixtures, and what is put around all of them.
//!
//! pbrt's opaque materials look alike from both sides, Mitsuba's are black from behind: they become `twosided`. Those that transmit have an
//! inside and an outside in both. `normalmap` and `displacement` turn the normal as `normalmap` and `bumpmap` do; pbrt's bumps follow
//! the change of the normal itself as well, which Blinn neglects.

use super::super::parameters::Parameters;
use super::super::scene::MaterialId;
use super::Mapper;
use super::node::{Draft, given, word};
use super::spectrum::Role;
use super::textures::{Rows, times};
use etalon_params::{Class, Node, SpectrumText, Value};
use std::sync::Arc;

/// What a material is in the tree.
#[derive(Clone, Debug)]
pub(crate) struct Surface {
    /// How the surface scatters.
    pub(crate) bsdf: Option<Arc<Node>>,
    /// What light does below it.
    pub(crate) subsurface: Option<Arc<Node>>,
}

impl Surface {
    /// A material that only scatters.
    pub(crate) fn of(bsdf: Arc<Node>) -> Self {
        Self {
            bsdf: Some(bsdf),
            subsurface: None,
        }
    }
}

impl<'a> Mapper<'a> {
    /// The material; `None` after a mistake.
    pub(crate) fn material(&mut self, id: MaterialId) -> Option<Surface> {
        if let Some(found) = self.materials.get(id)? {
            return found.clone();
        }
        // That materials contain each other in no circle, nor too deep, was seen when the file was read.
        let found = self.new_material(id);
        self.materials[id] = Some(found.clone());
        found
    }

    fn new_material(&mut self, id: MaterialId) -> Option<Surface> {
        let scene = self.scene;
        let material = &scene.materials[id];
        let params = self.read(&material.entity);
        let params = &params;
        let found = match params.entity.kind {
            "diffuse" => self.diffuse(params).map(both_sides),
            "diffusetransmission" => self.diffuse_transmission(params),
            "conductor" => self.conductor(params).map(both_sides),
            "dielectric" => self.dielectric(params),
            "thindielectric" => self.thin_dielectric(params),
            "coateddiffuse" => self.coated_diffuse(params).map(both_sides),
            "coatedconductor" => self.coated_conductor(params).map(both_sides),
            "hair" => self.hair(params),
            "measured" => self.measured(params).map(both_sides),
            "interface" => Some(Draft::of(params, Class::Bsdf, "null").node()),
            "mix" => self.mixture(params, &material.mixed),
            _ => {
                let subsurface = self.subsurface(params);
                let _ = self.tilted(params, None);
                params.finish();
                return subsurface;
            }
        };
        let found = self.tilted(params, found);
        params.finish();
        found.map(Surface::of)
    }

    fn diffuse(&mut self, params: &Parameters<'a>) -> Option<Arc<Node>> {
        let reflectance = self.colour(params, "reflectance", 0.5, Role::Reflectance)?;
        let draft = Draft::of(params, Class::Bsdf, "diffuse");
        Some(draft.given("reflectance", reflectance).node())
    }

    /// R/π on the side of the light and T/π on the other: a blend (1 − w) (R/(1 − w)) + w (T/w) of Etalon's two, with w such that neither
    /// share is above 1 where R + T is not.
    fn diffuse_transmission(&mut self, params: &Parameters<'a>) -> Option<Arc<Node>> {
        let scale = params.float("scale", 1.0);
        let reflectance = self.colour(params, "reflectance", 0.25, Role::Reflectance);
        let transmittance = self.colour(params, "transmittance", 0.25, Role::Reflectance);
        let (reflected, transmitted) = (times(reflectance?, scale), times(transmittance?, scale));
        let [r, t] = [&reflected.value, &transmitted.value].map(most);
        let weight = if r + t > 0.0 { t / (r + t) } else { 0.5 };
        let share = |part: f64| if part > 0.0 { 1.0 / part } else { 1.0 };
        let front = Draft::of(params, Class::Bsdf, "diffuse")
            .given("reflectance", times(reflected, share(1.0 - weight)));
        let through = Draft::of(params, Class::Bsdf, "difftrans")
            .given("transmittance", times(transmitted, share(weight)));
        let blend =
            Draft::of(params, Class::Bsdf, "blendbsdf").plain("weight", Value::Float(weight));
        Some(
            blend
                .child(both_sides(front.node()))
                .child(through.node())
                .node(),
        )
    }

    fn measured(&self, params: &Parameters<'_>) -> Option<Arc<Node>> {
        let Some(filename) = params.string("filename") else {
            params.missing("string filename");
            return None;
        };
        let draft = Draft::of(params, Class::Bsdf, "measured");
        Some(
            draft
                .from(params, "filename", "filename", word(filename))
                .node(),
        )
    }

    /// pbrt takes the second material with the probability `amount`.
    fn mixture(&mut self, params: &Parameters<'a>, mixed: &[MaterialId]) -> Option<Arc<Node>> {
        params.ignore(&["materials"]);
        let amount = self.number(params, "amount", 0.5);
        let parts: Vec<Option<Surface>> = mixed.iter().map(|id| self.material(*id)).collect();
        let [first, second] = parts.as_slice() else {
            return None;
        };
        let (first, second) = (first.as_ref()?, second.as_ref()?);
        let (Some(a), Some(b), None, None) = (
            &first.bsdf,
            &second.bsdf,
            &first.subsurface,
            &second.subsurface,
        ) else {
            let accepted = "materials that are no `subsurface`";
            self.refuse_value(params, "materials", "`mix` of a `subsurface`", accepted);
            return None;
        };
        let blend = Draft::of(params, Class::Bsdf, "blendbsdf").given("weight", amount?);
        Some(blend.child(Arc::clone(a)).child(Arc::clone(b)).node())
    }

    /// The material with its normal turned by a map or by heights.
    fn tilted(&mut self, params: &Parameters<'a>, bsdf: Option<Arc<Node>>) -> Option<Arc<Node>> {
        let map = params.string("normalmap");
        let heights = self.number_if_given(params, "displacement");
        let broken = heights.is_none() && params.has("displacement");
        let bsdf = bsdf.filter(|_| !broken)?;
        let bsdf = match heights.filter(|heights| matches!(heights.value, Value::Object(_))) {
            Some(heights) => {
                let draft = Draft::new(Class::Bsdf, "bumpmap", heights.span);
                draft.given("", heights).child(bsdf).node()
            }
            // The same height everywhere moves no normal.
            None => bsdf,
        };
        let Some(filename) = map else {
            return Some(bsdf);
        };
        let span = params.span("normalmap");
        let picture = Draft::new(Class::Texture, "bitmap", span)
            .plain("filename", word(filename))
            .plain("raw", Value::Boolean(true))
            .plain("to_uv", Value::Transform(Rows::turned()));
        // pbrt's facets cast no shadows on each other.
        let draft = Draft::new(Class::Bsdf, "normalmap", span)
            .plain("use_shadowing_function", Value::Boolean(false));
        let picture = given(Value::Object(picture.node()), span);
        Some(draft.given("normalmap", picture).child(bsdf).node())
    }
}

/// A material that is the same from behind.
pub(crate) fn both_sides(bsdf: Arc<Node>) -> Arc<Node> {
    let draft = Draft::new(Class::Bsdf, "twosided", bsdf.span);
    draft.child(bsdf).node()
}

/// The most that a value may be, ½ for a texture.
fn most(value: &Value) -> f64 {
    match value {
        Value::Float(x) => *x,
        Value::Rgb(rgb) => rgb.max_element(),
        Value::Spectrum(SpectrumText::Uniform(x)) => *x,
        Value::Spectrum(SpectrumText::Samples(pairs)) => {
            pairs.iter().map(|(_, x)| *x).fold(0.0, f64::max)
        }
        _ => 0.5,
    }
}
