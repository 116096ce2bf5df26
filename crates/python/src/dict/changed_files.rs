//! Arrays in place of what is in a scene's files: pictures, volumes, and those of meshes.

use super::arrays;
use super::file_arrays::FileArray;
use super::mesh::{self, Part};
use super::mistakes::Mistakes;
use crate::listing::{Change, Contents, FILE, file_name, join};
use etalon_formats::{FileAssets, ply};
use etalon_geometry::mesh_format;
use etalon_params::{Node, Value};
use etalon_render::scene_hash;
use etalon_transport::{Assets, MeshData};
use pyo3::prelude::*;
use std::cell::OnceCell;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The arrays among some changes.
pub(super) struct ChangedFiles<'a, 'py> {
    open: &'a dyn Fn() -> FileAssets,
    files: OnceCell<FileAssets>,
    changes: BTreeMap<String, Contents>,
    /// Objects with the arrays of meshes that are to be others.
    meshes: BTreeMap<String, (&'a Node, Vec<Part<'py>>)>,
}

impl<'a, 'py> ChangedFiles<'a, 'py> {
    /// None yet; `open` gives the scene's files.
    pub(super) fn new(open: &'a dyn Fn() -> FileAssets) -> Self {
        Self {
            open,
            files: OnceCell::new(),
            changes: BTreeMap::new(),
            meshes: BTreeMap::new(),
        }
    }

    fn files(&self) -> &FileAssets {
        self.files.get_or_init(self.open)
    }

    /// Takes the value of a key, if that is one of an array.
    pub(super) fn take(
        &mut self,
        (object, node): (&str, &'a Node),
        key: &str,
        value: &Bound<'py, PyAny>,
        mistakes: &mut Mistakes,
    ) -> PyResult<bool> {
        let plugin = node.plugin.value.as_str();
        if mesh_format(node).is_some() && mesh::is_part(key) {
            let (_, parts) = (self.meshes.entry(object.to_owned())).or_insert((node, Vec::new()));
            parts.push((key.to_owned(), arrays::as_array(value)?));
            return Ok(true);
        }
        let Some((kind, name)) = FileArray::of_key(plugin, key).zip(file_name(node)) else {
            return Ok(false);
        };
        let path = join(object, key);
        let old = match kind {
            FileArray::Picture => None,
            FileArray::Volume => match self.files().bytes(name) {
                Ok(old) => Some(old),
                Err(error) => {
                    mistakes.add(&path, error.message);
                    return Ok(true);
                }
            },
        };
        match arrays::file(kind, value, old.as_ref().map(|old| old.as_slice()))? {
            Ok(file) => {
                let contents = Contents::Bytes(Arc::new(file));
                if self.changes.insert(object.to_owned(), contents).is_some() {
                    mistakes.add(&path, "it is given twice, by another name, too");
                }
            }
            Err(reason) => mistakes.add(&path, reason),
        }
        Ok(true)
    }

    /// The changes.
    pub(super) fn finish(mut self, mistakes: &mut Mistakes) -> Vec<Change> {
        for (object, (node, parts)) in std::mem::take(&mut self.meshes) {
            match self.mesh(node, &parts) {
                Ok(mesh) => {
                    let contents = Contents::Mesh(Arc::new(mesh));
                    self.changes.insert(object, contents);
                }
                Err((key, reason)) => mistakes.add(&join(&object, &key), reason),
            }
        }
        let changes = self.changes.into_iter();
        let change = |(object, contents): (String, Contents)| Change {
            path: join(&object, FILE),
            value: Value::String(format!("array {} of {object}", hash(&contents))),
            contents: Some(contents),
        };
        changes.map(change).collect()
    }

    /// The mesh of an object with some arrays in place of its own.
    fn mesh(&self, node: &Node, parts: &[Part<'py>]) -> Result<MeshData, (String, String)> {
        let (Some(format), Some(name)) = (mesh_format(node), file_name(node)) else {
            return mesh::mesh(parts, None);
        };
        let (py, files) = (parts[0].1.py(), self.files());
        let old = py.detach(|| files.mesh(format, name));
        let old = old.map_err(|error| (parts[0].0.clone(), error.message))?;
        mesh::mesh(parts, Some(&old))
    }
}

/// What tells some contents from others.
fn hash(contents: &Contents) -> String {
    match contents {
        Contents::Bytes(bytes) => scene_hash::of_contents(bytes),
        Contents::Mesh(mesh) => {
            let mut bytes = ply::write(mesh);
            bytes.push(u8::from(mesh.face_normals));
            bytes.extend(mesh.copies.iter().flat_map(|copy| copy.to_le_bytes()));
            scene_hash::of_contents(&bytes)
        }
    }
}
