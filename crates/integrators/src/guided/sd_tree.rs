//! What was learned of where light comes from: for every region of space a density of directions.
//!
//! A binary tree divides a cube in halves, along x, y and z in turn (the spatial half of the SD-tree of
//! Müller, Gross & Novák 2017, §3.1). Each of its leaves has a [`Quadtree`] over the unit square, which an
//! equal-area map takes to the sphere of directions: p(ω) = p(u) / 4π. It has one for each of the six
//! sides to which surfaces may look: so the cosine can be learned with the radiance, and a floor does not
//! look for light where the wall beside it finds some.

use etalon_math::float::ONE_MINUS_EPSILON;
use etalon_math::lane::Lane;
use etalon_math::{Density, SolidAngle};
use etalon_sampling::discrete::{Quadtree, Refinement};
use etalon_sampling::warps::{UNIFORM_SPHERE_DENSITY, sphere_to_square, uniform_sphere};
use glam::{Vec2, Vec3};
use std::sync::LazyLock;

/// Directions from which light comes, region by region.
#[derive(Clone, Debug)]
pub(crate) struct SdTree {
    /// The corner of the cube (m).
    corner: Vec3,
    /// One over the cube's side (m⁻¹).
    scale: f32,
    /// The two halves of every inner node; the first is the root.
    branches: Vec<[Child; 2]>,
    regions: Vec<SpatialLeaf>,
}

#[derive(Clone, Copy, Debug)]
enum Child {
    Branch(u32),
    SpatialLeaf(u32),
}

/// The faces of a region: which of ±x, ±y, ±z a surface's normal is nearest to.
pub(crate) const FACES: usize = 6;

/// The face of a surface with this normal.
#[inline]
pub(crate) fn face(normal: Vec3) -> usize {
    let axis = normal.abs().max_position();
    2 * axis + usize::from(normal[axis] < 0.0)
}

/// Incident radiance by the side that a surface faces; `None` if nothing was learned.
pub(crate) type Lobes = [Option<Quadtree>; FACES];

/// A leaf of the spatial tree.
#[derive(Clone, Debug)]
pub(crate) struct SpatialLeaf {
    /// Its size (m).
    pub(crate) size: Vec3,
    /// The directions from which light comes.
    pub(crate) lobes: Lobes,
    /// The irradiance that scattering found on surfaces that look to each side, the mean of their records.
    pub(crate) irradiance: [f32; FACES],
    /// α, the probability of following the scattering model's own choice there.
    pub(crate) own: [f32; FACES],
}

impl SpatialLeaf {
    /// The quadtree of a face whose leaves learn.
    pub(crate) fn tree(&self, face: usize) -> &Quadtree {
        static UNIFORM: LazyLock<Quadtree> = LazyLock::new(Quadtree::uniform);
        self.lobes[face].as_ref().unwrap_or(&UNIFORM)
    }
}

/// No region is halved more often than this: in each dimension 16 times.
const DEEPEST: u32 = 48;

/// The update of a region by one round.
pub(crate) struct RegionUpdate {
    /// The new densities of directions.
    pub(crate) lobes: Lobes,
    /// The new irradiances.
    pub(crate) irradiance: [f32; FACES],
    /// The new fractions α.
    pub(crate) own: [f32; FACES],
    /// Number of recorded directions.
    pub(crate) records: u64,
}

impl SdTree {
    /// One region with a uniform density, for the box between two points; `own` is the least α.
    pub(crate) fn new(from: Vec3, to: Vec3, own: f32) -> Self {
        // A little larger, and never empty.
        let side = (to - from).max_element().max(f32::MIN_POSITIVE.sqrt()) * 1.001;
        Self {
            corner: 0.5 * (from + to) - 0.5 * side,
            scale: 1.0 / side,
            branches: Vec::new(),
            regions: vec![SpatialLeaf {
                size: Vec3::splat(side),
                lobes: Lobes::default(),
                irradiance: [0.0; FACES],
                own: [own; FACES],
            }],
        }
    }

    /// The regions.
    pub(crate) fn regions(&self) -> &[SpatialLeaf] {
        &self.regions
    }

    /// The index of the region in which a point lies; points outside of the cube count to the nearest.
    #[inline]
    pub(crate) fn find(&self, point: Vec3) -> usize {
        let place = (point - self.corner) * self.scale;
        let mut place = place.clamp(Vec3::ZERO, Vec3::splat(ONE_MINUS_EPSILON));
        let Some(mut branch) = self.branches.first() else {
            return 0;
        };
        loop {
            let above = place.x >= 0.5;
            // Now halve along the next axis.
            place = Vec3::new(place.y, place.z, 2.0 * place.x - f32::from(u8::from(above)));
            match branch[usize::from(above)] {
                Child::Branch(index) => branch = &self.branches[index as usize],
                Child::SpatialLeaf(index) => return index as usize,
            }
        }
    }

