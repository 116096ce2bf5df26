//! Overlapping bodies: `priority` decides which of the bodies at a point fills it.
//!
//! Liquid in a glass is described by two closed shapes that overlap a little. Where they do, the one of higher `priority`
//! counts (C. M. Schmidt, B. Budge, Simple nested dielectrics in ray traced images, 2002): a surface is there only if
//! another body, or another medium, begins behind it, and between two dielectrics it has the index
//!
//! ```text
//! η = η(inside) / η(outside)
//! ```
//!
//! A ray carries the set of bodies that it is in. All sets that may occur are enumerated when the scene is compiled and
//! numbered after the media, so that a set is a [`MediumId`].

use crate::parts::Parts;
use etalon_bsdf::BsdfAtPoint;
use etalon_params::{Diagnostic, Diagnostics, Params, Span};
use etalon_spectrum::Wavelengths;
use etalon_transport::{MaterialId, MediumId, MediumInterface, ShapeId, SurfaceInteraction};
use glam::{Vec3, Vec4};
use std::collections::HashMap;

/// The most sets of bodies.
const MOST_SETS: u64 = 1 << 16;

/// The most overlapping bodies if their positions are unknown.
const DEPTH_UNKNOWN: usize = 16;

/// The most times that a point may be in one body that intersects itself.
const ITSELF: usize = 4;

/// The most bodies whose boxes are compared.
const MOST_COMPARED: usize = 4096;

/// The most kinds of bodies.
const MOST: usize = 16;

/// A body, or several alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Body {
    /// The higher, the stronger.
    pub(crate) priority: i64,
    /// The material of its surface.
    pub(crate) material: MaterialId,
    /// The medium inside.
    pub(crate) medium: MediumId,
}

impl Body {
    /// Reads `priority`, which makes a body of a closed shape with this material and these media.
    pub(crate) fn from_params(
        params: &Params<'_>,
        material: MaterialId,
        media: Option<MediumInterface>,
    ) -> Option<(Self, Span)> {
        let priority = params.integer("priority")?;
        if media.is_some_and(|media| media.outside.is_some()) {
            let message =
                "a shape with a `priority` has no `exterior`: that is what it is put into";
            params.error_at("priority", message);
        }
        let medium = media.map_or(MediumId::NONE, |media| media.inside);
        let body = Self {
            priority,
            material,
            medium,
        };
        Some((body, params.node.plugin.span))
    }
}

/// The bounds of a body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extent {
    /// The corners of its box.
    pub(crate) bounds: [Vec3; 2],
    /// Whether no point is in it more than once.
    pub(crate) is_simple: bool,
}

impl Extent {
    /// Whether the boxes of two meet.
    fn meets(&self, other: &Self) -> bool {
        let ([from, to], [low, high]) = (self.bounds, other.bounds);
        from.cmple(high).all() && to.cmpge(low).all()
    }
}

/// The bodies that a point is in, with the medium around them all.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Set {
    around: MediumId,
    /// Kinds, in order of strength.
    bodies: Vec<usize>,
}

/// The body and the medium at a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Filling {
    /// The body, unless none is there.
    pub(crate) body: Option<Body>,
    /// The medium.
    pub(crate) medium: MediumId,
}

/// The bodies of a scene, and the sets of them.
#[derive(Debug)]
pub(crate) struct Bodies {
    /// Kinds, the strongest first.
    kinds: Vec<Body>,
    /// The kind of each shape.
    of_shape: Vec<Option<usize>>,
    /// Number of media: sets are numbered from here.
    media: u32,
    sets: HashMap<Set, usize>,
    /// The places of the media with no body in them; empty space is the last.
    plain: Vec<Option<usize>>,
    /// The largest number of overlapping bodies of each kind, and in total.
    most: (Vec<usize>, usize),
    /// Body and medium for each set.
    fillings: Vec<Filling>,
    /// The sets with one more and one less, by set and kind.
    moves: Vec<[MediumId; 2]>,
}

