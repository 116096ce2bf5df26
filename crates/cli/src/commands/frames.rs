//! `etalon render --frames`: one picture after another.

use super::{fail, note, render};
use crate::args::RenderArgs;
use crate::frames::{Frame, FrameRange};
use crate::interrupt;
use crate::preview::Onlookers;
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// What stands before the bar of a frame.
pub(super) fn prefix(frame: Frame) -> String {
    let FrameRange { first, .. } = frame.of;
    let place = frame.number - first + 1;
    format!("frame {place} of {}  ", frame.of.count())
}

/// Renders the frames of a range, until one fails or the user has had enough.
pub(super) fn run(args: &RenderArgs, range: FrameRange, onlookers: &Onlookers) -> ExitCode {
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
        let code = render::run_here(&frame.arguments(args), onlookers);
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
