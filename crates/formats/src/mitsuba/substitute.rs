//! `$name` in attribute values.
//!
//! A value comes from `-D name=value` or, failing that, from the first `<default>` of that name
//! that stands before its use. At each `$` the longest known name wins (`$sppx` is `$spp`
//! followed by an `x` unless `sppx` is known); `\$` is a dollar sign. What was inserted is not
//! looked at again.
//!
//! `<default>`s whose values contain each other's names can double with every line. What they may
//! grow to is therefore bounded: [`LONGEST_VALUE`] for one value, [`MOST_INSERTED`] for a scene.

use etalon_params::Span;

/// The longest value after substitution (bytes).
pub(crate) const LONGEST_VALUE: usize = 1 << 16;

/// How much can be inserted into all values of a scene together (bytes).
pub(crate) const MOST_INSERTED: usize = 1 << 26;

/// Where a parameter's value was written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Origin {
    /// On the command line.
    CommandLine,
    /// In a `<default>`, at this value.
    Default(Span),
}

#[derive(Debug)]
struct Parameter {
    name: String,
    /// `None` after a mistake in its `<default>`, about which enough has been said.
    value: Option<String>,
    origin: Origin,
    used: bool,
}

/// The parameters known so far.
#[derive(Debug, Default)]
pub(crate) struct Parameters {
    list: Vec<Parameter>,
    /// Names of all `<default>`s and of everything asked for, to suggest from.
    mentioned: Vec<String>,
    /// Bytes inserted so far.
    inserted: usize,
}

/// A value in which every `$name` has been replaced.
pub(crate) struct Substituted {
    /// The text.
    pub(crate) text: String,
    /// The positions of the inserted values in the scene.
    pub(crate) defaults: Vec<Span>,
}

/// A `$name` that cannot be replaced.
#[derive(Debug, PartialEq)]
pub(crate) struct Irreplaceable {
    /// The name, which may be empty.
    pub(crate) name: String,
    /// Byte offset of the `$` in the text.
    pub(crate) offset: usize,
    /// The mistake.
    pub(crate) trouble: Trouble,
}

/// Why a `$name` cannot be replaced.
#[derive(Debug, PartialEq)]
pub(crate) enum Trouble {
    /// It is not defined.
    Undefined,
    /// There is a mistake in its `<default>`, which has been reported.
    Broken,
    /// With it the value would be longer than [`LONGEST_VALUE`].
    TooLong,
    /// With it more than [`MOST_INSERTED`] would have been inserted.
    TooMuch,
}

impl Parameters {
    /// The parameters of the command line. Of two with one name the later wins.
    pub(crate) fn new(defines: &[(String, String)]) -> Self {
        let mut parameters = Self::default();
        for (name, value) in defines {
            parameters.list.retain(|p| p.name != *name);
            parameters.insert(name, Some(value), Origin::CommandLine);
        }
        parameters
    }

    fn insert(&mut self, name: &str, value: Option<&str>, origin: Origin) {
        self.list.push(Parameter {
            name: name.to_owned(),
            value: value.map(str::to_owned),
            origin,
            used: false,
        });
        self.list.sort_by_key(|p| std::cmp::Reverse(p.name.len()));
    }

    /// A `<default>`: it counts unless the name is known already. One with a mistake in it has no
    /// value.
    pub(crate) fn add_default(&mut self, name: &str, value: Option<&str>, span: Span) {
        self.mention(name);
        if !self.list.iter().any(|p| p.name == name) {
            self.insert(name, value, Origin::Default(span));
        }
    }

    fn mention(&mut self, name: &str) {
        if !name.is_empty() && !self.mentioned.iter().any(|m| m == name) {
            self.mentioned.push(name.to_owned());
        }
    }

