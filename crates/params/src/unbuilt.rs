//! Parameters of Mitsuba 0.6 that change the picture, and that nothing here obeys: they are refused, with what does instead.
//!
//! Every parameter of Mitsuba 0.6 has one of three fates: a plugin here reads it (under the name that
//! `etalon_formats::mitsuba` gives it), it changes nothing ([`crate::ignored`]), or it stands here. A list of all of them
//! in `docs/mitsuba-0.6.txt` is held to that by a test.

use crate::Class;

/// Parameters of one kind.
#[derive(Clone, Copy, Debug)]
pub struct Unbuilt {
    /// The class of the plugins.
    pub class: Class,
    /// The plugins; none means every plugin of the class.
    pub plugins: &'static [&'static str],
    /// The parameters.
    pub names: &'static [&'static str],
    /// What does the same, or comes near.
    pub instead: &'static str,
}

/// The list.
pub const LIST: &[Unbuilt] = &[
    Unbuilt {
        class: Class::Film,
        plugins: &[],
        names: &["label["],
        instead: "no text is drawn into pictures",
    },
    Unbuilt {
        class: Class::Integrator,
        plugins: &["ao"],
        names: &["ray_length"],
        instead: "`distance`, a number above 0",
    },
    Unbuilt {
        class: Class::Emitter,
        plugins: &["sunsky"],
        names: &["sun_radius_scale"],
        instead: "a sun without extent is a `directional` light beside a `sunsky` with a `sun_scale` of 0",
    },
    Unbuilt {
        class: Class::Medium,
        plugins: &["heterogeneous"],
        names: &["orientation"],
        instead: "flakes are turned by a volume of matrices, the `S` of the phase function `sggx`",
    },
    Unbuilt {
        class: Class::Medium,
        plugins: &["homogeneous"],
        names: &["g"],
        instead: "nest `<phase type=\"hg\"><float name=\"g\" value=\"…\"/></phase>`",
    },
    Unbuilt {
        class: Class::Subsurface,
        plugins: &["dipole", "multidipole"],
        names: &["g"],
        instead: "nest `<phase type=\"hg\"><float name=\"g\" value=\"…\"/></phase>`",
    },
    Unbuilt {
        class: Class::Subsurface,
        plugins: &["dipole", "multidipole", "adipole"],
        names: &["int_ior", "ext_ior"],
        instead: "a `boundary` that is `smooth` has them; such a surface mirrors as well",
    },
];

/// The entry of a plugin's parameter.
pub fn entry(class: Class, plugin: &str, name: &str) -> Option<&'static Unbuilt> {
    let about = (class, plugin, name);
    LIST.iter()
        .find(|entry| crate::ignored::names(entry.class, entry.plugins, entry.names, about))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ignored;

    #[test]
    fn no_parameter_is_in_both_lists() {
        for entry in LIST {
            for (plugin, name) in entry
                .plugins
                .iter()
                .flat_map(|p| entry.names.iter().map(move |n| (p, n)))
            {
                assert!(
                    ignored::entry(entry.class, plugin, name).is_none(),
                    "{plugin} {name}"
                );
            }
        }
    }
}
