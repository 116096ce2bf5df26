//! The one list of parameters that are accepted and change nothing; those of Mitsuba 0.6 are in `mitsuba06`.
//!
//! Most belong to how Mitsuba works, not to what the picture is: its tiles, its acceleration
//! structures, its accumulation; others mean nothing to one plugin of a class whose others take
//! them. [`crate::Params::finish`] does not complain about them.
//! `docs/ignored-parameters.md` is this list for people; a test keeps the two equal.

mod mitsuba06;

use crate::{Class, Value};

/// Parameters of one kind.
#[derive(Clone, Copy, Debug)]
pub struct Ignored {
    /// The class of the plugins.
    pub class: Class,
    /// The plugins; none means every plugin of the class.
    pub plugins: &'static [&'static str],
    /// The parameters.
    pub names: &'static [&'static str],
    /// Which values are ignored; `None` means all.
    pub only: Option<Only>,
    /// Whether a note says that they are ignored: with Mitsuba 0.6 they could change the picture.
    pub said: bool,
    /// Why they cannot change the picture.
    pub reason: &'static str,
}

/// A condition on a parameter's value.
#[derive(Clone, Copy, Debug)]
pub struct Only {
    /// The condition in words.
    pub words: &'static str,
    /// The condition.
    pub holds: fn(&Value) -> bool,
}

/// Those of Mitsuba 3.
const OF_MITSUBA_3: &[Ignored] = &[
    Ignored {
        class: Class::Scene,
        plugins: &[],
        names: &[
            "embree_use_robust_intersection",
            "embree_use_robust_intersections",
            "kd_intersection_cost",
            "kd_traversal_cost",
            "kd_empty_space_bonus",
            "kd_stop_prims",
            "kd_max_depth",
            "kd_min_max_bins",
            "kd_clip",
            "kd_retract_bad_splits",
            "kd_exact_primitive_threshold",
            "compact_acceleration_structures",
        ],
        only: None,
        said: false,
        reason: "They tune Mitsuba's acceleration structures. Intersections here are always \
                 watertight, whatever the structure.",
    },
    Ignored {
        class: Class::Scene,
        plugins: &[],
        names: &["allow_thread_reordering"],
        only: None,
        said: false,
        reason: "It tunes the scheduling of GPU threads.",
    },
    Ignored {
        class: Class::Film,
        plugins: &[],
        names: &["banner"],
        only: None,
        said: false,
        reason: "Mitsuba 3 ignores it, too; no banner is ever drawn into a picture.",
    },
    Ignored {
        class: Class::Film,
        plugins: &[],
        names: &["compensate"],
        only: None,
        said: false,
        reason: "It asks for compensated summation. Accumulation here is exact.",
    },
    Ignored {
        class: Class::Film,
        plugins: &[],
        names: &["sample_border"],
        only: None,
        said: false,
        reason: "Where pixels share samples, pixels beyond the border take some, too, whatever it says; where none are shared, none are needed.",
    },
    Ignored {
        class: Class::Integrator,
        plugins: &[],
        names: &["block_size", "samples_per_pass"],
        only: None,
        said: false,
        reason: "They cut the work into tiles and passes. Pictures here do not depend on how the \
                 work is cut.",
    },
    Ignored {
        class: Class::Integrator,
        plugins: &[],
        names: &["timeout"],
        only: Some(Only {
            words: "not above 0, which means no limit",
            holds: is_not_positive,
        }),
        said: false,
        reason: "Rendering ends when the samples are done, not when the time is up; `--time` fixes how many there are.",
    },
    Ignored {
        class: Class::Integrator,
        plugins: &["direct_projective", "prb_projective"],
        names: &[
            "sppc",
            "sppp",
            "sppi",
            "guiding",
            "guiding_proj",
            "guiding_rounds",
        ],
        only: None,
        said: false,
        reason: "They choose how derivatives are estimated.",
    },
    Ignored {
        class: Class::Integrator,
        plugins: &["depth", "signature", "aov", "moment"],
        names: &["hide_emitters"],
        only: None,
        said: false,
        reason: "They show distances, objects and properties of surfaces; integrators nested in them have their own.",
    },
    Ignored {
        class: Class::Integrator,
        plugins: &["ao"],
        names: &["max_depth", "rr_depth", "hide_emitters"],
        only: None,
        said: false,
        reason: "Occlusion has one ray and knows no lights.",
    },
    Ignored {
        class: Class::Integrator,
        plugins: &["whitted"],
        names: &["rr_depth"],
        only: None,
        said: false,
        reason: "Every branch is followed up to `max_depth`: nothing is cut at random.",
    },
    Ignored {
        class: Class::Sensor,
        plugins: &["perspective", "orthographic"],
        names: &["focus_distance"],
        only: None,
        said: false,
        reason: "Only a lens can be out of focus.",
    },
    Ignored {
        class: Class::Sensor,
        plugins: &[],
        names: &["jitter"],
        only: Some(Only {
            words: "true",
            holds: is_true,
        }),
        said: false,
        reason: "Samples are spread over the reach of the reconstruction filter.",
    },
    Ignored {
        class: Class::Sensor,
        plugins: &[],
        names: &["cone_scale"],
        only: None,
        said: false,
        reason: "It widens what Mitsuba averages of a texture at a point. Here the samples of a \
                 pixel average.",
    },
    Ignored {
        class: Class::Sampler,
        plugins: &[
            "multijitter",
            "orthogonal",
            "bose",
            "bush",
            "ldsampler",
            "halton",
            "hammersley",
        ],
        names: &["jitter", "strength"],
        only: None,
        said: false,
        reason: "The sampler `sobol` stands in for these, which is said.",
    },
    Ignored {
        class: Class::Emitter,
        plugins: &["constant"],
        names: &["to_world"],
        only: None,
        said: false,
        reason: "A uniform sky looks the same however it is turned.",
    },
    Ignored {
        class: Class::Shape,
        plugins: &[],
        names: &["silhouette_sampling_weight"],
        only: None,
        said: false,
        reason: "It weighs shapes in Mitsuba's estimation of derivatives.",
    },
    Ignored {
        class: Class::Shape,
        plugins: &["cube", "rectangle"],
        names: &["face_normals"],
        only: None,
        said: false,
        reason: "Their faces are flat anyway.",
    },
    Ignored {
        class: Class::Shape,
        plugins: &["shapegroup"],
        names: &["to_world"],
        only: None,
        said: false,
        reason: "Mitsuba does not use it either: instances are placed.",
    },
    Ignored {
        class: Class::Texture,
        plugins: &["bitmap"],
        names: &["accel", "format", "cache", "max_anisotropy"],
        only: None,
        said: false,
        reason: "They choose how Mitsuba stores and filters texels. Here texels keep the precision \
                 of 32-bit floats.",
    },
    Ignored {
        class: Class::Texture,
        plugins: &["uniform"],
        names: &["wavelength_min", "wavelength_max"],
        only: None,
        said: false,
        reason: "They say where Mitsuba samples wavelengths; the value holds everywhere.",
    },
    Ignored {
        class: Class::Volume,
        plugins: &["constvolume"],
        names: &["to_world"],
        only: None,
        said: false,
        reason: "It is the same everywhere.",
    },
];