    /// Replaces every `$name` in `text`.
    pub(crate) fn substitute(&mut self, text: &str) -> Result<Substituted, Irreplaceable> {
        let mut result = Substituted {
            text: String::with_capacity(text.len()),
            defaults: Vec::new(),
        };
        let mut rest = text;
        while let Some(at) = rest.find('$') {
            if let Some(before) = rest[..at].strip_suffix('\\') {
                result.text.push_str(before);
                result.text.push('$');
                rest = &rest[at + 1..];
                continue;
            }
            result.text.push_str(&rest[..at]);
            rest = &rest[at + 1..];
            let Some(found) = self
                .list
                .iter_mut()
                .find(|p| !p.name.is_empty() && rest.starts_with(&p.name))
            else {
                let end = rest
                    .find(|c: char| !c.is_ascii_alphanumeric() && c != '_')
                    .unwrap_or(rest.len());
                let name = rest[..end].to_owned();
                self.mention(&name);
                let offset = text.len() - rest.len() - 1;
                return Err(Irreplaceable {
                    name,
                    offset,
                    trouble: Trouble::Undefined,
                });
            };
            found.used = true;
            let added = found.value.as_ref().map_or(0, String::len);
            self.inserted += added;
            let value = match &found.value {
                None => Err(Trouble::Broken),
                Some(_) if result.text.len() + added > LONGEST_VALUE => Err(Trouble::TooLong),
                Some(_) if self.inserted > MOST_INSERTED => Err(Trouble::TooMuch),
                Some(value) => Ok(value),
            };
            let value = value.map_err(|trouble| Irreplaceable {
                name: found.name.clone(),
                offset: text.len() - rest.len() - 1,
                trouble,
            })?;
            result.text.push_str(value);
            rest = &rest[found.name.len()..];
            if let Origin::Default(span) = found.origin
                && !result.defaults.contains(&span)
            {
                result.defaults.push(span);
            }
        }
        result.text.push_str(rest);
        Ok(result)
    }

    /// The names that are defined.
    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        self.list.iter().map(|p| p.name.as_str())
    }

    /// The parameters that the scene mentions, in its order, with their values.
    pub(crate) fn values(&self) -> Vec<(String, String)> {
        let value = |name: &String| {
            let found = self.list.iter().find(|p| p.name == *name)?;
            Some((name.clone(), found.value.clone()?))
        };
        self.mentioned.iter().filter_map(value).collect()
    }

    /// The names of the command line that the scene does not use.
    pub(crate) fn unused(&self) -> impl Iterator<Item = &str> {
        self.list
            .iter()
            .filter(|p| p.origin == Origin::CommandLine && !p.used)
            .map(|p| p.name.as_str())
    }

    /// The names that the scene mentions.
    pub(crate) fn mentioned(&self) -> impl Iterator<Item = &str> {
        self.mentioned.iter().map(String::as_str)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_params::FileId;

    fn parameters() -> Parameters {
        let mut p = Parameters::new(&[("spp".into(), "8".into()), ("a".into(), "$b".into())]);
        let span = Span {
            file: FileId(0),
            start: 3,
            end: 4,
        };
        p.add_default("spp", Some("4"), span);
        p.add_default("sppx", Some("long"), span);
        p.add_default("b", Some("bee"), span);
        p
    }

    fn text(p: &mut Parameters, text: &str) -> String {
        p.substitute(text).map_or_else(
            |u| format!("{:?} `{}` at {}", u.trouble, u.name, u.offset),
            |s| s.text,
        )
    }

    #[test]
    fn values_grow_to_a_bound_and_no_further() {
        let mut p = Parameters::new(&[]);
        let span = Span {
            file: FileId(0),
            start: 0,
            end: 0,
        };
        p.add_default("a", Some(&"x".repeat(LONGEST_VALUE / 2)), span);
        assert_eq!(text(&mut p, "$a$a").len(), LONGEST_VALUE);
        // Only what is inserted counts: a long value without names is read as it is.
        assert_eq!(text(&mut p, "$a$a,"), text(&mut p, "$a$a") + ",");
        assert_eq!(text(&mut p, "$a,$a"), "TooLong `a` at 3");
        let uses = MOST_INSERTED / (LONGEST_VALUE / 2);
        let refused = (0..uses).position(|_| text(&mut p, "$a").starts_with("TooMuch"));
        assert_eq!(refused, Some(uses - 8), "eight were inserted before");
        // A value that was made of a thousand names still tells of each `<default>` once.
        p = Parameters::new(&[]);
        p.add_default("b", Some("y"), span);
        let made = p.substitute(&"$b".repeat(1000)).expect("short enough");
        assert_eq!((made.text.len(), made.defaults.len()), (1000, 1));
    }

    #[test]
    fn longest_name_wins_and_the_command_line_beats_a_default() {
        let p = &mut parameters();
        assert_eq!(text(p, "$spp $sppx $sppy $b."), "8 long 8y bee.");
    }

    #[test]
    fn escapes_and_what_was_inserted_are_left_alone() {
        let p = &mut parameters();
        assert_eq!(text(p, r"\$spp a\$ $spp"), "$spp a$ 8");
        assert_eq!(text(p, "$a"), "$b");
    }

    #[test]
    fn unknown_names_are_reported_with_their_place() {
        let p = &mut parameters();
        assert_eq!(text(p, "x $resx"), "Undefined `resx` at 2");
        assert_eq!(text(p, "5 $"), "Undefined `` at 2");
        assert_eq!(p.unused().collect::<Vec<_>>(), ["spp", "a"]);
    }
}
