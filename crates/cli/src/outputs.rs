//! The outputs of a render: the image, and the picture that may be beside it.
//!
//! `-o x.png` writes the picture `x.png` and, for the statistics, the image `x.exr`. Without `-o`
//! the image has the scene's name, in the current folder. A file that was not named is overwritten
//! only if Etalon has rendered it.

use etalon_images::exr;
use etalon_render::part::PartOfMany;
use etalon_render::write_guard::WriteGuard;
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
    /// Those of a scene, or one part of it, where `-o` names `output`.
    ///
    /// # Errors
    /// One sentence, if a file of this name could not be written.
    pub fn of(
        output: Option<&Path>,
        scene: &Path,
        part: Option<PartOfMany>,
    ) -> Result<Self, String> {
        let Some(output) = output else {
            let stem = scene.file_stem().unwrap_or("image".as_ref());
            let mut name = stem.to_owned();
            if let Some(part) = part {
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
            let example = output.join(scene.file_stem().unwrap_or("image".as_ref()));
            return refuse(&format!(
                "it is a folder; name a file in it, such as {}",
                example.with_extension("exr").display()
            ));
        }
        let extension = extension(output);
        if part.is_some() && !matches!(extension.as_str(), "exr" | "png") {
            return refuse("only .exr can hold a part's exact sums");
        }
        match extension.as_str() {
            "exr" | "hdr" | "rgbe" | "pfm" => Ok(Self {
                image: output.to_owned(),
                picture: None,
                named: true,
            }),
            "png" => Ok(Self {
                image: output.with_extension("exr"),
                picture: Some(output.to_owned()),
                named: false,
            }),
            "" => refuse(&format!("{ACCEPTED}, such as {text}.exr")),
            "jpg" | "jpeg" => refuse(&format!("{ACCEPTED}; JPEG is only read")),
            _ => refuse(ACCEPTED),
        }
    }

    /// Claims all files of a render, before hours are spent on them: refuses places where they cannot be, files
    /// that are read, and images that are somebody else's.
    ///
    /// # Errors
    /// One sentence.
    pub fn claim(
        &self,
        scene: &Path,
        stats: Option<&Path>,
        resume: bool,
    ) -> Result<WriteGuard, String> {
        let mut guard = WriteGuard::of([scene]);
        let files = [Some(self.image.as_path()), self.picture.as_deref(), stats];
        for path in files.into_iter().flatten() {
            guard.claim(path)?;
        }
        if resume {
            guard.claim(&self.checkpoint())?;
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
        Ok(guard)
    }

    /// Where the state of a render is kept while it lasts.
    pub fn checkpoint(&self) -> PathBuf {
        let mut name = self.image.clone().into_os_string();
        name.push(".checkpoint");
        name.into()
    }
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
