//! Curves from files, such as hair: the common part of `linearcurve`, `bsplinecurve`, `beziercurve` and `hair`.
//!
//! `to_world` maps points; radii are world lengths and not scaled. Each segment is a primitive. Curves are seen from
//! outside only, as in Mitsuba, and cannot be lights.
//!
//! Texture coordinates are (around, along): the angle, and the place along all segments. With `coordinates` = `along` they are
//! (along, around), along each segment by itself, as pbrt-v4 has them. The material `hair` wants the former.

pub mod control_points;
mod strands;

use crate::local_interaction::LocalInteraction;
use crate::placement::Placement;
use crate::shapes::analytic::crossing::{Crossing, Line};
pub use crate::shapes::curves::control_points::ControlPoint;
use crate::shapes::curves::control_points::{ControlPoints, fits};
use crate::shapes::shape_model::ShapeModel;
use etalon_params::{Diagnostic, Params};
use etalon_transport::file;
use etalon_transport::{Build, SurfacePoint};
use glam::{DVec2, DVec3, Vec2};

/// A point of a segment's surface.
#[derive(Clone, Copy, Debug)]
pub struct CurvePoint {
    /// The nearest point of the axis.
    pub axis: DVec3,
    /// From there to the surface.
    pub radial: DVec3,
    /// A normal of any length, outside.
    pub normal: DVec3,
    /// The unit vector along the axis.
    pub tangent: DVec3,
    /// Derivative of the surface by the parameter.
    pub along: DVec3,
}

/// A piece of a curve.
pub trait Segment: Sized {
    /// Number of control points of a segment.
    const POINTS: usize;

    /// The segment of so many control points, one after another.
    fn new(points: &[ControlPoint]) -> Self;

    /// The first place beyond `after` where a line goes in, and the parameter there.
    fn entry(&self, line: &Line, after: f64) -> Option<(f64, f64)>;

    /// The surface at a parameter, toward a point that is on it up to rounding.
    fn surface(&self, parameter: f64, p: DVec3) -> CurvePoint;

    /// A box that holds it.
    fn bounds(&self) -> [DVec3; 2];
}

/// After how many control points a segment begins, and how it is made of those that it has.
type SegmentRule<S> = (usize, fn(&[ControlPoint]) -> S);

/// Curves of one kind.
#[derive(Clone, Debug)]
pub struct Curves<S> {
    segments: Vec<S>,
    /// Whether u counts along each segment.
    is_along: bool,
}

