//! `etalon render --part` and `etalon merge`: what was split and put together again is the unsplit
//! file, byte for byte.

use crate::workshop::{Ran, Workshop, small_scene};

/// A picture so small, and so few samples, that a test can render many.
const SIZE: [&str; 4] = ["-D", "resx=24", "-D", "resy=20"];

/// Renders the Cornell box whole and in parts, `p1.exr` and so on.
fn parts(workshop: &Workshop, count: u32, further: &[&str]) {
    workshop.render("whole.exr", &[&["-q"], further].concat());
    for number in 1..=count {
        let part = format!("{number}/{count}");
        let options = [&["-q", "--part", &part], further].concat();
        workshop.render(&format!("p{number}.exr"), &options);
    }
}

/// Merges files into `merged.exr`.
fn merge(workshop: &Workshop, files: &[&str]) -> Ran {
    workshop.run(&[&["merge", "-o", "merged.exr"], files].concat())
}

/// Tries to merge files; every one of `words` must be said, and nothing written.
#[track_caller]
fn refused(workshop: &Workshop, files: &[&str], words: &[&str]) {
    let before = workshop.files();
    let said = merge(workshop, files).refused().stderr;
    for line in said.lines() {
        assert!(line.starts_with("error: "), "{said}");
    }
    for words in words {
        assert!(said.contains(words), "{words:?} in {said}");
    }
    assert_eq!(workshop.files(), before);
}

#[test]
fn parts_in_any_order_give_the_whole() {
    // Splats of a wide filter, and samples whose means are rounded: 7 replicates of 3.
    for integrator in ["path", "ptracer"] {
        let workshop = Workshop::new();
        let further = [
            "--integrator",
            integrator,
            "--replicates",
            "7",
            "--spp",
            "21",
        ];
        for count in [2, 3] {
            parts(&workshop, count, &further);
            let whole = workshop.read("whole.exr");
            let orders: [&[usize]; 3] = [&[0, 1, 2], &[2, 0, 1], &[1, 2, 0]];
            for order in orders {
                let names = ["p1.exr", "p2.exr", "p3.exr"].map(str::to_owned);
                let files: Vec<&str> = (order.iter().filter(|i| **i < count as usize))
                    .map(|i| names[*i].as_str())
                    .collect();
                let said = merge(&workshop, &files).fine();
                assert_eq!(said.stdout, "");
                assert!(
                    said.stderr.starts_with("merged.exr: 7 replicates from "),
                    "{}",
                    said.stderr
                );
                assert!(
                    workshop.read("merged.exr") == whole,
                    "{integrator}, {files:?}"
                );
            }
        }
    }
}

/// The comparison above is one of bytes; this is a fault that it must find.
#[test]
fn parts_of_another_seed_give_another_picture() {
    let workshop = Workshop::new();
    parts(&workshop, 2, &["--spp", "8"]);
    let whole = workshop.read("whole.exr");
    parts(&workshop, 2, &["--spp", "8", "--seed", "1"]);
    merge(&workshop, &["p1.exr", "p2.exr"]).fine();
    assert!(workshop.read("merged.exr") != whole);
    assert!(workshop.read("merged.exr") == workshop.read("whole.exr"));
}

/// Textures are blurred by the spacing of all of the picture's samples; nested integrators have
/// channels of their own.
#[test]
fn parts_of_nested_integrators_and_textures() {
    let workshop = Workshop::new();
    let aov = "<integrator type=\"aov\"><string name=\"aovs\" value=\"d:depth,n:sh_normal\"/>\
               <integrator type=\"path\" name=\"picture\"/></integrator>";
    let bitmap = "/></transform><bsdf type=\"diffuse\"><texture type=\"bitmap\" name=\"reflectance\">\
                  <string name=\"filename\" value=\"t.png\"/></texture></bsdf></shape>";
    workshop.render("t.exr", &["--spp", "4", "-q"]);
    workshop.run(&["convert", "t.exr", "t.png"]).fine();
    let scene = small_scene(aov).replacen("/></transform></shape>", bitmap, 1);
    assert!(scene.contains("t.png"));
    workshop.write("s.xml", scene);
    let render = |name: &str, further: &[&str]| {
        workshop
            .run(&[&["render", "s.xml", "-q", "-o", name], further].concat())
            .fine();
    };
    render("whole.exr", &[]);
    render("p1.exr", &["--part", "1/2"]);
    render("p2.exr", &["--part", "2/2"]);
    merge(&workshop, &["p2.exr", "p1.exr"]).fine();
    assert!(workshop.read("merged.exr") == workshop.read("whole.exr"));
}

