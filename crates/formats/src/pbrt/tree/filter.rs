//! Reconstruction filters (`filters.h`). All are separable, with the radii of pbrt's `Create` functions as defaults; Etalon's are the
//! same in x and y.
//!
//! | pbrt | Etalon |
//! |---|---|
//! | box | `box`, whose r is ½ unless `radius` says otherwise |
//! | triangle, max(0, r − |x|) | `tent` |
//! | gaussian, e^(−x²/2σ²) − e^(−r²/2σ²) | `gaussian`, whose r is 4σ unless `radius` says otherwise |
//! | mitchell over 2x/r | `mitchell`, whose r is 2 unless `radius` says otherwise |
//! | sinc, sinc(x) sinc(x/τ) for |x| < r | `lanczos` of τ lobes if τ is an integer, whose r is τ unless `radius` says otherwise |

use super::super::parameters::Parameters;
use super::Mapper;
use super::node::Draft;
use etalon_params::{Class, Node, Value};
use std::sync::Arc;

impl Mapper<'_> {
    /// The filter; `None` after a mistake.
    pub(crate) fn filter(&self) -> Option<Arc<Node>> {
        let params = self.read(&self.scene.filter);
        let found = self.filter_draft(&params);
        params.finish();
        found.map(Draft::node)
    }

    fn filter_draft(&self, params: &Parameters<'_>) -> Option<Draft> {
        let draft = |plugin| Draft::of(params, Class::ReconstructionFilter, plugin);
        match params.entity.kind {
            "box" => {
                let radius = self.radius(params, 0.5)?;
                Some(with_radius(params, draft("box"), radius, 0.5))
            }
            "triangle" => {
                let radius = Value::Float(self.radius(params, 2.0)?);
                Some(draft("tent").from(params, "xradius", "radius", radius))
            }
            "mitchell" => {
                let radius = self.radius(params, 2.0)?;
                let parts = ["B", "C"].map(|name| params.float(name, 1.0 / 3.0));
                let [b, c] = parts.map(Value::Float);
                let draft = draft("mitchell").from(params, "B", "B", b);
                let draft = draft.from(params, "C", "C", c);
                Some(with_radius(params, draft, radius, 2.0))
            }
            "sinc" => {
                let radius = self.radius(params, 4.0)?;
                let tau = params.float("tau", 3.0);
                if tau.fract() != 0.0 || !(1.0..=64.0).contains(&tau) || radius > 2.0 * tau {
                    let what = format!("`sinc` of the radius {radius} with tau = {tau}");
                    let accepted = "an integer from 1 to 64 for `tau`, and radii up to twice it";
                    self.refuse_value(params, "tau", &what, accepted);
                    return None;
                }
                let lobes = Value::Integer(tau as i64);
                let draft = draft("lanczos").from(params, "tau", "lobes", lobes);
                Some(with_radius(params, draft, radius, tau))
            }
            _ => {
                let radius = self.radius(params, 1.5)?;
                let sigma = params.float("sigma", 0.5);
                let draft = draft("gaussian").from(params, "sigma", "stddev", Value::Float(sigma));
                Some(with_radius(params, draft, radius, 4.0 * sigma))
            }
        }
    }

    /// The radius in x and y.
    fn radius(&self, params: &Parameters<'_>, default: f64) -> Option<f64> {
        let positive = |name| {
            params.float_where(name, default, "a finite number above 0", |r| {
                r > 0.0 && r.is_finite()
            })
        };
        let (x, y) = (positive("xradius"), positive("yradius"));
        if x != y {
            let what = "filters that are wider in one direction than in the other";
            self.refuse_value(params, "yradius", what, "`yradius` equal to `xradius`");
            return None;
        }
        Some(x)
    }
}

/// Adds a radius that is not Etalon's own.
fn with_radius(params: &Parameters<'_>, draft: Draft, radius: f64, own: f64) -> Draft {
    match radius == own {
        true => draft,
        false => draft.from(params, "xradius", "radius", Value::Float(radius)),
    }
}
