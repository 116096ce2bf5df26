//! The files of a scene, looked up along its search path.

use crate::document::{Document, embedded_name, mesh_name};
use crate::{SearchPath, gzip, obj, open_bounded, ply, read_bounded, serialized};
use etalon_transport::{AssetError, Assets, MeshData, MeshFormat, OpenFile, in_memory};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::io::{Read, Seek};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, Weak};

/// The largest file that is read.
const MOST_BYTES: u64 = 16 << 30;

/// Files up to this size stay in memory; larger ones only as long as somebody holds them.
const SMALL_FILE: usize = 1 << 20;

/// How much memory small files may take altogether.
const MOST_CACHED: usize = 64 << 20;

/// [`Assets`] in the file system.
///
/// Bytes are cached: while somebody holds a file's bytes, everybody gets the same ones, and
/// small files are kept for good. Meshes are not: they are large and read once.
#[derive(Debug, Default)]
pub struct FileAssets {
    search: SearchPath,
    limit: u64,
    /// Those that are no files: [`Document::meshes`], by their names.
    meshes: HashMap<String, Arc<MeshData>>,
    /// [`Document::embedded`], by their names.
    embedded: HashMap<String, Arc<Vec<u8>>>,
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    shared: HashMap<PathBuf, Weak<Vec<u8>>>,
    kept: HashMap<PathBuf, Arc<Vec<u8>>>,
    kept_bytes: usize,
    /// The files that were found, by the names that they were asked for.
    used: BTreeMap<String, PathBuf>,
}

impl FileAssets {
    /// Files along a search path.
    pub fn new(search: SearchPath) -> Self {
        Self {
            search,
            limit: MOST_BYTES,
            meshes: HashMap::new(),
            embedded: HashMap::new(),
            state: Mutex::default(),
        }
    }

    /// What a scene needs: files along its search path, and what its description has within.
    pub fn of(document: &Document) -> Self {
        let meshes = document.meshes.iter().enumerate();
        let meshes = meshes.map(|(index, mesh)| (mesh_name(index), Arc::clone(mesh)));
        let embedded = document.embedded.iter();
        let embedded = embedded.map(|(index, bytes)| (embedded_name(*index), Arc::clone(bytes)));
        Self {
            meshes: meshes.collect(),
            embedded: embedded.collect(),
            ..Self::new(document.search.clone())
        }
    }

    /// Refuses files of more than `limit` bytes.
    pub fn with_limit(mut self, limit: u64) -> Self {
        self.limit = limit;
        self
    }

    /// The search path.
    pub fn search(&self) -> &SearchPath {
        &self.search
    }

    /// The files that were found and read so far, sorted.
    pub fn used(&self) -> Vec<PathBuf> {
        let used: BTreeSet<PathBuf> = self.state().used.values().cloned().collect();
        used.into_iter().collect()
    }

    /// The contents of all files that were found so far, by the names that they were asked for.
    ///
    /// # Errors
    /// If one cannot be read any more.
    pub fn contents(&self) -> Result<HashMap<String, Arc<Vec<u8>>>, AssetError> {
        let used = self.state().used.clone();
        let found = used.into_iter().map(|(name, path)| {
            let bytes = self.read(&name, &path)?;
            Ok((name, Arc::new(bytes)))
        });
        let within = self.embedded.clone();
        within.into_iter().map(Ok).chain(found).collect()
    }

    /// Has these contents for these names, whatever is in files.
    pub fn holding(mut self, contents: impl IntoIterator<Item = (String, Arc<Vec<u8>>)>) -> Self {
        self.embedded.extend(contents);
        self
    }

    /// Has these meshes for these names, whatever their format.
    pub fn holding_meshes(
        mut self,
        meshes: impl IntoIterator<Item = (String, Arc<MeshData>)>,
    ) -> Self {
        self.meshes.extend(meshes);
        self
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(|e| e.into_inner())
    }

    fn find(&self, name: &str) -> Result<PathBuf, AssetError> {
        let path = self.search.find(name).ok_or_else(|| AssetError {
            message: format!("the file `{name}` was not found"),
            help: Some(self.search.why_not(name)),
        })?;
        self.state().used.insert(name.to_owned(), path.clone());
        Ok(path)
    }

    /// One mesh of a file that may hold thousands: no more of it is read than that.
    fn serialized(&self, name: &str, index: u32) -> Result<MeshData, AssetError> {
        let mut file = self.open(name)?;
        let mesh = serialized::read(&mut file, index);
        mesh.map_err(|error| {
            let mut head = [0; 4];
            let again = file.rewind().and_then(|()| file.read_exact(&mut head));
            let format = MeshFormat::Serialized { shape_index: index };
            AssetError {
                message: format!("`{name}`, {error}"),
                help: again.ok().and_then(|()| looks_like_another(format, &head)),
            }
        })
    }

