//! Spheres, disks and cylinders (`shapes.h`, `shapes.cpp`).
//!
//! pbrt turns a normal around if exactly one of these holds: `ReverseOrientation`, and a CTM that mirrors (`interaction.h`,
//! `flipNormal`). What it turns are the image of the sphere's and the cylinder's radius and of the disk's +z, which a mirroring CTM leaves on
//! the same side. Of Etalon's shapes, the sphere is turned by a mirroring `to_world` by itself, as Mitsuba's is; disk and cylinder are not.
//!
//! Texture coordinates differ: v of Mitsuba's sphere runs from +z down, pbrt's from −z up. Where they matter, the sphere is mirrored along z, and
//! its normals are turned back. Those of the disk are exchanged: where they matter, it is a mesh (`profile_point`), as all parts of these shapes are.

use super::super::parameters::Parameters;
use super::Mapper;
use super::node::vector;
use super::placement::mirrors;
use super::profile_point::{self, ProfilePoint};
use super::shapes::{Form, Wanted};
use etalon_math::float64;
use etalon_params::{DMat4, DVec3, Value};
use glam::DVec2;
use std::f64::consts::{PI, TAU};

impl<'a> Mapper<'a> {
    /// A sphere, or a part of one; `None` after a mistake.
    pub(crate) fn sphere(&mut self, params: &Parameters<'a>, wanted: &Wanted<'_>) -> Option<Form> {
        let radius = positive(params, "radius", 1.0);
        let [a, b] = [("zmin", -radius), ("zmax", radius)].map(|(n, z)| params.float(n, z));
        let [low, high] = [a.min(b), a.max(b)].map(|z| z.clamp(-radius, radius));
        let angle = full_angle(params);
        if angle < TAU || low > -radius || high < radius {
            let [from, to] = [low, high].map(|z| float64::acos(z / radius));
            let count = profile_point::pieces(from - to);
            let point = |k: usize| {
                let v = k as f64 / count as f64;
                let (sin, cos) = float64::sin_cos(from + (to - from) * v);
                // A pole is on the axis, whatever the rounding.
                let normal = DVec2::new(if sin < 1e-12 { 0.0 } else { sin }, cos);
                ProfilePoint {
                    at: radius * normal,
                    normal,
                    v,
                }
            };
            let profile: Vec<ProfilePoint> = (0..=count).map(point).collect();
            let area = angle * radius * (high - low);
            return self.turned_profile(params, wanted, &profile, [angle, area]);
        }
        let upside = match wanted.by_uv {
            true => DMat4::from_scale(DVec3::new(1.0, 1.0, -1.0)),
            false => DMat4::IDENTITY,
        };
        let draft = self.placed_form(params, wanted, "sphere", upside)?;
        let draft = draft.from(params, "radius", "radius", Value::Float(radius));
        let flip = wanted.shape.reverse_orientation != wanted.by_uv;
        Some(Form {
            drafts: vec![Wanted::flipped(draft, flip)],
            area: Some(4.0 * PI * radius * radius),
        })
    }

    /// A disk, or a part of one; `None` after a mistake.
    pub(crate) fn disk(&mut self, params: &Parameters<'a>, wanted: &Wanted<'_>) -> Option<Form> {
        let radius = positive(params, "radius", 1.0);
        let height = params.float("height", 0.0);
        let angle = full_angle(params);
        let accepted = "a number from 0 to below `radius`";
        let hole = params.float_where("innerradius", 0.0, accepted, |r| (0.0..radius).contains(&r));
        let area = 0.5 * angle * (radius * radius - hole * hole);
        if wanted.by_uv || wanted.along_u || hole > 0.0 || angle < TAU {
            let point = |v: f64| ProfilePoint {
                at: DVec2::new(radius + (hole - radius) * v, height),
                normal: DVec2::Y,
                v,
            };
            let profile = [point(0.0), point(1.0)];
            return self.turned_profile(params, wanted, &profile, [angle, area]);
        }
        let size = DMat4::from_scale(DVec3::new(radius, radius, 1.0));
        let local = DMat4::from_translation(DVec3::new(0.0, 0.0, height)) * size;
        let draft = self.placed_form(params, wanted, "disk", local)?;
        Some(Form {
            drafts: vec![Wanted::flipped(draft, turned(wanted))],
            area: Some(area),
        })
    }

    /// A cylinder, or a part of one; `None` after a mistake.
    pub(crate) fn cylinder(
        &mut self,
        params: &Parameters<'a>,
        wanted: &Wanted<'_>,
    ) -> Option<Form> {
        let radius = positive(params, "radius", 1.0);
        let [a, b] = [("zmin", -1.0), ("zmax", 1.0)].map(|(name, z)| params.float(name, z));
        let angle = full_angle(params);
        let ends = [a.min(b), a.max(b)];
        let area = angle * radius * (ends[1] - ends[0]);
        if angle < TAU {
            let profile = [(ends[0], 0.0), (ends[1], 1.0)].map(|(z, v)| ProfilePoint {
                at: DVec2::new(radius, z),
                normal: DVec2::X,
                v,
            });
            return self.turned_profile(params, wanted, &profile, [angle, area]);
        }
        let draft = self.placed_form(params, wanted, "cylinder", DMat4::IDENTITY)?;
        let [low, high] = ends.map(|z| vector(DVec3::new(0.0, 0.0, z)));
        let draft = draft
            .from(params, "zmin", "p0", low)
            .from(params, "zmax", "p1", high)
            .from(params, "radius", "radius", Value::Float(radius));
        Some(Form {
            drafts: vec![Wanted::flipped(draft, turned(wanted))],
            area: Some(area),
        })
    }
}

/// The angle about the z axis that is there, in radians.
fn full_angle(params: &Parameters<'_>) -> f64 {
    let accepted = "degrees above 0";
    let degrees = params.float_where("phimax", 360.0, accepted, |phi| phi > 0.0);
    degrees.min(360.0).to_radians()
}

/// `flip_normals` of a shape that Etalon turns around in no other way.
pub(crate) fn turned(wanted: &Wanted<'_>) -> bool {
    wanted.shape.reverse_orientation != mirrors(&wanted.shape.placement)
}

fn positive(params: &Parameters<'_>, name: &str, default: f64) -> f64 {
    params.float_where(name, default, "a finite number above 0", |x| {
        x > 0.0 && x.is_finite()
    })
}
