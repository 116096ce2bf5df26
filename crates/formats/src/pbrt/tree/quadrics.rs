//! Spheres, disks and cylinders (`shapes.h`, `shapes.cpp`).
//!
//! pbrt turns a normal around if exactly one of these holds: `ReverseOrientation`, and a CTM that mirrors (`interaction.h`,
//! `flipNormal`). What it turns are the image of the sphere's and the cylinder's radius and of the disk's +z, which a mirroring CTM leaves on
//! the same side. Of Etalon's shapes, the sphere is turned by a mirroring `to_world` by itself, as Mitsuba's is; disk and cylinder are not.
//!
//! Texture coordinates differ: v of Mitsuba's sphere runs from +z down, pbrt's from −z up. Where they matter, the sphere is mirrored along z, and
//! its normals are turned back. Those of the disk are exchanged and cannot be had.

use super::super::parameters::Parameters;
use super::Mapper;
use super::node::vector;
use super::placement::mirrors;
use super::shapes::{Form, Wanted};
use etalon_params::{DMat4, DVec3, Value};
use std::f64::consts::{PI, TAU};

impl Mapper<'_> {
    /// A whole sphere; `None` after a mistake.
    pub(crate) fn sphere(&self, params: &Parameters<'_>, wanted: &Wanted<'_>) -> Option<Form> {
        let radius = positive(params, "radius", 1.0);
        let [low, high] = [("zmin", -radius), ("zmax", radius)].map(|(n, z)| params.float(n, z));
        self.full_turn(params)?;
        if low.min(high) > -radius || low.max(high) < radius {
            let what = "parts of a `sphere`";
            self.refuse_value(
                params,
                "zmin",
                what,
                "`zmin` at −radius and `zmax` at radius",
            );
            return None;
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

    /// A whole disk; `None` after a mistake.
    pub(crate) fn disk(&self, params: &Parameters<'_>, wanted: &Wanted<'_>) -> Option<Form> {
        let radius = positive(params, "radius", 1.0);
        let height = params.float("height", 0.0);
        self.full_turn(params)?;
        if params.float("innerradius", 0.0) != 0.0 {
            self.refuse_value(params, "innerradius", "`disk` with a hole", "0");
            return None;
        }
        if wanted.by_uv || wanted.along_u {
            let what = "texture coordinates of a `disk`";
            let accepted = "materials without images, patterns and two roughnesses, or a mesh";
            self.refuse_value(params, "radius", what, accepted);
            return None;
        }
        let size = DMat4::from_scale(DVec3::new(radius, radius, 1.0));
        let local = DMat4::from_translation(DVec3::new(0.0, 0.0, height)) * size;
        let draft = self.placed_form(params, wanted, "disk", local)?;
        Some(Form {
            drafts: vec![Wanted::flipped(draft, turned(wanted))],
            area: Some(PI * radius * radius),
        })
    }

    /// A whole cylinder; `None` after a mistake.
    pub(crate) fn cylinder(&self, params: &Parameters<'_>, wanted: &Wanted<'_>) -> Option<Form> {
        let radius = positive(params, "radius", 1.0);
        let [a, b] = [("zmin", -1.0), ("zmax", 1.0)].map(|(name, z)| params.float(name, z));
        self.full_turn(params)?;
        let ends = [a.min(b), a.max(b)];
        let draft = self.placed_form(params, wanted, "cylinder", DMat4::IDENTITY)?;
        let [low, high] = ends.map(|z| vector(DVec3::new(0.0, 0.0, z)));
        let draft = draft
            .from(params, "zmin", "p0", low)
            .from(params, "zmax", "p1", high)
            .from(params, "radius", "radius", Value::Float(radius));
        Some(Form {
            drafts: vec![Wanted::flipped(draft, turned(wanted))],
            area: Some(TAU * radius * (ends[1] - ends[0])),
        })
    }

    /// Refuses what is not whole around the z axis.
    fn full_turn(&self, params: &Parameters<'_>) -> Option<()> {
        if params.float("phimax", 360.0) >= 360.0 {
            return Some(());
        }
        let what = format!("parts of a `{}`", params.entity.kind);
        self.refuse_value(params, "phimax", &what, "360");
        None
    }
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
