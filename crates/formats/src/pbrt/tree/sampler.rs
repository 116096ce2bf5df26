//! Samplers. Which numbers are drawn makes no difference to the mean picture, so the nearest of Etalon's does: Owen-scrambled Sobol'
//! points for every low-discrepancy sampler. Their number counts (`samplers.cpp`: 16 by default, of `independent` 4, of `stratified` the
//! product of two numbers, 4 each).

use super::Mapper;
use super::node::Draft;
use etalon_params::{Class, Node, Value};
use std::sync::Arc;

impl Mapper<'_> {
    /// The sampler; `count` is a number of samples in place of its own.
    pub(crate) fn sampler(&self, count: Option<i64>) -> Arc<Node> {
        let params = self.read(&self.scene.sampler);
        let (plugin, default) = match params.entity.kind {
            "independent" => ("independent", 4),
            "stratified" => ("stratified", 0),
            _ => ("sobol", 16),
        };
        let mut draft = Draft::of(&params, Class::Sampler, plugin);
        if plugin == "stratified" {
            let [x, y] = ["xsamples", "ysamples"].map(|side| params.integer_from(side, 4, 1));
            let product = i64::from(x) * i64::from(y);
            let count = Value::Integer(count.unwrap_or(product));
            draft = draft.from(&params, "xsamples", "sample_count", count);
            if !params.boolean("jitter", true) {
                let off = Value::Boolean(false);
                draft = draft.from(&params, "jitter", "jitter", off);
            }
        } else {
            let own = params.integer_from("pixelsamples", default, 1);
            let count = Value::Integer(count.unwrap_or(i64::from(own)));
            draft = draft.from(&params, "pixelsamples", "sample_count", count);
            params.ignore(&["randomization"]);
        }
        let option = self.scene.options.seed.as_ref();
        let seed = match (params.integer_if_given("seed"), option) {
            (Some(own), _) => Some((own, params.span("seed"))),
            (None, given) => given.map(|seed| (seed.value, seed.span)),
        };
        if let Some((seed, span)) = seed {
            // As pbrt, which adds the bits to others.
            let seed = Value::Integer(i64::from(seed.cast_unsigned()));
            draft = draft.with("seed", seed, span);
        }
        params.finish();
        draft.node()
    }
}
