//! The media of a scene, and which of them lie on the two sides of a surface.

pub(crate) mod bodies;
pub(crate) mod dark_media;
pub(crate) mod emission_medium;
pub(crate) mod homogeneous_media;
pub(crate) mod medium_lights;
pub(crate) mod short_flights;
pub(crate) mod subsurface;

use etalon_geometry::Shape;
use etalon_params::{Class, Diagnostic, Diagnostics, Node, Params, Span};
use etalon_sampling::{Independent, Sampler};
use etalon_subsurface::{MediumAtWavelengths, MediumDescription, Tracking};
use etalon_transport::{
    LightId, MediumId, MediumInterface, Ray, ShapeId, Shapes, SurfaceInteraction, Textures,
};
use glam::{Vec3, Vec4};

use crate::builder::Builder;
use crate::media::bodies::Bodies;
use crate::scene_tables::SceneTables;
use crate::surfaces::Surfaces;
use std::sync::Arc;

/// The most cells along the longest side of a medium's box that are bounded apart.
const MOST_CELLS: u32 = 128;

/// Values of a grid per majorant cell, along each axis.
const VALUES_PER_CELL: u32 = 4;

/// Makes media ready that vary in space: where they end, and how dense they are at most. `None` after a mistake.
/// `bounded` are the shapes with their media; without them nothing is known of where media end.
pub(crate) fn prepared(
    media: Vec<(MediumDescription, Span)>,
    bounded: Option<&[(ShapeId, MediumInterface)]>,
    camera: MediumId,
    lookup: &SceneTables,
    diagnostics: &Diagnostics,
) -> Option<Vec<MediumDescription>> {
    let table = &lookup.textures;
    let mut prepared = Vec::new();
    for (index, (mut medium, span)) in media.into_iter().enumerate() {
        if let MediumDescription::Heterogeneous(varying) = &mut medium {
            let id = MediumId(index as u32);
            let shapes = bounded.filter(|_| camera != id);
            let shapes = shapes.and_then(|bounded| within(id, bounded, lookup));
            let density = table.get(varying.density());
            let bounds = match (density.extent(table), shapes) {
                (Some([a, b]), Some([c, d])) => Some([a.max(c), b.min(d)]),
                (extent, shapes) => extent.or(shapes),
            };
            let cells = density
                .cells(table)
                .div_ceil(VALUES_PER_CELL)
                .min(MOST_CELLS);
            let most = |low: Vec3, high: Vec3| density.most_within(table, low, high);
            let least = |low: Vec3, high: Vec3| density.least_within(table, low, high);
            let anywhere = [Vec3::NEG_INFINITY, Vec3::INFINITY];
            let area = varying.largest_area(|id| {
                let [low, high] = anywhere;
                table.get(id).most_within(table, low, high)
            });
            if !varying.prepare(bounds, cells, area, most, least) {
                let message = "nothing bounds the density of this medium: it must be made of grids, patterns, numbers \
                               and spectra";
                diagnostics.push(Diagnostic::error(span, message));
                return None;
            }
        }
        note_bias(&medium, lookup, span, diagnostics);
        note_bias_of_profile(&medium, lookup, span, diagnostics);
        prepared.push(medium);
    }
    Some(prepared)
}

/// Refuses coefficients that vary over a surface in a scene with overlapping bodies: a walk that crosses the suppressed
/// surface of another body would take its coefficients from that surface.
pub(crate) fn refuse_varying_bodies(
    media: &[(MediumDescription, Span)],
    diagnostics: &Diagnostics,
) {
    let varies = |medium: &MediumDescription| matches!(medium, MediumDescription::Homogeneous(walk) if walk.varies());
    for (_, span) in media.iter().filter(|(medium, _)| varies(medium)) {
        let message =
            "coefficients that vary over a surface do not go with `priority` in one scene";
        let help = "give `albedo` and `mean_free_path` without a texture";
        diagnostics.push(Diagnostic::error(*span, message).help(help));
    }
}

