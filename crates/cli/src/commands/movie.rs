//! `etalon movie`: frames become a file that plays.

use super::convert::{of_colour, read};
use super::{fail, note};
use crate::args::MovieArgs;
use crate::frames::{FrameRange, lacking, numbered};
use etalon_images::animated_png::{AnimationFormat, write_animated_png};
use etalon_images::png;
use etalon_render::write_guard::{Destination, WriteGuard};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

/// Writes the film.
pub fn run(args: &MovieArgs) -> ExitCode {
    match movie(args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => fail(message),
    }
}

/// A frame in eight-bit sRGB.
struct Frame {
    bytes: Vec<u8>,
    size: [usize; 2],
    alpha: bool,
}

fn movie(args: &MovieArgs) -> Result<(), String> {
    let development = args.shown.development()?;
    let format = format(&args.output)?;
    let files = &frames(args)?;
    let output = &WriteGuard::of(files).claim(&args.output)?;
    let load = |path: &Path| -> Result<Frame, String> {
        let (image, _, _) = read(path)?;
        let colour = image.needed_colour(path).map_err(|e| e.to_string())?;
        let image = of_colour(&image, &colour);
        let developed = png::develop(&image, development);
        let (bytes, _) = developed.ok_or("an image without colour")?;
        Ok(Frame {
            bytes,
            size: [image.width(), image.height()],
            alpha: image.channel("A").is_some(),
        })
    };
    let first = load(&files[0])?;
    let conforming = |index: usize| -> Result<Frame, String> {
        let path = &files[index];
        let frame = load(path)?;
        if frame.size != first.size || frame.alpha != first.alpha {
            let words = |frame: &Frame| {
                let [width, height] = frame.size;
                let alpha = if frame.alpha { " with alpha" } else { "" };
                format!("{width} × {height}{alpha}")
            };
            return Err(format!(
                "{} is {}, and the first frame is {}: all frames of a film are alike",
                path.display(),
                words(&frame),
                words(&first)
            ));
        }
        Ok(frame)
    };
    let film = Film {
        output,
        rate: args.fps,
        frames: files.len(),
        first: &first,
    };
    match format {
        Format::Animated => film.animated(conforming)?,
        Format::ByFfmpeg => film.by_ffmpeg(conforming)?,
    }
    note(format!(
        "{}: {} frames, {:.2} s",
        args.output.display(),
        files.len(),
        files.len() as f64 / args.fps
    ));
    Ok(())
}

/// Who writes a film.
enum Format {
    Animated,
    ByFfmpeg,
}

/// What ffmpeg is asked for: it would take other names, too, and put a single frame in a picture.
const BY_FFMPEG: [&str; 7] = ["mp4", "m4v", "mov", "webm", "mkv", "avi", "gif"];

fn format(output: &Path) -> Result<Format, String> {
    let extension = output.extension().unwrap_or_default();
    match extension.to_string_lossy().to_lowercase().as_str() {
        "png" | "apng" => Ok(Format::Animated),
        extension if BY_FFMPEG.contains(&extension) => Ok(Format::ByFfmpeg),
        _ => Err(format!(
            "cannot write {}: a film's name must end in .png, .apng or, by ffmpeg, .{}",
            output.display(),
            BY_FFMPEG.join(", .")
        )),
    }
}

/// The files that a film is made of, each of which is there.
fn frames(args: &MovieArgs) -> Result<Vec<PathBuf>, String> {
    let files = match (args.frames, args.files.as_slice()) {
        (None, files) => {
            if let Some(missing) = lacking(files) {
                return Err(format!(
                    "{} is missing between the frames that were named",
                    missing.display()
                ));
            }
            files.to_vec()
        }
        (Some(FrameRange { first, last }), [pattern]) => (first..=last)
            .map(|number| numbered(pattern, number))
            .collect(),
        (Some(_), _) => {
            return Err(
                "`--frames` goes with one name for all frames, such as walk.####.exr".to_owned(),
            );
        }
    };
    let missing: Vec<&PathBuf> = files.iter().filter(|file| !file.exists()).collect();
    match missing.as_slice() {
        [] => Ok(files),
        [only] => Err(format!("the frame {} is missing", only.display())),
        [first, .., last] => Err(format!(
            "of {} frames {} are missing, from {} to {}",
            files.len(),
            missing.len(),
            first.display(),
            last.display()
        )),
    }
}