#[test]
fn every_replicate_may_be_a_part() {
    let workshop = Workshop::new();
    parts(&workshop, 8, &["--spp", "8"]);
    let first = workshop.image("p1.exr");
    assert!(first.image.channel("standard_error.R").is_none());
    let files: Vec<String> = (1..=8).rev().map(|n| format!("p{n}.exr")).collect();
    let files: Vec<&str> = files.iter().map(String::as_str).collect();
    merge(&workshop, &files).fine();
    assert!(workshop.read("merged.exr") == workshop.read("whole.exr"));
    // The whole as one part.
    parts(&workshop, 1, &["--spp", "8"]);
    merge(&workshop, &["p1.exr"]).fine();
    assert!(workshop.read("merged.exr") == workshop.read("whole.exr"));
}

#[test]
fn what_there_is_can_be_merged_if_asked_for() {
    let workshop = Workshop::new();
    parts(&workshop, 4, &["--spp", "8"]);
    let missing = "of the 8 replicates 0 to 7, these are missing: 2 to 3; render them, or merge what \
                   there is with `--partial`";
    refused(&workshop, &["p1.exr", "p3.exr", "p4.exr"], &[missing]);
    let said = merge(&workshop, &["p1.exr", "p3.exr", "p4.exr", "--partial"]).fine();
    assert!(said.stderr.contains("missing: 2 to 3"), "{}", said.stderr);
    let info = workshop.run(&["info", "merged.exr"]).fine().stdout;
    let part = "part         the replicates 0 to 1, 4 to 7 of 0 to 7, with exact sums for `etalon merge`\n";
    assert!(info.contains(part), "{info}");
    assert!(!info.contains("exact."), "{info}");
    // A part itself, which its rest completes.
    std::fs::rename(workshop.path("merged.exr"), workshop.path("most.exr")).expect("renamed");
    merge(&workshop, &["most.exr", "p2.exr", "-q"]).fine();
    assert!(workshop.read("merged.exr") == workshop.read("whole.exr"));
}

