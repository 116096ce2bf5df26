//! The names of Mitsuba 3's plugins, so that "not built yet" can be told from "misspelt".
//!
//! The tables follow Mitsuba 3.9. The crates of the plugins decide what is built; this module only
//! makes the messages for other names.

mod mitsuba06;
mod other_names;

use crate::{Class, Diagnostic, Node, suggest};

/// The status of a plugin's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// Mitsuba 3 has it in this class.
    Mitsuba3,
    /// Mitsuba 3 has it, but in this other class.
    OtherClass(Class),
    /// Only Mitsuba 0.6 had it.
    Mitsuba06,
    /// No Mitsuba has it.
    Unknown,
}

/// The plugins of Mitsuba 3 in a class.
pub fn names(class: Class) -> &'static [&'static str] {
    match class {
        Class::Scene => &["scene"],
        Class::Bsdf => &[
            "blendbsdf",
            "bumpmap",
            "circular",
            "conductor",
            "dielectric",
            "diffuse",
            "hair",
            "mask",
            "measured",
            "measured_polarized",
            "normalmap",
            "null",
            "plastic",
            "polarizer",
            "pplastic",
            "principled",
            "principledthin",
            "retarder",
            "roughconductor",
            "roughdielectric",
            "roughplastic",
            "thindielectric",
            "twosided",
        ],
        Class::Emitter => &[
            "area",
            "constant",
            "directional",
            "directionalarea",
            "envmap",
            "point",
            "projector",
            "spot",
            "sunsky",
            "timed_sunsky",
        ],
        Class::Film => &["hdrfilm", "specfilm"],
        Class::Integrator => &[
            "aov",
            "depth",
            "direct",
            "direct_projective",
            "moment",
            "path",
            "prb",
            "prb_basic",
            "prb_projective",
            "prbvolpath",
            "ptracer",
            "stokes",
            "volpath",
            "volpathmis",
            "volprim_rf_basic",
        ],
        Class::Medium => &["heterogeneous", "homogeneous"],
        Class::Phase => &[
            "blendphase",
            "hg",
            "isotropic",
            "rayleigh",
            "sggx",
            "tabphase",
        ],
        Class::ReconstructionFilter => &[
            "box",
            "catmullrom",
            "gaussian",
            "lanczos",
            "mitchell",
            "tent",
        ],
        Class::Sampler => &[
            "independent",
            "ldsampler",
            "multijitter",
            "orthogonal",
            "stratified",
        ],
        Class::Sensor => &[
            "batch",
            "distant",
            "flat_sensor",
            "irradiancemeter",
            "orthographic",
            "perspective",
            "radiancemeter",
            "thinlens",
        ],
        Class::Shape => &[
            "bsplinecurve",
            "cube",
            "cylinder",
            "disk",
            "ellipsoids",
            "ellipsoidsmesh",
            "instance",
            "linearcurve",
            "merge",
            "obj",
            "ply",
            "rectangle",
            "sdfgrid",
            "serialized",
            "shapegroup",
            "sphere",
        ],
        Class::Texture => &[
            "bitmap",
            "blackbody",
            "checkerboard",
            "d65",
            "irregular",
            "mesh_attribute",
            "rawconstant",
            "regular",
            "srgb",
            "uniform",
            "volume",
        ],
        // Mitsuba 3 has none.
        Class::Subsurface => &[],
        Class::Volume => &["constvolume", "gridvolume"],
    }
}

/// What can be used instead of a plugin that Mitsuba 0.6 had and Mitsuba 3 has not.
fn instead_of_06(class: Class, name: &str) -> Option<&'static str> {
    let found = mitsuba06::PLUGINS
        .iter()
        .find(|(of, known, _)| *of == class && *known == name);
    found.map(|(.., instead)| *instead)
}

/// Every class, for looking a name up in all of them.
pub const CLASSES: [Class; 14] = [
    Class::Scene,
    Class::Bsdf,
    Class::Emitter,
    Class::Film,
    Class::Integrator,
    Class::Medium,
    Class::Phase,
    Class::ReconstructionFilter,
    Class::Sampler,
    Class::Sensor,
    Class::Shape,
    Class::Subsurface,
    Class::Texture,
    Class::Volume,
];

/// The status of the plugin `name` of a class.
pub fn status(class: Class, name: &str) -> Status {
    if names(class).contains(&name) {
        return Status::Mitsuba3;
    }
    if instead_of_06(class, name).is_some() {
        return Status::Mitsuba06;
    }
    CLASSES
        .into_iter()
        .find(|&other| names(other).contains(&name))
        .map_or(Status::Unknown, Status::OtherClass)
}

