//! Parts of meshes: their vertices and triangles.
//!
//! Without normals a part is shaded flat (glTF 2.0, §3.7.2.1): each triangle has its own three vertices then, so that its outside does
//! not depend on what mirrors it later. Colours of vertices are the attribute `vertex_color`, their alpha `vertex_alpha`. A part
//! that uses few of the vertices that its accessors have keeps those alone.

use super::accessors::WantedAccessor;
use super::reader::Reader;
use super::topology::triangles;
use ::gltf::Semantic;
use ::gltf::json::Index;
use ::gltf::json::accessor::{Accessor, ComponentType, Type};
use ::gltf::json::mesh::Primitive;
use ::gltf::json::validation::Checked;
use ComponentType::{F32, I8, I16, U8, U16};
use etalon_transport::{Attribute, MeshData};
use glam::{Vec2, Vec3};

/// KHR_mesh_quantization admits them all.
const POSITIONS: WantedAccessor = WantedAccessor {
    types: &[Type::Vec3],
    components: &[
        (F32, false),
        (I8, false),
        (I8, true),
        (U8, false),
        (U8, true),
        (I16, false),
        (I16, true),
        (U16, false),
        (U16, true),
    ],
    words: "VEC3 of floats, or of integers of 8 or 16 bits",
};

const NORMALS: WantedAccessor = WantedAccessor {
    types: &[Type::Vec3],
    components: &[(F32, false), (I8, true), (I16, true)],
    words: "VEC3 of floats, or of normalised signed integers of 8 or 16 bits",
};

const COORDINATES: WantedAccessor = WantedAccessor {
    types: &[Type::Vec2],
    ..POSITIONS
};

const COLOURS: WantedAccessor = WantedAccessor {
    types: &[Type::Vec3, Type::Vec4],
    components: &[(F32, false), (U8, true), (U16, true)],
    words: "VEC3 or VEC4 of floats, or of normalised unsigned integers of 8 or 16 bits",
};

/// How many channels the colours of vertices have: none, 3, or 4 with alpha.
pub(crate) type Channels = usize;

/// The accessor of an attribute.
fn attribute(primitive: &Primitive, semantic: Semantic) -> Option<Index<Accessor>> {
    primitive.attributes.get(&Checked::Valid(semantic)).copied()
}