#[test]
fn what_does_not_belong_together_is_refused() {
    let workshop = Workshop::new();
    let part = |name: &str, further: &[&str]| {
        workshop.render(name, &[&["-q", "--part"], further].concat());
    };
    part("a.exr", &["1/2", "--spp", "8"]);
    part("b.exr", &["2/2", "--spp", "8"]);
    part("c.exr", &["2/3", "--spp", "8"]);
    part("seed.exr", &["2/2", "--spp", "8", "--seed", "9"]);
    part("spp.exr", &["2/2", "--spp", "16"]);
    part("of.exr", &["2/2", "--spp", "4", "--replicates", "4"]);
    let kind = ["2/2", "--spp", "8", "--independent-replicates"];
    part("kind.exr", &kind);
    part("size.exr", &["2/2", "--spp", "8", "-D", "max_depth=3"]);
    workshop.render("whole.exr", &["-q", "--spp", "8"]);
    workshop.write("text.exr", "nothing like a picture");
    let differ = |other: &str, words: &str| {
        let both = format!("a.exr and {other} are parts of different renders: ");
        refused(&workshop, &["a.exr", other], &[&both, words]);
    };
    differ("seed.exr", "the seed is 0 in the first, 9 in the second");
    differ(
        "spp.exr",
        "the number of samples per replicate is 1 in the first, 2 in the second",
    );
    differ(
        "of.exr",
        "the number of replicates of the whole is 8 in the first, 4 in the second",
    );
    differ(
        "kind.exr",
        "the kind of replicates is blocks in the first, independent in the second",
    );
    differ("size.exr", "the scene's hash is ");
    let twice = "a.exr and c.exr both have the replicates 2 to 3";
    refused(
        &workshop,
        &["a.exr", "c.exr"],
        &[twice, "are missing: 5 to 7"],
    );
    refused(
        &workshop,
        &["a.exr", "b.exr", "a.exr"],
        &["replicates 0 to 3; give every part once"],
    );
    refused(
        &workshop,
        &["a.exr", "whole.exr"],
        &["whole.exr: it is a whole image of 8 replicates"],
    );
    refused(
        &workshop,
        &["a.exr", "text.exr", "none.exr"],
        &["text.exr", "none.exr"],
    );
    let output = |output: &str, words: &str| {
        let before = workshop.files();
        let ran = workshop.run(&["merge", "a.exr", "b.exr", "-o", output]);
        let said = ran.refused().stderr;
        assert!(
            said.starts_with("error: ") && said.contains(words),
            "{said}"
        );
        assert_eq!(workshop.files(), before);
    };
    output("a.exr", "a.exr: it is read from");
    output("m.png", "the name must end in .exr");
    output("nowhere/m.exr", "no such folder");
    merge(&workshop, &["a.exr", "b.exr"]).fine();
}

#[test]
fn damaged_parts_are_refused() {
    let workshop = Workshop::new();
    parts(&workshop, 2, &["--spp", "8"]);
    let sound = workshop.read("p2.exr");
    for length in [0, 20, 300, sound.len() / 2, sound.len() - 1] {
        workshop.write("bad.exr", &sound[..length]);
        refused(&workshop, &["p1.exr", "bad.exr"], &["bad.exr"]);
    }
    // Somewhere in the compressed sums.
    for place in [sound.len() / 3, sound.len() / 2, sound.len() - 40] {
        let mut damaged = sound.clone();
        damaged[place] ^= 0x10;
        workshop.write("bad.exr", damaged);
        refused(&workshop, &["p1.exr", "bad.exr"], &["bad.exr"]);
    }
    // A header that declares a picture of 2³⁰ pixels in its data window.
    let mut huge = sound.clone();
    let name = b"dataWindow\0box2i\0";
    let at = huge
        .windows(name.len())
        .position(|w| w == name)
        .expect("a header");
    let corner = at + name.len() + 4 + 8;
    huge[corner..corner + 8].copy_from_slice(&[255, 127, 0, 0, 255, 127, 0, 0]);
    workshop.write("bad.exr", huge);
    refused(&workshop, &["p1.exr", "bad.exr"], &["bad.exr"]);
}

#[test]
fn parts_that_cannot_be_are_refused() {
    let workshop = Workshop::new();
    let scene = crate::workshop::cornell_box();
    let refused = |output: &str, further: &[&str], words: &[&str]| {
        let arguments = [&["render", &scene, "-o", output][..], &SIZE, further].concat();
        let said = workshop.run(&arguments).refused().stderr;
        for words in words {
            assert!(said.contains(words), "{words:?} in {said}");
        }
        assert_eq!(workshop.files(), [""; 0]);
    };
    for part in ["0/2", "3/2", "1", "1/0", "a/b", "-1/2", "1/2/3"] {
        refused(
            "a.exr",
            &[&format!("--part={part}")],
            &["expected I/N with I from 1 to N"],
        );
    }
    let words = ["8 replicates cannot be dealt to 9 parts", "--replicates 9"];
    refused("a.exr", &["--part", "9/9"], &words);
    let words = ["1 replicates cannot be dealt to 2 parts"];
    refused("a.exr", &["--part", "1/2", "--spp", "1"], &words);
    refused(
        "a.pfm",
        &["--part", "1/2"],
        &["only .exr can hold a part's exact sums"],
    );
}
