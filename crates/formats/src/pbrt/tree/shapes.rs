//! Shapes (`shapes.cpp`): dispatch, and what stands on them.
//!
//! pbrt's CTM is `to_world`. Which side is outside matters to light, to glass and to media; it is `flip_normals` of each kind of shape,
//! see `quadrics`, `meshes` and `bilinear`. A shape that is not opaque (`alpha`) has a `mask` around its material; both programs let
//! light pass by chance. A surface between two media says which is where, as pbrt's `MediumInterface` does: inside is where the normal
//! points away from.

use super::super::parameters::Parameters;
use super::super::scene::Shape;
use super::Mapper;
use super::curves;
use super::materials::Surface;
use super::node::{Draft, Given, given};
use super::placement::placed;
use super::textures::{has_tangents, looks_at_uv};
use etalon_params::{Class, DMat4, Node, Value};
use std::sync::Arc;

/// The form of a shape.
pub(crate) struct Form {
    /// Nodes without what stands on them.
    pub(crate) drafts: Vec<Draft>,
    /// The area of each light that pbrt makes of it, if all have the same.
    pub(crate) area: Option<f64>,
}

/// How a form is to be mapped.
pub(crate) struct Wanted<'s> {
    /// The shape.
    pub(crate) shape: &'s Shape,
    /// Those that become one with it.
    pub(crate) following: &'s [Shape],
    /// Whether anything is looked up by its texture coordinates.
    pub(crate) by_uv: bool,
    /// Whether anything depends on the direction in which u grows.
    pub(crate) along_u: bool,
}

impl Wanted<'_> {
    /// `flip_normals`, if it is needed.
    pub(crate) fn flipped(draft: Draft, flip: bool) -> Draft {
        match flip {
            true => draft.plain("flip_normals", Value::Boolean(true)),
            false => draft,
        }
    }
}

impl<'a> Mapper<'a> {
    /// The nodes of shapes, with their lights or without; what has a mistake is left out.
    pub(crate) fn shapes(&mut self, shapes: &'a [Shape], shine: bool) -> Vec<Arc<Node>> {
        let mut nodes = Vec::new();
        let mut rest = shapes;
        while let Some(first) = rest.first() {
            let (run, after) = rest.split_at(curves::run(rest));
            nodes.extend(self.shape(first, &run[1..], shine).unwrap_or_default());
            rest = after;
        }
        nodes
    }

    /// The nodes of a shape and of those that follow it and are one with it; `None` after a mistake.
    fn shape(
        &mut self,
        shape: &'a Shape,
        following: &'a [Shape],
        shines: bool,
    ) -> Option<Vec<Arc<Node>>> {
        let params = self.read(&shape.entity);
        let params = &params;
        let light = shape.area_light.as_deref().filter(|_| shines);
        let alpha = self.number_if_given(params, "alpha");
        let broken_alpha = alpha.is_none() && params.has("alpha");
        let alpha = alpha.filter(|alpha| !matches!(alpha.value, Value::Float(x) if x >= 1.0));
        let surface = self.material(shape.material);
        let media = self.interface(shape);
        let on_it = surface.as_ref().into_iter();
        let materials = on_it.flat_map(|on| on.bsdf.iter().chain(&on.subsurface));
        let holes = alpha.iter().filter_map(|alpha| match &alpha.value {
            Value::Object(texture) => Some(texture),
            _ => None,
        });
        let mut nodes = materials.clone().chain(holes);
        let wanted = Wanted {
            shape,
            following,
            by_uv: nodes.any(|node| looks_at_uv(node))
                || light.is_some_and(|l| l.params.find("filename").is_some()),
            along_u: materials.clone().any(|node| has_tangents(node)),
        };
        let form = self.form(params, &wanted);
        params.finish();
        let form = form?;
        let emitter = match light {
            Some(light) => Some(self.area_light(light, form.area, alpha.as_ref())?),
            None => None,
        };
        if broken_alpha {
            return None;
        }
        let mut surface = surface?;
        if let Some(alpha) = alpha {
            surface = self.masked(params, surface, alpha)?;
        }
        let media = media?;
        let complete = |draft: Draft| {
            let parts = [
                surface.bsdf.as_ref(),
                surface.subsurface.as_ref(),
                emitter.as_ref(),
            ];
            let parts = parts.into_iter().flatten().map(Arc::clone);
            let draft = parts.fold(draft, Draft::child);
            let within = media.iter().cloned();
            within
                .fold(draft, |draft, (name, medium)| draft.nested(name, medium))
                .node()
        };
        Some(form.drafts.into_iter().map(complete).collect())
    }

    /// The form; `None` after a mistake.
    fn form(&mut self, params: &Parameters<'a>, wanted: &Wanted<'a>) -> Option<Form> {
        match params.entity.kind {
            "sphere" => self.sphere(params, wanted),
            "disk" => self.disk(params, wanted),
            "cylinder" => self.cylinder(params, wanted),
            "trianglemesh" => self.triangle_mesh(params, wanted),
            "plymesh" => self.ply_mesh(params, wanted),
            "bilinearmesh" => self.bilinear_mesh(params, wanted),
            "loopsubdiv" => self.subdivided(params, wanted),
            "curve" => self.curves(params, wanted),
            // All that pbrt knows are above.
            _ => None,
        }
    }

    /// A node for a form in the shape's own space, which `local` is applied in first; `None` after a mistake.
    pub(crate) fn placed_form(
        &self,
        params: &Parameters<'_>,
        wanted: &Wanted<'_>,
        plugin: &str,
        local: DMat4,
    ) -> Option<Draft> {
        let span = params.entity.span;
        let to_world = self.to_world(&wanted.shape.placement, local, span)?;
        Some(placed(Draft::of(params, Class::Shape, plugin), to_world))
    }

    /// The material behind holes.
    fn masked(&self, params: &Parameters<'_>, surface: Surface, alpha: Given) -> Option<Surface> {
        let span = params.span("alpha");
        let (Some(bsdf), None) = (surface.bsdf, surface.subsurface) else {
            let what = "`alpha` of a shape with subsurface scattering";
            self.refuse_value(params, "alpha", what, "1");
            return None;
        };
        let draft = Draft::new(Class::Bsdf, "mask", span);
        let draft = draft.given("opacity", given(alpha.value, span));
        Some(Surface::of(draft.child(bsdf).node()))
    }

    /// The media on both sides of a surface, if it separates them; `None` after a mistake.
    fn interface(&mut self, shape: &Shape) -> Option<Vec<(&'static str, Arc<Node>)>> {
        if shape.inside == shape.outside {
            return Some(Vec::new());
        }
        let sides = [("interior", shape.inside), ("exterior", shape.outside)];
        let mut found = Vec::new();
        for (name, medium) in sides {
            if let Some(medium) = medium {
                found.push((name, self.medium(medium)?));
            }
        }
        Some(found)
    }
}
