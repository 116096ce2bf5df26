//! Displacement: a surface moved along its normal, as fine triangles.
//!
//! ```text
//! p'(u, v) = p(u, v) + h(u, v) n(u, v)
//! ```
//!
//! Cook (1984), *Shade Trees*: unlike a bump or normal map it changes the outline. A shape with a parametrisation becomes a
//! net; a mesh has its edges bisected until none is longer than `edge_length`. Bisection depends on the edge alone, so that
//! neighbours stay joined. Coincident vertices, as along the seam of a sphere, move together, by their mean displacement.

use crate::shapes::Shape;
use crate::shapes::mesh::{Mesh, MeshOptions, computed_normals};
use etalon_transport::{Attribute, MeshData};
use glam::{DVec2, Vec2, Vec3};
use std::collections::HashMap;

/// Triangles at most: as many take some gigabytes.
const MOST: usize = 1 << 26;

/// The answer where more would be needed.
fn too_many() -> String {
    format!("`edge_length` asks for more than {MOST} triangles")
}

impl Shape {
    /// The shape as triangles whose edges are at most `edge` long (m), each vertex moved along its normal by `height` of
    /// its position and texture coordinates (m). Shading normals are those of the moved surface, or the triangles' own.
    pub fn displaced(
        &self,
        edge: f32,
        height: impl Fn(Vec3, Vec2) -> f32,
        face_normals: bool,
    ) -> Result<Self, String> {
        let mut data = match self.mesh() {
            Some(mesh) => halved(mesh.data(), edge)?,
            None => self.net(edge)?,
        };
        data = joined(data, edge);
        let moved = moved(&data, height);
        data.positions = moved;
        data.normals = Vec::new();
        let options = MeshOptions {
            face_normals,
            ..MeshOptions::default()
        };
        Mesh::new(data, &options).map(Shape::Mesh)
    }

    /// A net of points by (u, v).
    fn net(&self, edge: f32) -> Result<MeshData, String> {
        let at = |uv: DVec2| {
            self.parametric(uv)
                .ok_or("a shape without texture coordinates")
        };
        let mut cells = [8_usize; 2];
        loop {
            let [columns, rows] = cells.map(|cells| cells + 1);
            if 2 * cells[0] * cells[1] > MOST {
                return Err(too_many());
            }
            let mut data = MeshData::default();
            for (row, column) in (0..rows).flat_map(|r| (0..columns).map(move |c| (r, c))) {
                let uv =
                    DVec2::new(column as f64, row as f64) / DVec2::from(cells.map(|n| n as f64));
                let point = at(uv)?;
                data.positions.push(point.position);
                data.normals.push(point.shading.n);
                // Those of the net's ends, where the shape itself would say 0 for 1.
                data.uvs.push(uv.as_vec2());
            }
            // The longest edges along u and along v.
            let mut longest = [0.0_f32; 2];
            for (row, column) in (0..rows).flat_map(|r| (0..columns).map(move |c| (r, c))) {
                let p = |row: usize, column: usize| data.positions[row * columns + column];
                if column > 0 {
                    longest[0] = longest[0].max(p(row, column).distance(p(row, column - 1)));
                }
                if row > 0 {
                    longest[1] = longest[1].max(p(row, column).distance(p(row - 1, column)));
                }
            }
            // Diagonals are edges, too.
            let side = edge * core::f32::consts::FRAC_1_SQRT_2;
            let finer = longest.map(|longest| (longest / side).max(1.0));
            if finer == [1.0; 2] {
                wind(&mut data, columns, rows);
                return Ok(data);
            }
            for (cells, finer) in cells.iter_mut().zip(finer) {
                *cells = (*cells as f32 * finer * 1.02).ceil() as usize;
            }
        }
    }
}

/// The triangles of a net, wound so that their normals are on the side of the points'.
fn wind(data: &mut MeshData, columns: usize, rows: usize) {
    for (row, column) in (0..rows - 1).flat_map(|r| (0..columns - 1).map(move |c| (r, c))) {
        let [a, b] = [row, row + 1].map(|row| (row * columns + column) as u32);
        for [i, j, k] in [[a, a + 1, b], [a + 1, b + 1, b]] {
            let p = |i: u32| data.positions[i as usize];
            let normal = (p(j) - p(i)).cross(p(k) - p(i));
            // At a pole two corners meet.
            if normal.length_squared() > 0.0 {
                let outside = normal.dot(data.normals[i as usize]) >= 0.0;
                data.triangles
                    .push(if outside { [i, j, k] } else { [i, k, j] });
            }
        }
    }
}

