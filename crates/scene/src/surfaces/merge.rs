//! `merge`: shapes together, as if each stood where the `merge` stands.
//!
//! Mitsuba makes one mesh of those that share a material, to be fast; the picture is the same without.

use etalon_params::{Class, Node, Params, Property};
use std::sync::Arc;

/// The shapes of a scene or group in the order of the file, those of a `merge` in its place.
pub(crate) fn shapes<'a>(params: &Params<'a>) -> Vec<(&'a Property, &'a Arc<Node>)> {
    let mut all = Vec::new();
    for (property, node) in params.children(Class::Shape) {
        if node.plugin.value == "merge" {
            let merged = Params::new(node, params.diagnostics);
            all.extend(shapes(&merged));
            merged.finish();
        } else {
            all.push((property, node));
        }
    }
    all
}
