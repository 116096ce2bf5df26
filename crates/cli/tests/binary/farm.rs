//! `etalon farm`: job files whose tasks, by whatever engine, come to the picture of one render.

use crate::workshop::{Workshop, cornell_box, small_scene};
use std::process::Command;

const SIZE: [&str; 6] = ["-D", "resx=24", "-D", "resy=20", "--spp", "64"];

/// Runs a script of a job as an engine would.
#[track_caller]
fn sh(workshop: &Workshop, script: &str, arguments: &[&str]) -> (bool, String) {
    let ran = Command::new("sh")
        .arg(workshop.path(script))
        .args(arguments)
        .env("SOURCE_DATE_EPOCH", "0")
        .output()
        .expect("sh runs");
    (
        ran.status.success(),
        String::from_utf8_lossy(&ran.stderr).into_owned(),
    )
}

#[track_caller]
fn farm(workshop: &Workshop, further: &[&str]) -> String {
    let scene = cornell_box();
    let all = [&["farm", &scene, "-o", "job"], &SIZE[..], further].concat();
    workshop.run(&all).fine().stdout
}

/// Three tasks, one of them twice and another out of order, come to the bits of one render.
#[test]
fn tasks_and_merge_come_to_the_bits_of_one_render() {
    let workshop = Workshop::new();
    // By the name that tasks know it by.
    let scene = std::fs::canonicalize(cornell_box()).expect("the scene is there");
    let scene = scene.to_string_lossy();
    let all = [&["render", &scene, "-o", "whole.exr"], &SIZE[..]].concat();
    workshop.run(&all).fine();
    let told = farm(&workshop, &["--engine", "parallel", "--parts", "3"]);
    assert!(
        told.starts_with("sh ") && told.contains("submit.sh"),
        "{told}"
    );
    assert!(
        !sh(&workshop, "job/merge.sh", &[]).0,
        "nothing is there yet"
    );
    for task in ["2", "3", "2"] {
        let (fine, said) = sh(&workshop, "job/task.sh", &[task]);
        assert!(fine, "{said}");
    }
    let (fine, said) = sh(&workshop, "job/merge.sh", &[]);
    assert!(!fine && said.contains("part-0001.exr"), "{said}");
    assert!(sh(&workshop, "job/task.sh", &["1"]).0);
    let (fine, said) = sh(&workshop, "job/merge.sh", &[]);
    assert!(fine, "{said}");
    assert!(workshop.read("job/cornell-box.exr") == workshop.read("whole.exr"));
    assert!(workshop.path("job/cornell-box.png").exists());
}

#[test]
fn frames_are_tasks_too() {
    let workshop = Workshop::new();
    farm(&workshop, &["--engine", "slurm", "--frames", "3..4"]);
    let script = String::from_utf8(workshop.read("job/render.slurm")).expect("text");
    assert!(
        script.contains("--array=3-4") && script.contains("--requeue"),
        "{script}"
    );
    assert!(sh(&workshop, "job/task.sh", &["3"]).0 && sh(&workshop, "job/task.sh", &["4"]).0);
    assert!(sh(&workshop, "job/merge.sh", &[]).0);
    assert!(workshop.path("job/frames/cornell-box.0004.exr").exists());
    assert!(workshop.path("job/cornell-box.png").exists());
}

#[test]
fn what_tasks_cannot_have_is_refused_before_anything_is_written() {
    let workshop = Workshop::new();
    let scene = cornell_box();
    for (further, words) in [
        (&["--parts", "9"][..], "9 parts"),
        (&["--resume"], "--resume"),
        (&["--part", "1/2"], "--part"),
        (&["--integrator", "pathh"], "pathh"),
        (&["--time", "5"], "--time"),
    ] {
        let all = [
            &["farm", &scene, "-o", "job", "--engine", "openjd"],
            further,
        ]
        .concat();
        let ran = workshop.run(&all);
        assert!(
            ran.code == Some(2) && ran.stderr.contains(words),
            "{further:?}: {}",
            ran.stderr
        );
    }
    assert!(workshop.files().is_empty());
}