/// Halves all edges that are too long, again and again.
fn halved(mut data: MeshData, edge: f32) -> Result<MeshData, String> {
    let expected = data.triangles.iter().map(|triangle| {
        let [a, b, c] = triangle.map(|i| data.positions[i as usize]);
        // A triangle whose edges are that long, by its area.
        let area = 0.5 * (b - a).cross(c - a).length();
        f64::from(area / (0.44 * edge * edge)).max(1.0)
    });
    if expected.sum::<f64>() > MOST as f64 {
        return Err(too_many());
    }
    loop {
        let mut middles: HashMap<[u32; 2], u32> = HashMap::new();
        let mut finer = Vec::with_capacity(data.triangles.len());
        let mut faces = Vec::with_capacity(data.triangles.len());
        for (face, triangle) in core::mem::take(&mut data.triangles).into_iter().enumerate() {
            let [a, b, c] = triangle;
            let [ab, bc, ca] = [[a, b], [b, c], [c, a]].map(|ends| {
                let [p, q] = ends.map(|i| data.positions[i as usize]);
                (p.distance(q) > edge).then(|| {
                    let key = [ends[0].min(ends[1]), ends[0].max(ends[1])];
                    *(middles.entry(key)).or_insert_with(|| add_middle(&mut data, key))
                })
            });
            let first = finer.len();
            match (ab, bc, ca) {
                (None, None, None) => finer.push([a, b, c]),
                (Some(m), None, None) => finer.extend([[a, m, c], [m, b, c]]),
                (None, Some(m), None) => finer.extend([[a, b, m], [a, m, c]]),
                (None, None, Some(m)) => finer.extend([[a, b, m], [m, b, c]]),
                (Some(m), Some(n), None) => finer.extend([[m, b, n], [a, m, n], [a, n, c]]),
                (None, Some(m), Some(n)) => finer.extend([[n, m, c], [a, b, m], [a, m, n]]),
                (Some(m), None, Some(n)) => finer.extend([[a, m, n], [m, b, c], [m, c, n]]),
                (Some(m), Some(n), Some(o)) => {
                    finer.extend([[a, m, o], [m, b, n], [o, n, c], [m, n, o]]);
                }
            }
            faces.extend(core::iter::repeat_n(face, finer.len() - first));
        }
        data.triangles = finer;
        if middles.is_empty() {
            return Ok(data);
        }
        if data.triangles.len() > MOST {
            return Err(too_many());
        }
        for attribute in data
            .attributes
            .iter_mut()
            .filter(|a| a.name.starts_with("face_"))
        {
            let Attribute {
                channels, values, ..
            } = attribute;
            let of = |face: &usize| values[face * *channels..(face + 1) * *channels].to_vec();
            *values = faces.iter().flat_map(of).collect();
        }
    }
}

/// Adds the vertex in the middle of an edge.
fn add_middle(data: &mut MeshData, [a, b]: [u32; 2]) -> u32 {
    let (a, b) = (a as usize, b as usize);
    let middle = (data.positions[a] + data.positions[b]) * 0.5;
    data.positions.push(middle);
    if !data.normals.is_empty() {
        let sum = data.normals[a] + data.normals[b];
        data.normals
            .push(sum.try_normalize().unwrap_or(data.normals[a]));
    }
    if !data.uvs.is_empty() {
        data.uvs.push((data.uvs[a] + data.uvs[b]) * 0.5);
    }
    for attribute in data
        .attributes
        .iter_mut()
        .filter(|a| a.name.starts_with("vertex_"))
    {
        let (channels, values) = (attribute.channels, &mut attribute.values);
        let mean = |channel: usize| {
            (values[a * channels + channel] + values[b * channels + channel]) * 0.5
        };
        let means: Vec<f32> = (0..channels).map(mean).collect();
        values.extend(means);
    }
    data.positions.len() as u32 - 1
}

/// The same mesh with vertices at the same place known as copies of the first of them.
fn joined(mut data: MeshData, edge: f32) -> MeshData {
    // Far below an edge, far above rounding.
    let cell = f64::from(edge) * 1e-3;
    let key = |p: Vec3| (p.as_dvec3() / cell).round().to_array().map(|x| x as i64);
    let mut first: HashMap<[i64; 3], u32> = HashMap::with_capacity(data.positions.len());
    let (mut kept, mut copies) = (Vec::new(), Vec::new());
    for (vertex, &p) in data.positions.iter().enumerate() {
        let original = *first.entry(key(p)).or_insert(kept.len() as u32);
        match original == kept.len() as u32 {
            true => kept.push(vertex),
            false => copies.push((vertex, original)),
        }
    }
    let order: Vec<usize> = (kept.iter().copied())
        .chain(copies.iter().map(|(vertex, _)| *vertex))
        .collect();
    let mut place = vec![0; order.len()];
    for (new, &old) in order.iter().enumerate() {
        place[old] = new as u32;
    }
    let sorted =
        |of: &[Vec3]| -> Vec<Vec3> { order.iter().filter_map(|&i| of.get(i).copied()).collect() };
    (data.positions, data.normals) = (sorted(&data.positions), sorted(&data.normals));
    data.uvs = order
        .iter()
        .filter_map(|&i| data.uvs.get(i).copied())
        .collect();
    for triangle in &mut data.triangles {
        *triangle = triangle.map(|i| place[i as usize]);
    }
    for attribute in data
        .attributes
        .iter_mut()
        .filter(|a| a.name.starts_with("vertex_"))
    {
        let Attribute {
            channels, values, ..
        } = attribute;
        let of = |&i: &usize| values[i * *channels..(i + 1) * *channels].to_vec();
        *values = order.iter().flat_map(of).collect();
    }
    data.copies = copies.into_iter().map(|(_, original)| original).collect();
    if data.attributes.is_empty() {
        // At a pole two corners meet.
        let mut triangles = core::mem::take(&mut data.triangles);
        triangles.retain(|triangle| {
            let [a, b, c] = triangle.map(|i| original(&data, i as usize));
            a != b && b != c && c != a
        });
        data.triangles = triangles;
    }
    data
}