impl Bodies {
    /// The bodies of `shapes`, in a scene with so many media. The media around them may be those of other shapes (`bounded`)
    /// and of the camera. `extent` is the bounding box of a shape, if known. `None` if there are no bodies, or after a
    /// mistake, which has been recorded.
    pub(crate) fn new(
        shapes: &[(ShapeId, Body, Span)],
        media: usize,
        bounded: &[(ShapeId, MediumInterface)],
        camera: MediumId,
        extent: impl Fn(ShapeId) -> Option<Extent>,
        diagnostics: &Diagnostics,
    ) -> Option<Self> {
        let mut kinds: Vec<Body> = Vec::new();
        for (_, body, span) in shapes {
            if !kinds.contains(body) {
                kinds.push(*body);
            }
            if kinds.len() > MOST {
                let message = format!("more than {MOST} kinds of bodies have a `priority`");
                let help = "bodies of one priority, material and medium are of one kind";
                diagnostics.push(Diagnostic::error(*span, message).help(help));
                return None;
            }
        }
        // Among equal priorities the first counts.
        kinds.sort_by_key(|body| core::cmp::Reverse(body.priority));
        let most = shapes
            .iter()
            .map(|(shape, ..)| shape.0 as usize + 1)
            .max()?;
        let mut of_shape = vec![None; most];
        for (shape, body, _) in shapes {
            of_shape[shape.0 as usize] = kinds.iter().position(|kind| kind == body);
        }
        let mut bodies = Self {
            kinds,
            of_shape,
            media: media as u32,
            sets: HashMap::new(),
            plain: vec![None; media + 1],
            most: (Vec::new(), 0),
            fillings: Vec::new(),
            moves: Vec::new(),
        };
        let others = bounded
            .iter()
            .filter(|(shape, _)| bodies.of_shape(*shape).is_none());
        let mut around: Vec<MediumId> = others
            .flat_map(|(_, sides)| [sides.inside, sides.outside])
            .chain([camera, MediumId::NONE])
            .collect();
        around.sort_unstable();
        around.dedup();
        let count = around.len() as u64;
        bodies.most = most_overlapping(shapes, &bodies.kinds, count, extent, diagnostics);
        for medium in around {
            bodies.list(Set {
                around: medium,
                bodies: Vec::new(),
            });
        }
        Some(bodies)
    }

    /// Lists a set and all that are made by adding to it; its place, and its number.
    fn list(&mut self, set: Set) -> (usize, MediumId) {
        let kinds = self.kinds.len();
        let known = self.sets.get(&set).copied();
        let index = known.unwrap_or(self.fillings.len());
        let number = match set.bodies[..] {
            [] => set.around,
            _ => MediumId(self.media + index as u32),
        };
        if known.is_some() {
            return (index, number);
        }
        if set.bodies.is_empty() {
            let place = set.around.0.min(self.media) as usize;
            self.plain[place] = Some(index);
        }
        let strongest = set.bodies.first().map(|kind| self.kinds[*kind]);
        self.fillings.push(Filling {
            body: strongest,
            medium: strongest.map_or(set.around, |body| body.medium),
        });
        self.moves.extend(vec![[number; 2]; kinds]);
        self.sets.insert(set.clone(), index);
        for kind in 0..kinds {
            let alike = set.bodies.iter().filter(|other| **other == kind).count();
            if alike == self.most.0[kind] || set.bodies.len() == self.most.1 {
                continue;
            }
            let mut more = set.clone();
            let place = more.bodies.partition_point(|other| *other < kind);
            more.bodies.insert(place, kind);
            let (with, its_number) = self.list(more);
            self.moves[index * kinds + kind][0] = its_number;
            self.moves[with * kinds + kind][1] = number;
        }
        (index, number)
    }

    /// The place of a set among all.
    #[inline]
    fn index(&self, set: MediumId) -> Option<usize> {
        if set.is_some() && set.0 >= self.media {
            return Some((set.0 - self.media) as usize);
        }
        self.plain[set.0.min(self.media) as usize]
    }

    /// Body and medium for a set.
    #[inline]
    pub(crate) fn filling(&self, set: MediumId) -> Filling {
        match self.index(set).and_then(|index| self.fillings.get(index)) {
            Some(filling) => *filling,
            None => Filling {
                body: None,
                medium: set,
            },
        }
    }

    /// The kind of a shape, if it is a body.
    #[inline]
    pub(crate) fn of_shape(&self, shape: ShapeId) -> Option<usize> {
        self.of_shape.get(shape.0 as usize).copied().flatten()
    }

    /// The set after entering (`true`) or leaving a body of this kind.
    #[inline]
    pub(crate) fn after(&self, set: MediumId, kind: usize, entered: bool) -> MediumId {
        let index = self.index(set);
        index.map_or(set, |index| {
            self.moves[index * self.kinds.len() + kind][usize::from(!entered)]
        })
    }

    /// The sets on both sides of the surface of a body, for a ray in `arriving` that meets it from outside or not.
    #[inline]
    pub(crate) fn around(&self, kind: usize, arriving: MediumId, outside: bool) -> MediumInterface {
        let beyond = self.after(arriving, kind, outside);
        let (inside, outside) = if outside {
            (beyond, arriving)
        } else {
            (arriving, beyond)
        };
        MediumInterface { inside, outside }
    }
}

