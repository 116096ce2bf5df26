//! The irradiance of the plane z = 0 under a convex or flat light of polygons, by Lambert's sum over their edges:
//! [`etalon_conform::truth::polygon_lights`].

use super::irradiance::Irradiance;
use crate::claim::Claim;
use crate::folders;
use etalon_conform::truth::polygon_lights::{Polygon, polygons};
use std::path::Path;

/// Under the mesh in the file `mesh`, or in that of the corners of `lamp`, raised by `height`.
pub fn mesh(claim: &Claim) -> Result<Irradiance, String> {
    let folder = folders::scenes().join("irradiance-mesh");
    let file = match claim.text("lamp") {
        Ok(lamp) => format!("{lamp}.obj"),
        Err(_) => claim.text("mesh")?.to_owned(),
    };
    let mut mesh = read(&folder.join(file))?;
    let height = claim.number("height")?;
    for corner in mesh.iter_mut().flatten() {
        corner[2] += height;
        if corner[2] <= 0.0 {
            return Err("the light must be above the plane".to_owned());
        }
    }
    Ok(Box::new(move |x, y| polygons(&mesh, [x, y])))
}

/// Reads an OBJ file of `v` and `f` lines of plain numbers.
fn read(path: &Path) -> Result<Vec<Polygon>, String> {
    let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
    let mut corners: Vec<[f64; 3]> = Vec::new();
    let mut polygons = Vec::new();
    for line in text.lines().filter(|line| !line.starts_with('#')) {
        let wrong = || format!("{}: `{line}` is no corner and no polygon", path.display());
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            [] => {}
            ["v", x, y, z] => {
                let [x, y, z] = [x, y, z].map(|word| word.parse::<f64>().map_err(|_| wrong()));
                corners.push([x?, y?, z?]);
            }
            ["f", ref words @ ..] if words.len() >= 3 => {
                let corner = |word: &&str| {
                    let index = word.parse::<usize>().ok()?.checked_sub(1)?;
                    corners.get(index).copied()
                };
                let polygon: Option<Polygon> = words.iter().map(corner).collect();
                polygons.push(polygon.ok_or_else(wrong)?);
            }
            _ => return Err(wrong()),
        }
    }
    Ok(polygons)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ cos θ cos θ'/d² dA: the definition, with the midpoints of n² parts of each triangle.
    fn by_definition(triangles: &[Polygon], x: f64, y: f64) -> f64 {
        const N: u32 = 128;
        let mut sum = 0.0;
        for triangle in triangles {
            let [a, b, c] = triangle[..] else {
                panic!("{} corners", triangle.len());
            };
            let [p, q] = [b, c].map(|to| [0, 1, 2].map(|i| to[i] - a[i]));
            let normal = [
                p[1] * q[2] - p[2] * q[1],
                p[2] * q[0] - p[0] * q[2],
                p[0] * q[1] - p[1] * q[0],
            ];
            for (u, v) in centroids(N) {
                let d: [f64; 3] =
                    std::array::from_fn(|i| a[i] + u * p[i] + v * q[i] - [x, y, 0.0][i]);
                let square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
                // |normal| is twice the area, of which this is 1/n².
                let facing = -(normal[0] * d[0] + normal[1] * d[1] + normal[2] * d[2]);
                sum += facing.max(0.0) * d[2] / (square * square) * 0.5 / f64::from(N * N);
            }
        }
        sum
    }

    /// Centroids of the n² equal triangles in the triangle (0, 0), (1, 0), (0, 1).
    fn centroids(n: u32) -> impl Iterator<Item = (f64, f64)> {
        (0..n * n).map(move |i| {
            let (column, row) = (i % n, i / n);
            // Upward triangles below the diagonal, downward ones above it.
            let third = if column + row < n { 1.0 } else { 2.0 };
            let (column, row) = if column + row < n {
                (column, row)
            } else {
                (n - 1 - column, n - 1 - row)
            };
            let at = |k: u32| (f64::from(k) + third / 3.0) / f64::from(n);
            (at(column), at(row))
        })
    }

    #[test]
    fn centroids_cover_the_triangle() {
        let (mut count, mut sum) = (0, [0.0; 2]);
        for (u, v) in centroids(16) {
            assert!(u > 0.0 && v > 0.0 && u + v < 1.0);
            count += 1;
            sum = [sum[0] + u, sum[1] + v];
        }
        assert_eq!(count, 256);
        assert!(sum.iter().all(|s| (s / 256.0 - 1.0 / 3.0).abs() < 1e-12));
    }

    /// The mesh of a claim, 1.2 above the plane.
    fn raised(name: &str) -> Vec<Polygon> {
        let path = folders::scenes().join("irradiance-mesh").join(name);
        let mut mesh = read(&path).expect("the mesh of a claim");
        for corner in mesh.iter_mut().flatten() {
            corner[2] += 1.2;
        }
        mesh
    }

    /// Mutant rejected: a normal of the first three corners, which may be those of a notch.
    #[test]
    fn an_outline_is_what_it_is_cut_into() {
        let (outline, star) = (raised("outline.obj"), raised("star.obj"));
        assert_eq!(outline.len(), 1);
        for [x, y] in [[0.1, 0.0], [0.9, -0.4], [-1.6, 1.9]] {
            let [found, expected] = [&outline, &star].map(|mesh| polygons(mesh, [x, y]));
            assert!((found / expected - 1.0).abs() < 1e-5, "{found} {expected}");
        }
    }

    #[test]
    fn meshes_are_the_integrals_over_their_triangles() {
        for name in ["star.obj", "octahedron.obj"] {
            let triangles = raised(name);
            for [x, y] in [[0.1, 0.0], [0.9, -0.4], [-1.6, 1.9]] {
                let expected = by_definition(&triangles, x, y);
                let found = polygons(&triangles, [x, y]);
                assert!(
                    (found / expected - 1.0).abs() < 1e-4,
                    "{name}: {found} {expected}"
                );
            }
        }
    }
}
