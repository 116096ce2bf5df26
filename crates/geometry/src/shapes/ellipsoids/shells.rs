//! `ellipsoidsmesh`: a cloud of ellipsoids from a file as a mesh, a shell of triangles around each.
//!
//! A shell is a mesh around the origin, made as large as Mitsuba 3 makes it: the nearest to the origin of its vertices
//! and of the middles of its triangles lies on the unit sphere. (So an icosahedron goes around the whole sphere, and a cube
//! cuts a little off it.) Unlike in Mitsuba, it has an inner side.

use crate::shapes::Shape;
use crate::shapes::ellipsoids::cloud::Cloud;
use crate::shapes::mesh::{Mesh, MeshOptions};
use core::f64::consts::{PI, TAU};
use etalon_math::float64::sin_cos;
use etalon_params::{Class, Diagnostic, Node, Params, plugins};
use etalon_transport::{Attribute, Build, MeshData};
use glam::DVec3;

/// A mesh around the origin, wound counter-clockwise as seen from outside.
struct Shell {
    vertices: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

/// Reads `shell` (`ico_sphere`, `uv_sphere`, `box` or a nested mesh) and what every cloud has.
pub(crate) fn mesh(params: &Params<'_>, build: &mut dyn Build) -> Option<Mesh> {
    let shell = match params.child(Class::Shape) {
        Some(node) => nested(node, params, build),
        None => {
            let known = ["box", "ico_sphere", "uv_sphere"];
            Some(match params.choice("shell", "ico_sphere", &known) {
                "box" => Shell::cube(),
                "uv_sphere" => Shell::globe(),
                _ => Shell::icosahedron(),
            })
        }
    };
    let cloud = Cloud::from_params(params, build);
    shell?
        .around(&cloud?)
        .map_err(|reason| params.error(format!("the shells cannot be made: {reason}")))
        .ok()
}

/// A mesh of the scene's as a shell.
fn nested(node: &Node, params: &Params<'_>, build: &mut dyn Build) -> Option<Shell> {
    let own = Params::new(node, params.diagnostics);
    let refuse = |message: &str| {
        let diagnostic = Diagnostic::error(node.plugin.span, message);
        let help = "accepted: meshes that stand still, such as `ply`, `obj` and `cube`";
        params.diagnostics.push(diagnostic.help(help));
    };
    if own.is_animated("to_world") {
        refuse("a shell stands still");
        return None;
    }
    if !Shape::plugins().any(|plugin| plugin == node.plugin.value) {
        let diagnostic = plugins::not_built(node, Shape::plugins());
        params.diagnostics.push(diagnostic);
        return None;
    }
    let shape = Shape::from_params(&own, build);
    own.finish_after(shape.is_some());
    let Shape::Mesh(mesh) = shape? else {
        refuse(&format!("{} is no mesh", node.with_article()));
        return None;
    };
    let data = mesh.data();
    let shell = Shell {
        vertices: data.positions.iter().map(|p| p.as_dvec3()).collect(),
        triangles: data.triangles,
    };
    let shell = shell.sized();
    if shell.is_none() {
        refuse("a shell goes around the origin, without touching it");
    }
    shell
}

impl Shell {
    /// A shell of triangles that are seen from the origin, wound as they should be.
    fn convex(vertices: Vec<DVec3>, mut triangles: Vec<[u32; 3]>) -> Self {
        for triangle in &mut triangles {
            let [a, b, c] = triangle.map(|i| vertices[i as usize]);
            if (b - a).cross(c - a).dot(a) < 0.0 {
                triangle.swap(1, 2);
            }
        }
        let shell = Self {
            vertices,
            triangles,
        };
        shell.sized().expect("it goes around the origin")
    }

    /// The same at the size of the unit sphere; `None` if it has none.
    fn sized(mut self) -> Option<Self> {
        let corners = |triangle: &[u32; 3]| triangle.map(|i| self.vertices[i as usize]);
        let distances = self
            .triangles
            .iter()
            .map(corners)
            .flat_map(|[a, b, c]| [a, b, c, (a + b + c) / 3.0].map(DVec3::length));
        let least = distances.fold(f64::INFINITY, f64::min);
        self.vertices.iter_mut().for_each(|v| *v /= least);
        (least > 0.0 && least.is_finite()).then_some(self)
    }

