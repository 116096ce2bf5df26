//! Vertex normals of a mesh that has none: the sum of the triangles' normals, weighted by their
//! angle at the vertex (Thürmer & Wüthrich 1998, "Computing Vertex Normals from Polygonal
//! Facets", JGT 3(1)). The weights do not depend on how a flat face is cut into triangles.

use etalon_math::float64;
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Triangles whose angles are taken at once, on all threads.
const AT_ONCE: usize = 1 << 16;

/// One unit normal per position; zero where no triangle has area. Sums are in the order of the
/// triangles for any number of threads.
pub(crate) fn vertex_normals(positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec<Vec3> {
    let mut sums = vec![DVec3::ZERO; positions.len()];
    for triangles in triangles.chunks(AT_ONCE) {
        let weighted: Vec<_> = triangles
            .par_iter()
            .map(|triangle| weighted_normals(positions, triangle))
            .collect();
        for (triangle, normals) in triangles.iter().zip(weighted) {
            for (vertex, normal) in triangle.iter().zip(normals) {
                sums[*vertex as usize] += normal;
            }
        }
    }
    sums.into_iter()
        .map(|sum| sum.try_normalize().unwrap_or(DVec3::ZERO).as_vec3())
        .collect()
}

/// The triangle's unit normal times its angle at each corner.
fn weighted_normals(positions: &[Vec3], triangle: &[u32; 3]) -> [DVec3; 3] {
    let [a, b, c] = *triangle;
    let at = |i: u32| positions[i as usize].as_dvec3();
    let (a, b, c) = (at(a), at(b), at(c));
    let cross = (b - a).cross(c - a);
    let twice_area = cross.length();
    if !(twice_area > 0.0) {
        return [DVec3::ZERO; 3];
    }
    let normal = cross / twice_area;
    // tan of an angle = twice the area over the dot product of its sides.
    let weighted =
        |p: DVec3, q: DVec3, r: DVec3| normal * float64::atan2(twice_area, (q - p).dot(r - p));
    [weighted(a, b, c), weighted(b, c, a), weighted(c, a, b)]
}
