//! The irradiance of the plane z = 0 under a convex or flat light of triangles.
//!
//! Every triangle that faces the point adds Lambert's sum over its edges,
//! E = L/2 · Σ γᵢ n·(rᵢ × rᵢ₊₁)/|rᵢ × rᵢ₊₁| (*Photometria*, 1760; see [`super::irradiance`]):
//! of a convex solid no such triangle hides another, and inner edges of a polygon cancel.

use super::irradiance::{Irradiance, lambert};
use crate::claim::Claim;
use crate::folders;
use std::path::Path;

/// Three corners, counterclockwise as seen from where the light goes.
type Triangle = [[f64; 3]; 3];

/// Under the mesh in the file `mesh`, raised by `height`.
pub fn mesh(claim: &Claim) -> Result<Irradiance, String> {
    let folder = folders::scenes().join("irradiance-mesh");
    let mut triangles = read(&folder.join(claim.text("mesh")?))?;
    let height = claim.number("height")?;
    for corner in triangles.iter_mut().flatten() {
        corner[2] += height;
        if corner[2] <= 0.0 {
            return Err("the light must be above the plane".to_owned());
        }
    }
    Ok(Box::new(move |x, y| per_radiance(&triangles, x, y)))
}

/// E/L at a point of the plane.
fn per_radiance(triangles: &[Triangle], x: f64, y: f64) -> f64 {
    triangles
        .iter()
        .map(|corners| corners.map(|c| [c[0] - x, c[1] - y, c[2]]))
        .filter(faces)
        .map(|corners| (0.5 * lambert(&corners)).abs())
        .sum()
}

/// Whether the triangle faces the origin.
fn faces([a, b, c]: &Triangle) -> bool {
    let [p, q] = [b, c].map(|to| [0, 1, 2].map(|i| to[i] - a[i]));
    let normal = [
        p[1] * q[2] - p[2] * q[1],
        p[2] * q[0] - p[0] * q[2],
        p[0] * q[1] - p[1] * q[0],
    ];
    normal[0] * a[0] + normal[1] * a[1] + normal[2] * a[2] < 0.0
}

/// Reads an OBJ file of `v` lines and triangular `f` lines of plain numbers.
fn read(path: &Path) -> Result<Vec<Triangle>, String> {
    let text = std::fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
    let mut corners: Vec<[f64; 3]> = Vec::new();
    let mut triangles = Vec::new();
    for line in text.lines().filter(|line| !line.starts_with('#')) {
        let wrong = || format!("{}: `{line}` is no corner and no triangle", path.display());
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            [] => {}
            ["v", x, y, z] => {
                let [x, y, z] = [x, y, z].map(|word| word.parse::<f64>().map_err(|_| wrong()));
                corners.push([x?, y?, z?]);
            }
            ["f", a, b, c] => {
                let corner = |word: &str| {
                    let index = word.parse::<usize>().ok()?.checked_sub(1)?;
                    corners.get(index).copied()
                };
                let triangle = (corner(a), corner(b), corner(c));
                let (Some(a), Some(b), Some(c)) = triangle else {
                    return Err(wrong());
                };
                triangles.push([a, b, c]);
            }
            _ => return Err(wrong()),
        }
    }
    Ok(triangles)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ cos θ cos θ'/d² dA: the definition, with the midpoints of n² parts of each triangle.
    fn by_definition(triangles: &[Triangle], x: f64, y: f64) -> f64 {
        const N: u32 = 128;
        let mut sum = 0.0;
        for [a, b, c] in triangles {
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

    #[test]
    fn meshes_are_the_integrals_over_their_triangles() {
        for name in ["star.obj", "octahedron.obj"] {
            let path = folders::scenes().join("irradiance-mesh").join(name);
            let mut triangles = read(&path).expect("the mesh of a claim");
            for corner in triangles.iter_mut().flatten() {
                corner[2] += 1.2;
            }
            for [x, y] in [[0.1, 0.0], [0.9, -0.4], [-1.6, 1.9]] {
                let expected = by_definition(&triangles, x, y);
                let found = per_radiance(&triangles, x, y);
                assert!(
                    (found / expected - 1.0).abs() < 1e-4,
                    "{name}: {found} {expected}"
                );
            }
        }
    }

    #[test]
    fn two_triangles_are_a_rectangle() {
        // A parallel unit square at unit distance, seen from below its corner: E/L = √½ atan √½
        // (Howell's configuration B-3 with A = B = 1).
        let square = [
            [[0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, 1.0, 1.0]],
            [[0.0, 0.0, 1.0], [1.0, 1.0, 1.0], [1.0, 0.0, 1.0]],
        ];
        let half = 0.5f64.sqrt();
        let expected = half * etalon_math::float64::atan(half);
        let found = per_radiance(&square, 0.0, 0.0);
        assert!((found - expected).abs() < 1e-14, "{found} {expected}");
        // Its back gives nothing.
        let turned = square.map(|[a, b, c]| [a, c, b]);
        assert_eq!(per_radiance(&turned, 0.0, 0.0), 0.0);
    }
}
