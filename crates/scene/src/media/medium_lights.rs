//! Media that emit light, as lights.
//!
//! The box of each is divided into cells, chosen by the power that they emit,
//!
//! ```text
//! Φ = 4π ∫ σa Lₑ dV
//! ```
//!
//! estimated from some points of each cell; a point in the chosen cell is uniform (C. Villemin, C. Hery, Practical
//! illumination from flames, 2013). Every cell has some probability, so that no emission is missed.

use crate::scene::Scene;
use crate::space::Space;
use core::f32::consts::PI;
use etalon_math::Density;
use etalon_math::float::ONE_MINUS_EPSILON;
use etalon_sampling::discrete::AliasTable;
use etalon_sampling::hash::mix64;
use etalon_sampling::warps::square_to_uniform_sphere;
use etalon_sampling::{Independent, Sampler};
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Emission, EmissionPdf, LightId, LightKind, LightSample, LightSampleContext, Media, Medium,
    MediumId, Ray, SamplePdf, World,
};
use glam::{UVec3, Vec2, Vec3, Vec4};

/// Cells along the longest side of a box.
const ALONG: f32 = 24.0;

/// Points at which the emission of a cell is estimated.
const ASKED: u32 = 4;

/// The probability of a uniform choice over the box, independent of emission.
const EVEN: f64 = 0.05;

/// Wavelengths (nm) that represent the spectrum.
const LAMBDA: Vec4 = Vec4::new(450.0, 520.0, 590.0, 660.0);

/// The box of a medium that emits.
#[derive(Debug)]
struct Region {
    medium: MediumId,
    low: Vec3,
    /// Sides of a cell (m).
    side: Vec3,
    count: UVec3,
    /// The place of the first cell among all.
    first: usize,
}

/// All media that emit light and end somewhere.
#[derive(Debug)]
pub(crate) struct MediumLights {
    regions: Vec<Region>,
    cells: AliasTable,
    /// Probability of choosing one of them instead of another light.
    pub(crate) share: f32,
}

impl Region {
    fn new(medium: MediumId, [low, high]: [Vec3; 2], first: usize) -> Option<Self> {
        let size = high - low;
        if !(size.is_finite() && size.min_element() > 0.0) {
            return None;
        }
        let count = (size * (ALONG / size.max_element())).ceil().as_uvec3();
        Some(Self {
            medium,
            low,
            side: size / count.as_vec3(),
            count,
            first,
        })
    }

    fn len(&self) -> usize {
        self.count.element_product() as usize
    }

    /// The corner of a cell.
    fn corner(&self, cell: usize) -> Vec3 {
        let (x, y) = (self.count.x as usize, self.count.y as usize);
        let place = [cell % x, cell / x % y, cell / (x * y)].map(|i| i as f32);
        self.low + Vec3::from_array(place) * self.side
    }

    /// The cell of a point.
    fn cell(&self, at: Vec3) -> Option<usize> {
        let place = (at - self.low) / self.side;
        if !(place.cmpge(Vec3::ZERO).all() && place.cmplt(self.count.as_vec3()).all()) {
            return None;
        }
        let [x, y, z] = place.to_array().map(|x| x as usize);
        Some((z * self.count.y as usize + y) * self.count.x as usize + x)
    }

    fn volume(&self) -> f32 {
        self.side.element_product()
    }
}

/// The chosen kind of light, with the random number rescaled for reuse.
pub(crate) enum LightChoice<'a> {
    Medium(&'a MediumLights, f32),
    Other(f32),
}

impl<'a> LightChoice<'a> {
    /// Chooses by `u` in [0, 1).
    #[inline]
    pub(crate) fn new(media: Option<&'a MediumLights>, u: f32) -> Self {
        let Some(lights) = media else {
            return Self::Other(u);
        };
        let others = 1.0 - lights.share;
        if u < lights.share || others == 0.0 {
            Self::Medium(lights, (u / lights.share).min(ONE_MINUS_EPSILON))
        } else {
            Self::Other(((u - lights.share) / others).min(ONE_MINUS_EPSILON))
        }
    }
}

/// Three numbers in [0, 1).
fn three(stream: &mut impl Sampler) -> Vec3 {
    Vec3::new(stream.next_1d(), stream.next_1d(), stream.next_1d())
}

impl MediumLights {
    /// Those of a space that is in the medium `outermost`; `None` if there are none. Other lights have the power `others`.
    pub(crate) fn find(space: &Space, outermost: MediumId, others: f64) -> Option<Self> {
        let mut regions: Vec<Region> = Vec::new();
        for (medium, bounds) in space.media.emitting_bounds() {
            let first = regions.last().map_or(0, |last| last.first + last.len());
            regions.extend(Region::new(medium, bounds, first));
        }
        let mut weights = Vec::new();
        let mut power = 0.0;
        for region in &regions {
            let powers: Vec<f64> = (0..region.len())
                .map(|cell| space.cell_power(region, cell, outermost))
                .collect();
            let all: f64 = powers.iter().sum();
            let even = EVEN * all / powers.len() as f64;
            weights.extend(powers.iter().map(|power| power * (1.0 - EVEN) + even));
            power += all;
        }
        let cells = AliasTable::new(&weights).ok()?;
        let share = match others > 0.0 {
            true => (power / (power + others)).clamp(0.1, 0.9),
            false => 1.0,
        };
        Some(Self {
            regions,
            cells,
            share: share as f32,
        })
    }