/// Notes the bias of ray marching, estimated along random segments through a medium's box.
fn note_bias(
    medium: &MediumDescription,
    lookup: &SceneTables,
    span: Span,
    diagnostics: &Diagnostics,
) {
    const WAYS: u32 = 256;
    let at = medium.enter(None, lookup, LAMBDA);
    let (Tracking::RayMarching(step), Some([low, high])) = (at.tracking(), medium.bounds()) else {
        return;
    };
    let mut stream = Independent::from_key(0);
    let mut place = || low + (high - low) * Vec3::from_array([(); 3].map(|()| stream.next_1d()));
    let errors = (0..WAYS).filter_map(|_| {
        let ray = Ray::between(place(), place(), 0.0)?;
        let ray = Ray {
            origin: ray.at(-2.0 * (high - low).length()),
            ..ray
        };
        let [coarse, fine] =
            [step, step / 32.0].map(|step| at.march(&ray, f32::INFINITY, step).element_sum());
        Some(0.25 * (coarse - fine).abs())
    });
    let errors: Vec<f32> = errors.collect();
    let mean = 100.0 * errors.iter().sum::<f32>() / errors.len().max(1) as f32;
    let most = 100.0 * errors.iter().fold(0.0_f32, |most, error| most.max(*error));
    let message = format!(
        "ray marching in steps of {step} m is biased: of the light through this medium it takes {mean:.2} % too much or too \
         little, on average over {WAYS} ways, and {most:.2} % at most"
    );
    let help =
        "the other ways of `tracking` are unbiased; half the step has about a quarter of the bias";
    diagnostics.push(Diagnostic::note(span, message).help(help));
}

/// Wavelengths (nm) at which biases are evaluated.
const LAMBDA: Vec4 = Vec4::new(450.0, 520.0, 590.0, 660.0);

/// Says by how much a diffusion profile is wrong about a flat surface.
fn note_bias_of_profile(
    medium: &MediumDescription,
    lookup: &SceneTables,
    span: Span,
    diagnostics: &Diagnostics,
) {
    let MediumDescription::Homogeneous(medium) = medium else {
        return;
    };
    if !medium.diffuses() {
        return;
    }
    let help = "`randomwalk` is unbiased";
    let Some([profile, exact]) = medium.bias(lookup, LAMBDA) else {
        let message =
            "a diffusion profile is biased, where little is scattered or a surface bends above all";
        diagnostics.push(Diagnostic::note(span, message).help(help));
        return;
    };
    let ([b, g, _, r], walk) = ((100.0 * profile).to_array(), 100.0 * exact);
    let message = format!(
        "a diffusion profile is biased: of the light that enters a flat piece of this it lets {r:.1}, {g:.1} and {b:.1} % leave at \
         660, 520 and 450 nm, where a walk lets {:.1}, {:.1} and {:.1} %; where a surface bends or matter is thin it is off by more",
        walk.w, walk.y, walk.x
    );
    diagnostics.push(Diagnostic::note(span, message).help(help));
}

/// The box of the shapes that hold a medium inside; `None` if it is outside of any.
fn within(
    medium: MediumId,
    bounded: &[(ShapeId, MediumInterface)],
    lookup: &SceneTables,
) -> Option<[Vec3; 2]> {
    let outside = bounded
        .iter()
        .any(|(_, interface)| interface.outside == medium);
    let inside = bounded
        .iter()
        .filter(|(_, interface)| interface.inside == medium);
    let bounds = inside.map(|(shape, _)| Shapes::bounds(lookup, *shape));
    let all = bounds.reduce(|[a, b], [c, d]| [a.min(c), b.max(d)]);
    all.filter(|_| !outside)
}

