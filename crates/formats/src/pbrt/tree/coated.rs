//! Layered materials (`materials.cpp`, `CoatedDiffuseMaterial` and `CoatedConductorMaterial`; `bxdfs.h`, `LayeredBxDF`).
//!
//! Etalon has both by the same random walk. pbrt divides the metal's index by that of the coat, and Etalon does.

use super::super::parameters::Parameters;
use super::Mapper;
use super::dielectrics::between_vacuum;
use super::node::Draft;
use super::spectrum::Role;
use etalon_params::{Class, Node, Value};
use std::sync::Arc;

impl<'a> Mapper<'a> {
    /// A matte base under a coat; `None` after a mistake.
    pub(crate) fn coated_diffuse(&mut self, params: &Parameters<'a>) -> Option<Arc<Node>> {
        let reflectance = self.colour(params, "reflectance", 0.5, Role::Reflectance);
        let coat = self.coat(params, "");
        Some(coat?.given("reflectance", reflectance?).node())
    }

    /// A metal under a coat; `None` after a mistake.
    pub(crate) fn coated_conductor(&mut self, params: &Parameters<'a>) -> Option<Arc<Node>> {
        let roughness = self.roughness(params, "conductor.");
        let coat = self.coat(params, "interface.");
        let metal = self.metal_under(params, "conductor.", coat?);
        Some(roughness?.on(metal?, "base_").node())
    }

    /// The coat, whose own parameters begin with `prefix`, over a base of which nothing is known yet.
    fn coat(&mut self, params: &Parameters<'a>, prefix: &str) -> Option<Draft> {
        let roughness = self.roughness(params, prefix);
        let index = self.single_index(params, &format!("{prefix}eta"), 1.5);
        let thickness = self.number(params, "thickness", 0.01);
        let albedo = self.colour(params, "albedo", 0.0, Role::Reflectance);
        let g = Value::Float(params.float("g", 0.0));
        let count = |name: &str, default| Value::Integer(i64::from(params.integer(name, default)));
        let draft = Draft::of(params, Class::Bsdf, params.entity.kind);
        let draft = between_vacuum(roughness?.on(draft, ""), index?)
            .given("thickness", thickness?)
            .given("albedo", albedo?)
            .from(params, "g", "g", g)
            .from(params, "maxdepth", "max_depth", count("maxdepth", 10))
            .from(params, "nsamples", "samples", count("nsamples", 1));
        Some(draft)
    }
}