    /// Where light comes from at a point of a surface with this normal, if that was learned, and how often
    /// the scattering model's own choice is followed all the same.
    #[inline]
    pub(crate) fn lobe(&self, point: Vec3, normal: Vec3) -> Option<(&Quadtree, f32)> {
        let region = &self.regions[self.find(point)];
        let face = face(normal);
        (region.lobes[face].as_ref()).map(|lobe| (lobe, region.own[face]))
    }

    /// The irradiance that scattering found around a point, on surfaces with this normal; 0 where nothing
    /// is known.
    pub(crate) fn irradiance(&self, point: Vec3, normal: Vec3) -> f32 {
        self.regions[self.find(point)].irradiance[face(normal)]
    }

    /// The field with what was learned of each region, in their order. Regions with more than `most`
    /// records are halved until their parts, if all had as many, have fewer.
    pub(crate) fn learned(self, updates: Vec<RegionUpdate>, most: u64) -> Self {
        let mut field = Self {
            branches: Vec::new(),
            regions: Vec::with_capacity(self.regions.len()),
            ..self
        };
        let old = Old {
            branches: &self.branches,
            regions: &self.regions,
            updates: &updates,
        };
        let root = match self.branches.first() {
            Some(_) => Child::Branch(0),
            None => Child::SpatialLeaf(0),
        };
        field.copy(root, 0, &old, most);
        field
    }

    fn copy(&mut self, child: Child, depth: u32, old: &Old<'_>, most: u64) -> Child {
        match child {
            Child::Branch(index) => {
                let [below, above] = old.branches[index as usize];
                let at = self.branch();
                let below = self.copy(below, depth + 1, old, most);
                let above = self.copy(above, depth + 1, old, most);
                self.branches[at] = [below, above];
                Child::Branch(at as u32)
            }
            Child::SpatialLeaf(index) => {
                let size = old.regions[index as usize].size;
                let update = &old.updates[index as usize];
                self.halve(size, update, update.records, depth, most)
            }
        }
    }

    fn halve(
        &mut self,
        size: Vec3,
        update: &RegionUpdate,
        records: u64,
        depth: u32,
        most: u64,
    ) -> Child {
        if records <= most || depth >= DEEPEST {
            self.regions.push(SpatialLeaf {
                size,
                lobes: update.lobes.clone(),
                irradiance: update.irradiance,
                own: update.own,
            });
            return Child::SpatialLeaf(self.regions.len() as u32 - 1);
        }
        let mut half = size;
        half[(depth % 3) as usize] *= 0.5;
        let at = self.branch();
        let below = self.halve(half, update, records / 2, depth + 1, most);
        let above = self.halve(half, update, records / 2, depth + 1, most);
        self.branches[at] = [below, above];
        Child::Branch(at as u32)
    }

    /// A new branch, whose halves are not known yet.
    fn branch(&mut self) -> usize {
        self.branches.push([Child::SpatialLeaf(0); 2]);
        self.branches.len() - 1
    }
}

/// A field that is being replaced.
struct Old<'a> {
    branches: &'a [[Child; 2]],
    regions: &'a [SpatialLeaf],
    updates: &'a [RegionUpdate],
}

/// The density with which a lobe finds a direction: alike in all lanes.
#[inline]
pub(crate) fn density(lobe: &Quadtree, direction: Vec3) -> Density<SolidAngle> {
    Density::uniform(density_at(lobe, place_of(direction)))
}

/// The density (sr⁻¹) with which a lobe finds the direction at a point of the square.
#[inline]
pub(crate) fn density_at(lobe: &Quadtree, place: Vec2) -> f32 {
    UNIFORM_SPHERE_DENSITY * lobe.density(place)
}

/// A direction of a lobe, and the density with which it is found.
#[inline]
pub(crate) fn sample(lobe: &Quadtree, u: Vec2) -> (Vec3, Density<SolidAngle>) {
    let (place, density) = sample_place(lobe, u);
    (
        directions::<f32>(place.to_array()),
        Density::uniform(density),
    )
}

/// The point of the square for a direction of a lobe, and the density (sr⁻¹) with which it is found.
#[inline]
pub(crate) fn sample_place(lobe: &Quadtree, u: Vec2) -> (Vec2, f32) {
    let (place, density) = lobe.sample(u);
    (place, UNIFORM_SPHERE_DENSITY * density)
}

/// The directions at points of the square.
#[inline(always)]
pub(crate) fn directions<F: Lane>(places: [F; 2]) -> F::Vector {
    uniform_sphere(places)
}

/// The point of the square for a direction.
#[inline]
pub(crate) fn place_of(direction: Vec3) -> Vec2 {
    places::<f32>(direction).into()
}

/// The points of the square for directions.
#[inline(always)]
pub(crate) fn places<F: Lane>(directions: F::Vector) -> [F; 2] {
    let end = F::splat(ONE_MINUS_EPSILON);
    sphere_to_square::<F>(directions).map(|u| u.max(F::ZERO).min(end))
}

/// The resolution of directions, if squares with more than this share of the light are divided.
pub(crate) fn refinement(share: f64) -> Refinement {
    Refinement { share, depth: 20 }
}
