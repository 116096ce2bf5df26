//! A picture to be rendered.

use crate::driver::PictureFormat;
use crate::mode::Mode;
use crate::scene_format;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A picture to be rendered: a question in a pose, with a seed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Job {
    /// The question's name.
    pub question: String,
    /// The number of the pose.
    pub pose: u32,
    /// Samples per pixel.
    pub samples: u32,
    /// The seed of the program.
    pub seed: u32,
    /// Whether the picture is there already, and is rendered once more.
    pub again: bool,
    /// The format of the picture.
    pub picture: PictureFormat,
}

impl Job {
    /// Any job.
    pub(crate) fn example() -> Self {
        Self {
            question: "wall".to_owned(),
            pose: 0,
            samples: 1,
            seed: 1,
            again: false,
            picture: PictureFormat::default(),
        }
    }

    /// Name of its scene's files, without their ending.
    pub fn scene_name(&self) -> String {
        Self::scene_of(&self.question, self.pose)
    }

    /// Name of the files of a question in a pose, without their ending.
    pub(crate) fn scene_of(question: &str, pose: u32) -> String {
        format!("{question}-pose{pose}")
    }

    /// Its picture within a folder.
    pub fn picture(&self, folder: &Path) -> PathBuf {
        let (samples, seed) = (self.samples, self.seed);
        let ending = self.picture.ending();
        let again = if self.again { "-again" } else { "" };
        let name = format!(
            "{}-n{samples}-seed{seed}{again}.{ending}",
            self.scene_name()
        );
        folder.join("pictures").join(name)
    }

    /// What stands in braces in a driver's command.
    pub(crate) fn values(
        &self,
        folder: &Path,
        threads: u32,
        mode: Mode,
    ) -> BTreeMap<&'static str, String> {
        let path = |path: PathBuf| path.display().to_string();
        let scene = |ending: &str| {
            let file = format!("{}.{ending}", self.scene_name());
            path(folder.join("scenes").join(file))
        };
        let formats = scene_format::ALL.map(|format| (format.ending, scene(format.ending)));
        let mut values = BTreeMap::from([
            ("scene", scene("json")),
            ("samples", self.samples.to_string()),
            ("seed", self.seed.to_string()),
            ("threads", threads.to_string()),
            ("mode", mode.name().to_owned()),
            ("out", path(self.picture(folder))),
        ]);
        values.extend(formats);
        values
    }
}
