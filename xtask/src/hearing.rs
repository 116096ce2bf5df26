//! What a plugin asks for in all branches of its reading.
//!
//! Words, truth values and parameters that need not be there decide what else is asked. So an element is read again with
//! each word of each choice, with both truth values, and with every parameter of which only the presence was asked.

use crate::load::load;
use etalon_params::questions::{self, Question, Questions};
use etalon_params::{Class, ParameterKind};
use std::collections::{BTreeMap, BTreeSet};

/// A plugin's parameters, as they were asked for.
pub(crate) struct Hearing<'a> {
    of: (Class, &'a str),
    surroundings: &'a str,
    parameters: BTreeMap<String, Heard>,
    tried: BTreeSet<String>,
}

/// What was heard of a parameter.
#[derive(Clone, Default)]
pub(crate) struct Heard {
    pub(crate) question: Question,
    /// Every kind that its value may be of.
    pub(crate) kinds: BTreeSet<ParameterKind>,
    /// The defaults that hold if it is not given.
    pub(crate) defaults: BTreeSet<String>,
    /// A default said where it was given, which may hold nowhere.
    said: String,
    /// Whether something could be read without it.
    pub(crate) can_be_left_out: bool,
}

impl Heard {
    /// The same, and what was heard elsewhere.
    pub(crate) fn and(&mut self, other: &Self) {
        if self.question.kind == ParameterKind::Unsaid {
            self.question.kind = other.question.kind;
        }
        for (known, new) in [
            (&mut self.question.accepted, &other.question.accepted),
            (&mut self.said, &other.said),
        ] {
            if known.is_empty() {
                known.clone_from(new);
            }
        }
        self.kinds.extend(&other.kinds);
        self.question.required |= other.question.required;
        self.defaults.extend(other.defaults.iter().cloned());
        self.can_be_left_out |= other.can_be_left_out;
    }

    /// The default, or `None` if what happens without the parameter depends on others, and takes words.
    pub(crate) fn what_holds(&self) -> Option<String> {
        let mut defaults = self.defaults.iter();
        let first = defaults.next().unwrap_or(&self.said);
        match (self.question.required, first.is_empty()) {
            (true, _) if !self.can_be_left_out => Some("required".to_owned()),
            (true, _) => None,
            (false, _) => defaults.next().is_none().then(|| first.clone()),
        }
    }
}

/// An element of the plugin with a further property; `None` if it has that already.
fn with(element: &str, plugin: &str, tag: &str, name: &str, value: &str) -> Option<String> {
    if gives(element, name) {
        return None;
    }
    let start = element.find(&format!("type=\"{plugin}\""))?;
    let open = element[..start].rfind('<')?;
    let end = start + element[start..].find('>')?;
    let property = format!("<{tag} name=\"{name}\" value=\"{value}\"/>");
    let (before, after) = element.split_at(end + 1);
    Some(match before.strip_suffix("/>") {
        Some(before) => {
            let tag = element[open + 1..start].split_whitespace().next()?;
            format!("{before}>{property}</{tag}>{after}")
        }
        None => format!("{before}{property}{after}"),
    })
}

fn gives(element: &str, name: &str) -> bool {
    element.contains(&format!("name=\"{name}\""))
}

impl<'a> Hearing<'a> {
    /// Of a plugin whose elements stand in these surroundings.
    pub(crate) fn new(class: Class, plugin: &'a str, surroundings: &'a str) -> Self {
        Self {
            of: (class, plugin),
            surroundings,
            parameters: BTreeMap::new(),
            tried: BTreeSet::new(),
        }
    }

    /// Reads an element, and gives back what was wrong.
    pub(crate) fn read(&mut self, element: &str) -> Vec<String> {
        let (said, asked) = questions::record(|| load(self.surroundings, element));
        self.hear(element, &asked, said.is_empty(), true);
        said
    }

    fn hear(&mut self, element: &str, asked: &Questions, is_read: bool, is_written: bool) {
        for ((class, plugin, name), question) in asked {
            if (*class, plugin.as_str()) != self.of {
                continue;
            }
            let default = question.default.clone();
            let mut heard = Heard {
                kinds: BTreeSet::from([question.kind]),
                question: Question {
                    default: String::new(),
                    ..question.clone()
                },
                ..Heard::default()
            };
            if !gives(element, name) {
                heard
                    .defaults
                    .extend((!default.is_empty()).then_some(default));
            } else if is_written {
                heard.said = default;
            }
            self.parameters.entry(name.clone()).or_default().and(&heard);
        }
        for (name, heard) in &mut self.parameters {
            heard.can_be_left_out |= is_read && !gives(element, name);
        }
    }

    /// Reads variants of the element until nothing new is asked, and says what was heard in all.
    pub(crate) fn in_all_branches(mut self, element: &str) -> BTreeMap<String, Heard> {
        loop {
            let variants: Vec<String> = (self.parameters.iter())
                .flat_map(|(name, heard)| self.variants(element, name, &heard.question))
                .filter(|variant| !self.tried.contains(variant))
                .collect();
            if variants.is_empty() {
                return self.parameters;
            }
            for variant in variants {
                let (said, asked) = questions::record(|| load(self.surroundings, &variant));
                self.hear(&variant, &asked, said.is_empty(), false);
                self.tried.insert(variant);
            }
        }
    }

    fn variants(&self, element: &str, name: &str, question: &Question) -> Vec<String> {
        let with = |tag: &str, value: &str| with(element, self.of.1, tag, name, value);
        let accepted = question.accepted.as_str();
        let variants: Vec<Option<String>> = match question.kind {
            ParameterKind::String if accepted.starts_with('`') => {
                (accepted.split('`').skip(1).step_by(2))
                    .map(|word| with("string", word))
                    .collect()
            }
            ParameterKind::Boolean => ["true", "false"].map(|value| with("boolean", value)).into(),
            ParameterKind::Unsaid if !name.starts_with('<') => vec![with("float", "1")],
            _ => Vec::new(),
        };
        variants.into_iter().flatten().collect()
    }
}
