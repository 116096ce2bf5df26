//! No command writes over what it reads, under whatever name: every path that a command line can hold is known here.

use crate::workshop::{Workshop, small_scene};
use clap::CommandFactory;
use etalon::args::Cli;
use std::any::TypeId;
use std::path::{Path, PathBuf};

/// The arguments of every command that are paths, and whether the command reads or writes there.
const PATHS: [(&str, &str, Use); 32] = [
    ("render", "scene", Use::Reads),
    ("render", "output", Use::Writes(&["scene.xml", "-o"])),
    ("render", "strategies", Use::FillsFolder),
    (
        "render",
        "stats",
        Use::Writes(&["scene.xml", "-o", "new.exr", "--stats"]),
    ),
    ("render", "data", Use::Reads),
    ("render", "environment", Use::Reads),
    ("merge", "parts", Use::Reads),
    ("merge", "output", Use::Writes(&["a.exr", "b.exr", "-o"])),
    ("replicates", "pictures", Use::Reads),
    (
        "replicates",
        "output",
        Use::Writes(&["a.exr", "b.exr", "-o"]),
    ),
    ("compare", "a", Use::Reads),
    ("compare", "b", Use::Reads),
    (
        "compare",
        "report",
        Use::Writes(&["a.exr", "b.exr", "--report"]),
    ),
    ("estimators", "scene", Use::Reads),
    ("estimators", "reference", Use::Reads),
    (
        "estimators",
        "report",
        Use::Writes(&[
            "scene.xml",
            "--integrators",
            "path,direct",
            "--time",
            "9",
            "--reference",
            "a.exr",
            "--report",
        ]),
    ),
    (
        "estimators",
        "json",
        Use::Writes(&[
            "scene.xml",
            "--integrators",
            "path,direct",
            "--time",
            "9",
            "--reference",
            "a.exr",
            "--json",
        ]),
    ),
    ("estimators", "data", Use::Reads),
    ("estimators", "environment", Use::Reads),
    ("denoise", "input", Use::Reads),
    ("denoise", "oidn", Use::Reads),
    ("denoise", "output", Use::Writes(&["a.exr", "-o"])),
    ("convert", "input", Use::Reads),
    ("convert", "output", Use::Writes(&["p.png"])),
    ("convert-scene", "input", Use::Reads),
    ("convert-scene", "output", Use::Writes(&["scene.xml"])),
    ("movie", "files", Use::Reads),
    ("movie", "output", Use::Writes(&["p.png", "q.png", "-o"])),
    ("info", "file", Use::Reads),
    ("view", "file", Use::Reads),
    ("view", "other", Use::Reads),
    ("farm", "program", Use::Reads),
];

/// What a command does with a path.
#[derive(Clone, Copy, Debug)]
enum Use {
    /// It reads a file, or from a folder.
    Reads,
    /// It writes a file, named after these arguments.
    Writes(&'static [&'static str]),
    /// It writes into a folder of its own.
    FillsFolder,
}

/// Whether an argument of `farm` is one of `render`, which `farm` takes over.
fn is_of_render(command: &str, argument: &str) -> bool {
    let of_render = |(c, a, _): &(&str, &str, Use)| *c == "render" && *a == argument;
    command == "farm" && PATHS.iter().any(of_render)
}

/// Whoever adds a command or an option says here whether it writes.
#[test]
fn every_path_of_every_command_is_known() {
    let tree = Cli::command();
    let path = TypeId::of::<PathBuf>();
    let mut seen = 0;
    for command in tree.get_subcommands() {
        for argument in command.get_arguments() {
            let (name, id) = (command.get_name(), argument.get_id().as_str());
            if argument.get_value_parser().type_id() != path || is_of_render(name, id) {
                continue;
            }
            let known = PATHS.iter().any(|(c, a, _)| (*c, *a) == (name, id));
            assert!(known, "does `{name}` read or write its `{id}`?");
            seen += 1;
        }
    }
    assert_eq!(seen, PATHS.len());
}

