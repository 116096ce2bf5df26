//! How another program is asked to render: a TOML file, with a script beside it or not.
//!
//! ```toml
//! name = "mine"
//! title = "My renderer"
//! version = ["my-renderer", "--version"]
//! command = ["my-renderer", "{xml}", "--spp", "{samples}", "--seed", "{seed}", "-o", "{out}"]
//! ```
//!
//! `command` is run for every picture. In its words stand `{scene}` (a neutral scene, JSON), `{xml}` (the same for readers of
//! Mitsuba's format), `{pbrt}` (for readers of pbrt's), `{samples}`, `{seed}`, `{threads}`, `{mode}` (`measure` or `shipped`), `{out}` (an EXR of linear
//! float32, the top row first, or with `picture = "pfm"` a portable float map), `{driver}` (the script `script` beside the TOML), `{python}` and `{etalon}`. Exit code 3 says
//! that the program cannot express the scene, with the reason as the last line on standard error.
//!
//! With `batch = true` the command runs once and reads jobs, one JSON object a line with these names, from its standard input.
//! For each it answers a line: `{"out": …}`, `{"unsupported": "why"}` or `{"error": "what"}`.

use crate::job::Job;
use crate::mode::Mode;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// What a TOML file says of a program.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Description {
    /// Its name, for files and reports.
    pub name: String,
    /// Its name in full.
    pub title: String,
    /// The command that prints its version.
    pub version: Vec<String>,
    /// The command that renders.
    pub command: Vec<String>,
    /// The script that stands for `{driver}`, beside the TOML file.
    pub script: Option<String>,
    /// Further files that the script needs beside it.
    #[serde(default)]
    pub files: Vec<String>,
    /// What has to be installed, in words.
    #[serde(default)]
    pub needs: Option<String>,
    /// Whether the command reads jobs from its standard input.
    #[serde(default)]
    pub batch: bool,
    /// What its pictures are: `exr` or `pfm`.
    #[serde(default)]
    pub picture: PictureFormat,
    /// Whether pictures depend on a seed; if not, every replicate is another pose.
    #[serde(default = "yes")]
    pub seed: bool,
    /// Whether the program looks for lights with an extent. One that finds them by chance alone may miss small ones in every picture
    /// and still be right in the mean; it is not called too dark for that.
    #[serde(default = "yes")]
    pub samples_lights: bool,
    /// What one has to know: units, factors with their reasons.
    #[serde(default)]
    pub conventions: BTreeMap<String, serde_json::Value>,
}

/// The format of pictures, by the ending of their names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PictureFormat {
    /// OpenEXR.
    #[default]
    Exr,
    /// Portable float map, which ten lines write.
    Pfm,
}

impl PictureFormat {
    /// The ending.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Exr => "exr",
            Self::Pfm => "pfm",
        }
    }
}

fn yes() -> bool {
    true
}

/// A program that can be asked.
#[derive(Clone, Debug)]
pub struct Driver {
    /// What its TOML says.
    pub description: Description,
    /// The words that stand for `{driver}`, `{python}` and `{etalon}`.
    words: BTreeMap<&'static str, String>,
}

/// Programs of this machine that drivers may run.
#[derive(Clone, Debug)]
pub struct Programs {
    /// Runs Python scripts.
    pub python: PathBuf,
    /// This program.
    pub etalon: PathBuf,
}

impl Driver {
    /// Reads a driver from a file, with its script beside it.
    ///
    /// # Errors
    /// One sentence.
    pub fn read(path: &Path, programs: &Programs) -> Result<Self, String> {
        let at = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
        let text = std::fs::read_to_string(path).map_err(|error| at(&error))?;
        let description: Description = toml::from_str(&text).map_err(|error| at(&error))?;
        let folder = path.parent().unwrap_or(Path::new("."));
        let script = description
            .script
            .as_ref()
            .map(|script| folder.join(script));
        if let Some(script) = script.as_ref().filter(|script| !script.is_file()) {
            return Err(at(&format!("there is no script {}", script.display())));
        }
        Self::new(description, script, programs).map_err(|error| at(&error))
    }

