//! Meshes from files: the plugins `obj`, `ply` and `serialized`.

use crate::placement::Placement;
use crate::shapes::mesh::{Mesh, MeshOptions};
use crate::shapes::shape_model::read_flip;
use etalon_params::{Class, Diagnostic, Node, Params, Value};
use etalon_transport::file::{report, span_of_filename};
use etalon_transport::{Build, MeshData, MeshFormat};

/// The format of a shape's file, if it is a mesh from a file.
pub fn mesh_format(shape: &Node) -> Option<MeshFormat> {
    match (shape.class, shape.plugin.value.as_str()) {
        (Class::Shape, "obj") => Some(MeshFormat::Obj),
        (Class::Shape, "ply") => Some(MeshFormat::Ply),
        (Class::Shape, "serialized") => {
            let shape_index = match shape.property("shape_index").map(|given| &given.value) {
                Some(Value::Integer(index)) => u32::try_from(*index).ok()?,
                Some(_) => return None,
                None => 0,
            };
            Some(MeshFormat::Serialized { shape_index })
        }
        _ => None,
    }
}

/// Reads an `obj`; v is flipped unless the scene says otherwise, as in Mitsuba.
pub(crate) fn obj(params: &Params<'_>, build: &mut dyn Build) -> Option<Mesh> {
    read(params, build, Some(true))
}

/// Reads a `ply`.
pub(crate) fn ply(params: &Params<'_>, build: &mut dyn Build) -> Option<Mesh> {
    read(params, build, Some(false))
}

/// Reads a `serialized`; as in Mitsuba, its texture coordinates stand as they are.
pub(crate) fn serialized(params: &Params<'_>, build: &mut dyn Build) -> Option<Mesh> {
    let index = params.integer_or("shape_index", 0);
    if u32::try_from(index).is_err() {
        params.refuse("shape_index", index, "an integer from 0 to 4294967295");
    }
    read(params, build, None)
}

/// Reads a mesh; if nothing says which of its file, only looks at the parameters.
fn read(params: &Params<'_>, build: &mut dyn Build, flip_tex_coords: Option<bool>) -> Option<Mesh> {
    let placement = Placement::from_params(params);
    let face_normals = params.boolean_or("face_normals", false);
    let flip_normals = read_flip(params);
    let flip_tex_coords =
        flip_tex_coords.is_some_and(|default| params.boolean_or("flip_tex_coords", default));
    let (filename, data) = contents(params, build, mesh_format(params.node), "the mesh file")?;
    let span = span_of_filename(params);
    for note in notes(&data, face_normals || data.face_normals) {
        let message = format!("`{filename}`: {note}");
        params.diagnostics.push(Diagnostic::note(span, message));
    }
    let options = MeshOptions {
        placement: placement?,
        face_normals: face_normals || data.face_normals,
        flip_normals,
        flip_tex_coords,
    };
    match Mesh::new(data, &options) {
        Ok(mesh) => Some(mesh),
        Err(message) => {
            let message = format!("`{filename}` cannot be used: {message}");
            params.diagnostics.push(Diagnostic::error(span, message));
            None
        }
    }
}

/// The name and the contents of the mesh file `filename`, which holds `what`; without a format, only looks at the parameter.
pub(crate) fn contents<'a>(
    params: &Params<'a>,
    build: &mut dyn Build,
    format: Option<MeshFormat>,
    what: &str,
) -> Option<(&'a str, MeshData)> {
    if !params.has("filename") {
        params.missing("filename", what);
    }
    let filename = params.string("filename")?;
    let data = build.assets().mesh(format?, filename);
    let data = data.map_err(|error| report(params, error)).ok()?;
    Some((filename, data))
}

/// Notes on a file that can be used.
fn notes(data: &MeshData, face_normals: bool) -> Vec<String> {
    let mut notes = data.notes.clone();
    if data.triangles.is_empty() {
        notes.push("the mesh has no triangles: nothing will be seen of it".into());
    }
    let count = data.normals.iter().filter(|n| !n.is_finite()).count();
    if count > 0 && !face_normals {
        notes.push(format!(
            "{count} of the {} normals are not finite; they are computed from the triangles instead",
            data.normals.len()
        ));
    }
    let count = data.uvs.iter().filter(|uv| !uv.is_finite()).count();
    if count > 0 {
        notes.push(format!(
            "{count} of the {} texture coordinates are not finite; they count as 0, 0",
            data.uvs.len()
        ));
    }
    notes
}
