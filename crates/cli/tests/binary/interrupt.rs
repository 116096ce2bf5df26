//! Signals: Ctrl-C finishes the pass and writes the image; a killed render leaves no image.
#![cfg(target_os = "linux")]

use crate::workshop::{Workshop, cornell_box};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// A render that would take very long.
fn long_render(workshop: &Workshop, further: &[&str]) -> Child {
    let scene = cornell_box();
    workshop
        .command()
        .args([
            "render", &scene, "-o", "a.exr", "-D", "resx=16", "-D", "resy=16",
        ])
        .args(["--spp", "16777216", "--replicates"])
        .args(further)
        .stderr(Stdio::piped())
        .spawn()
        .expect("it runs")
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
fn ctrl_c_finishes_the_pass_and_writes_the_image() {
    let workshop = Workshop::new();
    let child = long_render(&workshop, &["4096"]);
    wait_until_it_listens(&child);
    wait_until_it_renders(&child);
    send("-INT", &child);
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(130));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(said.contains("a.exr: stopped after "), "{said}");
    assert_eq!(workshop.files(), ["a.exr"]);
    let image = workshop.image("a.exr");
    let metadata = image.metadata.expect("metadata");
    assert!((1..4096).contains(&metadata.replicates));
    assert_eq!(metadata.spp, 4096 * u64::from(metadata.replicates));
    let green = image.image.channel("G").expect("G");
    assert!(green.iter().all(|v| v.is_finite()) && green.iter().any(|v| *v > 0.0));
}

#[test]
fn a_part_that_ctrl_c_ended_says_what_it_has() {
    let workshop = Workshop::new();
    let child = long_render(&workshop, &["4096", "--part", "2/2"]);
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
fn a_second_ctrl_c_does_not_wait() {
    let workshop = Workshop::new();
    let child = long_render(&workshop, &["1"]);
    wait_until_it_listens(&child);
    wait_until_it_renders(&child);
    send("-INT", &child);
    std::thread::sleep(Duration::from_millis(100));
    send("-INT", &child);
    assert_eq!(end(child).code(), Some(130));
    assert!(workshop.files().is_empty());
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
