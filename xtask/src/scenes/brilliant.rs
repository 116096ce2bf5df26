//! A gem in the round brilliant cut, after Tolkowsky (1919, "Diamond Design"): 57 facets and a girdle of 16 more, as OBJ.
//!
//! A convex body is what lies behind all of its facets' planes, so that each facet is its plane, cut by all others. Lengths are
//! in radii of the girdle, which lies around z = 0; the table looks along z.

use etalon_math::float64::{cos, sin};
use glam::DVec3;
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// Slopes of the facets against the girdle's plane (°).
const CROWN: f64 = 34.5;
const PAVILION: f64 = 40.75;
const STAR: f64 = 20.5;
const UPPER_GIRDLE: f64 = 41.5;
const LOWER_GIRDLE: f64 = 42.3;

/// The table's radius, to its corners.
const TABLE: f64 = 0.56;

/// Half the height of the girdle at its corners.
const GIRDLE: f64 = 0.02;

/// Points closer than this are one.
const SAME: f64 = 1e-6;

/// A plane and all behind it: normal · x ≤ distance.
#[derive(Clone, Copy)]
struct Facet {
    normal: DVec3,
    distance: f64,
}

impl Facet {
    /// The facet of a slope and an azimuth (°) through a point of that azimuth, given by its radius and height.
    fn new(slope: f64, azimuth: f64, [radius, height]: [f64; 2]) -> Self {
        let [slope, azimuth] = [slope, azimuth].map(|degrees| degrees / 360.0 * TAU);
        let normal = DVec3::new(
            sin(slope) * cos(azimuth),
            sin(slope) * sin(azimuth),
            cos(slope),
        );
        Self {
            normal,
            distance: sin(slope) * radius + cos(slope) * height,
        }
    }

    fn beyond(&self, point: DVec3) -> f64 {
        self.normal.dot(point) - self.distance
    }
}

/// All facets.
fn facets() -> Vec<Facet> {
    let around =
        |n: u32, first: f64| (0..n).map(move |i| first + 360.0 / f64::from(n) * f64::from(i));
    let slope = CROWN / 360.0 * TAU;
    let crown = |radius: f64| GIRDLE + (1.0 - radius) * sin(slope) / cos(slope);
    // Half-way between corners of the table, and of the girdle.
    let [edge, side] = [TABLE * cos(TAU / 16.0), cos(TAU / 32.0)];
    let mut facets = vec![Facet::new(0.0, 0.0, [0.0, crown(TABLE)])];
    facets.extend(around(8, 0.0).map(|a| Facet::new(CROWN, a, [1.0, GIRDLE])));
    facets.extend(around(8, 22.5).map(|a| Facet::new(STAR, a, [edge, crown(TABLE)])));
    facets.extend(around(16, 11.25).map(|a| Facet::new(UPPER_GIRDLE, a, [side, GIRDLE])));
    facets.extend(around(16, 11.25).map(|a| Facet::new(90.0, a, [side, 0.0])));
    facets.extend(around(16, 11.25).map(|a| Facet::new(180.0 - LOWER_GIRDLE, a, [side, -GIRDLE])));
    facets.extend(around(8, 0.0).map(|a| Facet::new(180.0 - PAVILION, a, [1.0, -GIRDLE])));
    facets
}

/// The corners of a facet, counterclockwise from outside.
fn polygon(facet: &Facet, all: &[Facet]) -> Vec<DVec3> {
    let (u, v) = facet.normal.any_orthonormal_pair();
    let middle = facet.normal * facet.distance;
    let mut corners = [u + v, v - u, -u - v, u - v]
        .map(|corner| middle + 4.0 * corner)
        .to_vec();
    for other in all {
        if other.normal.dot(facet.normal) > 1.0 - 1e-12 {
            continue;
        }
        let mut kept = Vec::with_capacity(corners.len() + 1);
        for (i, &a) in corners.iter().enumerate() {
            let b = corners[(i + 1) % corners.len()];
            let [from, to] = [a, b].map(|p| other.beyond(p));
            if from <= 0.0 {
                kept.push(a);
            }
            if (from <= 0.0) != (to <= 0.0) {
                kept.push(a + (b - a) * (from / (from - to)));
            }
        }
        corners = kept;
    }
    corners
}

/// The file's text.
pub(super) fn gem() -> String {
    let all = facets();
    let mut points: Vec<DVec3> = Vec::new();
    let mut faces = String::new();
    for facet in &all {
        let mut indices: Vec<usize> = Vec::new();
        for corner in polygon(facet, &all) {
            let known = points
                .iter()
                .position(|point| point.distance(corner) < SAME);
            let index = known.unwrap_or_else(|| {
                points.push(corner);
                points.len() - 1
            });
            if indices.last() != Some(&index) && indices.first() != Some(&index) {
                indices.push(index);
            }
        }
        if indices.len() > 2 {
            faces.push('f');
            for index in indices {
                // Writing to a string cannot fail.
                let _ = write!(faces, " {}", index + 1);
            }
            faces.push('\n');
        }
    }
    let mut text = String::from("# A brilliant: written by `cargo xtask scenes`\n");
    for p in points {
        let _ = writeln!(text, "v {:.6} {:.6} {:.6}", p.x, p.y, p.z);
    }
    text + &faces
}
