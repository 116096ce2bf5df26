//! `docs/mitsuba-compatibility.md` and `docs/mitsuba-0.6.md`: which plugins and parameters of Mitsuba 3 and 0.6 load, found out
//! by loading each of them.
//!
//! `docs/mitsuba.txt` and `docs/mitsuba-0.6.txt` list them; every one is put into the smallest scene that can hold it.
//! `cargo xtask plugins` writes the pages, and tests keep them true.

use crate::load::{CLASSES, load_as, turn};
use etalon_formats::mitsuba::underscored;
use etalon_params::{Class, ignored};
use etalon_validation::folders;
use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

/// A version of Mitsuba and its page.
pub(crate) struct Version {
    /// What its scenes call it.
    number: &'static str,
    /// The list of its plugins, and the page, without their folder.
    list: &'static str,
    page: &'static str,
    title: &'static str,
    /// What the page begins with.
    words: &'static str,
}

/// Mitsuba 3.
pub(crate) const MITSUBA_3: Version = Version {
    number: "3.0.0",
    list: "mitsuba.txt",
    page: "mitsuba-compatibility.md",
    title: "Plugins of Mitsuba 3.9, and what becomes of them",
    words: "Parameters that take a texture in Mitsuba are given one. What is read\n\
            differently is told in [known-differences.md](known-differences.md).\n",
};

/// Mitsuba 0.6.
pub(crate) const MITSUBA_06: Version = Version {
    number: "0.6.0",
    list: "mitsuba-0.6.txt",
    page: "mitsuba-0.6.md",
    title: "Plugins of Mitsuba 0.6, and what becomes of them",
    words: "Every parameter of Mitsuba 0.6 is read, changes nothing here (\"no effect\", see\n\
            [ignored-parameters.md](ignored-parameters.md)), or is refused; one that 0.6 does not have is an error.\n",
};

impl Version {
    /// The page's place.
    pub(crate) fn page(&self) -> PathBuf {
        folders::root().join("docs").join(self.page)
    }
}

/// A plugin with what it needs, and its parameters with an element each.
struct Plugin {
    class: Class,
    surroundings: &'static str,
    name: String,
    needs: String,
    parameters: Vec<(String, String)>,
}

fn read(text: &str) -> Result<Vec<Plugin>, String> {
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines
        .map(|line| plugin(line).ok_or_else(|| format!("docs/mitsuba.txt: {line}")))
        .collect()
}

fn plugin(line: &str) -> Option<Plugin> {
    let (title, rest) = line.split_once(':')?;
    let (class, name) = title.split_once(' ')?;
    let (needs, mut rest) = rest.split_once('|')?;
    let &(class, _, surroundings) = CLASSES.iter().find(|(of, ..)| of.name() == class)?;
    let mut parameters = Vec::new();
    while !rest.trim().is_empty() {
        rest = rest.trim_start();
        let end = if rest.starts_with('<') {
            rest.find("/>")? + 2
        } else {
            rest.find(' ').unwrap_or(rest.len())
        };
        let (token, after) = rest.split_at(end);
        parameters.push(parameter(token)?);
        rest = after;
    }
    Some(Plugin {
        class,
        surroundings,
        name: name.to_owned(),
        needs: needs.trim().to_owned(),
        parameters,
    })
}

/// A parameter's name, and its element.
fn parameter(token: &str) -> Option<(String, String)> {
    if let Some(element) = token.strip_prefix('<') {
        let class = element.split([' ', '/']).next()?;
        return Some((format!("nested {class}"), token.to_owned()));
    }
    let (kind, rest) = token.split_once(':')?;
    let (names, value) = rest.split_once('=').unwrap_or((rest, ""));
    let elements: Vec<String> = names
        .split(',')
        .map(|name| match kind {
            "b" => format!("<boolean name=\"{name}\" value=\"{value}\"/>"),
            "f" => format!("<float name=\"{name}\" value=\"{value}\"/>"),
            "i" => format!("<integer name=\"{name}\" value=\"{value}\"/>"),
            "v" => format!("<vector name=\"{name}\" value=\"{value}\"/>"),
            // The corners of a box.
            "c" if name == "min" => format!("<vector name=\"{name}\" value=\"0\"/>"),
            "c" => format!("<vector name=\"{name}\" value=\"{value}\"/>"),
            "q" => format!("<spectrum name=\"{name}\" value=\"0.5\"/>"),
            // Which says nothing without `fov`.
            "s" if name == "fov_axis" => {
                "<float name=\"fov\" value=\"40\"/><string name=\"fov_axis\" value=\"x\"/>"
                    .to_owned()
            }
            "r" => format!("<rgb name=\"{name}\" value=\"0.2, 0.3, 0.4\"/>"),
            "x" => format!("<texture type=\"checkerboard\" name=\"{name}\"/>"),
            "m" => format!("<transform name=\"{name}\"><scale value=\"1\"/></transform>"),
            _ => format!("<string name=\"{name}\" value=\"{value}\"/>"),
        })
        .collect();
    Some((names.replace(',', "`, `"), elements.concat()))
}

