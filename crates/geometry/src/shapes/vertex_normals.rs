//! Vertex normals of a mesh that has none: the sum of the triangles' normals, weighted by their
//! angle at the vertex (Thürmer & Wüthrich 1998, "Computing Vertex Normals from Polygonal
//! Facets", JGT 3(1)). The weights do not depend on how a flat face is cut into triangles.

use etalon_math::float64;
use glam::{DVec3, Vec3};

/// One unit normal per position; zero where no triangle has area.
pub(crate) fn vertex_normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut sums = vec![DVec3::ZERO; positions.len()];
    for triangle in triangles {
        let p = triangle.map(|i| positions[i as usize].as_dvec3());
        let Some(normal) = (p[1] - p[0]).cross(p[2] - p[0]).try_normalize() else {
            continue;
        };
        for corner in 0..3 {
            let a = p[(corner + 1) % 3] - p[corner];
            let b = p[(corner + 2) % 3] - p[corner];
            let angle = float64::atan2(a.cross(b).length(), a.dot(b));
            sums[triangle[corner] as usize] += normal * angle;
        }
    }
    sums.into_iter()
        .map(|sum| sum.try_normalize().unwrap_or(DVec3::ZERO).as_vec3())
        .collect()
}
