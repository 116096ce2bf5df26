//! `fov` and `focal_length` of cameras and projectors.

use crate::{Diagnostic, Params};
use etalon_math::float64::tan;

/// 36 mm × 24 mm film, whose diagonal the focal length refers to.
const FULL_FRAME_DIAGONAL_MM: f64 = 43.266_615_305_567_875;

/// Reads `fov` with `fov_axis`, or `focal_length`: tan(φ/2) of the horizontal field of view φ.
pub fn half_width_from_params(params: &Params<'_>, aspect: f64) -> f64 {
    let fov = params.float("fov");
    let focal_length = params.property("focal_length").is_some();
    if fov.is_some() && focal_length {
        params.error_at(
            "focal_length",
            "give either `fov` or `focal_length`, not both",
        );
    }
    if params.has("fov") {
        half_width_of_fov(params, aspect)
    } else {
        if let Some(axis) = params.property("fov_axis") {
            let message =
                "`fov_axis` says nothing without `fov`: a focal length refers to the diagonal";
            (params.diagnostics).push(Diagnostic::note(axis.name_span, message));
        }
        let diagonal = FULL_FRAME_DIAGONAL_MM / (2.0 * focal_length_from_params(params));
        of_diagonal(diagonal, aspect)
    }
}

/// tan(φ/2) of the diagonal spreads over the sides in proportion to their lengths.
fn of_diagonal(half_diagonal: f64, aspect: f64) -> f64 {
    half_diagonal / (1.0 + 1.0 / (aspect * aspect)).sqrt()
}

/// Reads `fov` with `fov_axis`: tan(φ/2) of the horizontal field of view φ.
pub fn half_width_of_fov(params: &Params<'_>, aspect: f64) -> f64 {
    let fov = params.float("fov");
    let axis = params.choice(
        "fov_axis",
        "x",
        &["x", "y", "diagonal", "smaller", "larger"],
    );
    let degrees = match fov {
        Some(degrees) if degrees > 0.0 && degrees < 180.0 => degrees,
        Some(degrees) => {
            params.refuse("fov", degrees, "degrees above 0 and below 180");
            90.0
        }
        None => 90.0,
    };
    let half = tan(degrees.to_radians() / 2.0);
    match (axis, aspect > 1.0) {
        ("diagonal", _) => of_diagonal(half, aspect),
        ("y", _) | ("smaller", true) | ("larger", false) => half * aspect,
        _ => half,
    }
}

/// Reads `focal_length`: millimetres, as in `50mm`.
fn focal_length_from_params(params: &Params<'_>) -> f64 {
    const DEFAULT_MM: f64 = 50.0;
    let Some(text) = params.string("focal_length") else {
        return DEFAULT_MM;
    };
    let number = text.strip_suffix("mm").unwrap_or(text).trim();
    match number.parse::<f64>() {
        Ok(length) if length > 0.0 && length.is_finite() => length,
        _ => {
            params.refuse(
                "focal_length",
                format!("`{text}`"),
                "a positive number of millimetres such as `50mm`",
            );
            DEFAULT_MM
        }
    }
}
