//! `etalon info --plugins`: the reference of scenes, as `docs/scene-format.md` has it.

use super::{answer, fail};
use etalon_params::{plugins, suggest};
use std::process::ExitCode;

/// Written by `cargo xtask plugins` from what the code asks for; a test keeps it up to date. A link to the page in `docs`, which
/// packages have a copy of.
const PAGE: &str = include_str!("../../scene-format.md");

/// A plugin's part of the page.
struct Section<'a> {
    /// The class it belongs to, in the plural.
    class: &'a str,
    names: Vec<&'a str>,
    text: &'a str,
}

fn sections() -> Vec<Section<'static>> {
    let mut sections = Vec::new();
    for part in PAGE.split("\n## ").skip(1) {
        let (class, plugins) = part.split_once('\n').unwrap_or((part, ""));
        for text in plugins.split("\n### ").skip(1) {
            let title = text.lines().next().unwrap_or_default();
            sections.push(Section {
                class,
                names: title.split('`').skip(1).step_by(2).collect(),
                text,
            });
        }
    }
    sections
}

/// All plugins, a line each, or what is known of those called `name`.
pub(super) fn run(name: &str) -> ExitCode {
    let sections = sections();
    let mut text = String::new();
    if name.is_empty() {
        let mut class = "";
        for section in &sections {
            if section.class != class {
                class = section.class;
                text += &format!("\n{class}\n");
            }
            let is = section.text.lines().nth(2).unwrap_or_default();
            text += &format!("  {:<24} {is}\n", section.names.join(", "));
        }
        text += "\n`etalon info --plugins NAME` tells the parameters of one.\n";
        return answer(text.trim_start_matches('\n'), ExitCode::SUCCESS);
    }
    for section in sections
        .iter()
        .filter(|section| section.names.contains(&name))
    {
        text += &format!("{}: {}\n", section.class, section.text.trim_end());
    }
    if !text.is_empty() {
        return answer(&text, ExitCode::SUCCESS);
    }
    let names = sections
        .iter()
        .flat_map(|section| section.names.iter().copied());
    let near = plugins::called_otherwise(name)
        .filter(|ours| names.clone().any(|name| name == *ours))
        .or_else(|| suggest::nearest(name, names))
        .map(|near| format!("; did you mean `{near}`?"))
        .unwrap_or_default();
    fail(format!("no plugin is called `{name}`{near}"))
}
