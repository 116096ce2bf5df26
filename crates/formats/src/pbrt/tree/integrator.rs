//! Integrators (`cpu/integrators.cpp`).
//!
//! pbrt's `maxdepth` counts the points at which light is scattered: with 0 only lights themselves are seen. Mitsuba's `max_depth`
//! counts segments, of which there is one more. pbrt's default is 5, Mitsuba's is none.

use super::super::parameters::Parameters;
use super::Mapper;
use super::node::{Draft, word};
use etalon_params::{Class, FileId, Node, Span, Value};
use std::sync::Arc;

impl Mapper<'_> {
    /// The integrator; `other` is a type in place of its own. `None` after a mistake.
    pub(crate) fn integrator(&self, other: Option<(&str, FileId)>) -> Option<Arc<Node>> {
        let params = self.read(&self.scene.integrator);
        if let Some((name, file)) = other {
            return Some(self.replaced(&params, name, file));
        }
        let draft = self.integrator_draft(&params);
        params.finish();
        draft.map(Draft::node)
    }

    /// Another integrator, which takes over how long paths are.
    fn replaced(&self, params: &Parameters<'_>, name: &str, file: FileId) -> Arc<Node> {
        let span = Span {
            file,
            start: 0,
            end: name.len() as u32,
        };
        let draft = Draft::new(Class::Integrator, name, span);
        let draft = match params.entity.kind {
            "ambientocclusion" | "function" => draft,
            _ => max_depth(params, draft),
        };
        // An integrator that has no such parameter is not to be blamed.
        let node = draft.node();
        node.properties
            .iter()
            .for_each(|property| property.mark_used());
        node
    }

    fn integrator_draft(&self, params: &Parameters<'_>) -> Option<Draft> {
        let draft = |plugin| Draft::of(params, Class::Integrator, plugin);
        let deep = |plugin| max_depth(params, draft(plugin));
        match params.entity.kind {
            "path" | "volpath" => {
                // Which light is asked makes a difference to the noise only.
                params.ignore(&["lightsampler"]);
                self.refuse_regularize(params);
                Some(deep("path"))
            }
            "simplevolpath" => Some(deep("path")),
            "simplepath" => {
                let lights = params.boolean("samplelights", true);
                let bsdf = params.boolean("samplebsdf", true);
                if lights {
                    return Some(deep("path"));
                }
                let draft = deep("naive");
                Some(match bsdf {
                    true => draft,
                    false => draft.from(params, "samplebsdf", "directions", word("uniform")),
                })
            }
            "randomwalk" => Some(deep("naive").plain("directions", word("uniform"))),
            "lightpath" => Some(deep("ptracer")),
            "bdpt" => {
                for name in ["visualizestrategies", "visualizeweights"] {
                    if params.boolean(name, false) {
                        let what = format!("`{name}` of `bdpt`");
                        self.refuse_value(params, name, &what, "false");
                    }
                }
                self.refuse_regularize(params);
                Some(deep("bdpt"))
            }
            "mlt" => {
                // How chains begin and how many there are makes a difference to the noise only.
                params.ignore(&["bootstrapsamples", "chains", "mutationsperpixel", "sigma"]);
                self.refuse_regularize(params);
                let what = "a number above 0, at most 1";
                let large =
                    params.float_where("largestepprobability", 0.3, what, |p| p > 0.0 && p <= 1.0);
                let large = Value::Float(large);
                Some(deep("mmlt").from(params, "largestepprobability", "large_step", large))
            }
            "sppm" => Some(sppm(params, deep("sppm"))),
            "ambientocclusion" => {
                let cosine = params.boolean("cossample", true);
                let far = params.float("maxdistance", f64::INFINITY);
                let mut draft = draft("ao");
                if !cosine {
                    draft = draft.from(params, "cossample", "sampling", word("uniform"));
                }
                if far.is_finite() {
                    draft = draft.from(params, "maxdistance", "distance", Value::Float(far));
                }
                Some(draft)
            }
            _ => {
                let accepted = "volpath, path, simplevolpath, simplepath, randomwalk, lightpath, bdpt, mlt, sppm, ambientocclusion";
                self.refuse(params, "integrator", accepted);
                // Nobody has read them.
                params.entity.params.iter().for_each(|p| p.mark_used());
                None
            }
        }
    }

    /// `regularize` makes rough what is smooth, and so another picture.
    fn refuse_regularize(&self, params: &Parameters<'_>) {
        if params.boolean("regularize", false) {
            self.refuse_value(params, "regularize", "`regularize`", "false");
        }
    }

    /// The number of samples of a pixel if the integrator has one of its own: the mutations of `mlt`.
    pub(crate) fn samples_of_integrator(&self) -> Option<i64> {
        let params = self.read(&self.scene.integrator);
        let is_mlt = params.entity.kind == "mlt";
        is_mlt.then(|| i64::from(params.integer_from("mutationsperpixel", 100, 1)))
    }
}

/// Adds the greatest number of segments.
fn max_depth(params: &Parameters<'_>, draft: Draft) -> Draft {
    let scatterings = params.integer_from("maxdepth", 5, 0);
    let segments = Value::Integer(i64::from(scatterings) + 1);
    draft.from(params, "maxdepth", "max_depth", segments)
}

/// Photons of a pass are as many as pixels in both, unless a number is given.
fn sppm(params: &Parameters<'_>, draft: Draft) -> Draft {
    params.ignore(&["seed"]);
    let radius = params.float_where("radius", 1.0, "a finite number above 0", |r| {
        r > 0.0 && r.is_finite()
    });
    let draft = draft.from(params, "radius", "radius", Value::Float(radius));
    match params.integer("photonsperiteration", -1) {
        photons if photons > 0 => {
            let photons = Value::Integer(i64::from(photons));
            draft.from(params, "photonsperiteration", "photons", photons)
        }
        _ => draft,
    }
}
