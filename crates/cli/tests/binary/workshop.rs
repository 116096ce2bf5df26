//! A temporary folder in which the binary is run.

use etalon_film::{RenderedImage, read_developed};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;
use tempfile::TempDir;

/// Longer than any run here takes on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// A scene of the project, as seen from this crate.
pub(crate) fn scene(name: &str) -> String {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    scenes.join(name).join("scene.xml").display().to_string()
}

/// The Cornell box.
pub(crate) fn cornell_box() -> String {
    scene("cornell-box")
}

/// A scene with an integrator of one's choice: a lit floor and a sphere, 20 × 12 pixels.
pub(crate) fn small_scene(integrator: &str) -> String {
    format!(
        "<scene version=\"3.0.0\">
    {integrator}
    <sensor type=\"perspective\">
        <transform name=\"to_world\"><lookat origin=\"0, 1, 4\" target=\"0, 0.5, 0\" up=\"0, 1, 0\"/></transform>
        <film type=\"hdrfilm\">
            <integer name=\"width\" value=\"20\"/><integer name=\"height\" value=\"12\"/>
        </film>
        <sampler type=\"independent\"><integer name=\"sample_count\" value=\"16\"/></sampler>
    </sensor>
    <shape type=\"rectangle\"><transform name=\"to_world\"><rotate x=\"1\" angle=\"-90\"/><scale value=\"2\"/></transform></shape>
    <shape type=\"sphere\"><point name=\"center\" value=\"0, 0.5, 0\"/><float name=\"radius\" value=\"0.5\"/></shape>
    <emitter type=\"constant\"/>
</scene>
"
    )
}

/// A ball with these children, seen through its middle by `volpath`, in luminance: 8 × 8 pixels of 256 samples.
pub(crate) fn ball_scene(ball: &str, further: &str) -> String {
    format!(
        "<scene version=\"3.0.0\">
    <integrator type=\"volpath\"><integer name=\"max_depth\" value=\"-1\"/></integrator>
    <sensor type=\"perspective\">
        <float name=\"fov\" value=\"0.5\"/>
        <transform name=\"to_world\"><lookat origin=\"0, -4, 0\" target=\"0, 0, 0\" up=\"0, 0, 1\"/></transform>
        <film type=\"hdrfilm\">
            <integer name=\"width\" value=\"8\"/><integer name=\"height\" value=\"8\"/><rfilter type=\"box\"/>
            <string name=\"pixel_format\" value=\"luminance\"/>
        </film>
        <sampler type=\"independent\"><integer name=\"sample_count\" value=\"256\"/></sampler>
    </sensor>{further}
    <shape type=\"sphere\">{ball}</shape>
</scene>"
    )
}

/// The mean of a channel over a picture whose pixels are independent, and its standard error.
#[track_caller]
pub(crate) fn mean_of(image: &RenderedImage, channel: &str) -> (f64, f64) {
    let plane = image.image.channel(channel).expect("the channel");
    let errors = image.standard_error(channel).expect("its standard errors");
    let count = plane.len() as f64;
    let mean = plane.iter().map(|&x| f64::from(x)).sum::<f64>() / count;
    let variance: f64 = errors.iter().map(|&s| f64::from(s).powi(2)).sum();
    (mean, variance.sqrt() / count)
}

/// The mean luminance of a picture, and its standard error.
#[track_caller]
pub(crate) fn luminance(image: &RenderedImage) -> (f64, f64) {
    mean_of(image, "Y")
}

/// What a run said.
#[derive(Debug)]
pub(crate) struct Ran {
    /// The exit code; `None` if a signal ended it.
    pub(crate) code: Option<i32>,
    /// Standard output.
    pub(crate) stdout: String,
    /// Standard error.
    pub(crate) stderr: String,
}

impl Ran {
    /// The same, if all went well.
    #[track_caller]
    pub(crate) fn fine(self) -> Self {
        assert_eq!(self.code, Some(0), "{}", self.stderr);
        self
    }

    /// The same, if it was refused with code 2, and politely.
    #[track_caller]
    pub(crate) fn refused(self) -> Self {
        assert_eq!(self.code, Some(2), "{}{}", self.stdout, self.stderr);
        assert!(!self.stderr.contains("panicked"), "{}", self.stderr);
        self
    }
}

/// A folder that goes away.
pub(crate) struct Workshop(TempDir);

impl Workshop {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    /// The path of a file in it.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Writes a file.
    pub(crate) fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), bytes).expect("written");
    }

    /// Reads a file.
    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).expect("the file is there")
    }

    /// Reads an image with its metadata.
    pub(crate) fn image(&self, name: &str) -> RenderedImage {
        read_developed(&self.path(name)).expect("a valid image")
    }

    /// All files, hidden ones too, sorted.
    pub(crate) fn files(&self) -> Vec<String> {
        let mut names: Vec<String> = std::fs::read_dir(self.0.path())
            .expect("the folder is there")
            .map(|entry| entry.expect("readable").file_name().display().to_string())
            .collect();
        names.sort();
        names
    }

    /// The binary, in this folder, with reproducible output.
    pub(crate) fn command(&self) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_etalon"));
        command
            .current_dir(self.0.path())
            .env("SOURCE_DATE_EPOCH", "0");
        command
    }

    /// Runs the binary in this folder.
    pub(crate) fn run(&self, arguments: &[&str]) -> Ran {
        let mut command = assert_cmd::Command::from_std(self.command());
        let output = command
            .args(arguments)
            .timeout(PATIENCE)
            .output()
            .expect("it runs");
        Ran {
            code: output.status.code(),
            stdout: String::from_utf8(output.stdout).expect("UTF-8"),
            stderr: String::from_utf8(output.stderr).expect("UTF-8"),
        }
    }

    /// Renders the Cornell box, 24 × 20 pixels unless the further arguments say otherwise.
    #[track_caller]
    pub(crate) fn render(&self, output: &str, further: &[&str]) -> Ran {
        let scene = cornell_box();
        let mut arguments = vec!["render", &scene, "-o", output];
        arguments.extend(["-D", "resx=24", "-D", "resy=20"]);
        arguments.extend(further);
        self.run(&arguments).fine()
    }
}
