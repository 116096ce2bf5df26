//! Wavefront OBJ.
//!
//! Read are `v` (with colours, if every vertex has them), `vt`, `vn` and `f`; everything else
//! (groups, materials, smoothing, curves) is passed over, as in Mitsuba. Corners that name the same
//! position, texture coordinate and normal become one vertex; only vertices that a face uses are
//! kept, in the order of their first use. Indices count from 1, or backwards from the last one
//! if negative. A `\` at a line's end continues it.
//!
//! A corner without a texture coordinate in a file that has some gets (0, 0); one without a normal
//! gets the area-weighted mean normal of its faces. Without any `vn` the mesh has no normals:
//! whether to make smooth ones is for the shape to decide.

mod corners;
mod lines;

use crate::mesh_error::{MeshError, Place};
use crate::polygon::triangulate;
use corners::{Corner, Corners};
use etalon_transport::{Attribute, MeshData};
use glam::{Vec2, Vec3};
use lines::{Line, Lines};

/// Reads the bytes of an OBJ file.
pub fn parse(bytes: &[u8]) -> Result<MeshData, MeshError> {
    let mut reader = Reader::default();
    let mut lines = Lines::new(bytes);
    while let Some(line) = lines.next_line() {
        reader.line(&line)?;
    }
    reader.finish()
}

#[derive(Default)]
struct Reader {
    positions: Vec<Vec3>,
    colours: Vec<Vec3>,
    uvs: Vec<Vec2>,
    normals: Vec<Vec3>,
    corners: Corners,
    triangles: Vec<[u32; 3]>,
    /// Vertices and positions of the face being read.
    face: Vec<u32>,
    polygon: Vec<Vec3>,
}

impl Reader {
    fn line(&mut self, line: &Line<'_>) -> Result<(), MeshError> {
        let mut words = line.words();
        match words.next() {
            Some(b"v") => {
                self.positions.push(vec3(line, &mut words, "position")?);
                let mut rest = words.clone();
                if words.count() >= 3 {
                    self.colours.push(vec3(line, &mut rest, "colour")?);
                }
            }
            Some(b"vt") => {
                let u = number(line, words.next(), "texture coordinate")?;
                let v = match words.next() {
                    Some(word) => number(line, Some(word), "texture coordinate")?,
                    None => 0.0,
                };
                self.uvs.push(Vec2::new(u, v));
            }
            Some(b"vn") => self.normals.push(vec3(line, &mut words, "normal")?),
            Some(b"f") => self.face(line, words)?,
            _ => {}
        }
        Ok(())
    }

