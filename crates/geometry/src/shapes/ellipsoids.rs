//! `ellipsoids`: a cloud of ellipsoids from a file, each intersected by a formula.
//!
//! ```text
//! |W (p − c)| = 1,   W = A⁻¹
//! ```
//!
//! for the ellipsoid c + A n, |n| = 1: a line is taken to where it is the unit sphere. As in Mitsuba they are seen from
//! outside only, and cannot be lights. u and v are those of the sphere.

pub(crate) mod cloud;
pub(crate) mod shells;

use crate::local_interaction::LocalInteraction;
use crate::shapes::analytic::crossing::{Crossing, Line};
use crate::shapes::shape_model::ShapeModel;
use crate::shapes::sphere::{coordinates, crossings};
use cloud::{Cloud, Ellipsoid};
use etalon_params::Params;
use etalon_transport::{Attribute, Build, SurfacePoint};
use glam::{DMat3, DVec3, Vec2};

/// A cloud of ellipsoids.
#[derive(Clone, Debug)]
pub struct Ellipsoids {
    pieces: Vec<Piece>,
    /// One value or more per piece.
    attributes: Vec<Attribute>,
}

/// An ellipsoid, by the map that makes it the unit sphere.
#[derive(Clone, Copy, Debug)]
struct Piece {
    /// c (m).
    center: DVec3,
    /// W (1/m).
    to_sphere: DMat3,
}

impl From<Ellipsoid> for Piece {
    fn from(Ellipsoid { center, axes }: Ellipsoid) -> Self {
        Self {
            center,
            to_sphere: axes.inverse(),
        }
    }
}

impl Ellipsoids {
    /// Reads `filename`, `scale_factor`, `extent`, `extent_adaptive_clamping` and `to_world`.
    pub(crate) fn from_params(params: &Params<'_>, build: &mut dyn Build) -> Option<Self> {
        let cloud = Cloud::from_params(params, build)?;
        Some(Self {
            pieces: cloud.ellipsoids.into_iter().map(Piece::from).collect(),
            attributes: cloud.attributes,
        })
    }

    /// The attributes of its ellipsoids.
    pub(crate) fn attributes(&self) -> &[Attribute] {
        &self.attributes
    }
}

impl ShapeModel for Ellipsoids {
    fn pieces(&self) -> u32 {
        self.pieces.len() as u32
    }

    fn has_inner_side(&self) -> bool {
        false
    }

    /// Along an axis e, c ± |Aᵀ e|: the greatest e·A n.
    fn piece_bounds(&self, piece: u32) -> [DVec3; 2] {
        let Piece { center, to_sphere } = self.pieces[piece as usize];
        let rows = to_sphere.inverse().transpose();
        let reach = DVec3::new(
            rows.x_axis.length(),
            rows.y_axis.length(),
            rows.z_axis.length(),
        );
        [center - reach, center + reach]
    }

    #[inline]
    fn next_crossing(&self, piece: u32, line: &Line, after: f64, _: f64) -> Option<Crossing> {
        let Piece { center, to_sphere } = self.pieces[piece as usize];
        let origin = to_sphere * (line.origin - center);
        let [enters, _] = crossings(origin, to_sphere * line.direction, 1.0);
        (enters > after).then(|| Crossing::new(enters, true))
    }

    fn surface_at(&self, piece: u32, p: DVec3, _: &Crossing) -> Option<LocalInteraction> {
        let Piece { center, to_sphere } = self.pieces[piece as usize];
        let axes = to_sphere.inverse();
        let n = (to_sphere * (p - center)).try_normalize();
        let n = n.unwrap_or(DVec3::Z);
        let (uv, [dp_du, dp_dv]) = coordinates(n);
        Some(LocalInteraction::exact(
            center + axes * n,
            (to_sphere.transpose() * n).normalize(),
            uv,
            axes * dp_du,
            axes * dp_dv,
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