impl Surfaces {
    /// The media on both sides of a shape, if it has `interior` or `exterior`, or a medium below its surface.
    pub(crate) fn media(
        &mut self,
        params: &Params<'_>,
        below: Option<MediumId>,
        builder: &mut Builder<'_>,
    ) -> Option<MediumInterface> {
        let mut media = below.map(|inside| MediumInterface {
            inside,
            outside: MediumId::NONE,
        });
        for (property, node) in params.children(Class::Medium) {
            let medium = self.medium(node, builder);
            let media = media.get_or_insert(MediumInterface::within(MediumId::NONE));
            match property.name.as_str() {
                "interior" if below.is_some() => {
                    let message = "`subsurface` has its medium already";
                    let diagnostic = Diagnostic::error(property.name_span, message);
                    builder.diagnostics.push(diagnostic);
                }
                "interior" => media.inside = medium,
                "exterior" => media.outside = medium,
                _ => builder.diagnostics.push(
                    Diagnostic::error(property.name_span, "a medium on which side of the shape?")
                        .help("accepted: `name=\"interior\"` and `name=\"exterior\"`"),
                ),
            }
        }
        media
    }

    /// Says so where something below a surface, or a body, needs a closed shape and this one is open.
    pub(crate) fn expect_closed(params: &Params<'_>, shape: &Shape, below: bool, body: bool) {
        let needs = match (below, body) {
            (true, _) => "what is below its surface",
            (_, true) => "its `priority`",
            _ => return,
        };
        if shape.is_open() {
            let message = format!("this shape is open, and {needs} needs a closed one");
            let help = "light that enters it has no way out but through other shapes that close it";
            let note = Diagnostic::note(params.node.plugin.span, message);
            params.diagnostics.push(note.help(help));
        }
    }

    /// A medium, read once however often it is used; media that are the same are one.
    pub fn medium(&mut self, node: &Arc<Node>, builder: &mut Builder<'_>) -> MediumId {
        let key = Arc::as_ptr(node) as usize;
        if let Some(id) = self.medium_by_node.get(&key) {
            return *id;
        }
        let params = Params::new(node, builder.diagnostics);
        let Some(medium) = MediumDescription::from_params(&params, builder) else {
            return MediumId::NONE;
        };
        let same = self.media.iter().position(|(other, _)| *other == medium);
        let id = MediumId(same.unwrap_or(self.media.len()) as u32);
        if same.is_none() {
            self.media.push((medium, node.plugin.span));
        }
        self.medium_by_node.insert(key, id);
        id
    }
}

/// Media by id.
#[derive(Debug)]
pub struct SceneMedia {
    pub(crate) media: Vec<MediumDescription>,
    /// By shape; empty beyond the last shape with media.
    interfaces: Vec<Option<MediumInterface>>,
    /// That of the camera.
    pub camera: MediumId,
    /// The boxes of the shapes that hold each.
    pub(crate) boxes: Vec<Option<[Vec3; 2]>>,
    /// Around each light, as far as the scene says.
    lights: Vec<Option<MediumInterface>>,
    /// Shapes that overlap, if any do.
    bodies: Option<Bodies>,
}

/// The medium around a light, as the scene names it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightMedium {
    /// The shape that the light is on.
    pub(crate) shape: Option<ShapeId>,
    /// The medium that the light names.
    pub(crate) declared: Option<MediumId>,
}

impl SceneMedia {
    /// Media with the shapes that bound them, some of which are `placed` as instances.
    pub(crate) fn new(
        media: Vec<MediumDescription>,
        bounded: &[(ShapeId, MediumInterface)],
        placed: bool,
        lights: &[LightMedium],
        camera: MediumId,
        bodies: Option<Bodies>,
        lookup: &SceneTables,
    ) -> Self {
        let mut interfaces = Vec::new();
        let is_body =
            |shape| (bodies.as_ref()).is_some_and(|bodies| bodies.of_shape(shape).is_some());
        for (shape, interface) in bounded.iter().filter(|(shape, _)| !is_body(*shape)) {
            let index = shape.0 as usize;
            if interfaces.len() <= index {
                interfaces.resize(index + 1, None);
            }
            interfaces[index] = Some(*interface);
        }
        let around = |light: &LightMedium| {
            let shape = light.shape.map(|shape| shape.0 as usize);
            let own = shape.and_then(|shape| interfaces.get(shape).copied().flatten());
            own.or(light.declared.map(MediumInterface::within))
        };
        let held = |index| {
            let id = MediumId(index as u32);
            (!placed && id != camera)
                .then(|| within(id, bounded, lookup))
                .flatten()
        };
        Self {
            lights: lights.iter().map(around).collect(),
            boxes: (0..media.len()).map(held).collect(),
            media,
            interfaces,
            camera,
            bodies,
        }
    }

