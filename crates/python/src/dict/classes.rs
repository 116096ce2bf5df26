//! The class of a plugin by its name alone: a dict says `sphere`, where XML says `<shape type="sphere">`.

use etalon_params::{Class, Diagnostic, plugins, suggest};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// All plugins that are built, of which tests know that the list is complete.
const WORDS: &str = include_str!("../../plugins.toml");

/// What is taken of the list.
#[derive(Deserialize)]
struct Words {
    plugin: Vec<Plugin>,
}

#[derive(Deserialize)]
struct Plugin {
    class: String,
    names: Vec<String>,
}

/// Name and class of every plugin that is built; of a name that two classes have, the class that is meant without further signs.
fn built() -> &'static BTreeMap<String, Class> {
    static BUILT: OnceLock<BTreeMap<String, Class>> = OnceLock::new();
    BUILT.get_or_init(|| {
        let words: Words = toml::from_str(WORDS).expect("a test reads it");
        let mut built = BTreeMap::new();
        for plugin in words.plugin {
            let mut classes = plugins::CLASSES.into_iter();
            let Some(class) = classes.find(|class| class.name() == plugin.class) else {
                continue;
            };
            for name in plugin.names {
                // A texture of space is a volume, too; and most hair is the material.
                let first = built.entry(name).or_insert(class);
                *first = (*first).min(class);
            }
        }
        built
    })
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
    let built = built().get(name).copied();
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
