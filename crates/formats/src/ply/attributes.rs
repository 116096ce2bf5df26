//! Which numbers of a vertex or face belong together, and what they are called.
//!
//! As in Mitsuba 3: successive properties `name_x name_y name_z name_w`, `name_0 … name_3` or
//! `name_1 … name_4` are the attribute `name`; `name_r name_g name_b name_a` are `name_color`, and
//! a bare `r g b a` or `red green blue alpha` is `color`. A property that belongs to no group is
//! an attribute of its own. Values are kept as they stand: colours in bytes go from 0 to 255.

/// An attribute and the numbers of its properties.
#[derive(Debug, PartialEq)]
pub(super) struct Group {
    pub(super) name: String,
    pub(super) properties: Vec<usize>,
}

const FAMILIES: [[&str; 4]; 4] = [
    ["x", "y", "z", "w"],
    ["r", "g", "b", "a"],
    ["0", "1", "2", "3"],
    ["1", "2", "3", "4"],
];
const COLOUR: usize = 1;
const LONG_COLOUR: [&str; 4] = ["red", "green", "blue", "alpha"];

/// The name without its postfix, and the postfix.
fn split(name: &str) -> (&str, &str) {
    match name.rsplit_once('_') {
        Some(parts) => parts,
        None if LONG_COLOUR.contains(&name) => {
            let position = LONG_COLOUR.iter().position(|l| *l == name).unwrap_or(0);
            ("", FAMILIES[COLOUR][position])
        }
        None if FAMILIES[COLOUR].contains(&name) => ("", name),
        None => (name, ""),
    }
}

/// Groups properties, given by number and name.
pub(super) fn groups(properties: &[(usize, &str)]) -> Vec<Group> {
    let mut groups = Vec::new();
    let mut rest = properties;
    while let [(number, name), ..] = *rest {
        let (prefix, postfix) = split(name);
        let family = FAMILIES.iter().position(|f| f[0] == postfix);
        let Some(family) = family else {
            groups.push(Group {
                name: name.to_owned(),
                properties: vec![number],
            });
            rest = &rest[1..];
            continue;
        };
        let length = rest
            .iter()
            .zip(FAMILIES[family])
            .take_while(|((_, name), postfix)| split(name) == (prefix, *postfix))
            .count();
        let name = match (prefix, family == COLOUR) {
            ("", true) => "color".to_owned(),
            (prefix, true) => format!("{prefix}_color"),
            (prefix, false) => prefix.to_owned(),
        };
        groups.push(Group {
            name,
            properties: rest[..length].iter().map(|(i, _)| *i).collect(),
        });
        rest = &rest[length..];
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grouped(names: &str) -> Vec<(String, usize)> {
        let list: Vec<(usize, &str)> = names.split(' ').enumerate().collect();
        groups(&list)
            .into_iter()
            .map(|g| (g.name, g.properties.len()))
            .collect()
    }

    #[test]
    fn names_are_those_of_mitsuba() {
        // The first six as Mitsuba 3.9.1 lists them.
        let one = |name: &str, channels| vec![(name.to_owned(), channels)];
        assert_eq!(grouped("r g b"), one("color", 3));
        assert_eq!(grouped("red green blue alpha"), one("color", 4));
        assert_eq!(grouped("foo_x foo_y foo_z"), one("foo", 3));
        assert_eq!(grouped("foo_1 foo_2 foo_3"), one("foo", 3));
        assert_eq!(grouped("foo_r foo_g foo_b"), one("foo_color", 3));
        assert_eq!(grouped("foo_0"), one("foo", 1));
        assert_eq!(grouped("quality"), one("quality", 1));
        assert_eq!(
            grouped("a_x b_x b_y b_z c_y"),
            [("a".into(), 1), ("b".into(), 3), ("c_y".into(), 1)]
        );
    }
}
