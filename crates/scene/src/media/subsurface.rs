//! `<subsurface>`: light that enters a closed shape, walks about in it and leaves elsewhere.
//!
//! `randomwalk` is exactly a shape with a medium inside and a boundary, and is made into that: every estimator that sees media sees it, and
//! an explicit medium in the same boundary is the same. The `boundary` is
//!
//! - `diffuse`, the default: all light passes, and in all directions alike (`difftrans`), as through a fine powder: what enters
//!   is diffuse already, and the inversion of a surface's albedo (`etalon_subsurface::surface_albedo`) holds as it is;
//! - `smooth`: a `dielectric`, through which lights that are but points or directions are not seen by integrators that connect
//!   surfaces with lights;
//! - `rough`: a `roughdielectric`.
//!
//! The diffusion profiles (`dipole` and others) are the same, with a profile in place of the walk
//! (`etalon_subsurface::profiles`).

use crate::builder::Builder;
use crate::surfaces::Surfaces;
use etalon_bsdf::interface::{fresnel, relative_index::RelativeIndex};
use etalon_params::{Class, Diagnostic, Node, Params, Property, Spanned, Value};
use etalon_subsurface::{Boundary, Homogeneous, MediumDescription, Profile};
use etalon_transport::MediumId;
use std::sync::Arc;

/// Names of the subsurface plugins.
fn built() -> impl Iterator<Item = &'static str> + Clone {
    ["randomwalk"]
        .into_iter()
        .chain(Profile::BUILT.iter().copied())
}

/// The boundary's description, and the medium inside. `None` after a mistake.
pub(crate) fn read(
    node: &Node,
    builder: &mut Builder<'_>,
) -> Option<(Arc<Node>, MediumDescription)> {
    let params = Params::new(node, builder.diagnostics);
    if !built().any(|name| name == node.plugin.value) {
        (builder.diagnostics).push(etalon_params::plugins::not_built(node, built()));
        return None;
    }
    let (plugin, own): (_, &[&str]) =
        match params.choice("boundary", "diffuse", &["diffuse", "smooth", "rough"]) {
            "smooth" => ("dielectric", &["int_ior", "ext_ior"]),
            "rough" => (
                "roughdielectric",
                &["int_ior", "ext_ior", "alpha", "distribution"],
            ),
            _ => ("difftrans", &[]),
        };
    let mut properties: Vec<Property> = (own.iter())
        .filter_map(|name| params.property(name))
        .map(|p| Property::new(p.name.clone(), p.name_span, p.value.clone(), p.span))
        .collect();
    let boundary = match own {
        [] => {
            let span = node.plugin.span;
            let all = Value::Float(1.0);
            properties.push(Property::new("transmittance", span, all, span));
            Boundary {
                eta: None,
                inside: 0.0,
            }
        }
        _ => {
            let eta = RelativeIndex::constant_from_params(&params, "bk7")?;
            Boundary {
                eta: Some(eta as f32),
                inside: fresnel::internal_diffuse_reflectance(eta) as f32,
            }
        }
    };
    let medium = Homogeneous::of_subsurface(&params, boundary, builder);
    params.finish();
    let material = Node {
        class: Class::Bsdf,
        plugin: Spanned {
            value: plugin.to_owned(),
            span: node.plugin.span,
        },
        id: None,
        span: node.span,
        properties,
    };
    Some((Arc::new(material), MediumDescription::Homogeneous(medium?)))
}

impl Surfaces {
    /// The boundary and the medium of a shape that has something below its surface.
    pub(crate) fn below(
        &mut self,
        params: &Params<'_>,
        builder: &mut Builder<'_>,
    ) -> Option<(Arc<Node>, MediumId)> {
        let node = params.child(Class::Subsurface)?;
        for (property, _) in params.children(Class::Bsdf) {
            let message = "`subsurface` has its boundary already";
            (params.diagnostics).push(Diagnostic::error(property.span, message));
        }
        let (boundary, medium) = read(node, builder)?;
        let id = MediumId(self.media.len() as u32);
        self.media.push((medium, node.plugin.span));
        // Materials are known by the addresses of their descriptions, which must last.
        self.boundaries.push(Arc::clone(&boundary));
        Some((boundary, id))
    }
}
