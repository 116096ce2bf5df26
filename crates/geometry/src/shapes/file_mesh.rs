//! Meshes from files: the plugins `obj` and `ply`.

use crate::placement::Placement;
use crate::shapes::mesh::{Mesh, MeshOptions};
use crate::shapes::solid::read_flip;
use etalon_params::{Diagnostic, Params};
use etalon_transport::{Build, MeshFormat};

/// Reads an `obj`; v is flipped unless the scene says otherwise, as in Mitsuba.
pub(crate) fn obj(params: &Params<'_>, build: &mut dyn Build) -> Option<Mesh> {
    read(params, build, MeshFormat::Obj, true)
}

/// Reads a `ply`.
pub(crate) fn ply(params: &Params<'_>, build: &mut dyn Build) -> Option<Mesh> {
    read(params, build, MeshFormat::Ply, false)
}

fn read(
    params: &Params<'_>,
    build: &mut dyn Build,
    format: MeshFormat,
    flip_tex_coords: bool,
) -> Option<Mesh> {
    let placement = Placement::from_params(params);
    let face_normals = params.boolean_or("face_normals", false);
    let flip_normals = read_flip(params);
    let flip_tex_coords = params.boolean_or("flip_tex_coords", flip_tex_coords);
    let Some(filename) = params.string("filename") else {
        if !params.has("filename") {
            params.missing("filename", "the mesh file");
        }
        return None;
    };
    let span = params
        .property("filename")
        .map_or(params.node.plugin.span, |p| p.span);
    let data = match build.assets().mesh(format, filename) {
        Ok(data) => data,
        Err(error) => {
            let mut diagnostic = Diagnostic::error(span, error.message);
            diagnostic.help = error.help;
            params.diagnostics.push(diagnostic);
            return None;
        }
    };
    if data.triangles.is_empty() {
        let message = format!("`{filename}` has no triangles: nothing will be seen of it");
        params.diagnostics.push(Diagnostic::note(span, message));
    }
    let options = MeshOptions {
        placement: placement?,
        face_normals,
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
