//! Scenes broken at random are refused, or rendered, but never end the program.

use etalon_render::pipeline::{self, LoadOptions, RenderOptions};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

const CORNELL_BOX: &str = include_str!("../../../../scenes/cornell-box/scene.xml");
const EVERYTHING: &str = include_str!("everything.xml");

/// What is put in the place of something.
const PIECES: [&str; 34] = [
    "",
    "0",
    "-1",
    "1e38",
    "-1e38",
    "1e-38",
    "nan",
    "inf",
    "1e999",
    "99999999999999999999",
    "$spp",
    "$nothing",
    "\"",
    "<",
    ">",
    "/>",
    "<ref id=\"white\"/>",
    "<ref id=\"light\"/>",
    "0, 0, 0",
    "float",
    "rgb",
    "shape",
    "bsdf",
    "emitter",
    "dielectric",
    "sphere",
    "roughconductor",
    "twosided",
    "mask",
    "point",
    "\u{0}",
    "é",
    "<!--",
    "&#x41;",
];

/// One change of a text.
#[derive(Clone, Debug)]
enum Change {
    /// A token is replaced by a piece.
    Token(usize, usize),
    /// A token is replaced by another one of the text.
    Copied(usize, usize),
    /// A line is dropped.
    DropLine(usize),
    /// A line is written twice.
    TwiceLine(usize),
    /// The text ends early.
    Cut(usize),
}

/// Where the tokens of a text lie: runs of letters, digits, `.`, `-` and `_`.
fn tokens(text: &str) -> Vec<std::ops::Range<usize>> {
    let inside = |c: char| c.is_alphanumeric() || matches!(c, '.' | '-' | '_' | '$');
    let mut found: Vec<std::ops::Range<usize>> = Vec::new();
    for (at, c) in text.char_indices().filter(|(_, c)| inside(*c)) {
        match found.last_mut() {
            Some(last) if last.end == at => last.end = at + c.len_utf8(),
            _ => found.push(at..at + c.len_utf8()),
        }
    }
    found
}

fn changed(text: &str, change: &Change) -> String {
    let tokens = tokens(text);
    let mut lines: Vec<&str> = text.lines().collect();
    if tokens.is_empty() || lines.is_empty() {
        return text.to_owned();
    }
    let token = |index: usize| tokens[index % tokens.len()].clone();
    let mut new = text.to_owned();
    match *change {
        Change::Token(at, piece) => new.replace_range(token(at), PIECES[piece % PIECES.len()]),
        Change::Copied(at, from) => new.replace_range(token(at), &text[token(from)]),
        Change::DropLine(at) => {
            lines.remove(at % lines.len());
            new = lines.join("\n");
        }
        Change::TwiceLine(at) => {
            let at = at % lines.len();
            lines.insert(at, lines[at]);
            new = lines.join("\n");
        }
        Change::Cut(at) => {
            let at = at % text.len();
            new.truncate(
                (0..=at)
                    .rev()
                    .find(|&i| text.is_char_boundary(i))
                    .unwrap_or(0),
            );
        }
    }
    new
}

fn change() -> impl Strategy<Value = Change> {
    let any = || any::<usize>();
    prop_oneof![
        6 => (any(), any()).prop_map(|(at, piece)| Change::Token(at, piece)),
        4 => (any(), any()).prop_map(|(at, from)| Change::Copied(at, from)),
        1 => any().prop_map(Change::DropLine),
        1 => any().prop_map(Change::TwiceLine),
        1 => any().prop_map(Change::Cut),
    ]
}

/// Loads a broken scene, and renders four pixels of whatever it has become.
fn survive(scene: &str, changes: &[Change]) -> Result<(), TestCaseError> {
    let text = changes
        .iter()
        .fold(scene.to_owned(), |text, change| changed(&text, change));
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("scene.xml");
    std::fs::write(&path, text).expect("written");
    match pipeline::load(&path, &LoadOptions::default()) {
        Ok(mut loaded) => {
            let compiled =
                std::sync::Arc::get_mut(&mut loaded.compiled).expect("no other holds it");
            let size = &mut compiled.film.crop_size;
            (size.x, size.y) = (size.x.min(2), size.y.min(2));
            let options = RenderOptions {
                spp: Some(2),
                ..RenderOptions::default()
            };
            let plan = pipeline::plan(&loaded, &options);
            prop_assert!(pipeline::render(&loaded, &plan, &()).is_ok());
        }
        Err(refusal) => {
            prop_assert!(!refusal.diagnostics.is_empty());
            etalon::diagnose::render(&refusal.diagnostics, &refusal.sources, true);
        }
    }
    Ok(())
}

fn fixed(seed: u64) -> ProptestConfig {
    ProptestConfig {
        cases: 600,
        rng_seed: RngSeed::Fixed(seed),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

proptest! {
    #![proptest_config(fixed(0x0e7a_1011))]
    #[test]
    fn of_the_cornell_box(changes in prop::collection::vec(change(), 1..4)) {
        survive(CORNELL_BOX, &changes)?;
    }
}

proptest! {
    #![proptest_config(fixed(0x0e7a_1012))]
    #[test]
    fn of_something_of_every_kind(changes in prop::collection::vec(change(), 1..4)) {
        survive(EVERYTHING, &changes)?;
    }
}
