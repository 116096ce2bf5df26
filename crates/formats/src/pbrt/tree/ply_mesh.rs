//! Meshes in PLY files (`shapes.cpp`; `util/mesh.cpp`, `TriQuadMesh::ReadPLY`): a `ply`, with normals as of `trianglemesh`.
//!
//! Whether a file has normals and texture coordinates decides how it is shaded, so its header is looked at. Faces of four corners are
//! bilinear patches in pbrt and two triangles in Etalon, which is the same for parallelograms.
//!
//! With a `displacement` the edges are divided until none is longer than `edgelength` in the world, and vertices move along their normals in the
//! mesh's own space: a `displacement` of Etalon, which does both in the world. That is the same if the CTM does not stretch.

use super::super::parameters::Parameters;
use super::Mapper;
use super::meshes::{shaded, with_default_uvs};
use super::node::{Draft, Given, word};
use super::placement::mirrors;
use super::shapes::{Form, Wanted};
use super::textures::looks_at_place;
use crate::FileAssets;
use crate::gzip;
use crate::ply::{self, Carried};
use etalon_params::{Class, DMat4, DVec3, Diagnostic, Value};
use etalon_transport::{Assets, MeshFormat};

/// By how much, of its size, what a CTM does along one axis may differ from another.
const EVEN: f64 = 1e-5;

/// The most bytes that a header has.
const MOST_HEADER: u64 = 1 << 20;

impl<'a> Mapper<'a> {
    /// A mesh from a file; `None` after a mistake.
    pub(crate) fn ply_mesh(
        &mut self,
        params: &Parameters<'a>,
        wanted: &Wanted<'_>,
    ) -> Option<Form> {
        let height = self.number_if_given(params, "displacement");
        if height.is_none() && params.has("displacement") {
            return None;
        }
        let edge = params.float_where("edgelength", 1.0, "a finite number above 0", |edge| {
            edge > 0.0 && edge.is_finite()
        });
        let Some(filename) = params.string("filename") else {
            params.missing("string filename");
            return None;
        };
        let carried = self.carried_by(params, filename)?;
        if height.is_some() && !carried.uvs {
            let what = "`displacement` of a mesh without texture coordinates";
            self.refuse_value(params, "displacement", what, "a file with them");
            return None;
        }
        if wanted.by_uv && !carried.uvs {
            return self.with_default_coordinates(params, wanted, filename);
        }
        let draft = self.placed_form(params, wanted, "ply", DMat4::IDENTITY)?;
        let draft = draft.from(params, "filename", "filename", word(filename));
        if let Some(height) = height {
            let moved = self.displaced(params, wanted, height)?;
            let moved = moved.from(params, "edgelength", "edge_length", Value::Float(edge));
            return Some(Form {
                drafts: vec![moved.child(draft.node())],
                area: None,
            });
        }
        Some(Form {
            drafts: vec![shaded(draft, wanted, !carried.normals)],
            area: None,
        })
    }

    /// The mesh of a file without texture coordinates, with those that pbrt gives the corners of its triangles.
    fn with_default_coordinates(
        &mut self,
        params: &Parameters<'a>,
        wanted: &Wanted<'_>,
        filename: &str,
    ) -> Option<Form> {
        let files = FileAssets::new(self.scene.search.clone());
        let data = match files.mesh(MeshFormat::Ply, filename) {
            Ok(data) => data,
            Err(error) => {
                params.error_at("filename", error.message);
                return None;
            }
        };
        let draft = self.mesh_shape(params, wanted, with_default_uvs(&data))?;
        Some(Form {
            drafts: vec![draft],
            area: None,
        })
    }

    /// A `displacement` without its mesh; `None` after a mistake.
    fn displaced(
        &self,
        params: &Parameters<'_>,
        wanted: &Wanted<'_>,
        height: Given,
    ) -> Option<Draft> {
        let placement = &wanted.shape.placement;
        let to_world = placement.start;
        let refuse = |what: &str, accepted: &str| {
            self.refuse_value(params, "displacement", what, accepted);
            None
        };
        let axes = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| to_world.transform_vector3(axis));
        let length = axes[0].length();
        let even = axes
            .iter()
            .all(|axis| (axis.length() / length - 1.0).abs() < EVEN);
        let square = (0..3).all(|i| axes[i].dot(axes[(i + 1) % 3]).abs() < EVEN * length * length);
        if !(even && square) || mirrors(placement) || wanted.shape.reverse_orientation {
            let what = "`displacement` of a mesh that is stretched, mirrored or turned inside out";
            return refuse(what, "a CTM of rotations, translations and one scale");
        }
        if placement.is_animated() {
            return refuse(
                "`displacement` of a mesh that moves",
                "a mesh that stands still",
            );
        }
        if let Value::Object(texture) = &height.value
            && looks_at_place(texture)
            && to_world != DMat4::IDENTITY
        {
            let what =
                "`displacement` by a texture in space, of a mesh elsewhere than in its own space";
            return refuse(what, "a texture of (u, v), or no CTM");
        }
        let draft = Draft::of(params, Class::Shape, "displacement");
        let draft = draft.given("height", height);
        Some(match (length - 1.0).abs() < EVEN {
            true => draft,
            false => draft.plain("scale", Value::Float(length)),
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