    /// A point, by numbers in [0, 1), with its medium and its density per volume (m⁻³).
    fn point(&self, u_light: f32, u: Vec2) -> Option<(MediumId, Vec3, f32)> {
        let place = self.cells.sample_fine(u).index;
        let after = self.regions.partition_point(|region| region.first <= place);
        let region = self.regions.get(after.checked_sub(1)?)?;
        // Numbers that the choice of the cell has not used up.
        let bits = [u_light, u.x, u.y].map(|u| u64::from(u.to_bits()));
        let key = bits.into_iter().fold(0, |key, bits| mix64(key ^ bits));
        let within = three(&mut Independent::from_key(key)) * region.side;
        let at = region.corner(place - region.first) + within;
        // Rounding may have left the cell.
        let density = self.density(region.medium, at);
        (density > 0.0).then_some((region.medium, at, density))
    }

    /// The density per volume with which a point is chosen (m⁻³), the choice of media in place of other lights included.
    pub(crate) fn density(&self, medium: MediumId, at: Vec3) -> f32 {
        let region = self.regions.iter().find(|region| region.medium == medium);
        let found = region.and_then(|region| Some((region, region.cell(at)?)));
        found.map_or(0.0, |(region, cell)| {
            self.share * self.cells.probability(region.first + cell) / region.volume()
        })
    }
}

impl Space {
    /// What a cell emits at some wavelengths, by an estimate (W·nm⁻¹).
    fn cell_power(&self, region: &Region, cell: usize, outermost: MediumId) -> f64 {
        let Some(medium) = self.media.enter(region.medium, None, &self.lookup, LAMBDA) else {
            return 0.0;
        };
        let mut stream = Independent::from_key(mix64(cell as u64));
        let corner = region.corner(cell);
        let emitted = |_| {
            let at = corner + three(&mut stream) * region.side;
            let inside = self.within(region.medium, at, outermost).is_some();
            let emission = 0.25 * medium.emission(at, Vec3::Z).element_sum();
            if inside { emission } else { 0.0 }
        };
        let mean = (0..ASKED).map(emitted).sum::<f32>() / ASKED as f32;
        f64::from(4.0 * PI * region.volume() * mean)
    }

    /// What a ray from a point must know that is in a medium, and not only in its box.
    fn within(&self, medium: MediumId, at: Vec3, outermost: MediumId) -> Option<MediumId> {
        let direction = Vec3::new(0.36, 0.48, 0.8);
        let there = self.medium_along(Ray::new(at, direction, 0.0), outermost);
        (self.media.filling(there) == medium).then_some(there)
    }
}

impl Scene {
    fn within(&self, medium: MediumId, at: Vec3) -> Option<MediumId> {
        self.parts.space.within(medium, at, self.outermost())
    }

    /// A point of a medium that emits, as seen from `from`.
    pub(crate) fn sample_medium(
        &self,
        lights: &MediumLights,
        from: &LightSampleContext,
        wavelengths: &Wavelengths,
        u_light: f32,
        u: Vec2,
    ) -> Option<LightSample> {
        let (medium, at, density) = lights.point(u_light, u)?;
        let way = at - from.position;
        let distance_squared = way.length_squared();
        let resolved = self.media().enter(medium, None, wavelengths)?;
        let direction = way / distance_squared.sqrt();
        let radiance = resolved.emission(at, direction);
        if radiance == Vec4::ZERO || !(distance_squared > 0.0) {
            return None;
        }
        self.within(medium, at)?;
        Some(LightSample {
            direction,
            target: Some(at),
            radiance,
            chance: SamplePdf::Continuous(Density::uniform(density * distance_squared)),
            cos: 1.0,
            origin: LightKind::Medium,
            extinction: resolved.coefficients(at, direction).extinction(),
            light: LightId::NONE,
        })
    }

    /// A particle from a medium that emits.
    pub(crate) fn emit_from_medium(
        &self,
        lights: &MediumLights,
        wavelengths: &Wavelengths,
        u_light: f32,
        [u_position, u_direction]: [Vec2; 2],
        time: f32,
    ) -> Option<Emission> {
        let (medium, at, origin) = lights.point(u_light, u_position)?;
        let resolved = self.media().enter(medium, None, wavelengths)?;
        let direction = square_to_uniform_sphere(u_direction);
        let radiance = resolved.emission(at, direction);
        if radiance == Vec4::ZERO {
            return None;
        }
        let ray = Ray {
            medium: self.within(medium, at)?,
            ..Ray::new(at, direction, time)
        };
        Some(Emission {
            point: Emission::point_of(&ray),
            ray,
            weight: radiance * (4.0 * PI / origin),
            density: EmissionPdf {
                origin,
                ray: 0.25 / PI,
            },
            origin: LightKind::Medium,
            extinction: resolved.coefficients(at, direction).extinction(),
            light: LightId::NONE,
        })
    }
}
