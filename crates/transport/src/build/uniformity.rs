//! Lights without extent, skies of one colour and homogeneous media have nothing over which a texture could vary.

use crate::Build;
use etalon_params::{Class, Diagnostic, Node, Params, Value};

/// Whether the value of `name` is a texture that varies in space.
pub fn is_varying(params: &Params<'_>, name: &str, build: &dyn Build) -> bool {
    let property = params.node.property(name);
    matches!(property.map(|p| &p.value), Some(Value::Object(node)) if varies(node, build))
}

/// Refuses a texture that varies in space as the value of `name`.
pub fn refuse_varying(params: &Params<'_>, name: &str, build: &dyn Build) {
    if is_varying(params, name, build) {
        let message = format!(
            "`{name}` of `{}` must be a spectrum or colour that does not vary in space",
            params.node.plugin.value
        );
        let span = params.property(name).map_or(params.node.span, |p| p.span);
        let error = Diagnostic::error(span, message);
        params.diagnostics.push(match params.node.class {
            Class::Subsurface => error.help(
                "`albedo` and `mean_free_path` of a surface may vary over it; matter that varies in space is a `heterogeneous` \
                 medium, the `interior` of a shape with a `difftrans` or `roughdielectric`",
            ),
            _ => error,
        });
    }
}

/// Whether a texture, or one inside of it, varies in space.
fn varies(node: &Node, build: &dyn Build) -> bool {
    let inside = |value: &Value| matches!(value, Value::Object(inner) if varies(inner, build));
    let name = node.plugin.value.as_str();
    matches!(node.class, Class::Texture | Class::Volume)
        && (build.varies(name) || node.properties.iter().any(|p| inside(&p.value)))
}