    fn face<'l>(
        &mut self,
        line: &Line<'l>,
        words: impl Iterator<Item = &'l [u8]>,
    ) -> Result<(), MeshError> {
        self.face.clear();
        self.polygon.clear();
        for word in words {
            let corner = self.corner(line, word)?;
            self.polygon.push(self.positions[corner.position as usize]);
            self.face.push(self.corners.vertex(corner));
        }
        let (face, triangles) = (&self.face, &mut self.triangles);
        triangulate(&self.polygon, |t| triangles.push(t.map(|i| face[i])));
        if self.corners.list.len() >= u32::MAX as usize {
            return Err(line.error("the mesh has too many vertices"));
        }
        Ok(())
    }

    /// The indices of `position`, `position/uv`, `position//normal` or `position/uv/normal`.
    fn corner(&self, line: &Line<'_>, word: &[u8]) -> Result<Corner, MeshError> {
        let malformed = || line.error(format!("`{}` is not a corner of a face", text(word)));
        let mut parts = word.split(|&b| b == b'/');
        let written = [parts.next(), parts.next(), parts.next()];
        if parts.next().is_some() {
            return Err(malformed());
        }
        let index = |part: Option<&[u8]>, what: &str, count: usize| match part {
            None | Some(b"") => Ok(Corner::NONE),
            Some(part) => resolve(line, part, what, count),
        };
        let position = index(written[0], "position", self.positions.len())?;
        if position == Corner::NONE {
            return Err(malformed());
        }
        Ok(Corner {
            position,
            uv: index(written[1], "texture coordinate", self.uvs.len())?,
            normal: index(written[2], "normal", self.normals.len())?,
        })
    }

    fn finish(self) -> Result<MeshData, MeshError> {
        if self.triangles.is_empty() {
            return Err(MeshError::new(
                Place::Whole,
                "the file contains no faces of three or more corners",
            ));
        }
        let corners = &self.corners.list;
        let has_uvs = corners.iter().any(|c| c.uv != Corner::NONE);
        let has_normals = corners.iter().any(|c| c.normal != Corner::NONE);
        let mut mesh = MeshData {
            positions: corners
                .iter()
                .map(|c| self.positions[c.position as usize])
                .collect(),
            triangles: self.triangles,
            ..MeshData::default()
        };
        if has_uvs {
            let uv = |c: &Corner| self.uvs.get(c.uv as usize).copied().unwrap_or_default();
            mesh.uvs = corners.iter().map(uv).collect();
        }
        if has_normals {
            let normal = |c: &Corner| self.normals.get(c.normal as usize).copied();
            let given: Vec<Option<Vec3>> = corners.iter().map(normal).collect();
            mesh.normals = complete_normals(&mesh, &given);
        }
        if self.colours.len() == self.positions.len() {
            mesh.attributes.push(Attribute {
                name: "vertex_color".into(),
                channels: 3,
                values: corners
                    .iter()
                    .flat_map(|c| self.colours[c.position as usize].to_array())
                    .collect(),
            });
        }
        Ok(mesh)
    }
}

/// The normals given, with means over the adjacent faces where none is given.
fn complete_normals(mesh: &MeshData, given: &[Option<Vec3>]) -> Vec<Vec3> {
    let mut normals: Vec<Vec3> = given.iter().map(|n| n.unwrap_or_default()).collect();
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|i| mesh.positions[i as usize]);
        for corner in triangle.map(|i| i as usize) {
            if given[corner].is_none() {
                normals[corner] += (b - a).cross(c - a);
            }
        }
    }
    for (normal, given) in normals.iter_mut().zip(given) {
        if given.is_none() {
            *normal = normal.try_normalize().unwrap_or(Vec3::Z);
        }
    }
    normals
}

fn text(word: &[u8]) -> String {
    let short: String = String::from_utf8_lossy(word).chars().take(40).collect();
    short.escape_debug().to_string()
}

fn number(line: &Line<'_>, word: Option<&[u8]>, what: &str) -> Result<f32, MeshError> {
    let Some(word) = word else {
        return Err(line.error(format!("a number of this {what} is missing")));
    };
    let parsed = std::str::from_utf8(word).ok().and_then(|w| w.parse().ok());
    let number: f32 =
        parsed.ok_or_else(|| line.error(format!("`{}` is not a number", text(word))))?;
    if number.is_finite() {
        Ok(number)
    } else {
        Err(line.error(format!("`{}` in this {what} is not finite", text(word))))
    }
}

fn vec3<'l>(
    line: &Line<'l>,
    words: &mut impl Iterator<Item = &'l [u8]>,
    what: &str,
) -> Result<Vec3, MeshError> {
    let mut next = || number(line, words.next(), what);
    Ok(Vec3::new(next()?, next()?, next()?))
}

/// The index, from 0, that a written index means among `count` things.
fn resolve(line: &Line<'_>, part: &[u8], what: &str, count: usize) -> Result<u32, MeshError> {
    let written = std::str::from_utf8(part)
        .ok()
        .and_then(|p| p.parse::<i64>().ok());
    let written = written.ok_or_else(|| line.error(format!("`{}` is not an index", text(part))))?;
    let index = if written < 0 {
        written.checked_add(count as i64)
    } else {
        written.checked_sub(1)
    };
    match index {
        Some(index) if (0..count as i64).contains(&index) && index < i64::from(u32::MAX) => {
            Ok(index as u32)
        }
        _ => Err(line.error(format!(
            "the face refers to {what} {written}, but {count} are given so far"
        ))),
    }
}

#[cfg(test)]
mod tests;
