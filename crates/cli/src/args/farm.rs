//! Arguments of `etalon farm`.

use super::RenderArgs;
use crate::arg_values::whole;
use crate::farm::Engine;
use clap::Args;
use std::path::{Path, PathBuf};

/// Arguments of `farm`.
#[derive(Debug, Args, Clone)]
#[command(mut_arg("output", |output| output.value_name("DIR").help("The folder for job files, parts and picture").long_help(None)))]
pub struct FarmArgs {
    /// Who runs the tasks.
    #[arg(long, value_name = "ENGINE", value_enum)]
    pub engine: Engine,
    /// Into how many parts a picture is dealt [default: one for each replicate].
    #[arg(long, value_name = "N", value_parser = whole::<1, 4096>, allow_negative_numbers = true, conflicts_with = "frames")]
    pub parts: Option<u32>,
    /// The program as the cluster's machines see it [default: this one].
    #[arg(long, value_name = "PATH")]
    pub program: Option<PathBuf>,
    /// Paths that begin with FROM here begin with TO on the cluster's machines; may be given several times.
    #[arg(long, value_name = "FROM=TO", value_parser = PathMap::parse)]
    pub map: Vec<PathMap>,
    /// Submit the job at once.
    #[arg(long, conflicts_with = "map")]
    pub submit: bool,
    /// What to render.
    #[command(flatten)]
    pub render: RenderArgs,
}

/// Where the cluster has what is in a folder here.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PathMap {
    from: PathBuf,
    to: PathBuf,
}

impl PathMap {
    /// Reads `FROM=TO`, two absolute paths.
    ///
    /// # Errors
    ///
    /// What is wrong with it.
    pub fn parse(text: &str) -> Result<Self, String> {
        let [from, to] = match text.split_once('=') {
            Some((from, to)) => [from, to].map(PathBuf::from),
            None => return Err("FROM=TO is wanted, such as /home/me=/mnt/share".to_owned()),
        };
        let relative = [&from, &to].into_iter().find(|path| !path.is_absolute());
        if let Some(path) = relative {
            return Err(format!("`{}` is no absolute path", path.display()));
        }
        Ok(Self { from, to })
    }

    /// The path as the cluster sees it; `None` if it is not in this folder.
    pub fn seen(&self, path: &Path) -> Option<PathBuf> {
        Some(self.to.join(path.strip_prefix(&self.from).ok()?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_mapped_by_whole_folders() {
        let map = PathMap::parse("/home/me=/mnt/share").expect("two paths");
        let seen = map.seen(Path::new("/home/me/box/scene.xml"));
        assert_eq!(seen, Some("/mnt/share/box/scene.xml".into()));
        assert_eq!(map.seen(Path::new("/home/melanie/scene.xml")), None);
        assert!(PathMap::parse("/home/me").is_err() && PathMap::parse("a=/b").is_err());
    }
}
