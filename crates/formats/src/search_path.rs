//! Where the files of a scene are looked for.

use std::path::{Path, PathBuf};

/// Folders in the order in which a relative path is tried against them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SearchPath {
    folders: Vec<PathBuf>,
}

impl SearchPath {
    /// A path of these folders.
    pub fn new(folders: impl IntoIterator<Item = PathBuf>) -> Self {
        let mut path = Self::default();
        folders.into_iter().for_each(|folder| path.append(folder));
        path
    }

    /// Puts a folder in front of all others.
    pub fn prepend(&mut self, folder: PathBuf) {
        self.folders.retain(|known| *known != folder);
        self.folders.insert(0, folder);
    }

    /// Puts a folder behind all others, unless it is there already.
    pub fn append(&mut self, folder: PathBuf) {
        if !self.folders.contains(&folder) {
            self.folders.push(folder);
        }
    }

    /// The folders.
    pub fn folders(&self) -> &[PathBuf] {
        &self.folders
    }

    /// The first file or folder for `name`. An absolute name is used as it is; a name with backslashes
    /// that is not found is tried with slashes.
    pub fn find(&self, name: &str) -> Option<PathBuf> {
        if name.is_empty() || name.contains('\0') {
            return None;
        }
        self.find_exact(Path::new(name)).or_else(|| {
            name.contains('\\')
                .then(|| self.find_exact(Path::new(&name.replace('\\', "/"))))
                .flatten()
        })
    }

    fn find_exact(&self, name: &Path) -> Option<PathBuf> {
        if name.is_absolute() {
            return name.exists().then(|| name.to_owned());
        }
        self.folders
            .iter()
            .map(|folder| folder.join(name))
            .find(|path| path.exists())
    }

    /// Why `name` was not found: a file whose name differs in case, or the folders that were searched.
    pub fn why_not(&self, name: &str) -> String {
        match self.called_so_but_for_case(name) {
            Some(other) => format!(
                "there is `{}`: capital and small letters differ in the names of files",
                other.display()
            ),
            None => self.describe(),
        }
    }

    /// What a relative name would be that differs in its case only.
    fn called_so_but_for_case(&self, name: &str) -> Option<PathBuf> {
        let name = name.replace('\\', "/");
        self.folders.iter().find_map(|folder| {
            // From folder to folder, as each may be spelt otherwise.
            let mut found = PathBuf::new();
            for part in Path::new(&name).components() {
                let part = part.as_os_str();
                if folder.join(&found).join(part).exists() {
                    found.push(part);
                    continue;
                }
                let here = match folder.join(&found) {
                    here if here.as_os_str().is_empty() => PathBuf::from("."),
                    here => here,
                };
                let mut names = std::fs::read_dir(here)
                    .ok()?
                    .flatten()
                    .map(|e| e.file_name());
                found.push(names.find(|known| known.eq_ignore_ascii_case(part))?);
            }
            (found != Path::new(&name)).then_some(found)
        })
    }

    /// Where was looked.
    fn describe(&self) -> String {
        let folders: Vec<String> = self
            .folders
            .iter()
            .map(|folder| match folder.to_string_lossy() {
                name if name.is_empty() => "the current folder".to_owned(),
                name => format!("`{name}`"),
            })
            .collect();
        format!("looked in {}", folders.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn earlier_folders_win() {
        let root = tempfile::tempdir().expect("a temporary folder");
        let (a, b) = (root.path().join("a"), root.path().join("b"));
        for folder in [&a, &b] {
            std::fs::create_dir(folder).expect("created");
        }
        std::fs::write(b.join("x.obj"), "").expect("written");
        let mut path = SearchPath::new([a.clone(), b.clone()]);
        assert_eq!(path.find("x.obj"), Some(b.join("x.obj")));
        std::fs::write(a.join("x.obj"), "").expect("written");
        assert_eq!(path.find("x.obj"), Some(a.join("x.obj")));
        path.prepend(b.clone());
        assert_eq!(path.find("x.obj"), Some(b.join("x.obj")));
        assert_eq!(path.find("..\\b\\x.obj"), Some(b.join("../b/x.obj")));
        assert_eq!(path.find("nothing.obj"), None);
        assert_eq!(path.find(""), None);
        std::fs::create_dir(a.join("Meshes")).expect("created");
        std::fs::write(a.join("Meshes/M.OBJ"), "").expect("written");
        let why = path.why_not("meshes\\m.obj");
        assert!(why.starts_with("there is `Meshes/M.OBJ`"), "{why}");
        assert!(path.why_not("m.obj").starts_with("looked in "));
    }
}