/// The largest number of overlapping bodies of each kind and in total, by their boxes. A shape that may intersect itself
/// counts up to [`ITSELF`] times, or as often as the number of sets allows. If there are still too many sets, the total is
/// reduced, with a note.
fn most_overlapping(
    shapes: &[(ShapeId, Body, Span)],
    kinds: &[Body],
    media: u64,
    extent: impl Fn(ShapeId) -> Option<Extent>,
    diagnostics: &Diagnostics,
) -> (Vec<usize>, usize) {
    let extents: Option<Vec<_>> = match shapes.len() {
        0..=MOST_COMPARED => shapes.iter().map(|(shape, ..)| extent(*shape)).collect(),
        _ => None,
    };
    let Some(extents) = extents else {
        let of_kinds = vec![DEPTH_UNKNOWN; kinds.len()];
        let told_apart = largest_listed(&of_kinds, DEPTH_UNKNOWN, media);
        return (of_kinds, told_apart);
    };
    let kind_of = |body: &Body| kinds.iter().position(|kind| kind == body);
    let placed: Vec<(usize, Extent)> = (shapes.iter().zip(extents))
        .filter_map(|((_, body, _), extent)| Some((kind_of(body)?, extent)))
        .collect();
    // Bodies that overlap at a point have boxes that pairwise overlap.
    let deepest = |itself: usize| {
        let (mut of_kinds, mut of_all) = (vec![0; kinds.len()], 0);
        for (_, own) in &placed {
            let mut near = vec![0; kinds.len()];
            for (kind, other) in placed.iter().filter(|(_, other)| other.meets(own)) {
                near[*kind] += if other.is_simple { 1 } else { itself };
            }
            of_all = of_all.max(near.iter().sum());
            of_kinds = of_kinds.iter().zip(near).map(|(a, b)| b.max(*a)).collect();
        }
        (of_kinds, of_all)
    };
    let mut most = deepest(ITSELF);
    for itself in (1..ITSELF).rev() {
        if largest_listed(&most.0, most.1, media) == most.1 {
            return most;
        }
        most = deepest(itself);
    }
    let (of_kinds, of_all) = most;
    let told_apart = largest_listed(&of_kinds, of_all, media);
    if let (true, Some((.., span))) = (told_apart < of_all, shapes.first()) {
        let message = format!(
            "up to {of_all} bodies may overlap at a point here, by their boxes, and {told_apart} are told apart"
        );
        let help = "where more overlap, those entered last count for nothing: bodies of one priority, material and medium are of one \
                    kind, and fewer kinds make fewer sets";
        diagnostics.push(Diagnostic::note(*span, message).help(help));
    }
    (of_kinds, told_apart)
}

/// The size up to which all sets of bodies can be listed, in each of so many media.
fn largest_listed(of_kinds: &[usize], of_all: usize, media: u64) -> usize {
    let sets = sets_by_size(of_kinds, of_all);
    let mut listed = 0_u64;
    let fits = sets.iter().take_while(|count| {
        listed = listed.saturating_add(**count);
        listed.saturating_mul(media) <= MOST_SETS
    });
    fits.count().saturating_sub(1)
}

/// How many sets there are of 0, 1, … up to `of_all` bodies, with so many of each kind at most.
fn sets_by_size(of_kinds: &[usize], of_all: usize) -> Vec<u64> {
    let mut sets = vec![0_u64; of_all + 1];
    sets[0] = 1;
    for most in of_kinds {
        let fewer = sets.clone();
        for (size, count) in sets.iter_mut().enumerate() {
            let from = size.saturating_sub(*most);
            *count = fewer[from..=size]
                .iter()
                .fold(0, |sum: u64, count| sum.saturating_add(*count));
        }
    }
    sets
}

impl Parts {
    /// What the surface of a body is between those on both of its sides: `own`, if it is the surface of none.
    pub(crate) fn between_bodies<'w>(
        &'w self,
        bodies: &Bodies,
        own: BsdfAtPoint<'w>,
        vertex: &SurfaceInteraction,
        wo: Vec3,
        wavelengths: &Wavelengths,
    ) -> BsdfAtPoint<'w> {
        if bodies.of_shape(vertex.shape).is_none() {
            return own;
        }
        let sides = [vertex.media.inside, vertex.media.outside];
        let [inside, outside] = sides.map(|set| bodies.filling(set));
        if inside == outside {
            return BsdfAtPoint::passing(vertex.normal);
        }
        let index = |filling: Filling| {
            let material = &self.materials[filling.body?.material.0 as usize];
            let there = material.resolve(&self.space.lookup, vertex, wo, wavelengths);
            there.relative_index()
        };
        let [inside, outside] = [inside, outside].map(|side| index(side).unwrap_or(Vec4::ONE));
        own.with_relative_index(inside / outside)
    }
}

#[cfg(test)]
mod tests;
