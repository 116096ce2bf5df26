//! Where a render goes: the image, and the picture that may lie beside it.
//!
//! `-o x.png` writes the picture `x.png` and, for the statistics, the image `x.exr`. Without `-o`
//! the image has the scene's name, in the current folder. A file that nobody named is overwritten
//! only if Etalon has rendered it.

use crate::args::RenderArgs;
use etalon_images::exr;
use std::fs::{self, OpenOptions};
use std::path::{Path, PathBuf};

/// What the names of images may end in, in words.
const ACCEPTED: &str = "the name must end in .exr, .png (a picture beside an .exr), .hdr or .pfm";

/// The files that a render writes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Outputs {
    /// The image.
    pub image: PathBuf,
    /// A picture for the eye.
    pub picture: Option<PathBuf>,
    /// Whether somebody named the image, not only the picture or nothing.
    pub named: bool,
}

impl Outputs {
    /// Those that the command line asks for.
    ///
    /// # Errors
    /// One sentence, if a file of this name could not be written.
    pub fn of(args: &RenderArgs) -> Result<Self, String> {
        let Some(output) = &args.output else {
            let stem = args.scene.file_stem().unwrap_or("image".as_ref());
            let mut name = stem.to_owned();
            if let Some(part) = args.part {
                name.push(format!("-part-{}-of-{}", part.number, part.count));
            }
            name.push(".exr");
            return Ok(Self {
                image: name.into(),
                picture: None,
                named: false,
            });
        };
        let refuse = |reason: &str| Err(format!("cannot write {}: {reason}", output.display()));
        let text = output.to_string_lossy();
        if text == "-" {
            return refuse("an image cannot go to standard output; give it a name");
        }
        if output.is_dir() || text.ends_with(std::path::is_separator) {
            let example = output.join(args.scene.file_stem().unwrap_or("image".as_ref()));
            return refuse(&format!(
                "it is a folder; name a file in it, such as {}",
                example.with_extension("exr").display()
            ));
        }
        let extension = extension(output);
        if args.part.is_some() && !matches!(extension.as_str(), "exr" | "png") {
            return refuse("only .exr can hold a part's exact sums");
        }
        match extension.as_str() {
            "exr" | "hdr" | "rgbe" | "pfm" => Ok(Self {
                image: output.clone(),
                picture: None,
                named: true,
            }),
            "png" => Ok(Self {
                image: output.with_extension("exr"),
                picture: Some(output.clone()),
                named: false,
            }),
            "" => refuse(&format!("{ACCEPTED}, such as {text}.exr")),
            "jpg" | "jpeg" => refuse(&format!("{ACCEPTED}; JPEG is only read")),
            _ => refuse(ACCEPTED),
        }
    }

    /// Refuses folders that are not there, outputs that could not be written anyway, and files that
    /// are somebody else's, before hours are spent on them.
    ///
    /// # Errors
    /// One sentence.
    pub fn check(&self, args: &RenderArgs) -> Result<(), String> {
        let mut all = vec![self.image.as_path()];
        all.extend(self.picture.as_deref());
        all.extend(args.stats.as_deref());
        all.iter().try_for_each(|path| check_place(path))?;
        for (index, path) in all.iter().enumerate() {
            if all[..index].iter().any(|other| same(other, path)) {
                return Err(format!("{} would be written twice", path.display()));
            }
        }
        if !self.named && self.image.exists() && !is_ours(&self.image) {
            let (image, picture) = (self.image.display(), self.picture.as_ref());
            let why = match picture {
                Some(picture) => format!(
                    "the image with the statistics belongs beside {}",
                    picture.display()
                ),
                None => "without `-o` the image would be written there".to_owned(),
            };
            return Err(format!(
                "{image} exists, and Etalon has not rendered it: {why}; name another file with `-o`"
            ));
        }
        Ok(())
    }

    /// Refuses outputs that are among the files that the scene was read from.
    ///
    /// # Errors
    /// One sentence.
    pub fn check_inputs(&self, args: &RenderArgs, inputs: &[PathBuf]) -> Result<(), String> {
        let outputs = [
            Some(&self.image),
            self.picture.as_ref(),
            args.stats.as_ref(),
        ];
        let clash = outputs.into_iter().flatten().find(|output| {
            let there = inputs.iter().any(|input| same(input, output));
            output.exists() && there
        });
        match clash {
            Some(output) => Err(format!(
                "cannot write {}: the scene is read from it; give the image another name",
                output.display()
            )),
            None => Ok(()),
        }
    }
}

/// Whether two names are of one file.
fn same(a: &Path, b: &Path) -> bool {
    let place = |path: &Path| fs::canonicalize(path).ok();
    a == b || place(a).is_some_and(|a| Some(a) == place(b))
}

/// Whether a file is an image that was rendered here.
fn is_ours(path: &Path) -> bool {
    exr::read_header(path).is_ok_and(|header| !header.text.is_empty())
}

fn extension(path: &Path) -> String {
    path.extension()
        .map(|e| e.to_string_lossy().to_lowercase())
        .unwrap_or_default()
}

/// Refuses a place where no file can be made.
///
/// # Errors
/// One sentence.
pub fn check_place(path: &Path) -> Result<(), String> {
    let refuse =
        |reason: &dyn std::fmt::Display| Err(format!("cannot write {}: {reason}", path.display()));
    // The file that a symbolic link names is made where it leads.
    let path = match etalon_images::atomic_file::target(path) {
        Ok(target) => target,
        Err(error) => return refuse(&error),
    };
    if path.is_dir() {
        return refuse(&"it is a folder");
    }
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty());
    if folder.is_some_and(|folder| !folder.is_dir()) {
        return refuse(&"there is no such folder");
    }
    // A device is written to as it is; a file is written beside its old self and takes its place.
    let place = fs::canonicalize(&path).unwrap_or(path);
    if place.exists() && !place.is_file() {
        return Ok(());
    }
    // Only trying tells whether a file can be made there.
    let trial = place.with_file_name(format!(".etalon-{}.part", std::process::id()));
    let made = OpenOptions::new()
        .write(true)
        .create_new(true)
        .open(&trial)
        .and_then(|_| fs::remove_file(&trial));
    made.or_else(|error| refuse(&error))
}
