//! Normals of textures (glTF 2.0, §3.9.3): n = normalise((2c − 1) (s, s, 1)), in a frame whose x is that of the picture and whose y points up in
//! it, which is that of `normalmap`.
//!
//! `normalmap` takes a normal 2c' − 1 of any length. With s ≤ 1, c' = (s, s, 1) c + (½ − s/2) (1, 1, 0); with more, the third component is made
//! smaller instead, so that no component exceeds 1.

use super::materials::Maker;
use super::textures::{Look, TextureUse};
use crate::draft::{Draft, Given, vector};
use etalon_params::{Class, DVec3, Node};
use std::sync::Arc;

/// A material with its normal turned by its map, if it has one; `None` after a mistake.
pub(crate) fn tilted(maker: &mut Maker<'_, '_>, bsdf: Arc<Node>) -> Option<Arc<Node>> {
    let Some(info) = &maker.material.normal_texture else {
        return Some(bsdf);
    };
    let path = format!("{}.normalTexture", maker.path);
    let sample = TextureUse::of_normals(path.clone(), info);
    maker.use_sample(&sample);
    let scale = f64::from(info.scale);
    if !(scale >= 0.0 && scale.is_finite()) {
        let help = "a finite number from 0 on";
        let message = "this is no strength of a normal map";
        return maker.reader.refuse(&format!("{path}.scale"), message, help);
    }
    if scale == 0.0 {
        return Some(bsdf);
    }
    let map = maker.reader.bitmap(&sample, Look::Numbers)?;
    let map = if scale == 1.0 {
        map
    } else {
        scaled(map, scale)
    };
    let draft = Draft::new(Class::Bsdf, "normalmap", map.span);
    Some(draft.given("normalmap", map).child(bsdf).node())
}

fn scaled(map: Given, scale: f64) -> Given {
    let span = map.span;
    let factor = match scale <= 1.0 {
        true => DVec3::new(scale, scale, 1.0),
        false => DVec3::new(1.0, 1.0, 1.0 / scale),
    };
    let raw = |value: DVec3| {
        let draft = Draft::new(Class::Texture, "rawconstant", span);
        draft.plain("value", vector(value)).value()
    };
    let product = Draft::new(Class::Texture, "multiply", span)
        .given("a", map)
        .given("b", raw(factor));
    let sum = Draft::new(Class::Texture, "add", span);
    sum.given("a", product.value())
        .given("b", raw(0.5 * (DVec3::ONE - factor)))
        .value()
}
