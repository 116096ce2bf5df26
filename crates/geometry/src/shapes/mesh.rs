//! A triangle mesh in the world.
//!
//! ```text
//! p(b₁, b₂) = (1 − b₁ − b₂) p₀ + b₁ p₁ + b₂ p₂
//! ```
//!
//! Normals follow Mitsuba 3: a file's vertex normals are taken along by `to_world` (as
//! covectors); if it has none, they are computed in the world, weighted by the angle at the
//! vertex (Thürmer & Wüthrich 1998), as are those that are not finite; `face_normals` discards both. The geometric normal is the
//! one of the two perpendiculars that lies on the shading normal's side, so that "outside" never
//! depends on the winding of a file that has normals.
//!
//! Texture coordinates give ∂p/∂u and ∂p/∂v; without them (u, v) = (b₁, b₂).

pub(crate) mod convex;
pub(crate) mod displaced;
pub(crate) mod file_mesh;
mod shape_model;
pub(crate) mod vertex_normals;

use crate::accelerator::Bounds;
use crate::local_interaction::LocalInteraction;
use crate::placement::Placement;
use etalon_math::{DirectionCone, Frame, cross, gamma};
use etalon_sampling::discrete::AliasTable;
use etalon_transport::{Attribute, MeshData};
use glam::{DVec3, Vec2, Vec3};
use std::sync::OnceLock;

/// The options of a mesh.
#[derive(Clone, Copy, Debug)]
pub struct MeshOptions {
    /// Its placement.
    pub placement: Placement,
    /// Shade with the triangles' own normals.
    pub face_normals: bool,
    /// Turn all normals around.
    pub flip_normals: bool,
    /// Replace v by 1 − v.
    pub flip_tex_coords: bool,
}

impl Default for MeshOptions {
    fn default() -> Self {
        Self {
            placement: Placement::IDENTITY,
            face_normals: false,
            flip_normals: false,
            flip_tex_coords: false,
        }
    }
}

/// A triangle mesh in the world.
#[derive(Debug)]
pub struct Mesh {
    positions: Vec<Vec3>,
    /// Unit vertex normals, turned already; empty for face normals.
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    triangles: Vec<[u32; 3]>,
    attributes: Vec<Attribute>,
    /// Whether the outside is where (p₁ − p₀) × (p₂ − p₀) does *not* point, if there are no
    /// vertex normals.
    reversed: bool,
    by_area: OnceLock<Option<AliasTable>>,
    /// Whether it is intersected in double precision, see [`crate::touching`].
    pub(crate) touches: bool,
}

impl Mesh {
    /// Places a mesh; an error for invalid data.
    pub fn new(mut data: MeshData, options: &MeshOptions) -> Result<Self, String> {
        check(&data)?;
        for uv in data.uvs.iter_mut().filter(|uv| !uv.is_finite()) {
            *uv = Vec2::ZERO;
        }
        let placement = &options.placement;
        if *placement != Placement::IDENTITY {
            for p in &mut data.positions {
                *p = placement.point(p.as_dvec3()).as_vec3();
                if !p.is_finite() {
                    return Err("`to_world` takes a vertex out of the range of numbers".into());
                }
            }
        }
        let mut normals = core::mem::take(&mut data.normals);
        if options.face_normals {
            normals = Vec::new();
        } else if !normals.iter().any(|n| n.is_finite()) {
            normals = computed_normals(&data);
        } else {
            place_normals(&mut normals, &data, placement);
        }
        if options.flip_normals {
            normals.iter_mut().for_each(|n| *n = -*n);
        }
        if options.flip_tex_coords {
            data.uvs.iter_mut().for_each(|uv| uv.y = 1.0 - uv.y);
        }
        Ok(Self {
            positions: data.positions,
            normals,
            uvs: data.uvs,
            triangles: data.triangles,
            attributes: data.attributes,
            reversed: options.flip_normals,
            by_area: OnceLock::new(),
            touches: false,
        })
    }

    /// A mesh with face normals whose outside is given, not wound.
    pub(crate) fn outside(mut self, against_winding: bool) -> Self {
        self.reversed = against_winding;
        self
    }

    /// The mesh in world space, wound counter-clockwise as seen from outside.
    pub(crate) fn data(&self) -> MeshData {
        let mut triangles = self.triangles.clone();
        for (primitive, triangle) in (0..).zip(&mut triangles) {
            let [a, b, c] = self.corners(primitive);
            let wound = (b - a).cross(c - a);
            let outside = match self.normals.is_empty() {
                true => !self.reversed,
                false => {
                    let normals = self.at_corners(&self.normals, primitive);
                    wound.dot(normals.iter().sum()) >= 0.0
                }
            };
            if !outside {
                triangle.swap(1, 2);
            }
        }
        MeshData {
            positions: self.positions.clone(),
            normals: self.normals.clone(),
            uvs: self.uvs.clone(),
            triangles,
            attributes: self.attributes.clone(),
            ..MeshData::default()
        }
    }