impl<S: Segment> Curves<S> {
    /// Reads `filename` and `to_world`; each control point begins a segment.
    pub(crate) fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        Self::in_steps(params, build, (1, S::new))
    }

    /// The same where a segment begins after so many control points, and is made of them so.
    pub(crate) fn in_steps(
        params: &Params<'_>,
        build: &mut dyn Build,
        rule: SegmentRule<S>,
    ) -> Option<Self> {
        let what = "the file of control points";
        Self::read(params, build, (what, rule), control_points::parse)
    }

    /// Reads Mitsuba 0.6's `hair`: `filename`, `radius` (0.025 m), `angle_threshold` (1°), `reduction` (0) and `to_world`.
    pub(crate) fn hair(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let what = "a finite number above 0";
        let radius = params.float_where("radius", 0.025, what, |r| r > 0.0 && fits(r));
        let what = "an angle from 0 to 90°";
        let straight =
            params.float_where("angle_threshold", 1.0, what, |a| (0.0..=90.0).contains(&a));
        params.float_where("reduction", 0.0, "0: every hair is kept", |share| {
            share == 0.0
        });
        let file = ("the file of strands of hair", (1, S::new as fn(&_) -> S));
        Self::read(params, build, file, |bytes| {
            strands::parse(bytes, radius, straight.to_radians())
        })
    }

    fn read(
        params: &Params<'_>,
        build: &mut dyn Build,
        (what, rule): (&str, SegmentRule<S>),
        parse: impl FnOnce(&[u8]) -> Result<ControlPoints, String>,
    ) -> Option<Self> {
        let placement = Placement::from_params(params);
        let file = file::read(params, build, what, parse)?;
        let name = params.string("filename").unwrap_or_default();
        if let Some(header) = &file.header {
            let message = format!(
                "the first line of `{name}`, `{header}`, is no control point and is passed over"
            );
            let span = file::span_of_filename(params);
            (params.diagnostics).push(Diagnostic::note(span, message));
        }
        let refuse = |reason: String| {
            params.error_at("filename", format!("`{name}` cannot be used: {reason}"));
        };
        Self::new(&file, &placement?, rule).map_err(refuse).ok()
    }

    /// Curves through control points; the error names the line.
    fn new(
        file: &ControlPoints,
        placement: &Placement,
        (step, segment): SegmentRule<S>,
    ) -> Result<Self, String> {
        let mut segments = Vec::new();
        for (points, end) in &file.strands {
            let (count, least) = (points.len(), S::POINTS);
            if count < least {
                return Err(format!(
                    "line {end}: the curve that ends here has {count} control points; it takes {least} or more"
                ));
            }
            if !(count - least).is_multiple_of(step) {
                return Err(format!(
                    "line {end}: the curve that ends here has {count} control points; it takes {least} and {step} for each further piece"
                ));
            }
            let placed = points.iter().map(|point| ControlPoint {
                position: placement.point(point.position),
                ..*point
            });
            let placed: Vec<ControlPoint> = placed.collect();
            if !placed.iter().flat_map(|p| p.position.to_array()).all(fits) {
                return Err(format!(
                    "line {end}: the curve that ends here lies too far away"
                ));
            }
            segments.extend(placed.windows(least).step_by(step).map(segment));
        }
        Ok(Self {
            segments,
            is_along: false,
        })
    }

    /// Reads `coordinates`.
    pub(crate) fn with_coordinates(mut self, params: &Params<'_>) -> Self {
        let coordinates = params.choice("coordinates", "around", &["around", "along"]);
        self.is_along = coordinates == "along";
        self
    }
}

/// A frame around an axis, as Mitsuba's: the second vector is as near to z as it may be.
fn frame(tangent: DVec3) -> [DVec3; 2] {
    let up = (DVec3::Z - tangent * tangent.z).try_normalize();
    let up = up.filter(|_| tangent.z.abs() < 1.0).unwrap_or(DVec3::Y);
    [up.cross(tangent), up]
}

impl<S: Segment> ShapeModel for Curves<S> {
    fn pieces(&self) -> u32 {
        self.segments.len() as u32
    }

    fn has_inner_side(&self) -> bool {
        false
    }

    fn piece_bounds(&self, piece: u32) -> [DVec3; 2] {
        self.segments[piece as usize].bounds()
    }

    #[inline]
    fn next_crossing(&self, piece: u32, line: &Line, after: f64, _: f64) -> Option<Crossing> {
        let (t, parameter) = self.segments[piece as usize].entry(line, after)?;
        Some(Crossing {
            uv: DVec2::new(parameter, 0.0),
            ..Crossing::new(t, true)
        })
    }

    fn surface_at(&self, piece: u32, p: DVec3, crossing: &Crossing) -> Option<LocalInteraction> {
        let index = piece as usize;
        let parameter = crossing.uv.x;
        let point = self.segments[index].surface(parameter, p);
        let [x, y] = frame(point.tangent);
        let angle = etalon_math::float64::atan2(point.radial.dot(y), point.radial.dot(x));
        let turn = core::f64::consts::TAU;
        let around = (angle / turn).rem_euclid(1.0);
        let count = self.segments.len() as f64;
        let turned = point.tangent.cross(point.radial) * turn;
        let (uv, dp_du, dp_dv) = match self.is_along {
            true => (DVec2::new(parameter, around), point.along, turned),
            false => (
                DVec2::new(around, (parameter + index as f64) / count),
                turned,
                point.along * count,
            ),
        };
        Some(LocalInteraction::exact(
            point.axis + point.radial,
            point.normal.normalize(),
            uv.as_vec2(),
            dp_du,
            dp_dv,
        ))
    }

    fn is_convex(&self) -> bool {
        false
    }

    fn area(&self) -> Option<f64> {
        None
    }

    fn sample_area(&self, _: Vec2) -> Option<SurfacePoint> {
        None
    }
}
