//! The rules of the house that the compiler does not check (ARCHITECTURE.md, "Tidy rules").

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The floors of the house: a crate may depend only on crates of a lower floor.
const FLOORS: [&[&str]; 9] = [
    &["math", "statistics"],
    &["params", "sampling", "spectrum", "images"],
    &["transport", "tables"],
    &[
        "geometry",
        "textures",
        "bsdf",
        "subsurface",
        "lights",
        "cameras",
        "film",
    ],
    &["scene", "integrators"],
    &["formats"],
    &["render"],
    &["conform"],
    &["cli", "python", "validation", "benches", "xtask"],
];

/// Longest file, tables aside.
const LINES: usize = 420;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("xtask lies in the workspace")
        .to_owned()
}

/// Folder of each crate by its room's name.
fn rooms() -> BTreeMap<String, PathBuf> {
    let root = root();
    let mut rooms: BTreeMap<String, PathBuf> = fs::read_dir(root.join("crates"))
        .expect("crates/ exists")
        .map(|entry| entry.expect("readable").path())
        .map(|path| {
            (
                path.file_name()
                    .expect("named")
                    .to_string_lossy()
                    .into_owned(),
                path,
            )
        })
        .collect();
    for room in ["validation", "benches", "xtask"] {
        rooms.insert(room.to_owned(), root.join(room));
    }
    rooms
}

fn floor_of(room: &str) -> usize {
    FLOORS
        .iter()
        .position(|floor| floor.contains(&room))
        .unwrap_or_else(|| panic!("room `{room}` stands on no floor"))
}

