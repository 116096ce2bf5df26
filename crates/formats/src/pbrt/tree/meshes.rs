//! Triangle meshes that stand in the scene file (`shapes.cpp`, `Triangle::CreateMesh`; `util/mesh.cpp`).
//!
//! The tree has no value for arrays: a mesh goes into the document's list, and a `ply` has its name there for that of a file.
//!
//! Without vertex normals pbrt shades flat, which is `face_normals`; the normal follows from the winding in the world, and is turned if exactly
//! one of these holds: `ReverseOrientation`, and a CTM that mirrors. Vertex normals are carried along by the CTM as covectors, turned by
//! `ReverseOrientation` alone, and say where outside is, whatever the winding. Etalon's meshes do the same with `flip_normals`.
//!
//! A mesh without texture coordinates has (0, 0), (1, 0) and (1, 1) at the corners of every triangle; that is written out where it matters, as
//! Mitsuba has others.

use super::super::parameters::Parameters;
use super::Mapper;
use super::node::{Draft, word};
use super::quadrics::turned;
use super::shapes::{Form, Wanted};
use crate::document::mesh_name;
use etalon_params::{DMat4, DVec3, Diagnostic, Value};
use etalon_transport::MeshData;
use glam::{Vec2, Vec3};
use std::sync::Arc;

/// By how much, of its size, the area of a triangle may differ from that of others for it to count as the same.
const SAME_AREA: f64 = 1e-4;

impl<'a> Mapper<'a> {
    /// A mesh; `None` after a mistake.
    pub(crate) fn triangle_mesh(
        &mut self,
        params: &Parameters<'a>,
        wanted: &Wanted<'_>,
    ) -> Option<Form> {
        params.ignore(&["faceIndices"]);
        if let Some(tangents) = params.vectors3("S") {
            let message = format!("the {} tangents `S` are not used", tangents.len());
            let note = Diagnostic::note(params.span("S"), message);
            self.diagnostics.push(note);
        }
        let positions = positions(params);
        let uvs = uvs(params);
        let normals = normals(params);
        let corners = corners::<3>(params, positions.as_ref().map_or(0, Vec::len));
        let (positions, corners) = (positions?, corners?);
        let mut data = MeshData {
            normals: per_vertex(params, "N", normals, positions.len())?,
            uvs: per_vertex(params, "uv", uvs, positions.len())?,
            positions,
            triangles: corners,
            ..MeshData::default()
        };
        if wanted.by_uv && data.uvs.is_empty() {
            data = with_default_uvs(&data);
        }
        let area = common_area(&data, wanted.shape.placement.start);
        let draft = self.mesh_shape(params, wanted, data)?;
        Some(Form {
            drafts: vec![draft],
            area,
        })
    }

    /// The shape of a mesh that becomes part of the document.
    pub(crate) fn mesh_shape(
        &mut self,
        params: &Parameters<'_>,
        wanted: &Wanted<'_>,
        data: MeshData,
    ) -> Option<Draft> {
        let flat = data.normals.is_empty();
        let draft = self.inline_mesh(params, wanted, data)?;
        Some(shaded(draft, wanted, flat))
    }

    /// The same without saying how it is shaded and where its outside is.
    pub(crate) fn inline_mesh(
        &mut self,
        params: &Parameters<'_>,
        wanted: &Wanted<'_>,
        data: MeshData,
    ) -> Option<Draft> {
        let name = mesh_name(self.meshes.len());
        let draft = self.placed_form(params, wanted, "ply", DMat4::IDENTITY)?;
        self.meshes.push(Arc::new(data));
        Some(draft.plain("filename", word(&name)))
    }
}

/// Adds how a mesh is shaded and where its outside is.
pub(crate) fn shaded(draft: Draft, wanted: &Wanted<'_>, flat: bool) -> Draft {
    if !flat {
        return Wanted::flipped(draft, wanted.shape.reverse_orientation);
    }
    let draft = draft.plain("face_normals", Value::Boolean(true));
    Wanted::flipped(draft, turned(wanted))
}

/// The vertices; `None` after a mistake.
pub(crate) fn positions(params: &Parameters<'_>) -> Option<Vec<Vec3>> {
    let Some(points) = params.points3("P") else {
        params.missing("point3 P");
        return None;
    };
    Some(points.iter().map(single).collect())
}

