//! Signals: Ctrl-C and its like stop a render soon and keep what there is; a killed render leaves no image.
#![cfg(target_os = "linux")]

use crate::workshop::{Workshop, cornell_box};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// The longest that a render may take to end once it is told to: a few times what it is meant to, as this
/// machine may be busy. A replicate of [`long_render`] takes hours.
const SOON: Duration = Duration::from_secs(6);

const SMALL: [&str; 4] = ["-D", "resx=16", "-D", "resy=16"];

/// A render in the background.
fn begin(workshop: &Workshop, further: &[&str]) -> Child {
    let scene = cornell_box();
    workshop
        .command()
        .args(["render", &scene, "-o", "a.exr"])
        .args(further)
        .stderr(Stdio::piped())
        .spawn()
        .expect("it runs")
}

/// A render that would take very long, in so many replicates.
fn long_render(workshop: &Workshop, further: &[&str]) -> Child {
    let long = ["--spp", "16777216", "--replicates"];
    begin(workshop, &[&SMALL[..], &long, further].concat())
}

/// A render of many short replicates.
fn short_replicates(workshop: &Workshop, further: &[&str]) -> Child {
    let short = ["--spp", "262144", "--replicates", "4096"];
    begin(workshop, &[&SMALL[..], &short, further].concat())
}

/// Renders to the end.
#[track_caller]
fn whole(workshop: &Workshop, output: &str, further: &[&str]) -> String {
    let scene = cornell_box();
    let arguments = [&["render", &scene, "-o", output][..], &SMALL, further].concat();
    workshop.run(&arguments).fine().stderr
}

