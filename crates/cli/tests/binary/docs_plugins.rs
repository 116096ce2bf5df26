//! What the pages say of plugins in words is what the tables of the scene format have, which are asked of the program.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// The pages that tell of plugins in words.
const PAGES: [&str; 2] = ["docs/extensions.md", "docs/animation.md"];

fn page(name: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    std::fs::read_to_string(root.join(name)).expect("the page is there")
}

/// What stands between backticks.
fn quoted(text: &str) -> Vec<&str> {
    text.split('`').skip(1).step_by(2).collect()
}

/// The cells of a table's row.
fn cells(line: &str) -> Option<Vec<&str>> {
    let inner = line.strip_prefix('|')?.strip_suffix('|')?;
    Some(inner.split(" | ").map(str::trim).collect())
}

/// A value that can be compared; `None` of words that explain one.
fn literal(text: &str) -> Option<String> {
    let text = text.trim().trim_matches('`').replace('−', "-");
    let number = match text.split_once('/') {
        Some((a, b)) => a
            .parse::<f64>()
            .ok()
            .zip(b.parse::<f64>().ok())
            .map(|(a, b)| a / b),
        None => text.parse().ok(),
    };
    match number {
        Some(number) => Some(format!("{number:.5e}")),
        None => (!text.is_empty() && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_'))
            .then_some(text),
    }
}

/// The defaults of each plugin's parameters, by the tables of the scene format.
fn defaults() -> BTreeMap<(String, String), String> {
    let (mut known, mut plugins) = (BTreeMap::new(), Vec::new());
    let text = page("docs/scene-format.md");
    for line in text.lines() {
        if let Some(heading) = line.strip_prefix("### ") {
            plugins = quoted(heading);
        } else if let Some(cells) = cells(line)
            && let [Some(name), Some(default)] = [quoted(cells[0]).first(), cells.get(2)]
        {
            for plugin in &plugins {
                known.insert((plugin.to_string(), name.to_string()), default.to_string());
            }
        }
    }
    known
}

/// A value that a page says holds where a parameter is not given, of these plugins or of any.
#[derive(Debug)]
struct Said<'a> {
    name: &'a str,
    value: String,
    plugins: Vec<&'a str>,
}

/// What a page says in tables with a column of defaults, and in words: "`name` (value)".
fn said(text: &str) -> Vec<Said<'_>> {
    let mut said = Vec::new();
    let (mut plugins, mut columns) = (Vec::new(), None);
    for line in text.lines() {
        if line.starts_with('#') {
            plugins = quoted(line);
        }
        let Some(row) = cells(line) else {
            columns = None;
            let after_names = line.split('`').collect::<Vec<_>>();
            for pair in after_names.windows(2).skip(1).step_by(2) {
                let value = pair[1]
                    .strip_prefix(" (")
                    .and_then(|rest| rest.split([')', ';']).next());
                let value = value
                    .and_then(literal)
                    .filter(|v| v.contains('e') && v.parse::<f64>().is_ok());
                let plugins = Vec::new();
                said.extend(value.map(|value| Said {
                    name: pair[0],
                    value,
                    plugins,
                }));
            }
            continue;
        };
        let column = |title: &str| row.iter().position(|cell| *cell == title);
        let Some((default, of)) = columns else {
            columns = Some((
                column("default").filter(|_| row[0] == "parameter"),
                column("of"),
            ));
            continue;
        };
        let Some(default) = default else { continue };
        if row.len() <= default.max(of.unwrap_or(0)) {
            continue;
        }
        let names = quoted(row[0]);
        let own = of.map_or_else(Vec::new, |of| quoted(row[of]));
        let values: Vec<&str> = row[default].split(", ").collect();
        for (i, name) in names.iter().enumerate() {
            let value = match values.len() == names.len() {
                true => values[i],
                false => row[default],
            };
            let plugins = if own.is_empty() {
                plugins.clone()
            } else {
                own.clone()
            };
            said.extend(literal(value).map(|value| Said {
                name,
                value,
                plugins,
            }));
        }
    }
    said
}

/// Mutants rejected: a default that the program has changed since; one that no page of the program ever had.
#[test]
fn defaults_in_words_are_those_of_the_program() {
    let known = defaults();
    let mut compared = 0;
    for page_name in PAGES {
        let text = page(page_name);
        for Said {
            name,
            value,
            plugins,
        } in said(&text)
        {
            let of_name = known.iter().filter(|((plugin, parameter), _)| {
                parameter == name && (plugins.is_empty() || plugins.contains(&plugin.as_str()))
            });
            let held: Vec<_> = of_name
                .filter_map(|(_, default)| literal(default))
                .collect();
            if held.is_empty() {
                continue;
            }
            compared += 1;
            assert!(
                held.contains(&value),
                "{page_name} says that `{name}` of {plugins:?} is {value}, and the program {held:?}"
            );
        }
    }
    assert!(compared > 60, "{compared}");
}

/// Mutants rejected: a parameter under an old name; one that is not built.
#[test]
fn parameters_in_words_exist() {
    let mut known: BTreeSet<String> = BTreeSet::new();
    for name in [
        "docs/scene-format.md",
        "docs/ignored-parameters.md",
        "docs/command-line.md",
        "docs/mitsuba-compatibility.md",
        "docs/mitsuba-0.6.md",
    ] {
        let text = page(name);
        let words = quoted(&text).into_iter().chain(text.split('"'));
        known.extend(words.map(str::to_owned));
    }
    // Fields of tables of measured BRDFs, and of renders' metadata.
    known.extend(["theta_i", "theta_o", "resolution_error"].map(str::to_owned));
    let is_name = |word: &&str| {
        word.contains('_')
            && word
                .chars()
                .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_')
    };
    for name in PAGES {
        let text = page(name);
        for word in quoted(&text).into_iter().filter(is_name) {
            assert!(known.contains(word), "{name}: there is no `{word}`");
        }
    }
}