    /// Number of triangles.
    #[inline]
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// The smallest box around it.
    pub fn bounds(&self) -> Bounds {
        Bounds::around(&self.positions)
    }

    /// Memory held (bytes).
    pub fn bytes(&self) -> usize {
        let attributes: usize = self.attributes.iter().map(|a| 4 * a.values.len()).sum();
        12 * (self.positions.len() + self.normals.len() + self.triangles.len())
            + 8 * self.uvs.len()
            + attributes
    }

    /// The corners of a triangle.
    #[inline]
    pub fn corners(&self, primitive: u32) -> [Vec3; 3] {
        self.at_corners(&self.positions, primitive)
    }

    /// The elements of `of` for the corners of a triangle.
    #[inline(always)] // One by one: `map` over arrays is not reliably inlined.
    fn at_corners<T: Copy>(&self, of: &[T], primitive: u32) -> [T; 3] {
        let [a, b, c] = self.triangles[primitive as usize];
        [of[a as usize], of[b as usize], of[c as usize]]
    }

    fn triangle_area(corners: [Vec3; 3]) -> f64 {
        let [p0, p1, p2] = corners.map(|p| p.as_dvec3());
        0.5 * (p1 - p0).cross(p2 - p0).length()
    }

    /// Surface area (m²).
    pub fn area(&self) -> f64 {
        self.by_area().map_or(0.0, AliasTable::total)
    }

    /// The distribution of triangles by area, built at first use; `None` if there is no area.
    pub(crate) fn by_area(&self) -> Option<&AliasTable> {
        self.by_area
            .get_or_init(|| {
                let areas: Vec<f64> = (0..self.triangles.len() as u32)
                    .map(|i| Self::triangle_area(self.corners(i)))
                    .collect();
                AliasTable::new(&areas).ok()
            })
            .as_ref()
    }

    /// A cone that holds the normals of its triangles: everything, where vertex normals say which side
    /// is outside.
    pub(crate) fn cone_of_normals(&self) -> DirectionCone {
        if !self.normals.is_empty() {
            return DirectionCone::ALL;
        }
        (0..self.triangles.len() as u32)
            .filter(|&i| Self::triangle_area(self.corners(i)) > 0.0)
            .map(|i| self.surface(i, Vec2::ZERO).normal.as_dvec3())
            .filter_map(DVec3::try_normalize)
            .map(DirectionCone::along)
            .reduce(DirectionCone::union)
            .unwrap_or(DirectionCone::ALL)
    }

    /// The surface point with barycentric coordinates `b` of a triangle's second and third
    /// corner.
    #[inline(always)] // Lights that are sampled need little of it.
    pub(crate) fn surface(&self, primitive: u32, b: Vec2) -> LocalInteraction {
        self.surface_between(self.corners(primitive), primitive, b)
    }

    /// [`Mesh::surface`] of a triangle whose corners are known.
    #[inline(always)] // As above.
    pub(crate) fn surface_between(
        &self,
        [p0, p1, p2]: [Vec3; 3],
        primitive: u32,
        b: Vec2,
    ) -> LocalInteraction {
        let b0 = 1.0 - b.x - b.y;
        let position = p0 * b0 + p1 * b.x + p2 * b.y;
        // Seven roundings (Pharr, Jakob, Humphreys 2023, section 6.8.5); and the next ray's
        // intersection rounds differences to the corners.
        let error = (p0.abs() * b0.abs() + p1.abs() * b.x.abs() + p2.abs() * b.y.abs()) * gamma(9)
            + f32::MIN_POSITIVE;
        let (e1, e2) = (p1 - p0, p2 - p0);
        let cross = unit_normal(e1, e2);
        let mut normal = if self.reversed { -cross } else { cross };
        let mut shading_normal = normal;
        if !self.normals.is_empty() {
            let [n0, n1, n2] = self.at_corners(&self.normals, primitive);
            let sum = n0 * b0 + n1 * b.x + n2 * b.y;
            shading_normal = sum.try_normalize().unwrap_or(normal);
            if shading_normal.dot(normal) < 0.0 {
                normal = -normal;
            }
        }
        let (uv, dp_du, dp_dv) = if self.uvs.is_empty() {
            (b, e1, e2)
        } else {
            let [t0, t1, t2] = self.at_corners(&self.uvs, primitive);
            let (d1, d2) = (t1 - t0, t2 - t0);
            let inverse = 1.0 / d1.perp_dot(d2);
            let uv = t0 * b0 + t1 * b.x + t2 * b.y;
            if inverse.is_finite() {
                let dp_du = (e1 * d2.y - e2 * d1.y) * inverse;
                let dp_dv = (e2 * d1.x - e1 * d2.x) * inverse;
                (uv, dp_du, dp_dv)
            } else {
                let frame = Frame::from_normal(normal);
                (uv, frame.s, frame.t)
            }
        };
        LocalInteraction {
            position,
            error,
            depth: f32::NAN,
            normal,
            shading: Frame::from_normal_and_tangent(shading_normal, dp_du),
            uv,
            dp_du,
            dp_dv,
            face: 0,
        }
    }

