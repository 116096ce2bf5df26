//! `etalon movie`: frames become a file that plays.

use super::convert::{of_colour, read};
use super::{fail, note};
use crate::args::MovieArgs;
use crate::outputs::check_place;
use etalon_images::animated_png::{self, AnimationFormat};
use etalon_images::png;
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
    if !args.exposure.is_finite() {
        return Err("--exposure must be a finite number of stops".to_owned());
    }
    check_place(&args.output)?;
    let load = |path: &Path| -> Result<Frame, String> {
        let (image, _, _) = read(path)?;
        let colour = image.needed_colour(path).map_err(|e| e.to_string())?;
        let image = of_colour(&image, &colour);
        let developed = png::develop(&image, args.exposure);
        let (bytes, _) = developed.ok_or("an image without colour")?;
        Ok(Frame {
            bytes,
            size: [image.width(), image.height()],
            alpha: image.channel("A").is_some(),
        })
    };
    let first = load(&args.frames[0])?;
    let conforming = |index: usize| -> Result<Frame, String> {
        let path = &args.frames[index];
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
    let extension = args.output.extension().unwrap_or_default();
    match extension.to_string_lossy().to_lowercase().as_str() {
        "png" | "apng" => animated(args, &first, conforming)?,
        "" => return Err("the film's name must end in .png, .mp4, .webm, .mkv or .gif".to_owned()),
        _ => by_ffmpeg(args, &first, conforming)?,
    }
    note(format!(
        "{}: {} frames, {:.2} s",
        args.output.display(),
        args.frames.len(),
        args.frames.len() as f64 / args.fps
    ));
    Ok(())
}

/// Writes an animated PNG.
fn animated(
    args: &MovieArgs,
    first: &Frame,
    frame: impl Fn(usize) -> Result<Frame, String>,
) -> Result<(), String> {
    let size = first.size.map(|n| u32::try_from(n).unwrap_or(u32::MAX));
    let format = AnimationFormat {
        width: size[0],
        height: size[1],
        alpha: first.alpha,
        frames: u32::try_from(args.frames.len()).map_err(|e| e.to_string())?,
        rate: args.fps,
    };
    animated_png::write(&args.output, format, |number| {
        let frame = frame(number as usize).map_err(std::io::Error::other)?;
        Ok(frame.bytes)
    })
    .map_err(|error| error.to_string())
}

/// Hands the frames to ffmpeg, which writes beside the output until it is done.
fn by_ffmpeg(
    args: &MovieArgs,
    first: &Frame,
    frame: impl Fn(usize) -> Result<Frame, String>,
) -> Result<(), String> {
    let output = &args.output;
    let partial: PathBuf = {
        let name = output.file_name().unwrap_or_default().to_string_lossy();
        output.with_file_name(format!(".part-{}-{name}", std::process::id()))
    };
    let [width, height] = first.size;
    let pixels = if first.alpha { "rgba" } else { "rgb24" };
    let mut command = Command::new("ffmpeg");
    command
        .args(["-hide_banner", "-loglevel", "error", "-y", "-f", "rawvideo"])
        .args(["-pixel_format", pixels])
        .args(["-video_size", &format!("{width}x{height}")])
        .args(["-framerate", &args.fps.to_string(), "-i", "-"]);
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
        for index in 0..args.frames.len() {
            let bytes = frame(index)?.bytes;
            pipe.write_all(&bytes)
                .map_err(|error| format!("`ffmpeg` ended early: {error}"))?;
        }
        Ok::<_, String>(())
    };
    let sent = send();
    let ended = child.wait().map_err(|error| error.to_string());
    let delivered = match (sent, ended) {
        (Ok(()), Ok(status)) if status.success() => {
            std::fs::rename(&partial, output).map_err(|e| e.to_string())
        }
        (Ok(()), Ok(status)) => Err(format!("`ffmpeg` ended with {status}")),
        (Err(message), _) | (_, Err(message)) => Err(message),
    };
    if delivered.is_err() {
        // There may be nothing to remove.
        let _ = std::fs::remove_file(&partial);
    }
    delivered
}
