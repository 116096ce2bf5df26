//! `--integrator NAME`: another integrator for a scene.
//!
//! The innermost integrator (inside of `aov` and `moment`) becomes one of the type `NAME`, but a `field` only if it is the
//! only one. Of its
//! properties only `max_depth`, `rr_depth` and `hide_emitters` are kept; an integrator that does
//! not know one of these leaves it unused without complaint. One that has the type already keeps
//! all. A scene without an integrator gets one.
//!
//! Some integrators that are not built, whether the scene names them or `--integrator`, are replaced in the same way by
//! one that converges to the same picture, with a note: see [`stand_in`].

use super::draft::{DraftObject, DraftProperty, DraftValue, ObjectId};
use super::number::excerpt;
use super::reader::Reader;
use etalon_params::unused::Unused;
use etalon_params::{Class, Diagnostic, Span, Spanned, Value, plugins};

/// The properties that survive the change.
const KEPT: [&str; 3] = ["max_depth", "rr_depth", "hide_emitters"];

/// What survives of `ppm` beside them, whose photons are those of `sppm`.
const PHOTONS: [&str; 3] = ["photons", "radius", "alpha"];

/// Replacements of integrators that are not built, and what they have in common.
const STAND_INS: [(&str, &str, &str); 16] = [
    ("volpath_simple", "volpath", SAME_PICTURE),
    ("prbvolpath", "volpath", SAME_WITHOUT_DERIVATIVES),
    ("prb", "path", SAME_WITHOUT_DERIVATIVES),
    ("prb_basic", "path", SAME_WITHOUT_DERIVATIVES),
    ("prb_projective", "path", SAME_WITHOUT_DERIVATIVES),
    ("prb_reparam", "path", SAME_WITHOUT_DERIVATIVES),
    ("prb_threepoint", "path", SAME_WITHOUT_DERIVATIVES),
    ("direct_projective", "direct", SAME_WITHOUT_DERIVATIVES),
    ("direct_reparam", "direct", SAME_WITHOUT_DERIVATIVES),
    ("erpt", "mmlt", SAME_PICTURE),
    ("mlt", "mmlt", SAME_PICTURE),
    ("photonmapper", "photonmap", SAME_METHOD),
    ("ppm", "sppm", SAME_METHOD),
    ("guided_path", "guided", SAME_METHOD),
    ("path_guiding_integrator", "guided", SAME_METHOD),
    ("recursive_path", "path", SAME_PICTURE),
];

const SAME_WITHOUT_DERIVATIVES: &str = "they agree where no derivatives are asked for";
const SAME_PICTURE: &str = "both converge to the same picture";
const SAME_METHOD: &str = "it is the same method, with parameters of its own";

/// The `max_depth` of Mitsuba's differentiable path integrators where the scene names none.
const DIFFERENTIABLE_DEPTH: i64 = 6;

/// Integrators of Mitsuba 0.6 that distribute the samples of another one, which replaces them.
const WRAPPERS: [&str; 2] = ["adaptive", "irrcache"];

/// Replaces integrators that are not built.
pub(crate) fn stand_in(reader: &mut Reader<'_>) {
    for id in 0..reader.draft.objects.len() {
        let object = &mut reader.draft.objects[id];
        if object.class != Class::Integrator {
            continue;
        }
        let name = object.plugin.value.as_str();
        if WRAPPERS.contains(&name) {
            unwrap(reader, id);
            continue;
        }
        let Some((name, other, agree)) = STAND_INS.into_iter().find(|(old, ..)| *old == name)
        else {
            continue;
        };
        let span = object.plugin.span;
        object.plugin.value = other.to_owned();
        let kept = |p: &DraftProperty| {
            KEPT.contains(&p.name.as_str()) || name == "ppm" && PHOTONS.contains(&p.name.as_str())
        };
        let (mut rest, dropped) = std::mem::take(&mut object.properties)
            .into_iter()
            .partition::<Vec<_>, _>(kept);
        let is_bounded = rest.iter().any(|p| p.name == "max_depth");
        if name.starts_with("prb") && !is_bounded {
            rest.push(DraftProperty {
                name: "max_depth".to_owned(),
                name_span: span,
                value: DraftValue::Plain(Value::Integer(DIFFERENTIABLE_DEPTH)),
                span,
                excused: false,
            });
        }
        // An integrator that does not know one of these is not to be blamed.
        rest.iter_mut().for_each(|p| p.excused = true);
        object.properties = rest;
        let unknown = judge(reader, name, &dropped);
        let help = match unknown.as_slice() {
            [] => agree.to_owned(),
            names => format!("{agree}; it does without {}", names.join(", ")),
        };
        reader.report(
            Diagnostic::note(
                span,
                format!("the integrator `{name}` is not built: `{other}` stands in for it"),
            )
            .help(help),
        );
    }
}