/// The first vertex at the place of one.
fn original(data: &MeshData, vertex: usize) -> usize {
    let originals = data.positions.len() - data.copies.len();
    (vertex.checked_sub(originals)).map_or(vertex, |copy| data.copies[copy] as usize)
}

/// The displaced positions of the vertices.
fn moved(data: &MeshData, height: impl Fn(Vec3, Vec2) -> f32) -> Vec<Vec3> {
    let originals = data.positions.len() - data.copies.len();
    let original = |vertex: usize| original(data, vertex);
    let computed;
    let normals = match data.normals.is_empty() {
        true => {
            computed = computed_normals(data);
            &computed
        }
        false => &data.normals,
    };
    let mut sums = vec![(Vec3::ZERO, 0.0_f32); originals];
    for (vertex, &p) in data.positions.iter().enumerate() {
        let uv = data.uvs.get(vertex).copied().unwrap_or_default();
        let (sum, count) = &mut sums[original(vertex)];
        *sum += normals[vertex] * height(p, uv);
        *count += 1.0;
    }
    let to = |vertex: usize| {
        let (sum, count) = sums[original(vertex)];
        data.positions[original(vertex)] + sum / count
    };
    (0..data.positions.len()).map(to).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::placement::Placement;
    use crate::shapes::rectangle::Rectangle;
    use crate::shapes::sphere::Sphere;
    use glam::DVec3;

    fn mesh(shape: &Shape) -> &Mesh {
        shape.mesh().expect("triangles")
    }

    fn longest(mesh: &Mesh) -> f32 {
        let edges = (0..mesh.triangle_count() as u32).flat_map(|i| {
            let [a, b, c] = mesh.corners(i);
            [a.distance(b), b.distance(c), c.distance(a)]
        });
        edges.fold(0.0, f32::max)
    }

    #[test]
    fn a_sphere_grows_and_stays_closed() {
        let sphere = Sphere::new(&Placement::IDENTITY, DVec3::ZERO, 1.0, false).expect("round");
        // Nothing that has the same height on both sides of the seam.
        let grown = Shape::Sphere(sphere).displaced(0.05, |_, uv| 0.5 + 0.02 * uv.x, false);
        let grown = grown.expect("finite");
        let mesh = mesh(&grown);
        assert!(mesh.has_no_border());
        for i in 0..mesh.triangle_count() as u32 {
            let [a, b, c] = mesh.corners(i);
            assert!([a, b, c].iter().all(|p| (1.49..1.53).contains(&p.length())));
            assert!(
                (b - a).cross(c - a).dot(a + b + c) > 0.0,
                "turned inside out"
            );
        }
        // By half more than before it was moved.
        assert!(longest(mesh) < 0.05 * 1.7);
    }

    #[test]
    fn a_wave_has_its_height_and_its_normals() {
        let placement = Placement::IDENTITY;
        let flat = Shape::Rectangle(Rectangle::new(&placement, false).expect("flat"));
        let wave = |p: Vec3| 0.1 * etalon_math::float::sin(4.0 * p.x);
        let shape = flat.displaced(0.02, |p, _| wave(p), false).expect("finite");
        let mesh = mesh(&shape);
        for i in (0..mesh.triangle_count() as u32).step_by(7) {
            let corners = mesh.corners(i);
            for p in corners {
                assert!((p.z - wave(p)).abs() < 1e-6);
            }
            let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
            let surface = mesh.surface_between(corners, i, Vec2::splat(1.0 / 3.0));
            let slope = 0.4 * etalon_math::float::cos(4.0 * middle.x);
            let expected = Vec3::new(-slope, 0.0, 1.0).normalize();
            let inside = middle.x.abs() < 0.95 && middle.y.abs() < 0.95;
            assert!(
                !inside || surface.shading.n.dot(expected) > 0.9999,
                "{middle}"
            );
        }
    }

    #[test]
    fn halved_edges_leave_no_gaps() {
        let cube = crate::shapes::cube::cube(&Placement::IDENTITY, false).expect("finite");
        let shape = Shape::Mesh(cube)
            .displaced(0.17, |p, _| 0.1 * p.x, true)
            .expect("finite");
        let mesh = mesh(&shape);
        assert!(mesh.has_no_border());
        assert!(mesh.triangle_count() > 12 * 64);
    }

    #[test]
    fn too_fine_is_refused() {
        let flat = Shape::Rectangle(Rectangle::new(&Placement::IDENTITY, false).expect("flat"));
        assert!(flat.displaced(1e-5, |_, _| 0.0, false).is_err());
    }
}
