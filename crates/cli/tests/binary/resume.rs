//! `render --resume`: a killed render goes on, and ends as the file that it would have been.

use crate::workshop::{Workshop, cornell_box};
use std::process::Stdio;
use std::time::{Duration, Instant};

const SIZE: [&str; 4] = ["-D", "resx=24", "-D", "resy=20"];

/// Begins to render `a.exr` and kills the process when there is a checkpoint.
#[track_caller]
fn begin_and_kill(workshop: &Workshop, further: &[&str]) {
    let scene = cornell_box();
    let mut child = workshop
        .command()
        .args(["render", &scene, "-q", "-o", "a.exr", "--resume"])
        .args(SIZE)
        .args(further)
        .stderr(Stdio::null())
        .spawn()
        .expect("it runs");
    let start = Instant::now();
    while !workshop.path("a.exr.checkpoint").exists() {
        assert!(start.elapsed() < Duration::from_secs(30), "no checkpoint");
        let ended = child.try_wait().expect("a child");
        assert!(ended.is_none(), "it ended before it could be killed");
        std::thread::sleep(Duration::from_millis(2));
    }
    child.kill().expect("killed");
    child.wait().expect("it ends");
    let files = workshop.files();
    assert!(!files.contains(&"a.exr".to_owned()), "{files:?}");
    // What was being written when it was killed is nobody's any more.
    for name in files.iter().filter(|name| name.starts_with('.')) {
        std::fs::remove_file(workshop.path(name)).expect("removed");
    }
}

/// A killed render that goes on is the render that was never interrupted.
#[track_caller]
fn goes_on(further: &[&str]) {
    let workshop = Workshop::new();
    workshop.render("whole.exr", further);
    begin_and_kill(&workshop, further);
    let ran = workshop.render("a.exr", &[further, &["--resume"]].concat());
    assert!(
        ran.stderr.contains("note: going on after "),
        "{}",
        ran.stderr
    );
    assert!(
        workshop.read("a.exr") == workshop.read("whole.exr"),
        "{further:?}"
    );
    assert_eq!(workshop.files(), ["a.exr", "whole.exr"]);
}

/// Long enough to be killed in the midst of it.
const LONG: [&str; 4] = ["--spp", "1024", "--replicates", "16"];

#[test]
fn a_killed_render_goes_on() {
    goes_on(&LONG);
}

#[test]
fn splats_and_what_was_learned_go_on() {
    for integrator in ["ptracer", "guided"] {
        goes_on(&[&LONG[..], &["--integrator", integrator]].concat());
    }
}

#[test]
fn what_a_pilot_fixed_stays_fixed() {
    goes_on(&["--error", "0.15", "--replicates", "12"]);
    goes_on(&["--error", "0.08", "--replicates", "12", "--adaptive"]);
}

#[test]
fn info_says_how_far_a_checkpoint_got() {
    let workshop = Workshop::new();
    begin_and_kill(&workshop, &LONG);
    let said = (workshop.run(&["info", "a.exr.checkpoint"]).fine()).stdout;
    let metadata = etalon_film::Part::read_metadata(&workshop.path("a.exr.checkpoint"));
    let finished = metadata.expect("a checkpoint").replicates;
    for words in [
        "24 × 20 pixels\n".to_owned(),
        format!(
            "checkpoint   {finished} of 16 replicates are finished; `etalon render --resume` continues"
        ),
    ] {
        assert!(said.contains(&words), "{words:?} in {said}");
    }
    assert!(!said.contains("\npart "), "{said}");
    let json = (workshop.run(&["info", "a.exr.checkpoint", "--json"]).fine()).stdout;
    let facts: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert!(facts["metadata"]["checkpoint"].is_object(), "{json}");
}

#[test]
fn a_time_is_not_counted_anew() {
    let workshop = Workshop::new();
    let further = ["--time", "2", "--replicates", "20"];
    begin_and_kill(&workshop, &further);
    let checkpoint = etalon_film::Part::read_metadata(&workshop.path("a.exr.checkpoint"));
    let metadata = checkpoint.expect("a checkpoint");
    let each = metadata.spp / u64::from(metadata.replicates);
    workshop.render("a.exr", &[&further[..], &["--resume"]].concat());
    let finished = workshop.image("a.exr").metadata.expect("metadata");
    assert_eq!((finished.replicates, finished.spp), (20, 20 * each));
    assert_eq!(workshop.files(), ["a.exr"]);
}

#[test]
fn a_part_goes_on() {
    goes_on(&[&LONG[..], &["--part", "2/2"]].concat());
}