    fn read(&self, name: &str, path: &Path) -> Result<Vec<u8>, AssetError> {
        read_bounded(path, self.limit).map_err(|reason| unreadable(name, &reason))
    }
}

impl Assets for FileAssets {
    fn bytes(&self, name: &str) -> Result<Arc<Vec<u8>>, AssetError> {
        if let Some(bytes) = self.embedded.get(name) {
            return Ok(Arc::clone(bytes));
        }
        let path = self.find(name)?;
        if let Some(bytes) = self.state().shared.get(&path).and_then(Weak::upgrade) {
            return Ok(bytes);
        }
        let bytes = Arc::new(self.read(name, &path)?);
        let mut state = self.state();
        // Another thread may have been faster; then its bytes are everybody's.
        if let Some(first) = state.shared.get(&path).and_then(Weak::upgrade) {
            return Ok(first);
        }
        state.shared.insert(path.clone(), Arc::downgrade(&bytes));
        if bytes.len() <= SMALL_FILE && state.kept_bytes + bytes.len() <= MOST_CACHED {
            state.kept_bytes += bytes.len();
            state.kept.insert(path, bytes.clone());
        }
        Ok(bytes)
    }

    fn open(&self, name: &str) -> Result<Box<dyn OpenFile>, AssetError> {
        if let Some(bytes) = self.embedded.get(name) {
            return Ok(in_memory(Arc::clone(bytes)));
        }
        let path = self.find(name)?;
        match open_bounded(&path, self.limit) {
            Ok(file) => Ok(Box::new(file)),
            Err(reason) => Err(unreadable(name, &reason)),
        }
    }

    fn mesh(&self, format: MeshFormat, name: &str) -> Result<MeshData, AssetError> {
        if let Some(mesh) = self.meshes.get(name) {
            return Ok((**mesh).clone());
        }
        if let MeshFormat::Serialized { shape_index } = format {
            return self.serialized(name, shape_index);
        }
        let bytes = match self.embedded.get(name) {
            Some(bytes) => bytes.to_vec(),
            None => self.read(name, &self.find(name)?)?,
        };
        // pbrt's scenes have compressed PLY files.
        let bytes = gzip::plain(bytes, self.limit).map_err(|reason| unreadable(name, &reason))?;
        let mesh = match format {
            MeshFormat::Obj => obj::parse(&bytes),
            MeshFormat::PlyPoints => ply::parse_points(&bytes),
            _ => ply::parse(&bytes),
        };
        mesh.map_err(|error| AssetError {
            message: format!("`{name}`, {error}"),
            help: looks_like_another(format, &bytes),
        })
    }
}

fn unreadable(name: &str, reason: &str) -> AssetError {
    AssetError {
        message: format!("cannot read `{name}`: {reason}"),
        help: None,
    }
}