    /// The attribute `name` at a point of a triangle, as three channels; each stored number counts
    /// as the nearest in the range.
    pub(crate) fn attribute(
        &self,
        name: &str,
        primitive: u32,
        b: Vec2,
        range: [f32; 2],
    ) -> Option<Vec3> {
        let attribute = self.attributes.iter().find(|a| a.name == name)?;
        if name.starts_with("face_") {
            return Some(attribute.of(primitive as usize, range));
        }
        let corners = self.triangles[primitive as usize];
        let [a0, a1, a2] = corners.map(|i| attribute.of(i as usize, range));
        Some(a0 * (1.0 - b.x - b.y) + a1 * b.x + a2 * b.y)
    }

    /// The attributes of its vertices and faces.
    pub(crate) fn attributes(&self) -> &[Attribute] {
        &self.attributes
    }

    /// Whether it has texture coordinates.
    pub fn has_uvs(&self) -> bool {
        !self.uvs.is_empty()
    }
}

/// Vertex normals of positions in the world; copies of a vertex get one normal together.
pub(crate) fn computed_normals(data: &MeshData) -> Vec<Vec3> {
    if data.copies.is_empty() {
        return vertex_normals::vertex_normals(&data.positions, &data.triangles);
    }
    let first = data.positions.len() - data.copies.len();
    let original = |i: u32| match (i as usize).checked_sub(first) {
        Some(copy) => data.copies[copy],
        None => i,
    };
    let joined: Vec<[u32; 3]> = (data.triangles.iter())
        .map(|triangle| triangle.map(original))
        .collect();
    let mut normals = vertex_normals::vertex_normals(&data.positions, &joined);
    for (copy, &vertex) in data.copies.iter().enumerate() {
        normals[first + copy] = normals[vertex as usize];
    }
    normals
}

/// Takes normals into the world, where `data` stands already; computes those that are not finite,
/// on the side on which the others are.
fn place_normals(normals: &mut [Vec3], data: &MeshData, placement: &Placement) {
    let mut computed = Vec::new();
    if !normals.iter().all(|n| n.is_finite()) {
        computed = computed_normals(data);
        if placement.mirrors() {
            computed.iter_mut().for_each(|n| *n = -*n);
        }
    }
    for (i, n) in normals.iter_mut().enumerate() {
        *n = if n.is_finite() {
            let placed = placement.normal(n.as_dvec3());
            placed.try_normalize().unwrap_or(DVec3::ZERO).as_vec3()
        } else {
            computed[i]
        };
    }
}

/// An error for invalid data.
fn check(data: &MeshData) -> Result<(), String> {
    let count = data.positions.len();
    if let Some(i) = data.positions.iter().position(|p| !p.is_finite()) {
        return Err(format!("vertex {i} of the mesh is {}", data.positions[i]));
    }
    let outside = |t: &[u32; 3]| t.iter().any(|&i| i as usize >= count);
    if let Some(i) = data.triangles.iter().position(outside) {
        return Err(format!(
            "triangle {i} of the mesh refers to vertices {:?}, but there are only {count}",
            data.triangles[i]
        ));
    }
    for (what, length) in [
        ("normals", data.normals.len()),
        ("texture coordinates", data.uvs.len()),
    ] {
        if length != 0 && length != count {
            return Err(format!("the mesh has {count} vertices but {length} {what}"));
        }
    }
    let first = count.checked_sub(data.copies.len());
    if first.is_none_or(|first| data.copies.iter().any(|&c| c as usize >= first)) {
        return Err("the mesh has copies of vertices that it does not have".into());
    }
    for attribute in &data.attributes {
        let of = if attribute.name.starts_with("face_") {
            data.triangles.len()
        } else {
            count
        };
        if !(1..=4).contains(&attribute.channels)
            || attribute.values.len() != attribute.channels * of
        {
            return Err(format!(
                "the mesh attribute `{}` needs 1 to 4 values for each of {of}",
                attribute.name
            ));
        }
    }
    Ok(())
}

/// The unit vector perpendicular to two edges.
#[inline]
fn unit_normal(e1: Vec3, e2: Vec3) -> Vec3 {
    let n = cross(e1, e2);
    let length_squared = n.length_squared();
    if length_squared > 1e-30 && length_squared < 1e30 {
        return n / length_squared.sqrt();
    }
    // Squares of tiny or huge triangles leave the range of single precision.
    e1.as_dvec3().cross(e2.as_dvec3()).normalize().as_vec3()
}
