//! Triangle meshes, written as binary little-endian PLY files.

use etalon_transport::MeshData;

/// A triangle mesh.
#[derive(Default)]
pub(crate) struct Mesh {
    vertices: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl From<&MeshData> for Mesh {
    fn from(data: &MeshData) -> Self {
        let corner = |p: &glam::Vec3| p.to_array().map(f64::from);
        Self {
            vertices: data.positions.iter().map(corner).collect(),
            triangles: data.triangles.clone(),
        }
    }
}

impl Mesh {
    /// Adds a triangle with corners of its own.
    pub(crate) fn triangle(&mut self, corners: [[f64; 3]; 3]) {
        let first = self.vertices.len() as u32;
        self.vertices.extend(corners);
        self.triangles.push([first, first + 1, first + 2]);
    }

    /// Adds a tapering tube of `sides` sides from `from` to `to`.
    pub(crate) fn tube(&mut self, from: [f64; 3], to: [f64; 3], radii: [f64; 2], sides: u32) {
        let axis = normalised(difference(to, from));
        let across = if axis[1].abs() < 0.9 {
            [0.0, 1.0, 0.0]
        } else {
            [1.0, 0.0, 0.0]
        };
        let u = normalised(cross(axis, across));
        let v = cross(axis, u);
        let first = self.vertices.len() as u32;
        for side in 0..sides {
            let angle = std::f64::consts::TAU * f64::from(side) / f64::from(sides);
            let (sine, cosine) = (
                etalon_math::float64::sin(angle),
                etalon_math::float64::cos(angle),
            );
            for (centre, radius) in [(from, radii[0]), (to, radii[1])] {
                self.vertices.push(std::array::from_fn(|i| {
                    centre[i] + radius * (cosine * u[i] + sine * v[i])
                }));
            }
        }
        for side in 0..sides {
            let [a, b] = [first + 2 * side, first + 2 * ((side + 1) % sides)];
            self.triangles.push([a, b, a + 1]);
            self.triangles.push([b, b + 1, a + 1]);
        }
    }

    /// The number of triangles.
    pub(crate) fn len(&self) -> usize {
        self.triangles.len()
    }

    /// The file.
    pub(crate) fn to_ply(&self) -> Vec<u8> {
        let mut bytes = format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n\
             property float y\nproperty float z\nelement face {}\n\
             property list uchar uint vertex_indices\nend_header\n",
            self.vertices.len(),
            self.triangles.len()
        )
        .into_bytes();
        for coordinate in self.vertices.iter().flatten() {
            bytes.extend((*coordinate as f32).to_le_bytes());
        }
        for triangle in &self.triangles {
            bytes.push(3);
            bytes.extend(triangle.iter().flat_map(|index| index.to_le_bytes()));
        }
        bytes
    }
}

pub(crate) fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub(crate) fn normalised(a: [f64; 3]) -> [f64; 3] {
    let length = a.iter().map(|x| x * x).sum::<f64>().sqrt();
    a.map(|x| x / length)
}
