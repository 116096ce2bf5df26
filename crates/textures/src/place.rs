//! Where a texture stands: the inverse of its `to_world`.

use etalon_params::Params;
use glam::DAffine3;

/// From the world to where the texture is defined; `None` after a mistake.
pub(crate) fn from_world(params: &Params<'_>) -> Option<DAffine3> {
    let place = DAffine3::from_mat4(params.transform("to_world"));
    let inverse = place.inverse();
    if !(place.is_finite() && inverse.is_finite()) {
        params.error_at(
            "to_world",
            "`to_world` of a texture must be finite and invertible",
        );
        return None;
    }
    Some(inverse)
}
