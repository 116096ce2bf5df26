//! `render --frames` and `movie`: sequences of pictures.

use crate::workshop::{Workshop, scene};
use std::process::Stdio;
use std::time::{Duration, Instant};

/// A small sequence of something that moves.
fn sequence<'a>(output: &'a str, frames: &'a str, scene: &'a str) -> Vec<&'a str> {
    let words = "-q --fps 24 --spp 16 -D resx=16 -D resy=12 -D close=0.02";
    let mut all = vec!["render", scene, "-o", output, "--frames", frames];
    all.extend(words.split(' '));
    all
}

#[test]
fn a_killed_sequence_goes_on() {
    let (workshop, scene) = (Workshop::new(), scene("motion"));
    workshop
        .run(&sequence("whole.##.exr", "1..24", &scene))
        .fine();
    let resumed = [&sequence("a.##.exr", "1..24", &scene)[..], &["--resume"]].concat();
    let child = workshop
        .command()
        .args(&resumed)
        .stderr(Stdio::null())
        .spawn();
    let mut child = child.expect("it runs");
    let start = Instant::now();
    while !workshop.path("a.07.exr").exists() {
        assert!(start.elapsed() < Duration::from_secs(60), "no frame 7");
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().expect("killed");
    child.wait().expect("it ends");
    assert!(!workshop.path("a.24.exr").exists(), "it was too fast");
    let first = workshop.read("a.01.exr");
    let loudly: Vec<&str> = resumed
        .iter()
        .copied()
        .filter(|word| *word != "-q")
        .collect();
    let ran = workshop.run(&loudly).fine();
    assert!(
        ran.stderr.contains("a.01.exr is there already"),
        "{}",
        ran.stderr
    );
    assert!(workshop.read("a.01.exr") == first);
    let mut seen = Vec::new();
    for frame in 1..=24 {
        let name = |which: &str| format!("{which}.{frame:02}.exr");
        let (whole, resumed) = (workshop.read(&name("whole")), workshop.read(&name("a")));
        assert!(whole == resumed, "frame {frame}");
        assert!(!seen.contains(&whole), "frame {frame} is another");
        seen.push(whole);
    }
    // What is there must be of this render.
    let other = [&resumed[..], &["--seed", "3"]].concat();
    let ran = workshop.run(&other).refused();
    assert!(
        ran.stderr
            .contains("a.01.exr: is of another render: the seed"),
        "{}",
        ran.stderr
    );
}

#[test]
fn seeds_go_with_frames_unless_they_are_fixed() {
    let (workshop, scene) = (Workshop::new(), scene("motion"));
    let seed = |name: &str| workshop.image(name).metadata.expect("it has some").seed;
    workshop.run(&sequence("a.exr", "1..2", &scene)).fine();
    assert_ne!(seed("a.0001.exr"), seed("a.0002.exr"));
    let fixed = [&sequence("b.exr", "1..2", &scene)[..], &["--seed", "9"]].concat();
    workshop.run(&fixed).fine();
    assert_eq!((seed("b.0001.exr"), seed("b.0002.exr")), (9, 9));
}

#[test]
fn a_film_of_frames() {
    let (workshop, scene) = (Workshop::new(), scene("motion"));
    workshop.run(&sequence("a.png", "0..3", &scene)).fine();
    let names = ["a.0000.exr", "a.0001.exr", "a.0002.exr", "a.0003.exr"];
    let movie = |frames: &[&str], output: &str| {
        let arguments = [&["movie"][..], frames, &["-o", output]].concat();
        workshop.run(&arguments)
    };
    let ran = movie(&names, "film.png").fine();
    assert!(ran.stderr.contains("film.png: 4 frames"), "{}", ran.stderr);
    let bytes = workshop.read("film.png");
    let chunks = |name: &[u8]| bytes.windows(4).filter(|w| *w == name).count();
    assert_eq!((chunks(b"acTL"), chunks(b"fcTL")), (1, 4));
    // Frames of another size, and a kind that nothing here writes.
    workshop.render("other.exr", &["--spp", "1"]);
    let ran = movie(&["a.0000.exr", "other.exr"], "b.png").refused();
    assert!(
        ran.stderr.contains("all frames of a film are alike"),
        "{}",
        ran.stderr
    );
    assert!(!workshop.path("b.png").exists());
    let mut without = workshop.command();
    let ran = without
        .env("PATH", "")
        .args(["movie", "a.0000.exr", "-o", "b.mp4"])
        .output();
    let said = String::from_utf8_lossy(&ran.expect("it runs").stderr).into_owned();
    assert!(said.contains("`ffmpeg` is needed for b.mp4"), "{said}");
}

/// A film has the frames that were asked for, all of them.
#[test]
fn a_frame_that_is_missing_is_named() {
    let (workshop, scene) = (Workshop::new(), scene("motion"));
    workshop.run(&sequence("a.##.exr", "1..5", &scene)).fine();
    let movie =
        |frames: &[&str]| workshop.run(&[&["movie"][..], frames, &["-o", "film.png"]].concat());
    movie(&["a.##.exr", "--frames", "2..4"]).fine();
    let film = workshop.read("film.png");
    assert_eq!(film.windows(4).filter(|w| *w == b"fcTL").count(), 3);
    std::fs::remove_file(workshop.path("a.03.exr")).expect("removed");
    let listed = ["a.01.exr", "a.02.exr", "a.04.exr", "a.05.exr"];
    for frames in [&["a.##.exr", "--frames", "1..5"][..], &listed] {
        let said = movie(frames).refused().stderr;
        assert!(
            said.contains("a.03.exr") && said.contains("missing"),
            "{said}"
        );
    }
    let said = movie(&["a.##.exr", "--frames", "1..9"]).refused().stderr;
    assert!(
        said.contains("of 9 frames 5 are missing, from a.03.exr to a.09.exr"),
        "{said}"
    );
    assert!(workshop.read("film.png") == film);
    for name in ["film.exr", "film.jpg"] {
        let said = workshop
            .run(&["movie", "a.01.exr", "-o", name])
            .refused()
            .stderr;
        assert!(said.contains("must end in .png"), "{said}");
    }
}

#[test]
fn ranges_of_nothing() {
    let (workshop, scene) = (Workshop::new(), scene("motion"));
    let ran = workshop.run(&sequence("a.exr", "5..3", &scene)).refused();
    assert!(
        ran.stderr.contains("there is no frame from 5 to 3"),
        "{}",
        ran.stderr
    );
    assert!(workshop.files().is_empty());
    let replay = ["render", &scene, "--frames", "1..2", "--replay", "1,1,0,0"];
    let ran = workshop.run(&replay).refused();
    assert!(ran.stderr.contains("is about one frame"), "{}", ran.stderr);
}