    /// Twelve triangles.
    fn cube() -> Self {
        let side = |bit: u32| if bit & 1 == 0 { -1.0 } else { 1.0 };
        let corner = |i: u32| DVec3::new(side(i), side(i >> 1), side(i >> 2));
        // The corners of each face, across from one another the first and third.
        let faces = [
            [0, 1, 3, 2],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 3, 7, 6],
            [0, 2, 6, 4],
            [1, 3, 7, 5],
        ];
        let triangles = faces
            .iter()
            .flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]);
        Self::convex((0..8).map(corner).collect(), triangles.collect())
    }

    /// Twenty triangles.
    fn icosahedron() -> Self {
        // 1/√5 above and below the middle.
        let height = 0.2_f64.sqrt();
        let ring =
            |y: f64, turn: f64| (0..5).map(move |k| on_sphere(y, (f64::from(k) + turn) / 5.0));
        let mut vertices = vec![DVec3::NEG_Y];
        vertices.extend(ring(-height, 0.5));
        vertices.extend(ring(height, 0.0));
        vertices.push(DVec3::Y);
        let (low, high) = (|k: u32| 1 + k % 5, |k: u32| 6 + k % 5);
        let triangles = (0..5).flat_map(|k| {
            [
                [0, low(k), low(k + 1)],
                [low(k), low(k + 1), high(k + 1)],
                [high(k), high(k + 1), low(k)],
                [high(k), high(k + 1), 11],
            ]
        });
        Self::convex(vertices, triangles.collect())
    }

    /// Seventy-two triangles, between four circles of latitude and nine meridians.
    fn globe() -> Self {
        const AROUND: u32 = 9;
        let mut vertices = vec![DVec3::Y];
        for ring in 1..5 {
            let (_, y) = sin_cos(PI * f64::from(ring) / 5.0);
            vertices.extend((0..AROUND).map(|k| on_sphere(y, 0.75 + f64::from(k) / 9.0)));
        }
        vertices.push(DVec3::NEG_Y);
        let at = |ring: u32, k: u32| 1 + AROUND * ring + k % AROUND;
        let triangles = (0..AROUND).flat_map(|k| {
            let caps = [[0, at(0, k), at(0, k + 1)], [37, at(3, k), at(3, k + 1)]];
            let belt = (0..3).flat_map(move |ring| {
                [
                    [at(ring, k), at(ring, k + 1), at(ring + 1, k)],
                    [at(ring, k + 1), at(ring + 1, k), at(ring + 1, k + 1)],
                ]
            });
            caps.into_iter().chain(belt)
        });
        Self::convex(vertices, triangles.collect())
    }

    /// One around each ellipsoid.
    fn around(&self, cloud: &Cloud) -> Result<Mesh, String> {
        let (copies, size) = (cloud.ellipsoids.len(), self.vertices.len());
        let most = u32::MAX as usize;
        if copies.saturating_mul(size.max(self.triangles.len())) > most {
            return Err(format!(
                "{copies} shells of {size} vertices are more than 32 bits can count"
            ));
        }
        let mut data = MeshData::default();
        for (first, ellipsoid) in (0..).step_by(size).zip(&cloud.ellipsoids) {
            let placed = |v: &DVec3| (ellipsoid.center + ellipsoid.axes * *v).as_vec3();
            data.positions.extend(self.vertices.iter().map(placed));
            let mirrored = ellipsoid.axes.determinant() < 0.0;
            data.triangles
                .extend(self.triangles.iter().map(|&[a, b, c]| {
                    let wound = if mirrored { [a, c, b] } else { [a, b, c] };
                    wound.map(|i| i + first)
                }));
        }
        data.attributes = (cloud.attributes.iter())
            .map(|attribute| repeated(attribute, size))
            .collect();
        let options = MeshOptions {
            face_normals: true,
            ..MeshOptions::default()
        };
        Mesh::new(data, &options)
    }
}

/// A point of the unit sphere at a height, so many turns about the y axis.
fn on_sphere(y: f64, turns: f64) -> DVec3 {
    let (sin, cos) = sin_cos(TAU * turns);
    let radius = (1.0 - y * y).sqrt();
    DVec3::new(radius * cos, y, radius * sin)
}

/// What each ellipsoid has, for each of its vertices.
fn repeated(attribute: &Attribute, times: usize) -> Attribute {
    let rows = attribute.values.chunks_exact(attribute.channels);
    let all = rows.flat_map(|row| row.iter().copied().cycle().take(times * row.len()));
    Attribute {
        values: all.collect(),
        ..attribute.clone()
    }
}