/// The normals at vertices.
pub(crate) fn normals(params: &Parameters<'_>) -> Vec<Vec3> {
    let normals = params.normals("N").unwrap_or_default();
    normals.iter().map(single).collect()
}

/// The texture coordinates at vertices.
pub(crate) fn uvs(params: &Parameters<'_>) -> Vec<Vec2> {
    let pairs = params.points2("uv").unwrap_or_default();
    let pair = |[u, v]: &[f64; 2]| Vec2::new(*u as f32, *v as f32);
    pairs.iter().map(pair).collect()
}

fn single([x, y, z]: &[f64; 3]) -> Vec3 {
    Vec3::new(*x as f32, *y as f32, *z as f32)
}

/// The corners of polygons of N corners; a single polygon needs no indices. `None` after a mistake.
pub(crate) fn corners<const N: usize>(
    params: &Parameters<'_>,
    vertices: usize,
) -> Option<Vec<[u32; N]>> {
    let Some(indices) = params.integers("indices") else {
        if params.has("indices") || vertices == 0 {
            return None;
        }
        if vertices == N {
            return Some(vec![core::array::from_fn(|corner| corner as u32)]);
        }
        params.missing("integer indices");
        return None;
    };
    let (polygons, rest) = indices.as_chunks::<N>();
    if !rest.is_empty() {
        let message = format!("{} indices are no multiple of {N}", indices.len());
        params.error_at("indices", message);
        return None;
    }
    let outside = |index: &&i32| usize::try_from(**index).is_ok_and(|i| i < vertices);
    if let Some(wrong) = indices.iter().find(|index| !outside(index)) {
        let most = vertices.saturating_sub(1);
        params.refuse("indices", wrong, &format!("integers from 0 to {most}"));
        return None;
    }
    // All are from 0 on.
    Some(
        polygons
            .iter()
            .map(|polygon| polygon.map(|i| i as u32))
            .collect(),
    )
}

/// Quantities of which there must be as many as vertices, if there are any; `None` after a mistake.
pub(crate) fn per_vertex<T>(
    params: &Parameters<'_>,
    name: &str,
    values: Vec<T>,
    vertices: usize,
) -> Option<Vec<T>> {
    if values.is_empty() && params.has(name) {
        return None;
    }
    if !values.is_empty() && values.len() != vertices {
        let message = format!(
            "there are {} `{name}` for {vertices} vertices",
            values.len()
        );
        params.error_at(name, message);
        return None;
    }
    Some(values)
}

/// The mesh with the texture coordinates that pbrt gives the corners of every triangle.
pub(crate) fn with_default_uvs(data: &MeshData) -> MeshData {
    let corners = || {
        data.triangles
            .iter()
            .flatten()
            .map(|&corner| corner as usize)
    };
    let all = |of: &[Vec3]| -> Vec<Vec3> {
        corners()
            .filter_map(|corner| of.get(corner).copied())
            .collect()
    };
    let count = data.triangles.len() as u32;
    MeshData {
        positions: all(&data.positions),
        normals: all(&data.normals),
        uvs: [Vec2::ZERO, Vec2::X, Vec2::ONE].repeat(data.triangles.len()),
        triangles: (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        ..MeshData::default()
    }
}

/// The area of a triangle in the world, if all triangles have the same.
fn common_area(data: &MeshData, to_world: DMat4) -> Option<f64> {
    let place = |&corner: &u32| {
        let position = data.positions.get(corner as usize)?;
        Some(to_world.transform_point3(position.as_dvec3()))
    };
    let area = |triangle: &[u32; 3]| {
        let [a, b, c]: [Option<DVec3>; 3] = triangle.each_ref().map(place);
        let (a, b, c) = (a?, b?, c?);
        Some(0.5 * (b - a).cross(c - a).length())
    };
    let areas: Option<Vec<f64>> = data.triangles.iter().map(area).collect();
    same_for_all(&areas?)
}

/// The area that all have.
pub(crate) fn same_for_all(areas: &[f64]) -> Option<f64> {
    let first = *areas.first()?;
    let same = |area: &f64| (area - first).abs() <= SAME_AREA * first;
    areas.iter().all(same).then_some(first)
}
