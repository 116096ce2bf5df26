//! The pages say what the program has: every option, and none that there is not.

use clap::CommandFactory;
use etalon::args::Cli;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn page(name: &str) -> String {
    std::fs::read_to_string(root().join(name)).expect("the page is there")
}

/// The arguments of a command, and of the commands within it.
fn arguments(command: &clap::Command) -> impl Iterator<Item = &clap::Arg> {
    let within = command.get_subcommands().flat_map(|c| c.get_arguments());
    command.get_arguments().chain(within)
}

/// The long options of a command, with their dashes; that it has help goes without saying.
fn options(command: &clap::Command) -> impl Iterator<Item = String> {
    let shown = arguments(command).filter(|a| !a.is_hide_set());
    let names = shown.filter_map(|argument| argument.get_long());
    names
        .filter(|name| !["help", "version"].contains(name))
        .map(|name| format!("--{name}"))
}

/// The part of the page on a command: from its heading to the next of the same level.
fn section<'a>(page: &'a str, command: &str) -> &'a str {
    let heading = format!("`{command}`");
    let mut sections = page.split("\n## ");
    let is_its = |text: &&str| {
        text.lines()
            .next()
            .is_some_and(|line| line.contains(&heading))
    };
    sections.find(is_its).unwrap_or_default()
}

/// Every word of a page that looks like an option of ours: not on lines of other programs.
fn option_words(page: &str) -> BTreeSet<&str> {
    let others = [
        "cargo", "#SBATCH", "sbatch", "squeue", "scancel", "openjd", "pip ",
    ];
    let lines = page
        .lines()
        .filter(|line| !others.iter().any(|other| line.contains(other)));
    let is_of_word = |c: char| c.is_ascii_alphanumeric() || c == '-';
    let words = lines.flat_map(|line| line.split(|c| !is_of_word(c)));
    let is_option = |word: &&str| {
        word.strip_prefix("--")
            .is_some_and(|name| name.starts_with(|c: char| c.is_ascii_lowercase()))
    };
    words.filter(is_option).collect()
}

/// Mutants rejected: an option that the page does not tell; one that was renamed, under its old name.
#[test]
fn options_are_those_of_the_page() {
    let tree = Cli::command();
    let text = page("docs/command-line.md");
    let of_render: BTreeSet<String> = tree
        .find_subcommand("render")
        .into_iter()
        .flat_map(options)
        .collect();
    let mut missing = Vec::new();
    for command in tree.get_subcommands() {
        let name = command.get_name();
        let part = section(&text, name);
        let told: BTreeSet<&str> = option_words(part);
        for option in options(command) {
            // What `farm` has of `render` is told there, and what is as for `render` by one line.
            let elsewhere = name != "render" && of_render.contains(&option);
            if !(told.contains(option.as_str()) || elsewhere) {
                missing.push(format!("{name} {option}"));
            }
        }
        if name != "completions" {
            assert!(
                text.contains(&format!("| `etalon {name} ")),
                "{name} is in no table"
            );
        }
    }
    assert!(
        missing.is_empty(),
        "not in docs/command-line.md: {missing:?}"
    );
}

#[test]
fn options_of_the_pages_exist() {
    let tree = Cli::command();
    let mut known: BTreeSet<String> = tree.get_subcommands().flat_map(options).collect();
    known.extend(["--help", "--version", "--verbose"].map(str::to_owned));
    let pages = std::fs::read_dir(root().join("docs")).expect("pages");
    let pages = pages.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let pages = pages
        .filter(|name| name.ends_with(".md"))
        .map(|name| format!("docs/{name}"));
    let mut unknown = Vec::new();
    for name in pages.chain(["README.md".to_owned()]) {
        // That page is on `cargo xtask validate`.
        if name == "docs/validation-json.md" {
            continue;
        }
        // Of `cargo xtask validate`, Docker and Blender.
        let others = [
            "--thorough",
            "--full",
            "--rm",
            "--background",
            "--python-exit-code",
        ];
        for word in option_words(&page(&name)).into_iter().map(str::to_owned) {
            if !known.contains(&word) && !others.contains(&word.as_str()) {
                unknown.push(format!("{name}: {word}"));
            }
        }
    }
    assert!(unknown.is_empty(), "{unknown:?}");
}

/// Defaults that a page states in words are those of `--help`.
#[test]
fn defaults_of_the_page_are_those_of_help() {
    let tree = Cli::command();
    let text = page("docs/command-line.md");
    for command in tree.get_subcommands() {
        let part = section(&text, command.get_name());
        // Its other options are those of `render`.
        if command.get_name() == "farm" {
            continue;
        }
        for argument in arguments(command) {
            let (Some(name), [default]) = (argument.get_long(), argument.get_default_values())
            else {
                continue;
            };
            let default = default.to_string_lossy();
            // Beside the option, or within the same sentence.
            let option = format!("--{name}");
            let names = part.match_indices(&option);
            let mut near = names.map(|(at, _)| part[at..].chars().take(160).collect::<String>());
            let told = near.any(|text| text.contains(&*default));
            // Zero is what everybody expects of an exposure.
            assert!(
                told || default == "0",
                "{} --{name}: {default}",
                command.get_name()
            );
        }
    }
}
