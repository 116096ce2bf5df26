//! `cargo xtask plugins`: writes `docs/scene-format.md`, the reference of every plugin and parameter.
//!
//! What there is, of which kind and with which default, is asked of the code: every example of `docs/plugins.toml` is
//! read, and what its plugin asks for meanwhile is noted ([`etalon_params::questions`]). The file adds words. A test
//! keeps the two together: no plugin and no parameter may lack words, no words may lack a plugin or parameter.

use crate::compatibility::{self, MITSUBA_3, MITSUBA_06};
use crate::gallery::stages::Stages;
use crate::hearing::{Heard, Hearing};
use etalon_params::{Class, Severity, ignored};
use etalon_render::pipeline::{self, LoadOptions};
use etalon_validation::folders;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard};

/// `docs/plugins.toml`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Words {
    /// What parameters of a name are, whatever the plugin.
    parameters: BTreeMap<String, String>,
    /// All plugins, in the order of the page.
    pub(crate) plugin: Vec<Plugin>,
}

impl Words {
    /// Reads the file.
    pub(crate) fn read() -> Result<Self, String> {
        let path = folders::root().join("docs/plugins.toml");
        let words = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
        toml::from_str(&words).map_err(|e| format!("{}: {e}", path.display()))
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Plugin {
    pub(crate) class: String,
    /// The name; several plugins with the same parameters share their words.
    pub(crate) names: Vec<String>,
    /// What it is.
    is: String,
    /// An element of a scene, which must load; `NAME` stands for the plugin's name.
    pub(crate) example: String,
    /// What the gallery shows, if not the example.
    pub(crate) picture: Option<String>,
    /// The class on whose stage it is shown, if not its own.
    pub(crate) pictured_as: Option<String>,
    /// How much brighter its picture is shown (stops).
    pub(crate) exposure: Option<f32>,
    /// Why there is no picture of it.
    pub(crate) unpictured: Option<String>,
    /// The scene around the example, where that of its class does not do.
    scene: Option<String>,
    /// Whether the example loads: not if it names a file that is not here.
    #[serde(default = "yes")]
    loads: bool,
    /// Further elements, for parameters that are asked for in some circumstances only. They need not load.
    #[serde(default)]
    probes: Vec<String>,
    /// Words for parameters, where those for all plugins do not fit.
    #[serde(default)]
    parameters: BTreeMap<String, String>,
    /// What holds without a parameter, where that depends on others.
    #[serde(default)]
    defaults: BTreeMap<String, String>,
}

fn yes() -> bool {
    true
}

/// The classes that have plugins, in the order of the page, with their titles and the scene around an element.
pub(crate) const CLASSES: [(Class, &str, &str); 13] = [
    (
        Class::Integrator,
        "Integrators",
        "ELEMENT<sensor type='perspective'/>",
    ),
    (Class::Sensor, "Sensors", "ELEMENT"),
    (
        Class::Film,
        "Films",
        "<sensor type='perspective'>ELEMENT</sensor>",
    ),
    (
        Class::ReconstructionFilter,
        "Reconstruction filters",
        "<sensor type='perspective'><film type='hdrfilm'>ELEMENT</film></sensor>",
    ),
    (
        Class::Sampler,
        "Samplers",
        "<sensor type='perspective'>ELEMENT</sensor>",
    ),
    (
        Class::Shape,
        "Shapes",
        "<sensor type='perspective'/>ELEMENT",
    ),
    (
        Class::Bsdf,
        "BSDFs",
        "<sensor type='perspective'/><shape type='sphere'>ELEMENT</shape>",
    ),
    (
        Class::Subsurface,
        "Below surfaces",
        "<sensor type='perspective'/><integrator type='volpath'/><shape type='sphere'>ELEMENT</shape>",
    ),
    (
        Class::Emitter,
        "Emitters",
        "<sensor type='perspective'/><shape type='sphere'><transform name='to_world'><translate z='5'/></transform></shape>ELEMENT",
    ),
    (
        Class::Texture,
        "Textures and spectra",
        "<sensor type='perspective'/><shape type='obj'><string name='filename' value='files/ball.obj'/><bsdf type='diffuse'>ELEMENT</bsdf></shape>",
    ),
    (
        Class::Medium,
        "Media",
        "<sensor type='perspective'/><integrator type='volpath'/><shape type='sphere'><bsdf type='null'/>ELEMENT</shape>",
    ),
    (
        Class::Phase,
        "Phase functions",
        "<sensor type='perspective'/><integrator type='volpath'/><shape type='sphere'><bsdf type='null'/><medium type='heterogeneous' name='interior'>ELEMENT</medium></shape>",
    ),
    (
        Class::Volume,
        "Volumes",
        "<sensor type='perspective'/><integrator type='volpath'/><shape type='sphere'><bsdf type='null'/><medium type='heterogeneous' name='interior'>ELEMENT</medium></shape>",
    ),
];

/// The page's place.
pub(crate) fn page() -> PathBuf {
    folders::root().join("docs/scene-format.md")
}

/// Writes the page.
pub(crate) fn run() -> Result<(), String> {
    let path = page();
    fs::write(&path, text()?).map_err(|e| format!("{}: {e}", path.display()))?;
    println!("{}", path.display());
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

/// What is asked is noted for the whole program, and scenes are loaded from one file: one page at a time.
static TURN: Mutex<()> = Mutex::new(());

/// Waits for the turn to make a page.
pub(crate) fn turn() -> MutexGuard<'static, ()> {
    TURN.lock().unwrap_or_else(|e| e.into_inner())
}

/// Loads a scene with an element in its place, and gives back what was wrong.
pub(crate) fn load(surroundings: &str, element: &str) -> Vec<String> {
    load_as("3.0.0", surroundings, element)
}

/// The same with a scene of this version.
pub(crate) fn load_as(version: &str, surroundings: &str, element: &str) -> Vec<String> {
    // Lights of shapes stand in one; a beam is seen by integrators that follow it.
    let is = |name: &str| element.contains(&format!("type=\"{name}\""));
    let surroundings = match surroundings {
        _ if is("directionalarea") => {
            "<integrator type='ptracer'/><sensor type='perspective'/><shape type='sphere'>ELEMENT</shape>"
        }
        _ if is("area") => "<sensor type='perspective'/><shape type='sphere'>ELEMENT</shape>",
        surroundings => surroundings,
    };
    let scene = format!(
        "<scene version=\"{version}\">{}</scene>",
        surroundings.replace("ELEMENT", element)
    );
    let folder = std::env::temp_dir();
    let path = folder.join(format!("etalon-plugins-{}.xml", std::process::id()));
    if let Err(error) = fs::write(&path, scene) {
        return vec![error.to_string()];
    }
    let options = LoadOptions {
        data: vec![folders::scenes()],
        ..LoadOptions::default()
    };
    let loaded = pipeline::load(&path, &options);
    let _ = fs::remove_file(&path);
    match loaded {
        Ok(_) => Vec::new(),
        Err(refusal) => (refusal.diagnostics.into_iter())
            .filter(|d| d.severity == Severity::Error)
            .map(|d| d.message + &d.help.map_or(String::new(), |help| format!(" ({help})")))
            .collect(),
    }
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

/// The page.
pub(crate) fn text() -> Result<String, String> {
    let _turn = turn();
    let words = Words::read()?;
    let stages = Stages::read()?;
    let mut wrong = Vec::new();
    let mut unused: BTreeSet<&str> = words.parameters.keys().map(String::as_str).collect();
    let mut out = String::from(
        "# The scene format\n\n\
         A scene is Mitsuba 3 XML. This page lists every plugin and every parameter that is built, as `etalon info --plugins`\n\
         does; it is written by `cargo xtask plugins` from what the code asks for. What goes beyond Mitsuba is told at more length\n\
         in [extensions.md](extensions.md); what moves, in [animation.md](animation.md). Lengths are metres, angles degrees,\n\
         wavelengths nanometres. Parameters without a default may be left out unless they are required.\n",
    );
    for (class, title, surroundings) in CLASSES {
        let mut undescribed = built(class, surroundings);
        let _ = write!(out, "\n## {title}\n");
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
            describe(
                &mut out,
                (plugin, stages.pictures(plugin)),
                &rows,
                &words.parameters,
                &mut unused,
                &mut wrong,
            );
        }
        wrong.extend(
            undescribed
                .into_iter()
                .map(|name| format!("{} `{name}` has no words", class.name())),
        );
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
        let kind = match question.kind.as_str() {
            "" if question.accepted.is_empty() => "",
            "" => question.accepted.as_str(),
            kind => kind,
        };
        let kind = kind.trim_start_matches("an ").trim_start_matches("a ");
        let kind = kind.replace(" (`true` or `false`)", "");
        let accepted = match question.accepted.as_str() {
            "" => String::new(),
            accepted if accepted.contains(&kind) || kind.is_empty() => String::new(),
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
        let kind = if nested { String::new() } else { kind };
        let _ = writeln!(out, "| {shown} | {kind} | {default} | {words}{accepted} |");
    }
    wrong.extend(
        (depending.into_iter())
            .map(|name| format!("`{}` has no default of `{name}`", plugin.names[0])),
    );
    let _ = write!(
        out,
        "\n```xml\n{}\n```\n",
        plugin.example.replace("NAME", &plugin.names[0])
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every plugin and parameter has its words and its example loads; the page is what the code says.
    #[test]
    fn the_page_of_the_scene_format_is_up_to_date() {
        let text = text().unwrap_or_else(|wrong| panic!("{wrong}"));
        let page = fs::read_to_string(page()).expect("the page is there");
        assert!(
            page == text,
            "`cargo xtask plugins` writes docs/scene-format.md anew"
        );
    }
}
