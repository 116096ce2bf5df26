//! Loop's subdivision of triangle meshes (Loop 1987, *Smooth Subdivision Surfaces Based on Triangles*; boundaries and limits by
//! Hoppe et al. 1994), as pbrt's `loopsubdiv` has it (`util/loopsubdiv.cpp`).
//!
//! Each step cuts a triangle in four. With n neighbours of a vertex v and s the sum of their positions,
//!
//! ```text
//! v′ = (1 − nβ) v + β s,   β = 3/16 for n = 3, else 3/(8n)      on a border: v′ = ¾ v + ⅛ (a + b)
//! edge between a and b, opposite to c and d: ⅜ (a + b) + ⅛ (c + d)       on a border: ½ (a + b)
//! limit: v∞ = (1 − nγ) v + γ s,   γ = 1/(n + 3/(8β))            on a border: ⅗ v + ⅕ (a + b)
//! ```
//!
//! The limit of the border's own spline were ⅔ v + ⅙ (a + b); pbrt's rule is kept.
//!
//! Normals are those of the limit surface: the cross product of Σ cos(2πi/n) vᵢ and Σ sin(2πi/n) vᵢ over the neighbours in their order; on a
//! border of the difference of its neighbours and the tangent across.

use super::super::parameters::Parameters;
use super::Mapper;
use super::meshes::{corners, positions};
use super::shapes::{Form, Wanted};
use etalon_math::float64;
use etalon_params::DVec3;
use etalon_transport::MeshData;
use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

/// The most triangles after all steps.
const MOST_TRIANGLES: usize = 1 << 26;

/// The mesh between two steps.
struct Cage {
    points: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

/// The neighbours of a vertex, in the order of the triangles around it; the first and the last are on the border if it has one.
struct Ring {
    neighbours: Vec<u32>,
    on_border: bool,
}

impl<'a> Mapper<'a> {
    /// A subdivided mesh; `None` after a mistake.
    pub(crate) fn subdivided(
        &mut self,
        params: &Parameters<'a>,
        wanted: &Wanted<'_>,
    ) -> Option<Form> {
        params.choice("scheme", "loop", &["loop"]);
        let levels = params.integer_from("levels", 3, 0);
        let points = positions(params);
        let triangles = corners::<3>(params, points.as_ref().map_or(0, Vec::len));
        let (points, triangles) = (points?, triangles?);
        if wanted.by_uv {
            let what = "texture coordinates of a `loopsubdiv`, which has none";
            let accepted = "materials without images and patterns";
            self.refuse_value(params, "P", what, accepted);
            return None;
        }
        let growth = 4_usize.saturating_pow(levels.unsigned_abs());
        if triangles.len().saturating_mul(growth) > MOST_TRIANGLES {
            let message = format!(
                "{} triangles in {levels} steps become more than {MOST_TRIANGLES}",
                triangles.len()
            );
            params.error_at("levels", message);
            return None;
        }
        let mut cage = Cage {
            points: points.iter().map(|p| p.as_dvec3()).collect(),
            triangles,
        };
        for _ in 0..levels {
            cage = match cage.rings() {
                Ok(rings) => cage.step(&rings),
                Err(vertex) => return refuse(params, vertex),
            };
        }
        let mesh = match cage.rings() {
            Ok(rings) => cage.limit(&rings),
            Err(vertex) => return refuse(params, vertex),
        };
        let draft = self.mesh_shape(params, wanted, mesh)?;
        Some(Form {
            drafts: vec![draft],
            area: None,
        })
    }
}

fn refuse(params: &Parameters<'_>, vertex: u32) -> Option<Form> {
    let message = format!(
        "the triangles around point {vertex} are no single fan, or are turned against each other: such a mesh cannot be subdivided"
    );
    params.error_at("indices", message);
    None
}

impl Cage {
    /// The rings of all vertices that a triangle has, or a vertex around which the triangles are no single fan.
    fn rings(&self) -> Result<Vec<Ring>, u32> {
        // Of each vertex, from one neighbour to the next in the order of the triangles.
        let mut next: Vec<Vec<[u32; 2]>> = vec![Vec::new(); self.points.len()];
        for &[a, b, c] in &self.triangles {
            for [at, from, to] in [[a, b, c], [b, c, a], [c, a, b]] {
                next[at as usize].push([from, to]);
            }
        }
        let ring = |(vertex, steps): (usize, &Vec<[u32; 2]>)| ring(steps).ok_or(vertex as u32);
        next.iter().enumerate().map(ring).collect()
    }

    fn sum(&self, of: &[u32]) -> DVec3 {
        of.iter().map(|&i| self.points[i as usize]).sum()
    }

    /// `own` of a vertex, and the rest in equal parts of the ends of its border.
    fn on_border(&self, vertex: usize, ring: &Ring, own: f64) -> DVec3 {
        let ends = [
            ring.neighbours[0],
            ring.neighbours[ring.neighbours.len() - 1],
        ];
        own * self.points[vertex] + 0.5 * (1.0 - own) * self.sum(&ends)
    }

    /// 1 − n `weight` of a vertex, and `weight` of each neighbour.
    fn inside(&self, vertex: usize, ring: &Ring, weight: f64) -> DVec3 {
        let count = ring.neighbours.len() as f64;
        (1.0 - count * weight) * self.points[vertex] + weight * self.sum(&ring.neighbours)
    }

