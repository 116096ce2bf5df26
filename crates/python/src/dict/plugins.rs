//! The class of a plugin by its name alone: a dict says `sphere`, where XML says `<shape type="sphere">`.

use super::file_arrays::FileArray;
use etalon_params::{Class, Diagnostic, plugins, suggest};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// All plugins that are built, of which tests know that the list is complete.
const WORDS: &str = include_str!("../../plugins.toml");

/// What is taken of the list.
#[derive(Deserialize)]
struct Words {
    plugin: Vec<Listed>,
}

#[derive(Deserialize)]
struct Listed {
    class: String,
    names: Vec<String>,
    file: Option<FileArray>,
}

/// What is known of a plugin by its name.
#[derive(Clone, Copy)]
pub(super) struct Plugin {
    class: Class,
    /// What its file holds, if an array may stand in its place.
    pub(super) file: Option<FileArray>,
}

/// Every plugin that is built; of a name that two classes have, the one that is meant without further signs.
fn built() -> &'static BTreeMap<String, Plugin> {
    static BUILT: OnceLock<BTreeMap<String, Plugin>> = OnceLock::new();
    BUILT.get_or_init(|| {
        let words: Words = toml::from_str(WORDS).expect("a test reads it");
        let mut built: BTreeMap<String, Plugin> = BTreeMap::new();
        for Listed { class, names, file } in words.plugin {
            let mut classes = plugins::CLASSES.into_iter();
            let Some(class) = classes.find(|known| known.name() == class) else {
                continue;
            };
            for name in names {
                // A texture of space is a volume, too; and most hair is the material.
                let plugin = Plugin { class, file };
                let first = built.entry(name).or_insert(plugin);
                if class < first.class {
                    *first = plugin;
                }
            }
        }
        built
    })
}

/// The plugin `name`, if it is built.
pub(super) fn plugin(name: &str) -> Option<Plugin> {
    built().get(name).copied()
}

/// The class of the plugin `name`, which has a `filename` or not.
pub(super) fn class(name: &str, has_filename: bool) -> Option<Class> {
    // The shape is read from a file, the material is not.
    if name == "hair" && has_filename {
        return Some(Class::Shape);
    }
    let is_known = |class: &Class| {
        use plugins::Status::{Mitsuba3, Mitsuba06};
        matches!(plugins::status(*class, name), Mitsuba3 | Mitsuba06)
    };
    let built = plugin(name).map(|plugin| plugin.class);
    built.or_else(|| plugins::CLASSES.into_iter().find(is_known))
}

/// The message about a name that no class has.
pub(super) fn unknown(name: &str) -> Diagnostic {
    let others = [
        "scene",
        "rgb",
        "spectrum",
        "ref",
        "mesh",
        "resources",
        "animation",
    ];
    let names = || built().keys().map(String::as_str).chain(others);
    let near = plugins::called_otherwise(name).or_else(|| suggest::nearest(name, names()));
    let diagnostic = Diagnostic::error_nowhere(format!("there is no plugin `{name}`"));
    match near {
        Some(near) => diagnostic.help(format!("did you mean `{near}`?")),
        None => diagnostic.help("docs/scene-format.md lists all"),
    }
}