fn rust_files(folder: &Path, found: &mut Vec<PathBuf>) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    for entry in entries {
        let path = entry.expect("readable").path();
        if path.is_dir() {
            if path.file_name().is_none_or(|name| name != "target") {
                rust_files(&path, found);
            }
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

fn all_rust_files() -> Vec<(PathBuf, String)> {
    let mut files = Vec::new();
    for folder in rooms().values() {
        rust_files(folder, &mut files);
    }
    files
        .into_iter()
        .map(|path| {
            let text = fs::read_to_string(&path).expect("UTF-8");
            (path.strip_prefix(root()).expect("inside").to_owned(), text)
        })
        .collect()
}

fn manifest(folder: &Path) -> toml::Table {
    fs::read_to_string(folder.join("Cargo.toml"))
        .expect("every room has a manifest")
        .parse()
        .expect("valid TOML")
}

#[test]
fn every_room_stands_on_a_floor() {
    let mut expected: Vec<&str> = FLOORS.iter().flat_map(|f| f.iter().copied()).collect();
    expected.sort_unstable();
    let found: Vec<String> = rooms().into_keys().collect();
    assert_eq!(found, expected);
}

#[test]
fn arrows_point_down() {
    for (room, folder) in rooms() {
        let manifest = manifest(&folder);
        let Some(dependencies) = manifest.get("dependencies").and_then(|d| d.as_table()) else {
            continue;
        };
        for name in dependencies.keys() {
            let target = match name.as_str() {
                "etalon" => "cli",
                other => match other.strip_prefix("etalon-") {
                    Some(target) => target,
                    None => continue,
                },
            };
            let same_top =
                floor_of(&room) == FLOORS.len() - 1 && floor_of(target) == FLOORS.len() - 1;
            assert!(
                floor_of(target) < floor_of(&room) || same_top,
                "`{room}` must not depend on `{target}`: an arrow may only point down"
            );
        }
    }
}

#[test]
fn integrators_name_nothing_concrete() {
    let manifest = manifest(&root().join("crates/integrators"));
    let dependencies = manifest["dependencies"].as_table().expect("a table");
    for room in FLOORS[3] {
        assert!(
            !dependencies.contains_key(&format!("etalon-{room}")),
            "integrators may not know `{room}`"
        );
    }
}

#[test]
fn files_are_short_and_open_with_their_purpose() {
    for (path, text) in all_rust_files() {
        let shown = path.display();
        assert!(text.starts_with("//!"), "{shown} does not open with `//!`");
        let is_table = path.components().any(|c| c.as_os_str() == "tables");
        let lines = text.lines().count();
        assert!(
            lines <= LINES || is_table,
            "{shown} has {lines} lines, more than {LINES}: is it one concept?"
        );
    }
}

/// Files that define types and are named after none of their items. May only shrink.
const MISNAMED: &str = include_str!("misnamed.txt");

/// `FilterSampler1d` and `filter_samplers_1d` as `filter`, `sampler`, `1d`: words without a plural's s.
fn words(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut before = '_';
    for c in name.chars() {
        let starts = matches!(c, '_' | '-')
            || c.is_uppercase() && !before.is_uppercase()
            || c.is_numeric() && !before.is_numeric();
        if starts {
            words.push(String::new());
        }
        if c.is_alphanumeric() {
            words.last_mut().expect("one").extend(c.to_lowercase());
        }
        before = c;
    }
    words.retain(|word| !word.is_empty());
    (words.iter())
        .map(|word| match word.strip_suffix('s') {
            Some(one) if one.len() > 1 => one.to_owned(),
            _ => word.clone(),
        })
        .collect()
}

/// The items of a source file that can give it its name: what it defines, and the types and traits of its `impl` blocks.
/// Whether any of its own types can be seen from outside.
fn items(text: &str) -> (Vec<&str>, bool) {
    let (mut names, mut types) = (Vec::new(), false);
    let code = text.split("#[cfg(test)]").next().unwrap_or_default();
    for line in code.lines() {
        let bare = line.trim_start();
        let public = bare.starts_with("pub");
        let rest = match bare.strip_prefix("pub(") {
            Some(scoped) => scoped.split_once(") ").map_or("", |(_, rest)| rest),
            None => bare.strip_prefix("pub ").unwrap_or(bare),
        };
        let mut tokens = rest
            .split(|c: char| !c.is_alphanumeric() && c != '_')
            .filter(|token| !matches!(*token, "" | "const" | "static" | "unsafe" | "async"));
        match tokens.next() {
            Some("struct" | "enum" | "trait") => {
                types |= public;
                names.extend(tokens.next());
            }
            Some("fn" | "type" | "macro_rules") => names.extend(tokens.next()),
            Some("impl") => names.extend(tokens),
            _ => {}
        }
    }
    (names, types)
}

/// A file with types is named after an item that it defines or implements, or after a plugin of its crate; its words may
/// be part of the item's. A file of functions only, and one that has other files inside, may be named after its subject.
#[test]
fn files_are_named_after_what_they_define() {
    let files = all_rust_files();
    let mut misnamed = Vec::new();
    for (path, text) in &files {
        let shown = path.display().to_string();
        let stem = path.file_stem().expect("named").to_string_lossy();
        assert!(
            !["utils", "util", "common", "helpers", "misc"].contains(&&*stem),
            "{shown} is named after nothing it defines"
        );
        let is_room = ["lib", "main", "mod"].contains(&&*stem)
            || (text.lines()).any(|line| line.trim_start_matches("pub ").starts_with("mod "));
        if is_room || path.components().any(|c| c.as_os_str() == "tests") || stem == "tests" {
            continue;
        }
        let (names, types) = items(text);
        let wanted = words(&stem);
        let holds = |name: &&str| {
            let words = words(name);
            words.concat() == wanted.concat()
                || words.windows(wanted.len()).any(|part| part == wanted)
        };
        let room: PathBuf = path.components().take(2).collect();
        let plugin = format!("\"{}\"", stem.replace('_', ""));
        let is_plugin = || {
            (files.iter()).any(|(other, text)| other.starts_with(&room) && text.contains(&plugin))
        };
        if types && !names.iter().any(holds) && !is_plugin() {
            misnamed.push(shown);
        }
    }
    misnamed.sort_unstable();
    let known: Vec<&str> = MISNAMED.lines().collect();
    assert_eq!(
        misnamed, known,
        "the list of misnamed files may only shrink"
    );
}

#[test]
fn obvhs_is_named_in_one_file() {
    let word = concat!("obv", "hs::");
    let files: Vec<_> = all_rust_files()
        .into_iter()
        .filter(|(_, text)| text.contains(word))
        .map(|(path, _)| path)
        .filter(|path| path.starts_with("crates"))
        .collect();
    assert!(files.len() <= 1, "obvhs is named in {files:?}");
}

#[test]
fn nothing_unfinished_and_no_ignored_tests() {
    let marks = [
        concat!("TO", "DO"),
        concat!("FIX", "ME"),
        concat!("#[ign", "ore"),
        concat!("should_", "panic"),
        concat!("todo", "!("),
        concat!("unimplemented", "!("),
    ];
    for (path, text) in all_rust_files() {
        for mark in marks {
            assert!(!text.contains(mark), "{} contains `{mark}`", path.display());
        }
    }
}

#[test]
fn every_room_obeys_the_workspace_lints() {
    for (room, folder) in rooms() {
        let manifest = manifest(&folder);
        let inherits = manifest
            .get("lints")
            .and_then(|l| l.get("workspace"))
            .and_then(toml::Value::as_bool);
        assert_eq!(inherits, Some(true), "`{room}` does not inherit the lints");
    }
}

#[test]
fn profiles_differ_in_build_time_only() {
    let manifest = manifest(&root());
    let fast = &manifest["profile"]["fast"];
    assert_eq!(fast["inherits"].as_str(), Some("release"));
    let keys: Vec<&str> = fast
        .as_table()
        .expect("a table")
        .keys()
        .map(String::as_str)
        .collect();
    assert_eq!(keys, ["codegen-units", "incremental", "inherits", "lto"]);
}

/// A package holds its own folder only: what a crate includes must lie there, if by a link.
#[test]
fn crates_include_nothing_from_outside_of_them() {
    for (room, folder) in rooms() {
        let mut files = Vec::new();
        rust_files(&folder.join("src"), &mut files);
        for file in files {
            let text = fs::read_to_string(&file).expect("readable");
            let above = file
                .strip_prefix(&folder)
                .expect("within")
                .components()
                .count()
                - 1;
            for (at, _) in text.match_indices("include_") {
                let Some((_, rest)) = text[at..].split_once('"') else {
                    continue;
                };
                let path = rest.split('"').next().unwrap_or_default();
                let up = path.split('/').take_while(|part| *part == "..").count();
                let is_test = file.components().any(|part| part.as_os_str() == "tests");
                assert!(
                    up <= above || is_test || room == "xtask",
                    "{} includes {path}, which its package lacks",
                    file.display()
                );
            }
        }
    }
}