/// A search path that finds a program of ours first.
fn programs(workshop: &Workshop, name: &str, script: &str) -> String {
    use std::os::unix::fs::PermissionsExt;
    let folder = workshop.path("bin");
    std::fs::create_dir_all(&folder).expect("created");
    workshop.write(&format!("bin/{name}"), script);
    let mode = std::fs::Permissions::from_mode(0o755);
    std::fs::set_permissions(folder.join(name), mode).expect("made a program");
    format!("{}:/bin:/usr/bin", folder.display())
}

/// Names with spaces, quotes and what engines replace reach the program as they are. Mutants rejected: quotes for one shell
/// where there are two; `%A` and `{{x}}` left to the engine.
#[test]
fn names_that_mean_something_to_engines() {
    let workshop = Workshop::new();
    let scene = "it's {{my}} scene%A.xml";
    workshop.write(scene, small_scene("<integrator type=\"path\"/>"));
    let job = "jo b%A{{x}}";
    let farm = |engine: &str| {
        let all = [
            "farm", scene, "-o", job, "--engine", engine, "--parts", "2", "--spp", "16",
        ];
        workshop.run(&all).fine();
    };
    let text = |name: &str| {
        let bytes = workshop.read(&format!("{job}/{name}"));
        String::from_utf8(bytes).expect("text")
    };
    // A `parallel` that does what that of GNU does with the lines it reads: hands each to a shell.
    farm("parallel");
    let bin = programs(
        &workshop,
        "parallel",
        "#!/bin/sh\ntr '\\0' '\\n' | while IFS= read -r line; do sh -c \"$line\" || exit 1; done\n",
    );
    let ran = Command::new("sh")
        .arg(workshop.path(job).join("submit.sh"))
        .env("PATH", &bin)
        .output()
        .expect("sh runs");
    assert!(
        ran.status.success(),
        "{}",
        String::from_utf8_lossy(&ran.stderr)
    );
    assert!(workshop.path(job).join("it's {{my}} scene%A.png").exists());
    farm("slurm");
    let script = text("render.slurm");
    assert!(script.contains("jo\\ b%%A{{x}}"), "{script}");
    farm("openjd");
    let template = text("template.yaml");
    // What a parameter is by default is no format.
    let mut formats = template.lines().filter(|line| !line.contains("default:"));
    assert!(formats.all(|line| !line.contains("{{x}}")), "{template}");
}

/// A submission that fails is a failure.
#[test]
fn a_submission_that_fails_is_told() {
    let workshop = Workshop::new();
    let scene = cornell_box();
    let all = ["farm", &scene, "-o", "job", "--engine", "slurm", "--submit"];
    let all = [&all[..], &SIZE[..]].concat();
    for program in ["none", "sbatch"] {
        let path = programs(
            &workshop,
            program,
            "#!/bin/sh\necho no such partition >&2\nexit 1\n",
        );
        let mut command = workshop.command();
        let ran = command
            .args(&all)
            .env("PATH", &path)
            .output()
            .expect("it runs");
        let said = String::from_utf8_lossy(&ran.stderr);
        assert_eq!(ran.status.code(), Some(2), "{said}");
        assert!(said.contains("it needs `sbatch`"), "{said}");
        let out = String::from_utf8_lossy(&ran.stdout);
        assert!(!out.contains("submitted"), "{out}");
    }
}

/// Scripts name what the cluster sees, and are written where they were asked for.
#[test]
fn paths_are_those_of_the_cluster() {
    let workshop = Workshop::new();
    let here = std::fs::canonicalize(workshop.path(".")).expect("a folder");
    let map = format!("{}=/mnt/share", here.display());
    farm(&workshop, &["--engine", "slurm", "--map", &map]);
    let script = String::from_utf8(workshop.read("job/render.slurm")).expect("text");
    assert!(
        script.contains("--output=/mnt/share/job/log/")
            && script.contains("sh /mnt/share/job/task.sh"),
        "{script}"
    );
    let scene = cornell_box();
    let submitted = [
        "farm", &scene, "-o", "job", "--engine", "slurm", "--map", &map, "--submit",
    ];
    assert_eq!(workshop.run(&submitted).code, Some(2));
}
