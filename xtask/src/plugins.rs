//! `cargo xtask plugins`: writes `docs/scene-format.md`, the reference of every plugin and parameter.
//!
//! What there is, of which kind and with which default, is asked of the code: every example of `docs/plugins.toml` is
//! read, and what its plugin asks for meanwhile is noted ([`etalon_params::questions`]). The file adds words. A test
//! keeps the two together: no plugin and no parameter may lack words, no words may lack a plugin or parameter.

use crate::compatibility::{self, MITSUBA_3, MITSUBA_06};
use crate::gallery::stages::Stages;
use crate::hearing::{Heard, Hearing};
use crate::load::{CLASSES, load, turn};
use crate::schema::{relax_ng, xsd};
use crate::words::{Plugin, Words};
use etalon_params::{Class, ignored};
use etalon_validation::folders;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

/// The page's place.
pub(crate) fn page() -> PathBuf {
    folders::root().join("docs/scene-format.md")
}

/// The pages and schemas that say what plugins ask for.
fn pages() -> Result<Vec<(PathBuf, String)>, String> {
    let words = Words::read()?;
    let (all, wrong) = heard(&words);
    let schemas = folders::root().join("docs/schema");
    Ok(vec![
        (page(), text(&words, &all, wrong)?),
        (schemas.join("etalon.rng"), relax_ng::schema(&all)),
        (schemas.join("etalon.xsd"), xsd::schema(&all)),
    ])
}

/// Writes the pages.
pub(crate) fn run() -> Result<(), String> {
    for (path, text) in pages()? {
        fs::write(&path, text).map_err(|e| format!("{}: {e}", path.display()))?;
        println!("{}", path.display());
    }
    for version in [MITSUBA_3, MITSUBA_06] {
        let path = version.page();
        let text = compatibility::text(&version)?;
        fs::write(&path, text).map_err(|e| format!("{}: {e}", path.display()))?;
        println!("{}", path.display());
    }
    let path = folders::root().join("docs/ignored-parameters.md");
    fs::write(&path, ignored::markdown()).map_err(|e| format!("{}: {e}", path.display()))?;
    println!("{}", path.display());
    Ok(())
}

/// The plugins of a class, which the message about an unknown one lists.
fn built(class: Class, surroundings: &str) -> BTreeSet<String> {
    let name = match class {
        Class::Texture => "reflectance",
        Class::Volume => "albedo",
        _ => "",
    };
    let element = format!("<{} type=\"qqqqqqqq\" name=\"{name}\"/>", class.name());
    let said = load(surroundings, &element).join("\n");
    let list = ["built: ", "accepted: "]
        .into_iter()
        .find_map(|before| said.split(before).nth(1));
    let list = list.unwrap_or_default();
    let list = list.split([';', ')', '\n']).next().unwrap_or_default();
    list.split(", ")
        .filter(|name| !name.is_empty())
        .map(str::to_owned)
        .collect()
}

/// Plugins with the same words, and what they ask for.
pub(crate) struct Described<'a> {
    pub(crate) class: Class,
    pub(crate) plugin: &'a Plugin,
    pub(crate) rows: BTreeMap<String, Heard>,
}

/// What all plugins ask for, in the order of the page, and what is wrong with their words.
pub(crate) fn heard(words: &Words) -> (Vec<Described<'_>>, Vec<String>) {
    let _turn = turn();
    let (mut all, mut wrong) = (Vec::new(), Vec::new());
    for (class, _, surroundings) in CLASSES {
        let mut undescribed = built(class, surroundings);
        let of_class = words
            .plugin
            .iter()
            .filter(|plugin| plugin.class == class.name());
        for plugin in of_class {
            let mut rows: BTreeMap<String, Heard> = BTreeMap::new();
            let surroundings = plugin.scene.as_deref().unwrap_or(surroundings);
            for name in &plugin.names {
                if !undescribed.remove(name) {
                    wrong.push(format!("{} `{name}` is not built", class.name()));
                }
                let example = plugin.example.replace("NAME", name);
                let mut hearing = Hearing::new(class, name, surroundings);
                let said = hearing.read(&example);
                if plugin.loads && !said.is_empty() {
                    wrong.push(format!("the example of `{name}`: {}", said.join("; ")));
                }
                for probe in &plugin.probes {
                    hearing.read(&probe.replace("NAME", name));
                }
                hearing.read(&format!("<{} type=\"{name}\"/>", class.name()));
                for (parameter, heard) in hearing.in_all_branches(&example) {
                    rows.entry(parameter).or_default().and(&heard);
                }
            }
            all.push(Described {
                class,
                plugin,
                rows,
            });
        }
        wrong.extend(
            undescribed
                .into_iter()
                .map(|name| format!("{} `{name}` has no words", class.name())),
        );
    }
    (all, wrong)
}