    /// Shapes that overlap, if any do.
    #[inline]
    pub(crate) fn bodies(&self) -> Option<&Bodies> {
        self.bodies.as_ref()
    }

    /// The medium by its own number, of a ray in it that may be in some bodies.
    #[inline]
    pub(crate) fn filling(&self, medium: MediumId) -> MediumId {
        match &self.bodies {
            None => medium,
            Some(bodies) => bodies.filling(medium).medium,
        }
    }

    /// The box from `low` to `high` with all media that end by themselves.
    pub fn extent(&self, [low, high]: [Vec3; 2]) -> [Vec3; 2] {
        let bounds = self.media.iter().filter_map(MediumDescription::bounds);
        bounds.fold([low, high], |[a, b], [c, d]| [a.min(c), b.max(d)])
    }

    /// Whether a medium has no end.
    pub fn is_endless(&self, medium: MediumId) -> bool {
        let medium = self.media.get(self.filling(medium).0 as usize);
        medium.is_some_and(|medium| medium.bounds().is_none())
    }

    /// The media on both sides of a shape, if it bounds any.
    #[inline]
    pub fn of_shape(&self, shape: ShapeId) -> Option<MediumInterface> {
        self.interfaces.get(shape.0 as usize).copied().flatten()
    }

    /// Whether the media on both sides of a shape may differ.
    pub(crate) fn bounds_medium(&self, shape: ShapeId) -> bool {
        let bodies = self.bodies.as_ref();
        let is_body = bodies.is_some_and(|bodies| bodies.of_shape(shape).is_some());
        is_body || self.of_shape(shape).is_some()
    }

    /// The media on both sides of a light, if the scene says.
    #[inline]
    pub fn of_light(&self, light: LightId) -> Option<MediumInterface> {
        self.lights.get(light.0 as usize).copied().flatten()
    }

    /// Those that emit light and end somewhere, with their boxes.
    pub fn emitting_bounds(&self) -> impl Iterator<Item = (MediumId, [Vec3; 2])> {
        let boxes = self.media.iter().zip(&self.boxes).zip(0..);
        boxes.filter_map(|((medium, bounds), id)| {
            let bounds = medium.bounds().or(*bounds).filter(|_| medium.emits())?;
            Some((MediumId(id), bounds))
        })
    }

    /// Number of emitting media.
    pub fn emitting(&self) -> u32 {
        self.media.iter().filter(|medium| medium.emits()).count() as u32
    }

    /// Whether rays must track their medium.
    pub fn exist(&self) -> bool {
        !self.interfaces.is_empty() || self.camera.is_some() || self.bodies.is_some()
    }

    /// Whether there are any.
    pub fn any(&self) -> bool {
        !self.media.is_empty()
    }

    /// The media on both sides of a shape for a ray that arrives in `arriving`, from `outside` or not: that one, if the shape
    /// bounds none.
    #[inline]
    pub fn around(&self, shape: ShapeId, arriving: MediumId, outside: bool) -> MediumInterface {
        if let Some(bodies) = &self.bodies
            && let Some(kind) = bodies.of_shape(shape)
        {
            return bodies.around(kind, arriving, outside);
        }
        let own = self.of_shape(shape);
        own.unwrap_or(MediumInterface::within(arriving))
    }

    /// A medium at four wavelengths (nm), for a path that enters it at a surface point or is in it already.
    #[inline]
    pub fn enter<'a, T: Textures>(
        &'a self,
        medium: MediumId,
        at: Option<&SurfaceInteraction>,
        textures: &'a T,
        lambda: Vec4,
    ) -> Option<MediumAtWavelengths<'a, T>> {
        let medium = self.media.get(self.filling(medium).0 as usize)?;
        Some(medium.enter(at.map(Into::into), textures, lambda))
    }
}
