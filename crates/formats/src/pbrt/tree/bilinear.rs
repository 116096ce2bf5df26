//! Bilinear meshes (`shapes.cpp`, `BilinearPatch::CreateMesh`): patches between four corners, p(0, 0), p(1, 0), p(0, 1), p(1, 1).
//!
//! Parallelograms, which most are, become two triangles each, exactly: texture coordinates and normals too, if those of the
//! corners are linear as well. A curved patch becomes a `bilinear` if it has neither normals nor texture coordinates of its own. The
//! normal is ∂p/∂u × ∂p/∂v in the world, turned as that of a triangle is; Etalon's `bilinear` carries it along, so a mirroring CTM turns it
//! there by itself.

use super::super::parameters::Parameters;
use super::Mapper;
use super::meshes::{corners, normals, per_vertex, positions, same_for_all, uvs};
use super::node::vector;
use super::shapes::{Form, Wanted};
use etalon_params::{DMat4, DVec3};
use etalon_transport::MeshData;
use glam::{Vec2, Vec3};

/// By how much, of its size, a quantity at the fourth corner may differ from the linear one.
const LINEAR: f32 = 1e-5;

impl<'a> Mapper<'a> {
    /// A mesh of patches; `None` after a mistake.
    pub(crate) fn bilinear_mesh(
        &mut self,
        params: &Parameters<'a>,
        wanted: &Wanted<'_>,
    ) -> Option<Form> {
        params.ignore(&["faceIndices"]);
        if params.string("emissionfilename").is_some() {
            let accepted = "an area light with a `filename`";
            self.refuse_value(params, "emissionfilename", "`emissionfilename`", accepted);
            return None;
        }
        let positions = positions(params);
        let patches = corners::<4>(params, positions.as_ref().map_or(0, Vec::len));
        let (positions, patches) = (positions?, patches?);
        let normals = per_vertex(params, "N", normals(params), positions.len())?;
        let uvs = per_vertex(params, "uv", uvs(params), positions.len())?;
        let at = |of: &[Vec3], patch: &[u32; 4]| {
            patch.map(|i| of.get(i as usize).copied().unwrap_or_default())
        };
        let flat = patches.iter().all(|patch| {
            let uv = patch.map(|i| uvs.get(i as usize).map_or(Vec3::ZERO, |uv| uv.extend(0.0)));
            [at(&positions, patch), at(&normals, patch), uv]
                .iter()
                .all(is_linear)
        });
        if flat {
            let to_world = wanted.shape.placement.start;
            let areas: Vec<f64> = patches
                .iter()
                .map(|p| area(at(&positions, p), to_world))
                .collect();
            let data = triangulated(&positions, &normals, &uvs, &patches);
            let draft = self.mesh_shape(params, wanted, data)?;
            return Some(Form {
                drafts: vec![draft],
                area: same_for_all(&areas),
            });
        }
        if !normals.is_empty() || !uvs.is_empty() {
            let name = if normals.is_empty() { "uv" } else { "N" };
            let what = format!("`{name}` of curved patches");
            self.refuse_value(
                params,
                name,
                &what,
                "parallelograms, or patches without `N` and `uv`",
            );
            return None;
        }
        let mut drafts = Vec::new();
        for patch in &patches {
            let draft = self.placed_form(params, wanted, "bilinear", DMat4::IDENTITY)?;
            let names = ["p00", "p10", "p01", "p11"]
                .into_iter()
                .zip(at(&positions, patch));
            let draft = names.fold(draft, |draft, (name, p)| {
                draft.from(params, "P", name, vector(p.as_dvec3()))
            });
            drafts.push(Wanted::flipped(draft, wanted.shape.reverse_orientation));
        }
        Some(Form { drafts, area: None })
    }
}

/// Whether what four corners have is linear between them.
fn is_linear([a, b, c, d]: &[Vec3; 4]) -> bool {
    let size = (*b - *a).length() + (*c - *a).length() + (*d - *a).length();
    ((*a + *d) - (*b + *c)).length() <= LINEAR * size
}

/// The area of a parallelogram in the world.
fn area([a, b, c, _]: [Vec3; 4], to_world: DMat4) -> f64 {
    let side = |p: Vec3| -> DVec3 { to_world.transform_vector3((p - a).as_dvec3()) };
    side(b).cross(side(c)).length()
}

/// Two triangles of every patch, whose corners have (u, v) of the unit square if nothing is given.
fn triangulated(
    positions: &[Vec3],
    normals: &[Vec3],
    uvs: &[Vec2],
    patches: &[[u32; 4]],
) -> MeshData {
    let halves = |[a, b, c, d]: [u32; 4]| [[a, b, d], [a, d, c]];
    if !uvs.is_empty() {
        return MeshData {
            positions: positions.to_vec(),
            normals: normals.to_vec(),
            uvs: uvs.to_vec(),
            triangles: patches.iter().flat_map(|patch| halves(*patch)).collect(),
            ..MeshData::default()
        };
    }
    let corners = || patches.iter().flatten().map(|&corner| corner as usize);
    let all = |of: &[Vec3]| -> Vec<Vec3> { corners().filter_map(|i| of.get(i).copied()).collect() };
    let first = (0..patches.len() as u32).map(|i| 4 * i);
    MeshData {
        positions: all(positions),
        normals: all(normals),
        uvs: [Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::ONE].repeat(patches.len()),
        triangles: first
            .flat_map(|i| halves([i, i + 1, i + 2, i + 3]))
            .collect(),
        ..MeshData::default()
    }
}
