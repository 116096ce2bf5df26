//! Where an estimator's objections to a scene are shown.

use etalon_params::{Class, Diagnostic, Node, Span, Value};
use etalon_scene::Compiled;
use etalon_transport::{Incompatibility, Subject};

/// An objection as a message at the place in the scene file that it is about.
pub(crate) fn diagnostic(
    objection: Incompatibility,
    root: &Node,
    compiled: &Compiled,
) -> Diagnostic {
    let span = match objection.subject {
        Subject::Integrator => place(root, &[Class::Integrator]),
        Subject::Parameter(name) => {
            parameter(root, name).unwrap_or_else(|| place(root, &[Class::Integrator]))
        }
        Subject::Classic => compiled.classic.unwrap_or(root.plugin.span),
        Subject::Camera => compiled.sensor.plugin.span,
        Subject::Scene => root.plugin.span,
    };
    let diagnostic = if objection.fatal {
        Diagnostic::error(span, objection.message)
    } else {
        Diagnostic::note(span, objection.message)
    };
    Diagnostic {
        help: objection.help,
        ..diagnostic
    }
}

/// Where the object at the end of a path of classes is named, or the last one that there is.
pub(crate) fn place(root: &Node, classes: &[Class]) -> Span {
    let mut node = root;
    for class in classes {
        let found = node.properties.iter().find_map(|p| match &p.value {
            Value::Object(child) if child.class == *class => Some(child),
            _ => None,
        });
        match found {
            Some(child) => node = child,
            None => break,
        }
    }
    node.plugin.span
}

/// Where a parameter of the scene's integrator stands, or of one nested in it.
fn parameter(node: &Node, name: &str) -> Option<Span> {
    let is_integrator = node.class == Class::Integrator;
    let own = node
        .properties
        .iter()
        .find(|p| is_integrator && p.name == name);
    own.map(|p| p.span).or_else(|| {
        node.properties.iter().find_map(|p| match &p.value {
            Value::Object(child) if child.class == Class::Integrator => parameter(child, name),
            _ => None,
        })
    })
}
