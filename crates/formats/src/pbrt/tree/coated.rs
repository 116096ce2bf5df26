//! Layered materials (`materials.cpp`, `CoatedDiffuseMaterial` and `CoatedConductorMaterial`; `bxdfs.h`, `LayeredBxDF`).
//!
//! pbrt walks about between the layers by chance, with what is between them absorbing and scattering; Etalon has models in closed
//! form. They stand in with a note, as the pictures differ: `plastic` takes all interreflection below the coat into account
//! (`nonlinear`), `coating` none. pbrt divides the metal's index by that of the coat, as `ext_eta` does.

use super::super::parameters::Parameters;
use super::Mapper;
use super::dielectrics::{between_vacuum, of_alpha};
use super::spectrum::Role;
use etalon_params::{Node, Value};
use std::sync::Arc;

/// How pbrt walks, which a closed form has no use for, and what is between the layers.
const WALK: [&str; 5] = ["maxdepth", "nsamples", "thickness", "g", "albedo"];

impl<'a> Mapper<'a> {
    /// A matte base under a coat; `None` after a mistake.
    pub(crate) fn coated_diffuse(&mut self, params: &Parameters<'a>) -> Option<Arc<Node>> {
        let reflectance = self.colour(params, "reflectance", 0.5, Role::Reflectance);
        let alpha = self.single_alpha(params, "");
        let index = self.single_index(params, "eta", 1.5);
        params.ignore(&WALK);
        let draft = of_alpha(params, "plastic", alpha?);
        let draft = between_vacuum(draft.given("diffuse_reflectance", reflectance?), index?);
        self.note_stand_in(params, draft.plugin());
        Some(draft.plain("nonlinear", Value::Boolean(true)).node())
    }

    /// A metal under a coat; `None` after a mistake.
    pub(crate) fn coated_conductor(&mut self, params: &Parameters<'a>) -> Option<Arc<Node>> {
        let metal = self.conductor(params, "conductor.");
        let alpha = self.single_alpha(params, "interface.");
        let index = self.single_index(params, "interface.eta", 1.5);
        params.ignore(&WALK);
        let draft = between_vacuum(of_alpha(params, "coating", alpha?), index?);
        self.note_stand_in(params, draft.plugin());
        Some(draft.child(metal?).node())
    }

    fn note_stand_in(&self, params: &Parameters<'_>, plugin: &str) {
        let kind = params.entity.kind;
        let message = format!("`{plugin}` stands in for pbrt's `{kind}`");
        let help = "it is near, not the same: nothing is absorbed or scattered between the layers";
        self.note(params.entity.span, message, help);
    }
}