    fn step(&self, rings: &[Ring]) -> Self {
        let mut points = Vec::with_capacity(4 * self.points.len());
        for (vertex, ring) in rings.iter().enumerate() {
            points.push(match ring {
                Ring { neighbours, .. } if neighbours.is_empty() => self.points[vertex],
                Ring {
                    on_border: true, ..
                } => self.on_border(vertex, ring, 0.75),
                Ring { neighbours, .. } => self.inside(vertex, ring, beta(neighbours.len())),
            });
        }
        // The corners opposite to each edge.
        let mut opposite: HashMap<[u32; 2], Vec<u32>> = HashMap::new();
        for &[a, b, c] in &self.triangles {
            for [from, to, across] in [[a, b, c], [b, c, a], [c, a, b]] {
                opposite
                    .entry([from.min(to), from.max(to)])
                    .or_default()
                    .push(across);
            }
        }
        let mut middles: HashMap<[u32; 2], u32> = HashMap::new();
        let mut middle = |from: u32, to: u32| {
            let edge = [from.min(to), from.max(to)];
            *middles.entry(edge).or_insert_with(|| {
                let ends = self.sum(&edge);
                points.push(match opposite.get(&edge) {
                    Some(across) if across.len() == 2 => 0.375 * ends + 0.125 * self.sum(across),
                    _ => 0.5 * ends,
                });
                points.len() as u32 - 1
            })
        };
        let mut triangles = Vec::with_capacity(4 * self.triangles.len());
        for &[a, b, c] in &self.triangles {
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        Self { points, triangles }
    }

    /// The vertices moved to where infinitely many steps would take them, with the normals there.
    fn limit(&self, rings: &[Ring]) -> MeshData {
        let mut mesh = MeshData {
            triangles: self.triangles.clone(),
            ..MeshData::default()
        };
        for (vertex, ring) in rings.iter().enumerate() {
            let neighbours = &ring.neighbours;
            let moved = match ring {
                _ if neighbours.is_empty() => self.points[vertex],
                Ring {
                    on_border: true, ..
                } => self.on_border(vertex, ring, 0.6),
                _ => {
                    let n = neighbours.len() as f64;
                    let gamma = 1.0 / (n + 3.0 / (8.0 * beta(neighbours.len())));
                    self.inside(vertex, ring, gamma)
                }
            };
            let normal = self.normal(vertex, ring).normalize_or(DVec3::Z);
            mesh.positions.push(moved.as_vec3());
            mesh.normals.push(normal.as_vec3());
        }
        mesh
    }

    fn normal(&self, vertex: usize, ring: &Ring) -> DVec3 {
        let at = |i: usize| self.points[ring.neighbours[i] as usize];
        let n = ring.neighbours.len();
        if n < 2 {
            return DVec3::Z;
        }
        if !ring.on_border {
            let sum = |wave: fn(f64) -> f64| -> DVec3 {
                (0..n)
                    .map(|i| wave(TAU * i as f64 / n as f64) * at(i))
                    .sum()
            };
            return sum(float64::cos).cross(sum(float64::sin));
        }
        let own = self.points[vertex];
        let along = at(n - 1) - at(0);
        let across = match n {
            2 => at(0) + at(1) - 2.0 * own,
            3 => at(1) - own,
            4 => -at(0) + 2.0 * at(1) + 2.0 * at(2) - at(3) - 2.0 * own,
            _ => {
                let theta = PI / (n - 1) as f64;
                let inner = (1..n - 1).map(|k| {
                    let weight = (2.0 * float64::cos(theta) - 2.0) * float64::sin(k as f64 * theta);
                    weight * at(k)
                });
                -(float64::sin(theta) * (at(0) + at(n - 1)) + inner.sum::<DVec3>())
            }
        };
        // From the first neighbour of the border through the inside to the last.
        -along.cross(across)
    }
}

/// β of a vertex of so many neighbours.
fn beta(valence: usize) -> f64 {
    match valence {
        3 => 3.0 / 16.0,
        n => 3.0 / (8.0 * n as f64),
    }
}

/// The ring of a vertex from the steps from neighbour to neighbour; `None` if they make no single fan.
fn ring(steps: &[[u32; 2]]) -> Option<Ring> {
    let after: HashMap<u32, u32> = steps.iter().map(|&[from, to]| (from, to)).collect();
    if after.len() != steps.len() {
        return None;
    }
    let reached: std::collections::HashSet<u32> = steps.iter().map(|step| step[1]).collect();
    if reached.len() != steps.len() {
        return None;
    }
    let begin = steps.iter().find(|step| !reached.contains(&step[0]));
    let on_border = begin.is_some();
    let Some(&[first, _]) = begin.or(steps.first()) else {
        let neighbours = Vec::new();
        return Some(Ring {
            neighbours,
            on_border,
        });
    };
    let mut neighbours = vec![first];
    let mut at = first;
    while let Some(&to) = after.get(&at) {
        if to == first {
            break;
        }
        neighbours.push(to);
        at = to;
    }
    let met = neighbours.len() - usize::from(on_border);
    (met == steps.len()).then_some(Ring {
        neighbours,
        on_border,
    })
}
