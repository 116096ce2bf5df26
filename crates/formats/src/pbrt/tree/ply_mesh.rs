//! Meshes in PLY files (`shapes.cpp`; `util/mesh.cpp`, `TriQuadMesh::ReadPLY`): a `ply`, with normals as of `trianglemesh`.
//!
//! Whether a file has normals and texture coordinates decides how it is shaded, so its header is looked at. Faces of four corners are
//! bilinear patches in pbrt and two triangles in Etalon, which is the same for parallelograms.

use super::super::parameters::Parameters;
use super::Mapper;
use super::meshes::shaded;
use super::node::word;
use super::shapes::{Form, Wanted};
use crate::gzip;
use crate::ply::{self, Carried};
use etalon_params::{DMat4, Diagnostic};

/// The most bytes that a header has.
const MOST_HEADER: u64 = 1 << 20;

impl<'a> Mapper<'a> {
    /// A mesh from a file; `None` after a mistake.
    pub(crate) fn ply_mesh(
        &mut self,
        params: &Parameters<'a>,
        wanted: &Wanted<'_>,
    ) -> Option<Form> {
        if params.float_texture("displacement").is_some() {
            let accepted = "a mesh that is displaced already (`plytool displace` of pbrt)";
            self.refuse_value(params, "displacement", "displaced meshes", accepted);
            return None;
        }
        // The edge length is for displacement only.
        params.ignore(&["displacement", "edgelength"]);
        let Some(filename) = params.string("filename") else {
            params.missing("string filename");
            return None;
        };
        let carried = self.carried_by(params, filename)?;
        if wanted.by_uv && !carried.uvs {
            let what = "texture coordinates of a mesh that has none";
            let accepted = "a file with them, or materials without images and patterns";
            self.refuse_value(params, "filename", what, accepted);
            return None;
        }
        let draft = self.placed_form(params, wanted, "ply", DMat4::IDENTITY)?;
        let draft = draft.from(params, "filename", "filename", word(filename));
        Some(Form {
            drafts: vec![shaded(draft, wanted, !carried.normals)],
            area: None,
        })
    }

    /// What the vertices of a file carry; `None` after a mistake.
    fn carried_by(&mut self, params: &Parameters<'_>, filename: &str) -> Option<Carried> {
        if let Some(known) = self.ply_files.get(filename) {
            return *known;
        }
        let found = self.look_into(params, filename);
        self.ply_files.insert(filename.to_owned(), found);
        found
    }

    fn look_into(&self, params: &Parameters<'_>, filename: &str) -> Option<Carried> {
        let span = params.span("filename");
        let search = &self.scene.search;
        let Some(path) = search.find(filename) else {
            let mistake = Diagnostic::error(span, format!("the file `{filename}` was not found"));
            self.diagnostics
                .push(mistake.help(search.why_not(filename)));
            return None;
        };
        let head = gzip::head(&path, MOST_HEADER);
        let found = match head {
            Ok(bytes) => ply::carried(&bytes).map_err(|error| format!("`{filename}`, {error}")),
            Err(reason) => Err(format!("cannot read `{filename}`: {reason}")),
        };
        found
            .map_err(|message| params.error_at("filename", message))
            .ok()
    }
}