/// A scene with a picture for a texture, two renders of it, and two pictures.
fn workshop() -> Workshop {
    let workshop = Workshop::new();
    let scene = small_scene("<integrator type=\"path\"/>").replace(
        "<shape type=\"sphere\">",
        "<shape type=\"sphere\"><bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"bitmap\">\
         <string name=\"filename\" value=\"map.exr\"/></texture></bsdf>",
    );
    workshop.write("plain.xml", small_scene("<integrator type=\"path\"/>"));
    workshop.write("scene.xml", scene);
    let render = |output: &str, further: &[&str]| {
        let all = [
            &["render", "plain.xml", "-q", "--spp", "16", "-o", output],
            further,
        ]
        .concat();
        workshop.run(&all).fine();
    };
    render("map.exr", &[]);
    render("a.exr", &["--part", "1/2"]);
    render("b.exr", &["--part", "2/2"]);
    for name in ["p.png", "q.png"] {
        workshop.run(&["convert", "map.exr", name]).fine();
    }
    workshop
}

/// Mutants rejected: a command that asks nobody; a guard that compares names alone, or forgets what a scene names.
#[test]
fn no_command_writes_over_what_it_reads() {
    let workshop = workshop();
    let inputs = ["scene.xml", "map.exr", "a.exr", "b.exr", "p.png", "q.png"];
    let before = inputs.map(|name| workshop.read(name));
    for (command, argument, path) in PATHS {
        let Use::Writes(arguments) = path else {
            continue;
        };
        // What is named on the line, and what the scene names.
        let named = arguments
            .iter()
            .copied()
            .filter(|name| inputs.contains(name));
        let of_scene = arguments.contains(&"scene.xml").then_some("map.exr");
        for input in named.chain(of_scene) {
            let extension = Path::new(input).extension().unwrap_or_default();
            let links = ["soft", "hard"].map(|name| Path::new(name).with_extension(extension));
            let others = links
                .each_ref()
                .map(|link| workshop.path(&link.to_string_lossy()));
            std::os::unix::fs::symlink(input, &others[0]).expect("a link");
            std::fs::hard_link(workshop.path(input), &others[1]).expect("a link");
            let here = Path::new(".").join(input);
            for output in [Path::new(input), &here, &links[0], &links[1]] {
                let output = output.to_string_lossy();
                let ran = workshop.run(&[&[command][..], arguments, &[&output]].concat());
                let ran = ran.refused();
                // Where the name is refused for its kind, that is what is said.
                let words = [
                    "read from",
                    "must end in",
                    "only .exr",
                    "such as",
                    "cannot write",
                ];
                let is_told = words.iter().any(|words| ran.stderr.contains(words));
                assert!(is_told, "{command} {argument} {output}: {}", ran.stderr);
            }
            let after = inputs.map(|name| workshop.read(name));
            assert!(after == before, "{command} {argument} {input}");
            others
                .iter()
                .for_each(|link| std::fs::remove_file(link).expect("removed"));
        }
    }
}

/// 255 bytes are a name, of whatever letters.
#[test]
fn long_names_are_written() {
    let workshop = Workshop::new();
    workshop.write("scene.xml", small_scene("<integrator type=\"path\"/>"));
    for name in ["a".repeat(251), "光".repeat(83)] {
        let exr = format!("{name}.exr");
        let all = ["render", "scene.xml", "-q", "--spp", "1", "-o", &exr];
        workshop.run(&all).fine();
        // A checkpoint has a longer name, and is refused before anything is rendered.
        let resumed = workshop.run(&[&all[..], &["--resume"]].concat()).refused();
        assert!(
            resumed.stderr.contains(".exr.checkpoint"),
            "{}",
            resumed.stderr
        );
        let png = format!("{name}.png");
        workshop.run(&["convert", &exr, &png]).fine();
        let report = format!("{}.html", &name[..240]); // a boundary of `光`, too
        workshop.run(&["compare", &exr, &exr, "--report", &report]);
        for file in [exr, png, report] {
            assert!(workshop.path(&file).exists(), "{file}");
        }
    }
    let all = [
        "render",
        "scene.xml",
        "-q",
        "-o",
        &format!("{}.exr", "a".repeat(252)),
    ];
    workshop.run(&all).refused();
    let hidden = workshop
        .files()
        .into_iter()
        .find(|name| name.starts_with('.'));
    assert_eq!(hidden, None);
}