/// The plugin that other programs call `name`, of any class.
pub fn called_otherwise(name: &str) -> Option<&'static str> {
    CLASSES
        .into_iter()
        .find_map(|class| other_names::ours(class, name))
}

/// The diagnostic for a node whose plugin is not among those that are `built`.
pub fn not_built<'a>(node: &Node, built: impl IntoIterator<Item = &'a str>) -> Diagnostic {
    let (name, class) = (node.plugin.value.as_str(), node.class.name());
    let built: Vec<&str> = built.into_iter().collect();
    let error = |message: String| Diagnostic::error(node.plugin.span, message);
    let list = || match node.class {
        Class::Integrator => format!(
            "built: {}; `--integrator NAME` renders the scene with one of them",
            built.join(", ")
        ),
        _ => format!("built: {}", built.join(", ")),
    };
    match status(node.class, name) {
        Status::Mitsuba3 => {
            let diagnostic = error(format!(
                "the {class} plugin `{name}` is known to Mitsuba 3 but not built yet"
            ));
            if built.is_empty() {
                diagnostic
            } else {
                diagnostic.help(list())
            }
        }
        Status::OtherClass(other) => error(format!(
            "`{name}` is a plugin of the class {}, not {class}",
            other.name()
        ))
        .help(format!("write `<{} type=\"{name}\">`", other.name())),
        Status::Mitsuba06 => {
            let diagnostic = error(format!(
                "the {class} plugin `{name}` of Mitsuba 0.6 is not built yet"
            ));
            match instead_of_06(node.class, name).unwrap_or_default() {
                "" => diagnostic.help(list()),
                instead => diagnostic.help(format!("instead: {instead}")),
            }
        }
        Status::Unknown => {
            let known = names(node.class).iter().chain(&built).copied();
            let diagnostic = error(format!("unknown {class} plugin `{name}`"));
            let other = other_names::ours(node.class, name).filter(|name| built.contains(name));
            match other.or_else(|| suggest::nearest(name, known)) {
                Some(near) => diagnostic.help(format!("did you mean `{near}`?")),
                None => diagnostic.help(list()),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{FileId, Span, Spanned};

    fn words(class: Class, name: &str) -> String {
        let span = Span {
            file: FileId(0),
            start: 0,
            end: 0,
        };
        let node = Node {
            class,
            plugin: Spanned {
                value: name.into(),
                span,
            },
            id: None,
            span,
            properties: Vec::new(),
        };
        let diagnostic = not_built(&node, ["diffuse", "dielectric", "velvet"]);
        let help = diagnostic.help.unwrap_or_default();
        format!("{} ({help})", diagnostic.message)
    }

    #[test]
    fn names_are_sorted_and_in_one_list_only() {
        for class in CLASSES {
            assert!(names(class).is_sorted(), "{}", class.name());
        }
        assert!(mitsuba06::PLUGINS.is_sorted_by_key(|(class, name, _)| (*class, *name)));
        for (class, name, _) in mitsuba06::PLUGINS {
            assert!(!names(*class).contains(name), "{name}");
        }
    }

    #[test]
    fn each_status_has_its_words() {
        assert_eq!(
            words(Class::Bsdf, "principled"),
            "the bsdf plugin `principled` is known to Mitsuba 3 but not built yet \
             (built: diffuse, dielectric, velvet)"
        );
        assert_eq!(
            words(Class::Bsdf, "area"),
            "`area` is a plugin of the class emitter, not bsdf (write `<emitter type=\"area\">`)"
        );
        assert_eq!(
            words(Class::Emitter, "sky"),
            "the emitter plugin `sky` of Mitsuba 0.6 is not built yet (instead: `sunsky` with a `sun_scale` of 0)"
        );
        assert!(words(Class::Integrator, "my_research").contains("`--integrator NAME`"));
        assert_eq!(
            words(Class::Bsdf, "difuse"),
            "unknown bsdf plugin `difuse` (did you mean `diffuse`?)"
        );
        assert_eq!(
            words(Class::Bsdf, "velvett"),
            "unknown bsdf plugin `velvett` (did you mean `velvet`?)"
        );
        assert!(words(Class::Bsdf, "Glass").ends_with("(did you mean `dielectric`?)"));
    }
}