/// The page.
pub(crate) fn text(version: &Version) -> Result<String, String> {
    let _turn = turn();
    let path = folders::root().join("docs").join(version.list);
    let list = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    let plugins = read(&list)?;
    let mut out = format!(
        "# {}\n\n\
         Written by `cargo xtask plugins`, which puts each plugin and each parameter into the smallest scene that can hold it, and\n\
         loads that; a test keeps the page true. {}",
        version.title, version.words
    );
    let (mut whole, mut all) = (0, 0);
    for (class, title, _) in CLASSES {
        let _ = write!(
            out,
            "\n## {title}\n\n| plugin | | parameters that load | those that do not |\n|---|---|---|---|\n"
        );
        for plugin in plugins.iter().filter(|plugin| plugin.class == class) {
            let row = row(plugin, version.number);
            whole += usize::from(row.1);
            all += 1;
            out.push_str(&row.0);
        }
    }
    let _ = write!(out, "\n{whole} of {all} plugins load.\n");
    Ok(out)
}

/// A plugin's line, and whether it loads.
fn row(plugin: &Plugin, version: &str) -> (String, bool) {
    let (class, name) = (plugin.class.name(), &plugin.name);
    let role = match plugin.class {
        Class::Texture => " name=\"reflectance\"",
        Class::Volume => " name=\"albedo\"",
        Class::Medium => " name=\"interior\"",
        _ => "",
    };
    let said = |parameter: &str| {
        let element = format!(
            "<{class} type=\"{name}\"{role}>{}{parameter}</{class}>",
            plugin.needs
        );
        load_as(version, plugin.surroundings, &element)
    };
    let bare = said("");
    if let Some(message) = bare.iter().find(|m| m.contains("not built yet")) {
        let instead = message
            .split_once(" (instead: ")
            .map(|(_, help)| help.trim_end_matches(')'));
        let instead = instead.map(|help| format!("; {help}")).unwrap_or_default();
        return (
            format!("| `{name}` | not built yet{instead} | | |\n"),
            false,
        );
    }
    let (mut fine, mut refused) = (Vec::new(), Vec::new());
    for (parameter, element) in &plugin.parameters {
        let reasons: Vec<String> = said(element)
            .into_iter()
            .filter(|message| !bare.contains(message))
            .collect();
        let ignored = ignored::entry(plugin.class, name, &underscored(parameter)).is_some();
        match reasons.first() {
            None if ignored => fine.push(format!("`{parameter}` (no effect)")),
            None => fine.push(format!("`{parameter}`")),
            Some(reason) => refused.push(format!("`{parameter}`: {}", without_places(reason))),
        }
    }
    let status = match bare.first() {
        None => "loads".to_owned(),
        Some(reason) => format!("loads where it can: {}", without_places(reason)),
    };
    let line = format!(
        "| `{name}` | {status} | {} | {} |\n",
        fine.join(", "),
        refused.join("; ")
    );
    (line, true)
}

/// A message without what may help, which may name folders.
fn without_places(message: &str) -> &str {
    message
        .split_once(" (")
        .map_or(message, |(message, _)| message)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pages_of_mitsubas_plugins_are_up_to_date() {
        for version in [MITSUBA_3, MITSUBA_06] {
            let page = fs::read_to_string(version.page()).expect("the page is there");
            let text = text(&version).expect("the list is well-formed");
            assert!(
                page == text,
                "`cargo xtask plugins` writes docs/{} anew",
                version.page
            );
        }
    }

    #[test]
    fn no_parameter_of_mitsuba_06_is_unknown() {
        let page = fs::read_to_string(MITSUBA_06.page()).expect("the page is there");
        let unknown = page.lines().find(|line| line.contains("has no parameter"));
        assert_eq!(unknown, None);
    }
}