/// A film to be written.
struct Film<'a> {
    output: &'a Destination,
    rate: f64,
    frames: usize,
    first: &'a Frame,
}

impl Film<'_> {
    /// Writes an animated PNG.
    fn animated(&self, frame: impl Fn(usize) -> Result<Frame, String>) -> Result<(), String> {
        let size = self
            .first
            .size
            .map(|n| u32::try_from(n).unwrap_or(u32::MAX));
        let format = AnimationFormat {
            width: size[0],
            height: size[1],
            alpha: self.first.alpha,
            frames: u32::try_from(self.frames).map_err(|e| e.to_string())?,
            rate: self.rate,
        };
        self.output.write_with(|path| {
            write_animated_png(path, format, |number| {
                let frame = frame(number as usize).map_err(std::io::Error::other)?;
                Ok(frame.bytes)
            })
        })
    }

    /// Hands the frames to ffmpeg, which writes beside the output until it is done.
    fn by_ffmpeg(&self, frame: impl Fn(usize) -> Result<Frame, String>) -> Result<(), String> {
        let output = self.output.path();
        // What ffmpeg writes follows from the extension.
        let partial = {
            let extension = output.extension().unwrap_or_default().to_string_lossy();
            let name = format!(".etalon-{}.part.{extension}", std::process::id());
            output.with_file_name(name)
        };
        let first = self.first;
        let [width, height] = first.size;
        let pixels = if first.alpha { "rgba" } else { "rgb24" };
        let mut command = Command::new("ffmpeg");
        command
            .args(["-hide_banner", "-loglevel", "error", "-y", "-f", "rawvideo"])
            .args(["-pixel_format", pixels])
            .args(["-video_size", &format!("{width}x{height}")])
            .args(["-framerate", &self.rate.to_string(), "-i", "-"]);
        if output
            .extension()
            .is_none_or(|extension| extension != "gif")
        {
            // What players agree on, which needs even sizes.
            let even = "pad=ceil(iw/2)*2:ceil(ih/2)*2";
            command.args(["-vf", even, "-pix_fmt", "yuv420p"]);
        }
        let mut child = command
            .arg(&partial)
            .stdin(Stdio::piped())
            .spawn()
            .map_err(|error| match error.kind() {
                ErrorKind::NotFound => format!(
                    "`ffmpeg` is needed for {} and was not found: install it, or write an animated \
                     picture, such as {}",
                    output.display(),
                    output.with_extension("png").display()
                ),
                _ => format!("`ffmpeg` cannot be started: {error}"),
            })?;
        let mut send = || {
            let mut pipe = child.stdin.take().ok_or("`ffmpeg` takes no frames")?;
            for index in 0..self.frames {
                let bytes = frame(index)?.bytes;
                pipe.write_all(&bytes)
                    .map_err(|error| format!("`ffmpeg` ended early: {error}"))?;
            }
            Ok::<_, String>(())
        };
        let sent = send();
        let ended = child.wait().map_err(|error| error.to_string());
        let delivered = match (sent, ended) {
            (Ok(()), Ok(status)) if status.success() => self
                .output
                .write_with(|path| std::fs::rename(&partial, path)),
            (Ok(()), Ok(status)) => Err(format!("`ffmpeg` ended with {status}")),
            (Err(message), _) | (_, Err(message)) => Err(message),
        };
        if delivered.is_err() {
            // There may be nothing to remove.
            let _ = std::fs::remove_file(&partial);
        }
        delivered
    }
}
