//! How plugins read their nodes: types, ranges, choices, children and leftovers.

use etalon_params::{
    Class, DVec3, Diagnostics, FileId, Node, Params, Property, Severity, Sources, Span, Spanned,
    Value,
};
use std::sync::Arc;

/// A node whose properties stand one after the other in a source text.
struct Scene {
    sources: Sources,
    file: FileId,
}

impl Scene {
    fn new() -> Self {
        let mut sources = Sources::default();
        let file = sources.add("s.xml", "0123456789");
        Self { sources, file }
    }

    fn span(&self, start: u32) -> Span {
        Span {
            file: self.file,
            start,
            end: start + 1,
        }
    }

    fn node(&self, class: Class, plugin: &str, properties: Vec<(&str, Value)>) -> Node {
        Node {
            class,
            plugin: Spanned {
                value: plugin.into(),
                span: self.span(0),
            },
            id: None,
            span: self.span(0),
            properties: properties
                .into_iter()
                .enumerate()
                .map(|(i, (name, value))| {
                    let span = self.span(i as u32 + 1);
                    Property::new(name, span, value, span)
                })
                .collect(),
        }
    }

    /// Everything that `read` says about the node.
    fn messages(&self, node: &Node, read: impl FnOnce(&Params<'_>)) -> Vec<String> {
        let diagnostics = Diagnostics::new();
        let params = Params::new(node, &diagnostics);
        read(&params);
        params.finish();
        diagnostics
            .into_sorted()
            .iter()
            .map(|d| d.one_line(&self.sources))
            .collect()
    }
}

#[test]
fn values_of_the_right_type_are_read_without_a_word() {
    let scene = Scene::new();
    let node = scene.node(
        Class::Shape,
        "sphere",
        vec![
            ("radius", Value::Integer(2)),
            ("count", Value::Integer(7)),
            ("flip_normals", Value::Boolean(true)),
            ("center", Value::Vector(DVec3::X)),
            ("mode", Value::String("Smooth".into())),
            ("silhouette_sampling_weight", Value::Float(3.0)),
        ],
    );
    let messages = scene.messages(&node, |params| {
        assert_eq!(params.float_or("radius", 1.0), 2.0);
        assert_eq!(params.integer_or("count", 1), 7);
        assert!(params.boolean_or("flip_normals", false));
        assert_eq!(params.vector("center"), Some(DVec3::X));
        assert_eq!(params.choice("mode", "flat", &["flat", "smooth"]), "smooth");
        assert_eq!(params.float_or("absent", 0.25), 0.25);
    });
    assert!(messages.is_empty(), "{messages:?}");
}

#[test]
fn each_mistake_is_said_at_its_place() {
    let scene = Scene::new();
    let node = scene.node(
        Class::Bsdf,
        "roughthing",
        vec![
            ("alpha", Value::String("rough".into())),
            ("samples", Value::Float(4.0)),
            ("distribution", Value::String("gxx".into())),
            ("eta", Value::Float(-1.0)),
            ("alhpa_u", Value::Float(0.1)),
            ("", Value::Boolean(true)),
        ],
    );
    let messages = scene.messages(&node, |params| {
        params.float("alpha");
        params.integer("samples");
        params.choice("distribution", "ggx", &["ggx", "beckmann"]);
        params.float_where("eta", 1.5, "a number above 0", |x| x > 0.0);
        params.float("alpha_u");
        params.missing("material", "a name");
    });
    assert_eq!(
        messages,
        [
            "s.xml:1:1: error: `roughthing` needs the parameter `material` (a name)",
            "s.xml:1:2: error: parameter `alpha` of `roughthing` must be a number, not a string",
            "s.xml:1:3: error: parameter `samples` of `roughthing` must be an integer, not a float",
            "s.xml:1:4: error: `gxx` is not a value of `distribution` (did you mean `ggx`?)",
            "s.xml:1:5: error: parameter `eta` of `roughthing` cannot be -1 \
             (accepted: a number above 0)",
            "s.xml:1:6: error: `roughthing` has no parameter `alhpa_u` (did you mean `alpha_u`?)",
            "s.xml:1:7: error: `roughthing` does not take a boolean \
             (accepted: alpha, samples, distribution, eta, alpha_u)",
        ]
    );
}

#[test]
fn children_are_found_by_class() {
    let scene = Scene::new();
    let child = |class| Value::Object(Arc::new(scene.node(class, "x", Vec::new())));
    let node = scene.node(
        Class::Shape,
        "cube",
        vec![
            ("", child(Class::Bsdf)),
            ("second", child(Class::Bsdf)),
            ("", child(Class::Sampler)),
        ],
    );
    let messages = scene.messages(&node, |params| {
        assert_eq!(params.children(Class::Bsdf).len(), 2);
        assert!(params.child(Class::Bsdf).is_some());
        assert!(params.child(Class::Emitter).is_none());
    });
    assert_eq!(
        messages,
        [
            "s.xml:1:3: error: `cube` takes one bsdf only",
            "s.xml:1:4: error: `cube` does not take an object of the class `sampler`",
        ]
    );
}

#[test]
fn one_mistake_is_said_once_and_notes_are_no_errors() {
    let scene = Scene::new();
    let diagnostics = Diagnostics::new();
    let note = etalon_params::Diagnostic::note(scene.span(1), "a note");
    diagnostics.push(note.clone());
    diagnostics.push(note);
    assert!(!diagnostics.has_errors());
    let list = diagnostics.into_sorted();
    assert_eq!((list.len(), list[0].severity), (1, Severity::Note));
    assert_eq!(list[0].one_line(&scene.sources), "s.xml:1:2: note: a note");
}

#[test]
fn nothing_is_said_twice_about_one_place() {
    let scene = Scene::new();
    let error = |at, text: &str| etalon_params::Diagnostic::error(scene.span(at), text);
    let diagnostics = Diagnostics::silent_about(&[scene.span(3)]);
    diagnostics.push(error(3, "cannot be 1"));
    diagnostics.push(error(7, "something else"));
    let list = diagnostics.into_sorted();
    assert_eq!(
        (list.len(), list[0].message.as_str()),
        (1, "something else")
    );
}

#[test]
fn what_would_change_nothing_is_passed_over_and_a_limit_of_time_is_not() {
    // Mutant rejected: a list without its condition on `timeout`. (It reads no integrator.)
    let scene = Scene::new();
    let said = |plugin: &str, properties| {
        let node = scene.node(Class::Integrator, plugin, properties);
        scene.messages(&node, |_| ())
    };
    let tiles = vec![
        ("block_size", Value::Integer(32)),
        ("timeout", Value::Float(-1.0)),
    ];
    assert_eq!(said("path", tiles), [""; 0]);
    assert_eq!(
        said("path", vec![("timeout", Value::Float(5.0))]),
        ["s.xml:1:2: error: `timeout` must be not above 0, which means no limit"]
    );
    let lights = || vec![("hide_emitters", Value::Boolean(true))];
    assert_eq!(said("depth", lights()), [""; 0]);
    assert_eq!(said("path", lights()).len(), 1);
}

#[test]
fn what_mitsuba_06_obeys_and_nothing_here_is_refused_with_what_does_instead() {
    let scene = Scene::new();
    let said = |class, plugin: &str, name, value| {
        let node = scene.node(class, plugin, vec![(name, value)]);
        scene.messages(&node, |_| ()).concat()
    };
    let g = said(Class::Medium, "homogeneous", "g", Value::Float(0.5));
    assert!(g.contains("error: `g` of `homogeneous`, which Mitsuba 0.6 obeys, is not built"));
    assert!(g.contains("<phase type=\"hg\">"), "{g}");
    let text = || Value::String("a".into());
    let label = said(Class::Film, "hdrfilm", "label[10, 10]", text());
    assert!(label.contains("error"), "{label}");
    assert_eq!(said(Class::Film, "hdrfilm", "metadata['a']", text()), "");
    let index = |i| said(Class::Shape, "obj", "shape_index", Value::Integer(i));
    assert!(index(0).contains("must be negative"), "{}", index(0));
    assert_eq!(index(-1), "");
}

/// A plugin that gives up half way has not asked for all that it knows.
#[test]
fn what_was_not_asked_for_after_a_mistake_is_not_called_unknown() {
    let scene = Scene::new();
    let node = scene.node(Class::Bsdf, "mixture", vec![("int_ior", Value::Float(1.5))]);
    let said = |is_read: bool| {
        let diagnostics = Diagnostics::new();
        let params = Params::new(&node, &diagnostics);
        params.error("the shares are more than 1");
        params.finish_after(is_read);
        diagnostics.into_sorted().len()
    };
    assert_eq!([true, false].map(said), [2, 1]);
    // A slip in the name of what it missed is told all the same.
    let node = scene.node(
        Class::Texture,
        "bitmap",
        vec![("filname", Value::Integer(1))],
    );
    let diagnostics = Diagnostics::new();
    let params = Params::new(&node, &diagnostics);
    assert!(params.string("filename").is_none());
    params.missing("filename", "a file");
    params.finish_after(false);
    let help = diagnostics.into_sorted().into_iter().filter_map(|d| d.help);
    assert_eq!(help.collect::<Vec<_>>(), ["did you mean `filename`?"]);
}