/// A hint for files that were given to the wrong reader.
fn looks_like_another(format: MeshFormat, bytes: &[u8]) -> Option<String> {
    let is_ply = bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r");
    let is_serialized = bytes.starts_with(&serialized::MAGIC.to_le_bytes());
    let may_be_obj = bytes.starts_with(b"v ") || bytes.starts_with(b"# ");
    let help = match format {
        MeshFormat::Obj | MeshFormat::Serialized { .. } if is_ply => {
            "this is a PLY file: use the shape `ply`"
        }
        MeshFormat::Obj | MeshFormat::Ply | MeshFormat::PlyPoints if is_serialized => {
            "this is one of Mitsuba's serialized files: use the shape `serialized`"
        }
        MeshFormat::Ply | MeshFormat::Serialized { .. } if may_be_obj => {
            "this may be an OBJ file: use the shape `obj`"
        }
        _ => return None,
    };
    Some(help.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder() -> (tempfile::TempDir, FileAssets) {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let write = |name: &str, text: &str| {
            std::fs::write(folder.path().join(name), text).expect("written");
        };
        write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        write("bad.obj", "v 0 0 0\nf 1 2 3\n");
        write("x.ply", "ply\nformat ascii 1.0\nend_header\n");
        write("small", "12345");
        let assets = FileAssets::new(SearchPath::new([folder.path().to_owned()]));
        (folder, assets)
    }

    #[test]
    fn bytes_are_read_once() {
        let (folder, assets) = folder();
        let first = assets.bytes("small").expect("read");
        std::fs::remove_file(folder.path().join("small")).expect("removed");
        std::fs::write(folder.path().join("small"), "other").expect("written");
        assert!(Arc::ptr_eq(&first, &assets.bytes("small").expect("cached")));
        assert_eq!(assets.used(), [folder.path().join("small")]);
    }

    #[test]
    fn meshes_are_read_by_format() {
        let (_folder, assets) = folder();
        let mesh = assets.mesh(MeshFormat::Obj, "a.obj").expect("read");
        assert_eq!(mesh.triangles, [[0, 1, 2]]);
    }

    #[test]
    fn contents_stand_for_files() {
        let (folder, assets) = folder();
        let mesh = assets.mesh(MeshFormat::Obj, "a.obj").expect("read");
        assets.bytes("small").expect("read");
        let contents = assets.contents().expect("read again");
        let mut names: Vec<&str> = contents.keys().map(String::as_str).collect();
        names.sort_unstable();
        assert_eq!(names, ["a.obj", "small"]);
        drop(folder);
        let held = FileAssets::default().holding(contents);
        let again = held.mesh(MeshFormat::Obj, "a.obj").expect("held");
        assert_eq!(again.positions, mesh.positions);
        let mut text = String::new();
        let mut file = held.open("small").expect("held");
        file.read_to_string(&mut text).expect("text");
        assert_eq!(text, "12345");
        // Those that it holds are found again.
        assert_eq!(held.contents().expect("held").len(), 2);
        assert!(assets.contents().is_err());
    }

    #[test]
    fn files_in_memory_belong_to_a_scene() {
        let mesh = MeshData {
            positions: vec![glam::Vec3::X, glam::Vec3::Y, glam::Vec3::Z],
            triangles: vec![[0, 1, 2]],
            ..MeshData::default()
        };
        let scene = crate::mitsuba::SceneInMemory {
            name: "<here>".into(),
            text: "<scene version=\"3.0.0\"/>".into(),
            files: vec![Arc::new(b"12".to_vec()), Arc::new(ply::write(&mesh))],
        };
        let read = crate::mitsuba::read_in_memory(&scene, &crate::ReadOptions::default());
        let document = read.sound().expect("no mistakes");
        let named: Vec<_> = document.files.iter().map(|file| &file.bytes[..]).collect();
        assert_eq!(named[..2], [scene.text.as_bytes(), b"12"]);
        assert_eq!(document.files[2].path, PathBuf::from(embedded_name(1)));
        let assets = FileAssets::of(document);
        assert_eq!(**assets.bytes(&embedded_name(0)).expect("there"), *b"12");
        let again = assets.mesh(MeshFormat::Ply, &embedded_name(1));
        assert_eq!(again.expect("a mesh").positions, mesh.positions);
        let wrong = assets.mesh(MeshFormat::Obj, &embedded_name(1));
        let help = wrong.expect_err("not OBJ").help;
        assert_eq!(
            help.as_deref(),
            Some("this is a PLY file: use the shape `ply`")
        );
    }

    #[test]
    fn serialized_meshes_are_told_from_others() {
        let (folder, assets) = folder();
        std::fs::write(folder.path().join("s"), b"\x1c\x04\x04\0broken").expect("written");
        let said = |format, name: &str| {
            let error = assets.mesh(format, name).expect_err("broken");
            (error.message, error.help.unwrap_or_default())
        };
        let serialized = MeshFormat::Serialized { shape_index: 0 };
        let (message, help) = said(serialized, "s");
        assert!(
            message.starts_with("`s`, byte 0: the flags are damaged"),
            "{message}"
        );
        assert_eq!(help, "");
        for format in [MeshFormat::Obj, MeshFormat::Ply] {
            assert!(said(format, "s").1.ends_with("use the shape `serialized`"));
        }
        assert!(said(serialized, "x.ply").1.ends_with("use the shape `ply`"));
        assert!(said(serialized, "a.obj").1.ends_with("use the shape `obj`"));
        let assets = FileAssets::new(assets.search().clone()).with_limit(4);
        let error = assets.mesh(serialized, "s").expect_err("too large");
        assert!(error.message.contains("more than the 4 that are accepted"));
    }

    #[test]
    fn errors_name_the_file() {
        let (folder, assets) = folder();
        let message = |name: &str| {
            let error = assets.mesh(MeshFormat::Obj, name).expect_err("broken");
            format!("{} ({})", error.message, error.help.unwrap_or_default())
        };
        assert_eq!(
            message("bad.obj"),
            "`bad.obj`, line 2: the face refers to position 2, but 1 are given so far ()"
        );
        let place = folder.path().display();
        assert_eq!(
            message("none.obj"),
            format!("the file `none.obj` was not found (looked in `{place}`)")
        );
        assert!(message("x.ply").ends_with("(this is a PLY file: use the shape `ply`)"));
        let pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n";
        std::fs::write(folder.path().join("lfs.obj"), pointer).expect("written");
        assert!(message("lfs.obj").contains("`lfs.obj`: it is a pointer of git LFS"));
        assert!(message("A.OBJ").ends_with(
            "(there is `a.obj`: capital and small letters differ in the names of files)"
        ));
        let assets = FileAssets::new(assets.search().clone()).with_limit(4);
        assert_eq!(
            assets.bytes("small").expect_err("too large").message,
            "cannot read `small`: it has 5 bytes, more than the 4 that are accepted"
        );
    }
}
