//! Parts of quadrics as meshes: a profile in the half-plane of r and z, turned about the z axis by an angle.
//!
//! Whole spheres, disks and cylinders are exact (`quadrics`); what is cut, and disks with texture coordinates, are polygons with the normals and texture
//! coordinates of the surface at their corners, [`AROUND`] to a turn: nowhere further from the surface than 2·10⁻⁵ of its radius.
//! (u, v) are pbrt's: u the share of the angle, v the share of the profile.

use super::super::parameters::Parameters;
use super::Mapper;
use super::quadrics::turned;
use super::shapes::{Form, Wanted};
use etalon_math::float64;
use etalon_params::DVec3;
use etalon_transport::MeshData;
use glam::{DVec2, Vec2};

/// Polygons to a full turn.
const AROUND: f64 = 512.0;

/// A point of a profile.
#[derive(Clone, Copy)]
pub(crate) struct ProfilePoint {
    /// Distance from the axis, and height.
    pub(crate) at: DVec2,
    /// The unit normal there.
    pub(crate) normal: DVec2,
    /// Texture coordinate.
    pub(crate) v: f64,
}

/// How many pieces an arc of so many radians is cut in.
pub(crate) fn pieces(angle: f64) -> usize {
    (AROUND * angle / core::f64::consts::TAU).ceil().max(1.0) as usize
}

impl<'a> Mapper<'a> {
    /// A profile turned by an angle (radians), which makes a surface of an area; `None` after a mistake.
    pub(crate) fn turned_profile(
        &mut self,
        params: &Parameters<'a>,
        wanted: &Wanted<'_>,
        profile: &[ProfilePoint],
        [angle, area]: [f64; 2],
    ) -> Option<Form> {
        let steps = pieces(angle);
        let mut mesh = MeshData::default();
        for step in 0..=steps {
            let u = step as f64 / steps as f64;
            let (sin, cos) = float64::sin_cos(angle * u);
            let turned = |v: DVec2| DVec3::new(v.x * cos, v.x * sin, v.y).as_vec3();
            for point in profile {
                mesh.positions.push(turned(point.at));
                mesh.normals.push(turned(point.normal));
                mesh.uvs.push(Vec2::new(u as f32, point.v as f32));
            }
        }
        let rows = profile.len() as u32;
        for step in 0..steps as u32 {
            for row in 0..rows.saturating_sub(1) {
                let a = step * rows + row;
                let [b, c, d] = [a + rows, a + rows + 1, a + 1];
                // On the axis two corners are one.
                let off_axis = |row: u32| profile[row as usize].at.x > 0.0;
                mesh.triangles.extend(off_axis(row).then_some([a, b, c]));
                mesh.triangles
                    .extend(off_axis(row + 1).then_some([a, c, d]));
            }
        }
        let draft = self.inline_mesh(params, wanted, mesh)?;
        Some(Form {
            drafts: vec![Wanted::flipped(draft, turned(wanted))],
            area: Some(area),
        })
    }
}