impl Reader<'_> {
    /// How many channels the colours of a part's vertices have.
    pub(crate) fn colour_channels(&self, primitive: &Primitive) -> Channels {
        let colours = attribute(primitive, Semantic::Colors(0));
        colours
            .and_then(|index| self.kind_of(index))
            .map_or(0, |(components, _)| components)
    }

    /// The vertices and triangles of the part at a path, with the texture coordinates of a set if one is asked for. `None` after a
    /// mistake, and if there are no triangles.
    pub(crate) fn mesh_data(
        &mut self,
        path: &str,
        primitive: &Primitive,
        set: Option<u32>,
    ) -> Option<MeshData> {
        let Checked::Valid(mode) = primitive.mode else {
            return None;
        };
        let positions = attribute(primitive, Semantic::Positions)?;
        let positions: Vec<[f32; 3]> = self.vectors(positions, &POSITIONS)?;
        let count = positions.len();
        let triangles = match primitive.indices {
            Some(indices) => {
                let indices = self.indices(indices, count)?;
                let corner = |i: usize| indices.get(i).copied().unwrap_or_default();
                triangles(mode, indices.len(), corner)
            }
            None => triangles(mode, count, |i| i as u32),
        };
        let Some(triangles) = triangles else {
            self.note(path, format!("{mode:?} have no surface: they are left out"));
            return None;
        };
        let normals = match attribute(primitive, Semantic::Normals) {
            Some(normals) => self.per_vertex::<3>(path, "NORMAL", normals, &NORMALS, count)?,
            None => Vec::new(),
        };
        let uvs = match set {
            Some(set) => self.coordinates(path, primitive, set, count)?,
            None => Vec::new(),
        };
        let colours = match attribute(primitive, Semantic::Colors(0)) {
            Some(colours) => self.per_vertex::<4>(path, "COLOR_0", colours, &COLOURS, count)?,
            None => Vec::new(),
        };
        let channels = self.colour_channels(primitive);
        let mut attributes = Vec::new();
        if !colours.is_empty() {
            let values = colours.iter().flat_map(|c| [c[0], c[1], c[2]]).collect();
            attributes.push(("vertex_color", 3, values));
        }
        if channels == 4 {
            attributes.push(("vertex_alpha", 1, colours.iter().map(|c| c[3]).collect()));
        }
        let attributes = attributes
            .into_iter()
            .map(|(name, channels, values)| Attribute {
                name: name.to_owned(),
                channels,
                values,
            });
        let data = MeshData {
            positions: positions.into_iter().map(Vec3::from).collect(),
            normals: normals.into_iter().map(Vec3::from).collect(),
            uvs: uvs.into_iter().map(Vec2::from).collect(),
            triangles,
            attributes: attributes.collect(),
            ..MeshData::default()
        };
        Some(match data.normals.is_empty() {
            true => flat(&data),
            false if count > 3 * data.triangles.len() => separate(&data),
            false => data,
        })
    }

    /// A quantity of which there must be as many as vertices.
    fn per_vertex<const N: usize>(
        &mut self,
        path: &str,
        name: &str,
        index: Index<Accessor>,
        wanted: &WantedAccessor,
        count: usize,
    ) -> Option<Vec<[f32; N]>> {
        let values = self.vectors::<N>(index, wanted)?;
        if values.len() != count {
            let message = format!("there are {} for {count} vertices", values.len());
            self.error(&format!("{path}.attributes.{name}"), message);
            return None;
        }
        Some(values)
    }

    fn coordinates(
        &mut self,
        path: &str,
        primitive: &Primitive,
        set: u32,
        count: usize,
    ) -> Option<Vec<[f32; 2]>> {
        let name = format!("TEXCOORD_{set}");
        match attribute(primitive, Semantic::TexCoords(set)) {
            Some(index) => self.per_vertex::<2>(path, &name, index, &COORDINATES, count),
            None => {
                let message = format!(
                    "its material has textures, and it has no {name}: they are looked up at (0, 0)"
                );
                self.note(path, message);
                Some(vec![[0.0; 2]; count])
            }
        }
    }
}

/// A mesh whose triangles have vertices of their own.
fn separate(data: &MeshData) -> MeshData {
    let corners = || {
        data.triangles
            .iter()
            .flatten()
            .map(|&corner| corner as usize)
    };
    let attributes = data.attributes.iter().map(|attribute| {
        let channels = attribute.channels;
        let values = corners().flat_map(|corner| {
            let start = corner * channels;
            attribute
                .values
                .get(start..start + channels)
                .unwrap_or_default()
        });
        Attribute {
            name: attribute.name.clone(),
            channels,
            values: values.copied().collect(),
        }
    });
    let count = data.triangles.len() as u32;
    MeshData {
        positions: corners()
            .filter_map(|i| data.positions.get(i).copied())
            .collect(),
        normals: corners()
            .filter_map(|i| data.normals.get(i).copied())
            .collect(),
        uvs: corners().filter_map(|i| data.uvs.get(i).copied()).collect(),
        triangles: (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        attributes: attributes.collect(),
        ..MeshData::default()
    }
}

/// The same with the normals of the triangles at their vertices.
fn flat(data: &MeshData) -> MeshData {
    let mut data = separate(data);
    let (triangles, _) = data.positions.as_chunks::<3>();
    let normal = |[a, b, c]: &[Vec3; 3]| {
        let [a, b, c] = [a, b, c].map(|p| p.as_dvec3());
        let normal = (b - a).cross(c - a).try_normalize();
        // A triangle without area is seen by nobody.
        [normal.unwrap_or(glam::DVec3::Z).as_vec3(); 3]
    };
    data.normals = triangles.iter().flat_map(normal).collect();
    data
}