/// The page of what was heard.
pub(crate) fn text(
    words: &Words,
    all: &[Described<'_>],
    mut wrong: Vec<String>,
) -> Result<String, String> {
    let stages = Stages::read()?;
    let mut unused: BTreeSet<&str> = words.parameters.keys().map(String::as_str).collect();
    let mut out = String::from(
        "# The scene format\n\n\
         A scene is Mitsuba 3 XML. This page lists every plugin and every parameter that is built, as `etalon info --plugins`\n\
         does; it is written by `cargo xtask plugins` from what the code asks for. What goes beyond Mitsuba is told at more length\n\
         in [extensions.md](extensions.md); what moves, in [animation.md](animation.md). Lengths are metres, angles degrees,\n\
         wavelengths nanometres. Parameters without a default may be left out unless they are required. Editors may be given\n\
         [etalon.xsd](schema/etalon.xsd); [etalon.rng](schema/etalon.rng) is RELAX NG, and knows the parameters of each plugin.\n",
    );
    for (class, title, _) in CLASSES {
        let _ = write!(out, "\n## {title}\n");
        for described in all.iter().filter(|described| described.class == class) {
            describe(
                &mut out,
                (described.plugin, stages.pictures(described.plugin)),
                &described.rows,
                &words.parameters,
                &mut unused,
                &mut wrong,
            );
        }
    }
    wrong.extend(
        unused
            .into_iter()
            .map(|name| format!("no plugin has the parameter `{name}`")),
    );
    if wrong.is_empty() {
        Ok(out)
    } else {
        Err(wrong.join("\n"))
    }
}

fn describe<'a>(
    out: &mut String,
    (plugin, pictures): (&Plugin, Vec<String>),
    rows: &BTreeMap<String, Heard>,
    common: &'a BTreeMap<String, String>,
    unused: &mut BTreeSet<&'a str>,
    wrong: &mut Vec<String>,
) {
    let _ = write!(
        out,
        "\n### `{}`\n\n{}.\n\n",
        plugin.names.join("`, `"),
        plugin.is
    );
    for (name, picture) in plugin.names.iter().zip(&pictures) {
        let _ = writeln!(out, "![`{name}`](gallery/{picture}.jpg)");
    }
    if !pictures.is_empty() {
        out.push('\n');
    }
    let mut missing: BTreeSet<&str> = plugin.parameters.keys().map(String::as_str).collect();
    let described: Vec<(&str, &Heard, &str)> = (rows.iter())
        .filter_map(|(name, heard)| {
            let name = name.as_str();
            missing.remove(name);
            let words = match plugin.parameters.get(name) {
                Some(words) => words,
                None => {
                    let found = common.get_key_value(name);
                    let Some((key, words)) = found else {
                        if !name.starts_with('<') {
                            wrong.push(format!("`{name}` of `{}` has no words", plugin.names[0]));
                        }
                        return None;
                    };
                    unused.remove(key.as_str());
                    words
                }
            };
            // A parameter that is but refused with a better message than others.
            (words != "-").then_some((name, heard, words.as_str()))
        })
        .collect();
    wrong.extend(
        missing
            .into_iter()
            .map(|name| format!("`{}` has no parameter `{name}`", plugin.names[0])),
    );
    if !described.is_empty() {
        out.push_str("| parameter | kind | default | |\n|---|---|---|---|\n");
    }
    let mut depending: BTreeSet<&str> = plugin.defaults.keys().map(String::as_str).collect();
    for (name, heard, words) in described {
        let question = &heard.question;
        let nested = name.starts_with('<');
        let kind = match question.kind.noun() {
            "" => (question.accepted.trim_start_matches("an ")).trim_start_matches("a "),
            noun => noun,
        };
        let accepted = match question.accepted.as_str() {
            "" => String::new(),
            accepted if accepted.contains(kind) || kind.is_empty() => String::new(),
            accepted => format!("; {accepted}"),
        };
        let default = (plugin.defaults.get(name).cloned()).or_else(|| heard.what_holds());
        let default = default.unwrap_or_else(|| {
            let plugin = &plugin.names[0];
            wrong.push(format!(
                "what holds without `{name}` of `{plugin}` takes words: {:?}",
                heard.defaults
            ));
            String::new()
        });
        depending.remove(name);
        let shown = if nested {
            format!("a nested {}", name.trim_matches(['<', '>']))
        } else {
            format!("`{name}`")
        };
        let kind = if nested { "" } else { kind };
        let _ = writeln!(out, "| {shown} | {kind} | {default} | {words}{accepted} |");
    }
    wrong.extend(
        (depending.into_iter())
            .map(|name| format!("`{}` has no default of `{name}`", plugin.names[0])),
    );
    if let Some(array) = plugin.file {
        let form = array.described();
        let _ = write!(
            out,
            "\nPython may give an array, `data` ({form}), in place of the file.\n"
        );
    }
    let _ = write!(
        out,
        "\n```xml\n{}\n```\n",
        plugin.example.replace("NAME", &plugin.names[0])
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every plugin and parameter has its words and its example loads; the page and the schemas are what the code says.
    #[test]
    fn the_page_of_the_scene_format_is_up_to_date() {
        for (path, text) in pages().unwrap_or_else(|wrong| panic!("{wrong}")) {
            let there = fs::read_to_string(&path).expect("it is there");
            assert!(
                there == text,
                "`cargo xtask plugins` writes {} anew",
                path.display()
            );
        }
    }
}