/// Checks the parameters of a replaced integrator, which its replacement does not use. Returns unknown ones of an integrator
/// that no Mitsuba has.
fn judge(reader: &mut Reader<'_>, plugin: &str, dropped: &[DraftProperty]) -> Vec<String> {
    let is_mitsubas = plugins::status(Class::Integrator, plugin) != plugins::Status::Unknown;
    let mut unknown = Vec::new();
    for property in dropped {
        let DraftValue::Plain(value) = &property.value else {
            continue;
        };
        let name = property.name.as_str();
        if !is_mitsubas {
            unknown.push(format!("`{}`", excerpt(name)));
            continue;
        }
        let unused = Unused {
            class: Class::Integrator,
            plugin,
            name,
            span: property.name_span,
        };
        if let Some(diagnostic) = unused.judge(value, KEPT) {
            reader.report(diagnostic);
        }
    }
    unknown
}

/// Puts the only integrator inside of a wrapper in the wrapper's place.
fn unwrap(reader: &mut Reader<'_>, wrapper: ObjectId) {
    let inner: Vec<ObjectId> = nested(reader, wrapper);
    let &[inner] = inner.as_slice() else {
        return;
    };
    for object in &mut reader.draft.objects {
        for property in &mut object.properties {
            if matches!(property.value, DraftValue::Object(id) if id == wrapper) {
                property.value = DraftValue::Object(inner);
            }
        }
    }
    let name = reader.draft.objects[wrapper].plugin.value.clone();
    let own = reader.draft.objects[wrapper].properties.clone();
    judge(reader, &name, &own);
    let plugin = &reader.draft.objects[wrapper].plugin;
    let message = format!(
        "the integrator `{}` is not built: the `{}` inside of it stands in for it",
        plugin.value, reader.draft.objects[inner].plugin.value
    );
    let diagnostic = Diagnostic::note(plugin.span, message).help(SAME_PICTURE);
    reader.report(diagnostic);
}

/// The integrators directly inside of an object.
pub(crate) fn nested(reader: &Reader<'_>, id: ObjectId) -> Vec<ObjectId> {
    let objects = &reader.draft.objects;
    let children = objects[id].properties.iter();
    children
        .filter_map(|property| match property.value {
            DraftValue::Object(child) if objects[child].class == Class::Integrator => Some(child),
            _ => None,
        })
        .collect()
}

/// Replaces the type of the innermost integrator of the scene `root`.
pub(crate) fn replace(reader: &mut Reader<'_>, root: ObjectId, name: &str) {
    let file = reader.sources.add("--integrator", name);
    let span = Span {
        file,
        start: 0,
        end: name.len() as u32,
    };
    let plugin = Spanned {
        value: name.to_owned(),
        span,
    };
    let innermost = innermost(reader, root);
    for &id in &innermost {
        let object = &mut reader.draft.objects[id];
        if object.plugin.value == name {
            continue;
        }
        object.plugin = plugin.clone();
        object.properties.retain_mut(|property| {
            property.excused = true;
            KEPT.contains(&property.name.as_str())
        });
    }
    if innermost.is_empty() {
        let id = reader.draft.objects.len();
        reader.draft.objects.push(DraftObject {
            class: Class::Integrator,
            plugin,
            id: None,
            span,
            properties: Vec::new(),
        });
        reader.draft.objects[root].properties.push(DraftProperty {
            name: String::new(),
            name_span: span,
            value: DraftValue::Object(id),
            span,
            excused: false,
        });
    }
}

/// The integrators under `root` that contain no other.
fn innermost(reader: &Reader<'_>, root: ObjectId) -> Vec<ObjectId> {
    let mut found = Vec::new();
    let mut seen = Vec::new();
    let mut open = nested(reader, root);
    while let Some(id) = open.pop() {
        if seen.contains(&id) {
            continue;
        }
        seen.push(id);
        let inner = nested(reader, id);
        if inner.is_empty() {
            found.push(id);
        }
        open.extend(inner);
    }
    let is_field = |id: &ObjectId| reader.draft.objects[*id].plugin.value == "field";
    if !found.iter().all(is_field) {
        found.retain(|id| !is_field(id));
    }
    found
}
