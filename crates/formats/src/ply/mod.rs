//! The Stanford PLY format: text, and binary of both byte orders.
//!
//! Of the element `vertex` are read `x y z`, `nx ny nz`, a pair of texture coordinates
//! (`u v`, `s t`, `texture_u texture_v`, `texture_s texture_t`) and every further number as an
//! attribute; of `face` the corners (`vertex_indices` or `vertex_index`), attributes, and the list
//! `texcoord` of texture coordinates at its corners, which go before those of vertices; of
//! `tristrips` the corners. Elements may come in any order. Polygons are cut into triangles, which
//! inherit the attributes of their face. Other elements and lists are skipped.
//!
//! Attributes are grouped and named as in Mitsuba 3: see `attributes.rs`.

mod columns;
mod faces;
mod group;
mod header;
mod source;
mod write;

use crate::mesh_error::{MeshError, Place};
use crate::unused;
use columns::{Columns, Places};
use etalon_transport::{Attribute, MeshData};
use glam::Vec2;
use group::groups;
use header::{Element, Header, Kind, Property};
use source::Source;
pub use write::write;

/// The names of texture coordinates.
const UV_NAMES: [[&str; 2]; 4] = [
    ["u", "v"],
    ["s", "t"],
    ["texture_u", "texture_v"],
    ["texture_s", "texture_t"],
];

/// Reads the bytes of a PLY file.
pub fn parse(bytes: &[u8]) -> Result<MeshData, MeshError> {
    let header = Header::parse(bytes)?;
    let mut source = Source::new(bytes, &header);
    let mut mesh = MeshData::default();
    let mut places = None;
    // What stands before the vertices waits for them.
    let mut early = Vec::new();
    for (i, element) in header.elements.iter().enumerate() {
        let first = !header.elements[..i].iter().any(|e| e.name == element.name);
        match element.name.as_str() {
            "vertex" if first => {
                places = Some(vertices(element, &mut source, &mut mesh)?);
                for (element, mut source) in early.drain(..) {
                    triangles(element, &mut source, &mut mesh)?;
                }
            }
            "face" | "tristrips" if first && places.is_none() => {
                early.push((element, source.clone()));
                skip(element, &mut source)?;
            }
            "face" | "tristrips" if first => triangles(element, &mut source, &mut mesh)?,
            _ => skip(element, &mut source)?,
        }
    }
    if mesh.triangles.is_empty() {
        return Err(MeshError::new(Place::Whole, no_faces(&header)));
    }
    if let (Err(i), Some(places)) = (unused::settle(&mut mesh.positions, &mesh.triangles), places) {
        let message = format!("the position of element {i} is not finite");
        return Err(MeshError::new(places.of(i), message));
    }
    tidy_attributes(&mut mesh);
    Ok(mesh)
}

/// Reads the vertices alone, with their attributes, of a file that needs no faces.
pub fn parse_points(bytes: &[u8]) -> Result<MeshData, MeshError> {
    let header = Header::parse(bytes)?;
    let mut source = Source::new(bytes, &header);
    let mut points = MeshData::default();
    for element in &header.elements {
        if element.name != "vertex" {
            skip(element, &mut source)?;
            continue;
        }
        let places = vertices(element, &mut source, &mut points)?;
        if let Some(i) = points.positions.iter().position(|p| !p.is_finite()) {
            let message = format!("the position of element {i} is not finite");
            return Err(MeshError::new(places.of(i), message));
        }
        break;
    }
    if points.positions.is_empty() {
        return Err(MeshError::new(Place::Whole, "the file has no vertices"));
    }
    Ok(points)
}

/// What the vertices of a file carry beside their positions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Carried {
    /// Whether they have normals.
    pub(crate) normals: bool,
    /// Whether they, or the corners of faces, have texture coordinates.
    pub(crate) uvs: bool,
}

/// What the vertices of a file carry, by its header; what follows that may be missing.
pub(crate) fn carried(bytes: &[u8]) -> Result<Carried, MeshError> {
    let header = Header::parse(bytes)?;
    let element = |name: &str| header.elements.iter().find(|element| element.name == name);
    let has = |name: &str, all: &[&str]| {
        let found = |element: &Element| all.iter().all(|name| element.find(name).is_some());
        element(name).is_some_and(found)
    };
    Ok(Carried {
        normals: has("vertex", &["nx", "ny", "nz"]),
        uvs: UV_NAMES.iter().any(|names| has("vertex", names)) || has("face", &["texcoord"]),
    })
}

