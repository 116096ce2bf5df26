//! The rectangle [−1, 1]² × {0}, normal +z, as two triangles that meet at u + v = 1.
//!
//! ```text
//! p(u, v) = p₀₀ + 2u x + 2v y
//! ```
//!
//! As a light it is chosen by solid angle (Ureña, Fajardo & King 2013) unless `to_world` shears
//! it into a parallelogram or it is seen too small or too flat; then by area.

use crate::placement::{Placement, perpendicular};
use crate::shapes::mesh::{Mesh, MeshOptions};
use crate::shapes::solid::{read_face_normals, read_flip};
use crate::surface::Surface;
use etalon_params::Params;
use etalon_sampling::warps::{RectangleSides, SphericalRectangle};
use etalon_transport::MeshData;
use glam::{Vec2, Vec3};

/// A rectangle or parallelogram.
#[derive(Debug)]
pub struct Rectangle {
    mesh: Mesh,
    corner: Vec3,
    sides: RectangleSides,
    area: f64,
    right_angled: bool,
}

impl Rectangle {
    /// The image of the square under `placement`; its normal is the image of +z.
    pub fn new(placement: &Placement, flip: bool) -> Result<Self, String> {
        let uvs = vec![Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::ONE];
        let data = MeshData {
            positions: uvs.iter().map(|uv| (*uv * 2.0 - 1.0).extend(0.0)).collect(),
            uvs,
            triangles: vec![[0, 1, 2], [3, 2, 1]],
            ..MeshData::default()
        };
        let options = MeshOptions {
            placement: *placement,
            face_normals: true,
            ..MeshOptions::default()
        };
        let mesh = Mesh::new(data, &options)?.outside(flip != placement.mirrors());
        let [corner, x, y] = mesh.corners(0);
        let edges = [x - corner, y - corner];
        let [a, b] = edges.map(|e| e.as_dvec3());
        Ok(Self {
            mesh,
            corner,
            sides: RectangleSides::new(edges),
            area: a.cross(b).length(),
            right_angled: perpendicular(a, b, false),
        })
    }

    /// Reads `face_normals`, `flip_normals` and `to_world`.
    pub(crate) fn from_params(params: &Params<'_>) -> Option<Self> {
        let placement = Placement::from_params(params);
        let flip = read_flip(params);
        read_face_normals(params);
        Self::new(&placement?, flip)
            .map_err(|message| params.error_at("to_world", message))
            .ok()
    }

    /// Its two triangles.
    #[inline]
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Surface area (m²).
    pub fn area(&self) -> f64 {
        self.area
    }

    /// The point with texture coordinates `uv`: surface, triangle, barycentric coordinates.
    #[inline]
    pub(crate) fn at(&self, uv: Vec2) -> (Surface, u32, Vec2) {
        let (primitive, b) = if uv.x + uv.y <= 1.0 {
            (0, uv)
        } else {
            (1, 1.0 - uv)
        };
        (self.mesh.surface(primitive, b), primitive, b)
    }

    /// The rectangle as seen from a point, if it is to be sampled by solid angle.
    #[inline]
    pub(crate) fn seen_from(&self, from: Vec3) -> Option<SphericalRectangle> {
        if !self.right_angled {
            return None;
        }
        SphericalRectangle::seen(self.corner - from, &self.sides)
    }
}