/// Tells a render to stop; gives what it said. It must be quick.
#[track_caller]
fn stop(mut child: Child, signal: &str) -> String {
    wait_until_it_listens(&child);
    wait_until_it_renders(&child);
    let start = Instant::now();
    send(signal, &child);
    while child.try_wait().expect("it is a child").is_none() {
        if start.elapsed() > SOON {
            // Under `nohup`, for one, -HUP is ignored.
            let _ = child.kill();
            panic!("{signal} did not end it within {SOON:?}");
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    let output = child.wait_with_output().expect("it has ended");
    assert_eq!(output.status.code(), Some(130));
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn wait_until(what: &str, done: impl Fn() -> bool) {
    let start = Instant::now();
    while !done() {
        assert!(start.elapsed() < Duration::from_secs(30), "{what}");
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Waits until the process listens to SIGINT.
fn wait_until_it_listens(child: &Child) {
    let listens = || {
        let status = std::fs::read_to_string(format!("/proc/{}/status", child.id()));
        let status = status.unwrap_or_default();
        let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:"));
        let mask = caught.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
        mask.is_some_and(|mask| mask & 0b10 != 0)
    };
    wait_until("it listens to SIGINT", listens);
}

/// Waits until the process has used so much time of the processor that it must be rendering.
fn wait_until_it_renders(child: &Child) {
    let busy = || {
        let stat = std::fs::read_to_string(format!("/proc/{}/stat", child.id()));
        let stat = stat.unwrap_or_default();
        let ticks: Option<u64> = stat.split(' ').nth(13).and_then(|t| t.parse().ok());
        ticks.is_some_and(|ticks| ticks >= 50)
    };
    wait_until("it renders", busy);
}

fn send(signal: &str, child: &Child) {
    let id = child.id().to_string();
    let status = Command::new("kill").args([signal, &id]).status();
    assert!(status.expect("kill runs").success());
}

fn end(mut child: Child) -> ExitStatus {
    child.wait().expect("it ends")
}

#[test]
fn ctrl_c_writes_the_finished_replicates() {
    let workshop = Workshop::new();
    let said = stop(short_replicates(&workshop, &[]), "-INT");
    assert!(said.contains("a.exr: stopped after "), "{said}");
    assert_eq!(workshop.files(), ["a.exr"]);
    let image = workshop.image("a.exr");
    let metadata = image.metadata.expect("metadata");
    assert!((1..4096).contains(&metadata.replicates));
    assert_eq!(metadata.spp, 64 * u64::from(metadata.replicates));
    assert_eq!(metadata.unfinished, None);
    let green = image.image.channel("G").expect("G");
    assert!(green.iter().all(|v| v.is_finite()) && green.iter().any(|v| *v > 0.0));
}

/// Nobody waits for a replicate: what there is of the first makes a picture without standard errors. Mutants: sums
/// over the samples that there were to be; statistics of one replicate.
#[test]
fn within_the_first_replicate_there_is_a_picture_of_what_there_is() {
    let workshop = Workshop::new();
    whole(&workshop, "whole.exr", &["--spp", "256"]);
    let expected = workshop.image("whole.exr");
    let mean = |image: &etalon_film::RenderedImage| {
        let green = image.image.channel("G").expect("G");
        green.iter().map(|v| f64::from(*v)).sum::<f64>() / green.len() as f64
    };
    for (signal, further) in [
        ("-INT", &["1"][..]),
        ("-TERM", &["2", "--threads", "1"]),
        ("-HUP", &["8", "--integrator", "bdpt"]),
    ] {
        let said = stop(long_render(&workshop, further), signal);
        assert!(said.contains("warning: stopped within the first"), "{said}");
        assert!(said.contains("without standard errors"), "{said}");
        assert_eq!(workshop.files(), ["a.exr", "whole.exr"]);
        let image = workshop.image("a.exr");
        assert!(image.standard_error("G").is_none());
        assert!(
            (mean(&image) / mean(&expected) - 1.0).abs() < 0.1,
            "{further:?}"
        );
        let metadata = image.metadata.expect("metadata");
        let begun = metadata.unfinished.expect("it says so");
        assert_eq!((metadata.replicates, begun.without), (0, 0));
        assert!(begun.least > 0 && begun.most < begun.samples_per_replicate);
        assert_eq!(metadata.spp, begun.mean as u64);
        let judged = workshop.run(&["compare", "a.exr", "whole.exr"]);
        assert_eq!(judged.code, Some(3), "{}", judged.stdout);
        assert!(judged.stdout.contains("interrupted"), "{}", judged.stdout);
        let told = workshop.run(&["info", "a.exr"]).fine().stdout;
        assert!(told.contains("interrupted  the picture is of"), "{told}");
    }
}

/// Whatever takes long is told: bootstraps, training, photons, pilots.
#[test]
fn preparations_stop_as_well() {
    let workshop = Workshop::new();
    let integrator = |name: &str, more: &str| {
        crate::workshop::small_scene(&format!("<integrator type=\"{name}\">{more}</integrator>"))
    };
    workshop.write("guided.xml", integrator("guided", ""));
    let photons = "<integer name=\"photons\" value=\"67108864\"/>";
    workshop.write("photonmap.xml", integrator("photonmap", photons));
    workshop.write("vcm.xml", integrator("vcm", photons));
    let bootstrap = "<integer name=\"bootstrap_samples\" value=\"16777216\"/>\
                     <integer name=\"max_depth\" value=\"6\"/>";
    workshop.write("mmlt.xml", integrator("mmlt", bootstrap));
    workshop.write("path.xml", integrator("path", ""));
    let pilot = ["--error", "0.01", "--pilot", "1048576"];
    for (scene, further) in [
        ("guided.xml", &["--spp", "4194304"][..]),
        ("photonmap.xml", &[]),
        ("vcm.xml", &[]),
        ("mmlt.xml", &["--spp", "65536"]),
        ("path.xml", &pilot),
        (
            "path.xml",
            &["--time", "1000", "--adaptive", "--pilot", "1048576"],
        ),
    ] {
        let mut command = workshop.command();
        command.args(["render", scene, "-o", "a.exr", "--resume"]);
        let child = command.args(further).stderr(Stdio::piped()).spawn();
        let said = stop(child.expect("it runs"), "-TERM");
        assert!(said.contains("without an image"), "{scene}: {said}");
        assert!(!said.contains("panicked"), "{scene}: {said}");
        let files = workshop.files();
        assert!(files.iter().all(|name| name.ends_with(".xml")), "{files:?}");
    }
}

/// Interrupted again and again, within replicates and between them, on other numbers of threads: the same file in
/// the end. Mutant: the replicate that is begun is left out of the checkpoint.
#[test]
fn an_interrupted_render_goes_on_to_the_same_bits() {
    let all: [&[&str]; 4] = [
        &["--spp", "8192", "--replicates", "1"],
        &["--spp", "8192", "--replicates", "3"],
        &[
            "--spp",
            "4096",
            "--replicates",
            "2",
            "--integrator",
            "ptracer",
        ],
        &["--spp", "1024", "--replicates", "2", "--integrator", "vcm"],
    ];
    for further in all {
        let workshop = Workshop::new();
        whole(&workshop, "whole.exr", further);
        let mut resumed = false;
        for threads in ["2", "1", "3"] {
            let resume = ["--resume", "--threads", threads];
            let asked = [&SMALL[..], further, &resume].concat();
            let mut child = begin(&workshop, &asked);
            wait_until_it_listens(&child);
            wait_until_it_renders(&child);
            // A busy machine may have been quick.
            if child.try_wait().expect("a child").is_some() {
                break;
            }
            send("-INT", &child);
            let output = child.wait_with_output().expect("it ends");
            if output.status.code() != Some(130) {
                break;
            }
            resumed |= workshop.path("a.exr.checkpoint").exists();
        }
        assert!(resumed, "{further:?}: it was never interrupted");
        let said = whole(&workshop, "a.exr", &[further, &["--resume"]].concat());
        assert!(!said.contains("stopped"), "{said}");
        assert!(
            workshop.read("a.exr") == workshop.read("whole.exr"),
            "{further:?}"
        );
        assert_eq!(workshop.files(), ["a.exr", "whole.exr"]);
    }
}

/// `nohup` and its like are respected.
#[test]
fn a_hangup_that_is_ignored_stays_ignored() {
    let workshop = Workshop::new();
    let scene = cornell_box();
    let program = env!("CARGO_BIN_EXE_etalon");
    let line = format!(
        "trap '' HUP; exec '{program}' render '{scene}' -o a.exr -D resx=16 -D resy=16 --spp 16777216"
    );
    let mut command = Command::new("sh");
    let child = command.args(["-c", &line]).current_dir(workshop.path(""));
    let mut child = child.stderr(Stdio::piped()).spawn().expect("it runs");
    wait_until_it_listens(&child);
    send("-HUP", &child);
    wait_until_it_renders(&child);
    assert!(child.try_wait().expect("a child").is_none());
    stop(child, "-INT");
}

#[test]
fn a_part_that_ctrl_c_ended_says_what_it_has() {
    let workshop = Workshop::new();
    let child = short_replicates(&workshop, &["--part", "2/2"]);
    wait_until_it_listens(&child);
    wait_until_it_renders(&child);
    send("-INT", &child);
    assert_eq!(end(child).code(), Some(130));
    let metadata = workshop.image("a.exr").metadata.expect("metadata");
    let part = metadata.part.expect("it is a part");
    assert_eq!(part.replicates.iter().next(), Some(2048));
    assert_eq!(part.replicates.count(), metadata.replicates);
    let said = workshop.run(&["merge", "a.exr", "-o", "m.exr"]).refused();
    let missing = format!("missing: 0 to 2047, {} to 4095", part.replicates.end());
    assert!(said.stderr.contains(&missing), "{}", said.stderr);
    assert_eq!(workshop.files(), ["a.exr"]);
}

#[test]
fn a_part_without_a_finished_replicate_is_no_part() {
    let workshop = Workshop::new();
    let said = stop(long_render(&workshop, &["2", "--part", "1/2"]), "-TERM");
    assert!(
        said.contains("is no part that `etalon merge` takes"),
        "{said}"
    );
    let said = workshop.run(&["merge", "a.exr", "-o", "m.exr"]).refused();
    assert!(said.stderr.contains("not a part"), "{}", said.stderr);
}

/// Both arrive before anything could be finished. On a busy machine the first may get as far as an image before the second is
/// heard, but not three times; a second signal that is not heard at all leaves one every time.
#[test]
fn a_second_signal_ends_the_process_at_once() {
    let at_once = |_| {
        let workshop = Workshop::new();
        let child = long_render(&workshop, &["1"]);
        wait_until_it_listens(&child);
        wait_until_it_renders(&child);
        for signal in ["-STOP", "-INT", "-TERM", "-CONT"] {
            send(signal, &child);
        }
        assert_eq!(end(child).code(), Some(130));
        workshop.files().is_empty()
    };
    assert!((0..3).any(at_once));
}

#[test]
fn a_killed_render_leaves_no_image() {
    let workshop = Workshop::new();
    let child = long_render(&workshop, &["4096"]);
    wait_until_it_renders(&child);
    send("-KILL", &child);
    assert_eq!(end(child).code(), None);
    assert!(workshop.files().is_empty());
}
