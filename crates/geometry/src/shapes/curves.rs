//! Curves from files, as hair is made of: what `linearcurve` and `bsplinecurve` share.
//!
//! A file has a control point on each line, `x y z r`; empty lines begin a new curve. Points are placed by `to_world`,
//! radii are lengths in the world whatever it scales. Each segment is a primitive of its own. Curves are seen from
//! outside only, as in Mitsuba, and are no lights.

use crate::local_interaction::LocalInteraction;
use crate::placement::Placement;
use crate::shapes::crossing::{Crossing, Line};
use crate::shapes::model::ShapeModel;
use etalon_params::Params;
use etalon_transport::file;
use etalon_transport::{Build, SurfacePoint};
use glam::{DVec2, DVec3, Vec2};

/// A control point: where, and how thick there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ControlPoint {
    /// Position in the world.
    pub position: DVec3,
    /// Radius (m).
    pub radius: f64,
}

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
    /// How the surface moves with the parameter.
    pub along: DVec3,
}

/// A piece of a curve.
pub trait Segment: Sized {
    /// How many control points make one.
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

/// Curves of one kind.
#[derive(Clone, Debug)]
pub struct Curves<S> {
    segments: Vec<S>,
}

impl<S: Segment> Curves<S> {
    /// Reads `filename` and `to_world`.
    pub(crate) fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let placement = Placement::from_params(params);
        let text = file::read(params, build, "the file of control points", |bytes| {
            Ok(String::from_utf8_lossy(bytes).into_owned())
        });
        let curves = Self::parse(&text?, &placement?);
        let refuse = |message: String| {
            params.error_at("filename", format!("the control points, {message}"));
        };
        curves.map_err(refuse).ok()
    }

    /// Curves of a text, or what is wrong with it, and in which line.
    fn parse(text: &str, placement: &Placement) -> Result<Self, String> {
        let (mut segments, mut curve) = (Vec::new(), Vec::new());
        // An empty line at the end finishes the last curve.
        for (index, line) in text.lines().chain([""]).enumerate() {
            let line_number = index + 1;
            if line.trim().is_empty() {
                if (1..S::POINTS).contains(&curve.len()) {
                    let (count, least) = (curve.len(), S::POINTS);
                    return Err(format!(
                        "line {line_number}: the curve that ends here has {count} control points; it \
                         takes {least} or more"
                    ));
                }
                segments.extend(curve.windows(S::POINTS).map(S::new));
                curve.clear();
                continue;
            }
            let numbers: Vec<f64> = line
                .split_whitespace()
                .map_while(|word| word.parse().ok())
                .filter(|number: &f64| number.is_finite())
                .collect();
            match numbers[..] {
                [x, y, z, radius, ..] if radius >= 0.0 => curve.push(ControlPoint {
                    position: placement.point(DVec3::new(x, y, z)),
                    radius,
                }),
                _ => {
                    return Err(format!(
                        "line {line_number}: `{}` is no control point `x y z radius` of finite \
                         numbers, the radius not below 0",
                        line.trim()
                    ));
                }
            }
        }
        if segments.is_empty() {
            return Err("line 1: there are no control points".into());
        }
        Ok(Self { segments })
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
        Some(LocalInteraction::exact(
            point.axis + point.radial,
            point.normal.normalize(),
            Vec2::new(around as f32, ((parameter + index as f64) / count) as f32),
            point.tangent.cross(point.radial) * turn,
            point.along * count,
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
