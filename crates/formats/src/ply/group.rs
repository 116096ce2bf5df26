//! Which numbers of a vertex or face belong together, and what they are called.
//!
//! As in Mitsuba 3: properties `name_x name_y name_z name_w`, `name_0 … name_3` or
//! `name_1 … name_4` are the attribute `name`; `name_r name_g name_b name_a` are `name_color`, and
//! a bare `r g b a` or `red green blue alpha` is `color`. A property that belongs to no group is
//! an attribute of its own. The names alone decide, wherever the properties stand. Values are kept as they stand: colours in bytes go from 0 to 255.

use std::collections::HashMap;

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

/// Groups properties, given by number and name. A group stands where its first channel does.
pub(super) fn groups(properties: &[(usize, &str)]) -> Vec<Group> {
    let mut groups = Vec::new();
    let mut taken = vec![false; properties.len()];
    // By name: how colours are spelt keeps `r g b` and `red green blue` apart.
    let places: HashMap<&str, usize> = (properties.iter().enumerate())
        .map(|(place, (_, name))| (*name, place))
        .collect();
    // `name_0 …` goes before `name_1 …`, whose first could be the second of the former.
    for (family, postfixes) in FAMILIES.iter().enumerate() {
        for (place, &(_, name)) in properties.iter().enumerate() {
            let (prefix, postfix) = split(name);
            if postfix != postfixes[0] || taken[place] {
                continue;
            }
            let channel = |channel: usize| -> Option<usize> {
                let wanted = match name == LONG_COLOUR[0] {
                    true => LONG_COLOUR[channel].to_owned(),
                    false => name[..name.len() - 1].to_owned() + postfixes[channel],
                };
                places.get(wanted.as_str()).copied()
            };
            let members: Vec<usize> = (0..4).map_while(channel).collect();
            members.iter().for_each(|&member| taken[member] = true);
            let name = match (prefix, family == COLOUR) {
                ("", true) => "color".to_owned(),
                (prefix, true) => format!("{prefix}_color"),
                (prefix, false) => prefix.to_owned(),
            };
            groups.push((place, name, members));
        }
    }
    let alone = (0..properties.len()).filter(|&place| !taken[place]);
    let alone: Vec<_> = alone
        .map(|place| (place, properties[place].1.to_owned(), vec![place]))
        .collect();
    groups.extend(alone);
    groups.sort_by_key(|(place, ..)| *place);
    (groups.into_iter())
        .map(|(_, name, members)| Group {
            name,
            properties: members.iter().map(|&m| properties[m].0).collect(),
        })
        .collect()
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

    /// Neighbours do not decide, names do.
    #[test]
    fn channels_are_put_in_order() {
        let channels = |names: &str| -> Vec<(String, Vec<usize>)> {
            let list: Vec<(usize, &str)> = names.split(' ').enumerate().collect();
            (groups(&list).into_iter())
                .map(|g| (g.name, g.properties))
                .collect()
        };
        assert_eq!(
            channels("blue green red"),
            [("color".into(), vec![2, 1, 0])]
        );
        assert_eq!(
            channels("red quality green blue"),
            [("color".into(), vec![0, 2, 3]), ("quality".into(), vec![1])]
        );
        assert_eq!(channels("a r g b"), [("color".into(), vec![1, 2, 3, 0])]);
        assert_eq!(
            channels("foo_z foo_y foo_x"),
            [("foo".into(), vec![2, 1, 0])]
        );
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
        assert_eq!(grouped("foo_1 foo_0 foo_2"), one("foo", 3));
        assert_eq!(
            grouped("r g b red green blue"),
            [("color".into(), 3), ("color".into(), 3)]
        );
        assert_eq!(
            grouped("green blue"),
            [("green".into(), 1), ("blue".into(), 1)]
        );
        assert_eq!(
            grouped("a_x b_x b_y b_z c_y"),
            [("a".into(), 1), ("b".into(), 3), ("c_y".into(), 1)]
        );
    }
}
