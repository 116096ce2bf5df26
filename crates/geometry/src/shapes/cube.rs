//! The cube [−1, 1]³ as twelve triangles, with Mitsuba's vertices: each face is mapped to the
//! whole unit square.

use crate::placement::Placement;
use crate::shapes::mesh::{Mesh, MeshOptions};
use crate::shapes::shape_model::{read_face_normals, read_flip};
use etalon_params::Params;
use etalon_transport::MeshData;
use glam::{Vec2, Vec3};

/// The corners of each face, in the order of its texture coordinates (0, 1), (1, 1), (1, 0),
/// (0, 0).
const FACES: [[[f32; 3]; 4]; 6] = [
    [
        [1., -1., -1.],
        [1., -1., 1.],
        [-1., -1., 1.],
        [-1., -1., -1.],
    ],
    [[1., 1., -1.], [-1., 1., -1.], [-1., 1., 1.], [1., 1., 1.]],
    [[1., -1., -1.], [1., 1., -1.], [1., 1., 1.], [1., -1., 1.]],
    [[1., -1., 1.], [1., 1., 1.], [-1., 1., 1.], [-1., -1., 1.]],
    [
        [-1., -1., 1.],
        [-1., 1., 1.],
        [-1., 1., -1.],
        [-1., -1., -1.],
    ],
    [
        [1., 1., -1.],
        [1., -1., -1.],
        [-1., -1., -1.],
        [-1., 1., -1.],
    ],
];
const UVS: [Vec2; 4] = [Vec2::Y, Vec2::ONE, Vec2::X, Vec2::ZERO];

/// The cube under `placement`; its outside stays outside when mirrored.
pub fn cube(placement: &Placement, flip: bool) -> Result<Mesh, String> {
    let mut data = MeshData::default();
    for (face, corners) in (0u32..).zip(FACES) {
        data.positions.extend(corners.map(Vec3::from_array));
        data.uvs.extend(UVS);
        data.triangles
            .extend([[0, 1, 2], [3, 0, 2]].map(|t: [u32; 3]| t.map(|i| 4 * face + i)));
    }
    let options = MeshOptions {
        placement: *placement,
        face_normals: true,
        ..MeshOptions::default()
    };
    Ok(Mesh::new(data, &options)?.outside(flip != placement.mirrors()))
}

/// Reads `face_normals`, `flip_normals` and `to_world`.
pub(crate) fn from_params(params: &Params<'_>) -> Option<Mesh> {
    let placement = Placement::from_params(params);
    let flip = read_flip(params);
    read_face_normals(params);
    cube(&placement?, flip)
        .map_err(|message| params.error_at("to_world", message))
        .ok()
}
