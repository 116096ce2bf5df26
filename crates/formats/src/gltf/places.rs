//! Where the values of a JSON text stand: from a path such as `meshes[3].primitives[0].attributes["POSITION"]` to its place.
//!
//! The text has been read by a JSON parser before, so that this one only has to walk; what it does not understand, it leaves out.

/// Deeper values count as part of the one that holds them.
const MOST_LEVELS: usize = 64;

/// The places of all values.
#[derive(Debug)]
pub(crate) struct Places {
    values: Vec<Value>,
}

#[derive(Debug)]
struct Value {
    start: u32,
    end: u32,
    members: Vec<(Name, u32)>,
}

#[derive(Debug, PartialEq)]
enum Name {
    Key(String),
    Index(usize),
}

impl Places {
    /// Looks through a text.
    pub(crate) fn of(text: &str) -> Self {
        let mut walker = Walker {
            bytes: text.as_bytes(),
            at: 0,
            values: Vec::new(),
        };
        walker.value(0);
        Self {
            values: walker.values,
        }
    }

    /// The first byte of the value at a path and the one past its last, or those of the innermost value around it that there is.
    pub(crate) fn at(&self, path: &str) -> [u32; 2] {
        self.found(path).0
    }

    /// The same; `None` if there is no such value.
    pub(crate) fn exactly_at(&self, path: &str) -> Option<[u32; 2]> {
        let (place, is_exact) = self.found(path);
        is_exact.then_some(place)
    }

    fn found(&self, path: &str) -> ([u32; 2], bool) {
        let Some(mut value) = self.values.first() else {
            return ([0, 0], false);
        };
        let mut is_exact = true;
        for step in steps(path) {
            let member = match step {
                Name::Index(index) => value.members.get(index).filter(|(name, _)| *name == step),
                Name::Key(_) => value.members.iter().find(|(name, _)| *name == step),
            };
            match member.and_then(|(_, index)| self.values.get(*index as usize)) {
                Some(inner) => value = inner,
                None => {
                    is_exact = false;
                    break;
                }
            }
        }
        ([value.start, value.end], is_exact)
    }
}

/// The steps of a path.
fn steps(path: &str) -> impl Iterator<Item = Name> + '_ {
    let parts = path.split(['.', '[']).filter(|part| !part.is_empty());
    parts.map(|part| {
        let inner = part.strip_suffix(']').unwrap_or(part);
        match inner.parse() {
            Ok(index) if part.ends_with(']') => Name::Index(index),
            _ => Name::Key(inner.trim_matches('"').to_owned()),
        }
    })
}

struct Walker<'a> {
    bytes: &'a [u8],
    at: usize,
    values: Vec<Value>,
}

impl Walker<'_> {
    fn peek(&mut self) -> Option<u8> {
        while self.bytes.get(self.at).is_some_and(u8::is_ascii_whitespace) {
            self.at += 1;
        }
        self.bytes.get(self.at).copied()
    }

    /// Walks over a value, and keeps its place; its number.
    fn value(&mut self, level: usize) -> u32 {
        let first = self.peek();
        let number = self.values.len();
        self.values.push(Value {
            start: self.at as u32,
            end: self.at as u32,
            members: Vec::new(),
        });
        let mut members = Vec::new();
        match first {
            Some(b'{' | b'[') if level == MOST_LEVELS => self.skip(),
            Some(b'{') => self.members(b'}', |walker, _| {
                let key = walker.string();
                if walker.peek() == Some(b':') {
                    walker.at += 1;
                }
                members.push((Name::Key(key), walker.value(level + 1)));
            }),
            Some(b'[') => self.members(b']', |walker, index| {
                members.push((Name::Index(index), walker.value(level + 1)));
            }),
            Some(b'"') => drop(self.string()),
            _ => self.word(),
        }
        self.values[number].end = self.at as u32;
        self.values[number].members = members;
        number as u32
    }

    /// Walks over what stands between brackets; each `member` must get ahead.
    fn members(&mut self, close: u8, mut member: impl FnMut(&mut Self, usize)) {
        self.at += 1;
        let mut index = 0;
        while let Some(next) = self.peek() {
            let before = self.at;
            match next {
                _ if next == close => {
                    self.at += 1;
                    return;
                }
                b',' => self.at += 1,
                _ => {
                    member(self, index);
                    index += 1;
                }
            }
            if self.at == before {
                return;
            }
        }
    }

    /// Walks over a string; its text, with escapes as they stand.
    fn string(&mut self) -> String {
        if self.peek() != Some(b'"') {
            return String::new();
        }
        let start = self.at + 1;
        let mut end = start;
        while let Some(&byte) = self.bytes.get(end) {
            match byte {
                b'"' => break,
                b'\\' => end += 2,
                _ => end += 1,
            }
        }
        let end = end.min(self.bytes.len());
        self.at = (end + 1).min(self.bytes.len());
        // Of long strings, such as embedded buffers, nobody asks for the text.
        const LONGEST_KEY: usize = 256;
        let key = self.bytes.get(start..end.min(start + LONGEST_KEY));
        String::from_utf8_lossy(key.unwrap_or_default()).into_owned()
    }

    /// Walks over a number, `true`, `false` or `null`.
    fn word(&mut self) {
        let ends = |byte: &u8| byte.is_ascii_whitespace() || b",:[]{}\"".contains(byte);
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        self.at += rest.iter().position(ends).unwrap_or(rest.len());
    }

    /// Walks over a value in brackets without looking into it.
    fn skip(&mut self) {
        let mut open = 0_usize;
        while let Some(next) = self.peek() {
            match next {
                b'"' => {
                    self.string();
                    continue;
                }
                b'{' | b'[' => open += 1,
                b'}' | b']' => open = open.saturating_sub(1),
                _ => {}
            }
            self.at += 1;
            if open == 0 {
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Places;

    #[test]
    fn values_are_found_by_their_paths() {
        let text = r#"{ "a": [ {"b\"": 1}, {"c": { "POS": [1, 22, "x,]"] } } ], "d" : true }"#;
        let places = Places::of(text);
        let at = |path: &str| {
            let [start, end] = places.at(path).map(|byte| byte as usize);
            &text[start..end]
        };
        assert_eq!(at(""), text);
        assert_eq!(at("a[1].c[\"POS\"][1]"), "22");
        assert_eq!(at("a[1].c.POS"), "[1, 22, \"x,]\"]");
        assert_eq!(at("a[1].c.POS[2]"), "\"x,]\"");
        assert_eq!(at("d"), "true");
        assert_eq!(at("a[1].none.deeper"), at("a[1]"));
        assert_eq!(at("a[7]"), at("a"));
        assert!(places.exactly_at("a[7]").is_none() && places.exactly_at("d").is_some());
    }

    #[test]
    fn broken_and_deep_texts_are_survived() {
        let deep = "[".repeat(100_000);
        for text in [
            "", "{", "{\"", "{\"a\":", "[1", "[}", "\"\\", "{]", &deep, "[[]:]",
        ] {
            Places::of(text);
        }
    }
}
