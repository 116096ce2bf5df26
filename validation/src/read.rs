//! Reading claims from their files; every integrator of a matrix is asked about the scene.

use crate::claim::Claim;
use crate::matrix;
use etalon_params::suggest::nearest;
use rayon::iter::Either;
use rayon::prelude::*;
use std::path::{Path, PathBuf};

/// All claims, or everything that is wrong with them.
fn whole(
    claims: impl ParallelIterator<Item = Result<Claim, String>>,
) -> Result<Vec<Claim>, String> {
    let (claims, errors): (Vec<Claim>, Vec<String>) = claims.partition_map(|claim| match claim {
        Ok(claim) => Either::Left(claim),
        Err(message) => Either::Right(message),
    });
    if errors.is_empty() {
        Ok(claims)
    } else {
        Err(errors.join("\n"))
    }
}

impl Claim {
    /// Reads the claim in a file.
    ///
    /// # Errors
    /// Says what is wrong with the file, and where.
    pub fn read(path: &Path) -> Result<Self, String> {
        let mut claim = Self::parse(path)?;
        claim.expand(path)?;
        Ok(claim)
    }

    /// The claim in a file as it is written, without the rows of its matrix: no scene is looked at.
    fn parse(path: &Path) -> Result<Self, String> {
        let error = |message: String| format!("{}: {message}", path.display());
        let text = std::fs::read_to_string(path).map_err(|e| error(e.to_string()))?;
        let mut claim: Self = toml::from_str(&text).map_err(|e| error(e.to_string()))?;
        claim.name = path
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        let bounded = text.parse::<toml::Table>();
        let bounded = bounded.is_ok_and(|table| table.contains_key("bounds"));
        claim.check(bounded).map_err(error)?;
        Ok(claim)
    }

    /// Adds the rows of the matrix: every integrator is asked about the scene.
    fn expand(&mut self, path: &Path) -> Result<(), String> {
        matrix::expand(self).map_err(|message| format!("{}: {message}", path.display()))
    }

    /// Reads all claims in a folder, in the order of their names.
    ///
    /// # Errors
    /// Says what is wrong with every file that cannot be read.
    pub fn read_all(folder: &Path) -> Result<Vec<Self>, String> {
        Self::read_named(folder, None)
    }

    /// Reads the claims that `name` means ([`named`]), all if it is `None`. Every file must be well
    /// written, but the scenes of other claims are not looked at.
    ///
    /// # Errors
    /// Says what is wrong with every file that cannot be read, or that no claim has such a name.
    pub fn read_named(folder: &Path, name: Option<&str>) -> Result<Vec<Self>, String> {
        let entries =
            std::fs::read_dir(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
        let mut paths: Vec<PathBuf> = entries
            .filter_map(|entry| Some(entry.ok()?.path()))
            .filter(|path| path.extension().is_some_and(|e| e == "toml"))
            .collect();
        paths.sort();
        let mut claims = whole(paths.par_iter().map(|path| Self::parse(path)))?;
        if let Some(name) = name {
            let chosen: Vec<Self> = named(&claims, name).into_iter().cloned().collect();
            if chosen.is_empty() {
                return Err(unknown(&claims, name));
            }
            claims = chosen;
        }
        whole(claims.into_par_iter().map(|mut claim| {
            claim.expand(&folder.join(format!("{}.toml", claim.name)))?;
            Ok(claim)
        }))
    }
}

/// The claim of this name, or, if there is none, those whose names contain it.
pub fn named<'a>(claims: &'a [Claim], name: &str) -> Vec<&'a Claim> {
    match claims.iter().find(|claim| claim.name == name) {
        Some(claim) => vec![claim],
        None => (claims.iter())
            .filter(|claim| claim.name.contains(name))
            .collect(),
    }
}

/// What to tell somebody who asked for claims of this name, as there are none.
pub fn unknown(claims: &[Claim], name: &str) -> String {
    let names = claims.iter().map(|claim| claim.name.as_str());
    let help = match nearest(name, names) {
        Some(near) => format!("did you mean `{near}`?"),
        None => "see `cargo xtask validate --list`".to_owned(),
    };
    format!("no claim has such a name as `{name}`: {help}")
}
