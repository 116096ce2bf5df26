//! Flights that are too short for the coordinates of where they are.
//!
//! Coordinates are rounded to ulps of 2⁻²³ of their size, and a ray starts some of them beside the surface that it leaves. A walk whose
//! mean free path is not long against that begins too deep, and loses light: with a surface of albedo ½ some .4 % at [`ULPS`]
//! and 14 % at 8 of them. A thick body looks the same however short the flights in it are, but for a blur over some of them; so a mean
//! free path counts as [`ULPS`] of the coordinates or as [`SHARE`] of the body's size, whichever is less, if it is shorter than that.

use crate::scene_tables::SceneTables;
use etalon_params::{Diagnostic, Diagnostics, Span};
use etalon_subsurface::{Homogeneous, MediumDescription};
use etalon_transport::{MediumId, MediumInterface, ShapeId, Shapes};
use glam::Vec4;

/// So many ulps are long against rounding.
const ULPS: f32 = 256.0;

/// So much of half a body's smallest extent is short against it.
const SHARE: f32 = 3e-3;

/// Wavelengths (nm) at which coefficients are looked at.
const LAMBDA: Vec4 = Vec4::new(450.0, 520.0, 590.0, 660.0);

/// Holds the mean free paths of homogeneous media to what the coordinates of their shapes tell apart, and says so.
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
