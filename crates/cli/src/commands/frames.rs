//! `etalon render --frames`: one picture after another.

use super::{fail, note};
use crate::args::RenderArgs;
use crate::frames::{Frame, FrameRange, numbered};
use crate::interrupt;
use std::path::Path;
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// Renders the frames of a range with `render`, until one fails or the user has had enough.
pub(super) fn run(
    args: &RenderArgs,
    range: FrameRange,
    render: impl Fn(&RenderArgs) -> ExitCode,
) -> ExitCode {
    if args.replay.is_some() && range.count() > 1 {
        return fail("`--replay` is about one frame: name it alone, such as `--frames 7`");
    }
    let start = Instant::now();
    for number in range.first..=range.last {
        let frame = Frame {
            number,
            of: range,
            time: f64::from(number) / args.fps,
        };
        let code = render(&arguments(frame, args));
        if code != ExitCode::SUCCESS || interrupt::asked() {
            return code;
        }
        let done = u64::from(number - range.first) + 1;
        let left = range.count() - done;
        if left > 0 && !args.quiet {
            let each = start.elapsed().as_secs_f64() / done as f64;
            note(format!(
                "frame {done} of {} done, about {} left",
                range.count(),
                indicatif::HumanDuration(Duration::from_secs_f64(each * left as f64))
            ));
        }
    }
    ExitCode::SUCCESS
}

/// The arguments that render a frame alone.
fn arguments(frame: Frame, args: &RenderArgs) -> RenderArgs {
    let numbered = |path: &Path| numbered(path, frame.number);
    RenderArgs {
        output: Some(match &args.output {
            Some(output) => numbered(output),
            None => {
                let stem = args.scene.file_stem().unwrap_or("image".as_ref());
                numbered(Path::new(stem).with_extension("exr").as_path())
            }
        }),
        stats: args.stats.as_deref().map(numbered),
        frame: Some(frame),
        ..args.clone()
    }
}
