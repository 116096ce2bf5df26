//! Mean free paths that are too short for the precision of coordinates.
//!
//! Coordinates are rounded to ulps of 2⁻²³ of their magnitude, and rays start a few ulps off the surface that they leave.
//! A random walk with a mean free path comparable to that starts too deep and loses light: with a surface of albedo ½
//! about 0.4 % at [`ULPS`] ulps, and 14 % at 8. A thick body has the same appearance for any short mean free path, up to a
//! blur of a few of them. So the mean free path is clamped from below to the lesser of [`ULPS`] ulps and [`SHARE`] of the
//! body's size.

use crate::scene_tables::SceneTables;
use etalon_params::{Diagnostic, Diagnostics, Span};
use etalon_subsurface::{Homogeneous, MediumDescription};
use etalon_transport::{MediumId, MediumInterface, ShapeId, Shapes};
use glam::Vec4;

/// Mean free path, in ulps of the coordinates, at which rounding is negligible.
const ULPS: f32 = 256.0;

/// Mean free path, as a share of half the body's smallest extent, at which the blur is negligible.
const SHARE: f32 = 3e-3;

/// Wavelengths (nm) at which coefficients are examined.
const LAMBDA: Vec4 = Vec4::new(450.0, 520.0, 590.0, 660.0);

/// Clamps the mean free paths of homogeneous media to the precision of their shapes' coordinates, with a note.
pub(crate) fn hold(
    media: &mut [(MediumDescription, Span)],
    bounded: &[(ShapeId, MediumInterface)],
    lookup: &SceneTables,
    diagnostics: &Diagnostics,
) {
    for (index, (medium, span)) in media.iter_mut().enumerate() {
        let MediumDescription::Homogeneous(medium) = medium else {
            continue;
        };
        let id = MediumId(index as u32);
        let shapes = bounded.iter().filter(|(_, sides)| sides.inside == id);
        let bounds = shapes.map(|(shape, _)| Shapes::bounds(lookup, *shape));
        let finite = bounds.filter(|[low, high]| low.is_finite() && high.is_finite());
        let start = (0.0_f32, f32::INFINITY);
        let (far, size) = finite.fold(start, |(far, size), [low, high]| {
            let corner = low.abs().max(high.abs()).max_element();
            (far.max(corner), size.min(0.5 * (high - low).min_element()))
        });
        if size < f32::INFINITY && size > 0.0 {
            hold_one(medium, (far, size), lookup, *span, diagnostics);
        }
    }
}

/// The same of one medium in bodies as far as `far` along an axis, and `size` thick.
fn hold_one(
    medium: &mut Homogeneous,
    (far, size): (f32, f32),
    lookup: &SceneTables,
    span: Span,
    diagnostics: &Diagnostics,
) {
    let length = (ULPS * f32::EPSILON * far).min(SHARE * size);
    if length > 0.0 && medium.hold_flights(length, lookup, LAMBDA) {
        let message = format!(
            "the mean free path in this matter counts as {length:.2e} m: what shorter flights do is lost in the rounding of coordinates \
             up to {far} m"
        );
        let help = "it looks the same but for a blur over so much; nearer to the origin shorter flights are told apart";
        diagnostics.push(Diagnostic::note(span, message).help(help));
    }
}