    /// One of those that come with Etalon; its files are written into `folder`.
    ///
    /// # Errors
    /// One sentence, with the names of those that there are.
    pub fn named(name: &str, folder: &Path, programs: &Programs) -> Result<Self, String> {
        let Some(built_in) = crate::drivers::ALL
            .iter()
            .find(|driver| driver.name == name)
        else {
            let names: Vec<_> = crate::drivers::ALL
                .iter()
                .map(|driver| driver.name)
                .collect();
            return Err(format!(
                "there is no driver `{name}`: give {}, or the path of a TOML file",
                names.join(", ")
            ));
        };
        let description: Description =
            toml::from_str(built_in.toml).map_err(|error| format!("{name}: {error}"))?;
        for (file, text) in built_in.files {
            let path = folder.join(file);
            let written =
                std::fs::create_dir_all(folder).and_then(|()| std::fs::write(&path, text));
            written.map_err(|error| format!("{}: {error}", path.display()))?;
        }
        let script = description.script.as_ref().map(|file| folder.join(file));
        Self::new(description, script, programs)
    }

    fn new(
        description: Description,
        script: Option<PathBuf>,
        programs: &Programs,
    ) -> Result<Self, String> {
        if description.command.is_empty() {
            return Err("`command` has no words".to_owned());
        }
        let path = |path: &Path| path.display().to_string();
        let mut words = BTreeMap::from([
            ("python", path(&programs.python)),
            ("etalon", path(&programs.etalon)),
        ]);
        if let Some(script) = script {
            let absolute = std::path::absolute(&script).unwrap_or(script);
            words.insert("driver", path(&absolute));
        }
        let driver = Self { description, words };
        // A word that names something that there is not is told before anything is rendered.
        driver.command(&Job::example().values(Path::new(""), 1, Mode::default()))?;
        Ok(driver)
    }

    /// The program's version, as it says itself.
    ///
    /// # Errors
    /// One sentence, if it cannot be run.
    pub fn version(&self) -> Result<String, String> {
        let words = self.filled(&self.description.version, &BTreeMap::new())?;
        let [program, arguments @ ..] = &words[..] else {
            return Err("`version` has no words".to_owned());
        };
        let needs = (self.description.needs.as_ref())
            .map_or_else(String::new, |needs| format!("\n  help: it needs {needs}"));
        let output = Command::new(program)
            .args(arguments)
            .stdin(Stdio::null())
            .output()
            .map_err(|error| format!("{program}: {error}{needs}"))?;
        if !output.status.success() {
            let said = String::from_utf8_lossy(&output.stderr);
            let last = said.trim().lines().last().unwrap_or("it says nothing");
            return Err(format!("`{}` fails: {last}{needs}", words.join(" ")));
        }
        let said = String::from_utf8_lossy(&output.stdout);
        Ok(said.trim().lines().next().unwrap_or_default().to_owned())
    }

    /// The words of the command that renders, with these values in it.
    ///
    /// # Errors
    /// If a word names something that there is not.
    pub(crate) fn command(
        &self,
        values: &BTreeMap<&'static str, String>,
    ) -> Result<Vec<String>, String> {
        self.filled(&self.description.command, values)
    }

    fn filled(
        &self,
        words: &[String],
        values: &BTreeMap<&'static str, String>,
    ) -> Result<Vec<String>, String> {
        words.iter().map(|word| self.fill(word, values)).collect()
    }

    /// A word with what stands in braces replaced.
    fn fill(&self, word: &str, values: &BTreeMap<&'static str, String>) -> Result<String, String> {
        let mut filled = String::new();
        let mut rest = word;
        while let Some((before, after)) = rest.split_once('{') {
            let (name, after) = after
                .split_once('}')
                .ok_or_else(|| format!("`{word}` has a `{{` without a `}}`"))?;
            let value = self.words.get(name).or_else(|| values.get(name));
            let value = value.ok_or_else(|| {
                let names: Vec<_> = self.words.keys().chain(values.keys()).copied().collect();
                format!(
                    "there is no `{{{name}}}` for `{word}`: there are {}",
                    names.join(", ")
                )
            })?;
            filled += before;
            filled += value;
            rest = after;
        }
        Ok(filled + rest)
    }
}