#[test]
fn a_checkpoint_of_something_else_is_refused() {
    let workshop = Workshop::new();
    begin_and_kill(&workshop, &LONG);
    let before = workshop.files();
    let checkpoint = workshop.read("a.exr.checkpoint");
    let refused = |further: &[&str], expected: &str| {
        let scene = cornell_box();
        let arguments = ["render", &scene, "-o", "a.exr", "--resume"];
        let arguments = [&arguments[..], &SIZE, further].concat();
        let said = workshop.run(&arguments).refused().stderr;
        assert!(said.contains(expected), "{further:?}: {said}");
        assert!(said.contains("remove a.exr.checkpoint"), "{said}");
        assert_eq!(workshop.files(), before);
    };
    let and = |further: &[&'static str]| [&LONG[..], further].concat();
    refused(&and(&["--seed", "7"]), "the seed is 0 there, 7 here");
    refused(
        &["--spp", "4096", "--replicates", "16"],
        "samples per replicate is 64 there, 256 here",
    );
    refused(
        &["--spp", "1024", "--replicates", "32"],
        "replicates of the whole is 16 there, 32 here",
    );
    refused(
        &and(&["--integrator", "direct"]),
        "the integrator is `path`",
    );
    refused(
        &and(&["--independent-replicates"]),
        "the kind of replicates is blocks there, independent here",
    );
    refused(&and(&["-D", "resx=23"]), "the scene's hash");
    refused(
        &and(&["--adaptive"]),
        "is (nothing) there, `--adaptive` here",
    );
    refused(&["--error", "0.1"], "`--error 0.1` here");
    // A damaged one, an image, and something else entirely.
    let mut damaged = checkpoint.clone();
    let middle = damaged.len() / 2;
    damaged[middle..middle + 40].fill(0x55);
    workshop.write("a.exr.checkpoint", &damaged);
    refused(&LONG, "a.exr.checkpoint");
    workshop.write("a.exr.checkpoint", "nothing");
    refused(&LONG, "a.exr.checkpoint");
    workshop.render("a.exr.exr", &["--spp", "8", "--part", "1/2"]);
    std::fs::rename(
        workshop.path("a.exr.exr"),
        workshop.path("a.exr.checkpoint"),
    )
    .expect("renamed");
    refused(&["--spp", "8"], "a.exr.checkpoint is no checkpoint");
    // Nobody is made to go on.
    workshop.write("a.exr.checkpoint", &checkpoint);
    workshop.render("a.exr", &["--spp", "8"]);
    assert!(workshop.read("a.exr.checkpoint") == checkpoint);
}

#[test]
fn nothing_is_left_of_a_render_that_was_not_interrupted() {
    let workshop = Workshop::new();
    workshop.render("plain.exr", &["--spp", "64"]);
    workshop.render("kept.exr", &["--spp", "64", "--resume"]);
    assert!(workshop.read("plain.exr") == workshop.read("kept.exr"));
    assert_eq!(workshop.files(), ["kept.exr", "plain.exr"]);
}

/// A part that is finished is verified and left alone; one of another render, or a damaged one, is refused and stays as it is.
#[test]
fn a_finished_part_is_verified_and_left_alone() {
    let workshop = Workshop::new();
    let part = ["--spp", "64", "--part", "2/4", "--resume"];
    workshop.render("b.exr", &part);
    let before = workshop.read("b.exr");
    let ran = workshop.render("b.exr", &part);
    assert!(ran.stderr.contains("is there already"), "{}", ran.stderr);
    assert!(workshop.read("b.exr") == before);
    let scene = cornell_box();
    let again = |further: &[&str]| {
        let all = [
            &["render", &scene, "-o", "b.exr"],
            &SIZE[..],
            &part,
            further,
        ]
        .concat();
        workshop.run(&all)
    };
    let other = again(&["--seed", "5"]);
    assert_eq!(other.code, Some(2));
    assert!(
        other.stderr.contains("the seed is 0 there, 5 here"),
        "{}",
        other.stderr
    );
    let damaged = &before[..before.len() - 100];
    workshop.write("b.exr", damaged);
    assert_eq!(again(&[]).code, Some(2));
    assert!(workshop.read("b.exr") == damaged);
}

/// A folder of parts is merged to the bits of one render, and one that is missing, damaged, another scene's or there twice is named.
#[test]
fn a_folder_of_parts_is_merged() {
    let workshop = Workshop::new();
    workshop.render("whole.exr", &["--spp", "64"]);
    std::fs::create_dir(workshop.path("parts")).expect("a folder");
    for i in 1..=4 {
        let (name, part) = (format!("parts/{i}.exr"), format!("{i}/4"));
        workshop.render(&name, &["--spp", "64", "--part", &part]);
    }
    workshop.run(&["merge", "parts", "-o", "merged.exr"]).fine();
    assert!(workshop.read("merged.exr") == workshop.read("whole.exr"));
    let third = workshop.read("parts/3.exr");
    workshop.write("parts/3.exr", &third[..third.len() - 50]);
    let ran = workshop.run(&["merge", "parts", "-o", "again.exr"]);
    assert!(
        ran.code == Some(2) && ran.stderr.contains("3.exr"),
        "{}",
        ran.stderr
    );
    // In its place: the same part of another scene, and one that is there already.
    let other = ["--spp", "64", "--part", "3/4", "-D", "max_depth=3"];
    workshop.render("parts/3.exr", &other);
    let ran = workshop.run(&["merge", "parts", "-o", "again.exr"]);
    assert!(
        ran.code == Some(2) && ran.stderr.contains("scene"),
        "{}",
        ran.stderr
    );
    let second = workshop.read("parts/2.exr");
    workshop.write("parts/3.exr", &second);
    let ran = workshop.run(&["merge", "parts", "-o", "again.exr"]);
    assert!(
        ran.code == Some(2) && ran.stderr.contains("replicate"),
        "{}",
        ran.stderr
    );
    assert!(!workshop.path("again.exr").exists());
    std::fs::remove_file(workshop.path("parts/3.exr")).expect("removed");
    let ran = workshop.run(&["merge", "parts", "-o", "again.exr"]);
    assert!(
        ran.code == Some(2) && ran.stderr.contains("missing: 4–5")
            || ran.stderr.contains("missing: 4"),
        "{}",
        ran.stderr
    );
    let ran = workshop
        .run(&["merge", "parts", "-o", "preview.exr", "--partial"])
        .fine();
    assert!(ran.stderr.contains("missing"), "{}", ran.stderr);
}