fn is_true(value: &Value) -> bool {
    matches!(value, Value::Boolean(true))
}

fn is_not_positive(value: &Value) -> bool {
    match value {
        Value::Float(x) => *x <= 0.0,
        Value::Integer(i) => *i <= 0,
        _ => false,
    }
}

/// The whole list.
pub fn list() -> impl Iterator<Item = &'static Ignored> {
    OF_MITSUBA_3.iter().chain(mitsuba06::LIST)
}

/// Whether an entry of a list is about a parameter. No plugins are all of the class, and a name that ends with `[` stands for
/// those that begin so.
pub(crate) fn names(
    class: Class,
    plugins: &[&str],
    names: &[&str],
    (of, plugin, name): (Class, &str, &str),
) -> bool {
    let is_called =
        |known: &&str| *known == name || known.ends_with('[') && name.starts_with(known);
    class == of && (plugins.is_empty() || plugins.contains(&plugin)) && names.iter().any(is_called)
}

/// The entry of a plugin's parameter, whatever its value.
pub fn entry(class: Class, plugin: &str, name: &str) -> Option<&'static Ignored> {
    list().find(|entry| {
        names(
            entry.class,
            entry.plugins,
            entry.names,
            (class, plugin, name),
        )
    })
}

/// The list as Markdown.
pub fn markdown() -> String {
    let mut text = String::from(
        "# Parameters that are accepted and ignored\n\n\
         These parameters cannot change a picture made here. Every other parameter \
         that a plugin does not know is an error, in files of Mitsuba 0.x too: what becomes of their parameters is told in \
         [mitsuba-0.6.md](mitsuba-0.6.md).\n\n\
         | object | parameter | why it changes nothing |\n|---|---|---|\n",
    );
    for entry in list() {
        let class = entry.class.name();
        let object = if entry.plugins.is_empty() {
            format!("every `{class}`")
        } else {
            format!("`{class}` {}", code(entry.plugins))
        };
        let mut names = code(entry.names);
        if let Some(only) = entry.only {
            names = format!("{names} ({})", only.words);
        }
        let note = if entry.said { " A note says so." } else { "" };
        text.push_str(&format!(
            "| {object} | {names} | {}{note} |\n",
            entry.reason
        ));
    }
    text
}

fn code(names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    quoted.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_listed_is_ignored() {
        assert!(entry(Class::Film, "hdrfilm", "banner").is_some());
        assert!(entry(Class::Sensor, "perspective", "banner").is_none());
        assert!(entry(Class::Texture, "checkerboard", "accel").is_none());
        let timeout = entry(Class::Integrator, "path", "timeout").and_then(|entry| entry.only);
        let holds = timeout.expect("of some values only").holds;
        assert!(holds(&Value::Float(-1.0)) && !holds(&Value::Float(3.0)));
        let focus = |plugin| entry(Class::Sensor, plugin, "focus_distance").is_some();
        assert!(focus("perspective") && !focus("thinlens"));
    }
}