fn no_faces(header: &Header) -> String {
    let elements: Vec<String> = (header.elements.iter().take(8))
        .map(|e| format!("{} `{}`", e.count, e.name))
        .collect();
    let held = match elements.as_slice() {
        [] => "nothing".to_owned(),
        elements => elements.join(", "),
    };
    format!("the file contains no faces of three or more corners; it holds {held}")
}

fn triangles(
    element: &Element,
    source: &mut Source<'_>,
    mesh: &mut MeshData,
) -> Result<(), MeshError> {
    match element.name.as_str() {
        "face" => faces::faces(element, source, mesh),
        _ => faces::strips(element, source, mesh),
    }
}

/// Drops attributes of faces that strips lack, and notes what is not supported.
fn tidy_attributes(mesh: &mut MeshData) {
    let triangles = mesh.triangles.len();
    let notes = &mut mesh.notes;
    mesh.attributes.retain(|a| {
        let fits = !a.name.starts_with("face_") || a.values.len() == a.channels * triangles;
        if !fits {
            notes.push(format!(
                "`{}` is left out: triangle strips have none",
                a.name
            ));
        }
        fits
    });
    let several = (mesh.attributes.iter())
        .filter(|a| a.name == "face_texnumber" && !mesh.uvs.is_empty())
        .any(|a| a.values.iter().any(|&v| v != a.values[0]));
    if several {
        mesh.notes.push(
            "its faces refer to several images (`texnumber`); a texture is put on all of them"
                .into(),
        );
    }
}

/// Skips an element that is not needed.
fn skip(element: &Element, source: &mut Source<'_>) -> Result<(), MeshError> {
    if let Some(stride) = element.stride().filter(|_| source.is_binary()) {
        source.rows(element, stride)?;
        return Ok(());
    }
    if element.properties.is_empty() {
        return Ok(());
    }
    for _ in 0..element.count {
        for property in &element.properties {
            skip_property(property, source)?;
        }
    }
    Ok(())
}

fn skip_property(property: &Property, source: &mut Source<'_>) -> Result<(), MeshError> {
    match property.kind {
        Kind::Number(number) => source.number(number).map(drop),
        Kind::List { count, item } => {
            let length = source.length(count)?;
            (0..length).try_for_each(|_| source.number(item).map(drop))
        }
    }
}

fn vertices(
    element: &Element,
    source: &mut Source<'_>,
    mesh: &mut MeshData,
) -> Result<Places, MeshError> {
    if u32::try_from(element.count).is_err() {
        return Err(MeshError::new(
            Place::Line(element.line),
            format!("{} vertices are more than 32 bits can count", element.count),
        ));
    }
    let find = |names: &[&str]| -> Option<Vec<usize>> {
        names.iter().map(|name| element.find(name)).collect()
    };
    let Some(xyz) = find(&["x", "y", "z"]) else {
        return Err(MeshError::new(
            Place::Line(element.line),
            "the element `vertex` needs the properties `x`, `y` and `z`",
        ));
    };
    let columns = Columns::read(element, source)?;
    let normal = find(&["nx", "ny", "nz"]);
    let uv = UV_NAMES.iter().find_map(|names| find(names));
    mesh.positions = columns.vec3(&xyz);
    let mut used = xyz;
    if let Some(normal) = normal {
        mesh.normals = columns.vec3(&normal);
        used.extend(normal);
    }
    if let Some(uv) = uv {
        let pairs = columns.gather(&uv);
        mesh.uvs = pairs.chunks_exact(2).map(Vec2::from_slice).collect();
        used.extend(uv);
    }
    add_attributes("vertex", element, &used, &columns, mesh);
    Ok(columns.places())
}

/// Adds the properties that are not `used` as attributes.
fn add_attributes(
    prefix: &str,
    element: &Element,
    used: &[usize],
    columns: &Columns<'_>,
    mesh: &mut MeshData,
) {
    let free: Vec<(usize, &str)> = element
        .properties
        .iter()
        .enumerate()
        .filter(|(i, p)| !used.contains(i) && matches!(p.kind, Kind::Number(_)))
        .map(|(i, p)| (i, p.name.as_str()))
        .collect();
    for group in groups(&free) {
        let values = columns.gather(&group.properties);
        mesh.attributes.push(Attribute {
            name: format!("{prefix}_{}", group.name),
            channels: group.properties.len(),
            values,
        });
    }
}

#[cfg(test)]
mod tests;
