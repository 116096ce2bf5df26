//! Things that are defined once under a name, and mentioned by it before or after.

use super::mistakes::Mistakes;
use super::number::excerpt;
use etalon_params::{Diagnostic, Span, Spanned, suggest};
use std::collections::HashMap;

/// Things of one family. A thing's index is fixed when its name is first read.
#[derive(Debug)]
pub(crate) struct Definitions<T> {
    /// What they are, for messages: "material".
    family: &'static str,
    items: Vec<Item<T>>,
    ids: HashMap<String, usize>,
}

#[derive(Debug)]
struct Item<T> {
    /// Where its name was first mentioned.
    first: Spanned<String>,
    /// Where it is defined, and what it is.
    definition: Option<(Span, T)>,
}

impl<T> Definitions<T> {
    pub(crate) fn new(family: &'static str) -> Self {
        Self {
            family,
            items: Vec::new(),
            ids: HashMap::new(),
        }
    }

    /// The index of a thing that may be defined later.
    pub(crate) fn mention(&mut self, name: &Spanned<String>) -> usize {
        match self.ids.get(&name.value) {
            Some(id) => *id,
            None => {
                self.ids.insert(name.value.clone(), self.items.len());
                self.push(name.clone(), None)
            }
        }
    }

    /// Defines a thing; a second definition of a name is a mistake, and is not kept.
    pub(crate) fn define(&mut self, name: &Spanned<String>, thing: T) -> Result<usize, Diagnostic> {
        let id = self.mention(name);
        let item = &mut self.items[id];
        if let Some((first, _)) = item.definition {
            let name_shown = excerpt(&name.value);
            let message = format!("the {} `{name_shown}` is defined twice", self.family);
            return Err(Diagnostic::error(name.span, message).related(first, "first here"));
        }
        item.definition = Some((name.span, thing));
        Ok(id)
    }

    /// Keeps a thing without a name.
    pub(crate) fn keep(&mut self, thing: T, span: Span) -> usize {
        let value = String::new();
        self.push(Spanned { value, span }, Some((span, thing)))
    }

    /// The things by their indices. Of a name that is nowhere defined, which is a mistake, there is a stand-in.
    pub(crate) fn finish(
        self,
        mistakes: &mut Mistakes,
        stand_in: impl Fn(Spanned<String>) -> T,
    ) -> Vec<T> {
        let defined = |name: &&str| {
            let id = self.ids.get(*name);
            id.is_some_and(|id| self.items[*id].definition.is_some())
        };
        let missing = self.items.iter().filter(|item| item.definition.is_none());
        for Item { first, .. } in missing {
            if mistakes.is_full() {
                break;
            }
            let message = format!("there is no {} `{}`", self.family, excerpt(&first.value));
            let mistake = Diagnostic::error(first.span, message);
            let names = self.ids.keys().map(String::as_str).filter(defined);
            mistakes.report(suggested(mistake, &first.value, names));
        }
        let thing = |item: Item<T>| match item.definition {
            Some((_, thing)) => thing,
            None => stand_in(item.first),
        };
        self.items.into_iter().map(thing).collect()
    }

    fn push(&mut self, first: Spanned<String>, definition: Option<(Span, T)>) -> usize {
        self.items.push(Item { first, definition });
        self.items.len() - 1
    }
}

/// Adds the nearest name to a message about an unknown one. Scenes have long names, and many.
pub(crate) fn suggested<'a>(
    mistake: Diagnostic,
    word: &str,
    names: impl Iterator<Item = &'a str>,
) -> Diagnostic {
    const MOST_COMPARED: usize = 4096;
    const LONGEST_COMPARED: usize = 64;
    if word.len() > LONGEST_COMPARED {
        return mistake;
    }
    let short = names.filter(|name| name.len() <= LONGEST_COMPARED);
    // From a map without an order: of equally near ones, the first in the alphabet.
    let mut compared: Vec<&str> = short.take(MOST_COMPARED).collect();
    compared.sort_unstable();
    match suggest::nearest(word, compared) {
        Some(near) => mistake.help(format!("did you mean `{near}`?")),
        None => mistake,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etalon_params::FileId;

    fn name(value: &str, start: u32) -> Spanned<String> {
        let (value, file, end) = (value.to_owned(), FileId(0), start);
        let span = Span { file, start, end };
        Spanned { value, span }
    }

    #[test]
    fn names_may_be_mentioned_before_they_are_defined() {
        let mut mistakes = Mistakes::default();
        let mut things = Definitions::new("thing");
        assert_eq!(things.mention(&name("a", 0)), 0);
        assert_eq!(things.keep(7, name("", 1).span), 1);
        assert_eq!(things.define(&name("b", 2), 8), Ok(2));
        assert_eq!(things.define(&name("a", 3), 9), Ok(0));
        let twice = things.define(&name("a", 4), 10).expect_err("twice");
        assert_eq!(twice.message, "the thing `a` is defined twice");
        assert_eq!(twice.related, [(name("", 3).span, "first here".to_owned())]);
        assert_eq!(things.mention(&name("bb", 5)), 3);
        assert_eq!(things.finish(&mut mistakes, |_| -1), [9, 7, 8, -1]);
        let list = mistakes.into_sorted();
        assert_eq!(list.len(), 1);
        assert_eq!(list[0].message, "there is no thing `bb`");
        assert_eq!(list[0].help.as_deref(), Some("did you mean `b`?"));
    }
}
