//! Photons: particles from the lights, stored where they hit a scattering surface or are scattered by a medium.
//!
//! The value of a photon per lane is f/p of its path, with p the mean density over the lanes that could have chosen
//! (see [`crate::steps::path_throughput`]), over the cosine of its arrival. The sum of the photons' values per unit area of a
//! surface estimates the integral of radiance over directions; that per unit volume of a medium, σs times the
//! integral.

use super::is_sharp;
use super::kdtree::{KdTree, Neighbour};
use super::sets::{WavelengthChoice, WavelengthSets};
use crate::steps::light_path::{LightPath, LightVertex};
use crate::steps::settings::PathSettings;
use etalon_sampling::hash::mix64;
use etalon_sampling::{SampleId, Sobol};
use etalon_transport::{Bsdf, LightKind, MediumId, Pass, Placing, SamplePdf, World};
use glam::{Vec3, Vec4};
use rayon::prelude::*;

/// The kind of a photon's path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// It comes straight from a light.
    Direct,
    /// It was scattered in sharp directions only.
    Caustic,
    /// It was scattered in some other direction.
    Indirect,
}

/// A photon at a surface, or at a point of a medium.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Photon {
    /// Position (m).
    pub(crate) position: Vec3,
    /// Unit geometric normal there; zero in a medium.
    pub(crate) normal: Vec3,
    /// Unit direction to where it came from.
    pub(crate) from: Vec3,
    /// Its value per lane of its set.
    pub(crate) value: Vec4,
    /// Its set of wavelengths.
    pub(crate) set: u32,
    /// Segments behind it.
    pub(crate) segments: u32,
    /// The kind of its path.
    pub(crate) kind: Kind,
    /// The medium that scatters it, if it is not on a surface.
    pub(crate) medium: MediumId,
}

/// Photons by their places.
#[derive(Debug)]
pub(crate) struct PlacedPhotons {
    pub(crate) tree: KdTree,
    pub(crate) photons: Vec<Photon>,
    /// One of [`THINNED`] of them, chosen at random, if they are more than a look-up visits.
    thinned: Option<Box<PlacedPhotons>>,
}

/// The most photons that a look-up within a radius visits of a map, thinned or not.
pub(crate) const MOST_VISITED: usize = 1024;

/// The least cosine of the angle between the normals of surfaces that share photons.
pub(crate) const FACING: f32 = 0.7;

/// A thinned map keeps one photon of this many.
const THINNED: u64 = 4;

impl PlacedPhotons {
    pub(crate) fn new(photons: &[Photon]) -> Self {
        let (tree, order) = KdTree::new(photons.iter().map(|photon| photon.position));
        let placed: Vec<Photon> = order.iter().map(|i| photons[*i as usize]).collect();
        let thinned = (photons.len() > MOST_VISITED).then(|| {
            // Not the random numbers of paths, and others in each of the nested maps.
            let key = mix64(photons.len() as u64);
            let stays = |index: &u64| mix64(key ^ index).is_multiple_of(THINNED);
            let stay = (photons.iter().zip(0..)).filter(|(_, index)| stays(index));
            Box::new(Self::new(
                &stay.map(|(photon, _)| *photon).collect::<Vec<_>>(),
            ))
        });
        Self {
            tree,
            photons: placed,
            thinned,
        }
    }

    /// Collects in `found` the photons within the root of `radius_squared`; returns the weight of each, and the map of
    /// which these are indices. If there are more than [`MOST_VISITED`], a thinned map is used: a photon stays in it
    /// independently of its position, so that sums have the same expectation.
    pub(crate) fn around(
        &self,
        centre: Vec3,
        radius_squared: f32,
        found: &mut Vec<Neighbour>,
    ) -> (f32, &Self) {
        let (mut weight, mut map) = (1.0, self);
        while !(map.tree).within_at_most(centre, radius_squared, MOST_VISITED, found)
            && let Some(thinned) = &map.thinned
        {
            weight *= THINNED as f32;
            map = thinned;
        }
        (weight, map)
    }
}

/// The photons of a pass.
#[derive(Debug)]
pub(crate) struct PhotonMap {
    /// Those on surfaces.
    pub(crate) surfaces: PlacedPhotons,
    /// Those in media.
    pub(crate) space: PlacedPhotons,
}

impl PhotonMap {
    /// A map of some photons.
    pub(crate) fn new(photons: Vec<Photon>) -> Self {
        let in_space = |photon: &Photon| photon.medium.is_some();
        let (space, surfaces): (Vec<_>, Vec<_>) = photons.into_iter().partition(in_space);
        Self {
            surfaces: PlacedPhotons::new(&surfaces),
            space: PlacedPhotons::new(&space),
        }
    }
}

/// The row of pixels, beyond any film, whose random numbers photons take.
const ROW: u32 = u32::MAX;

/// The moment of all photons and camera rays of a pass: photons are merged with what a camera ray sees, so both
/// must be of the same moment. The passes of an image are spread over the shutter interval by the radical inverse.
pub(crate) fn moment(pass: &Pass) -> f32 {
    let index = pass
        .replicate
        .wrapping_mul(pass.count)
        .wrapping_add(pass.number);
    let shift = mix64(pass.seed ^ 0x7469_6d65) as u32;
    let bits = index.reverse_bits().wrapping_add(shift);
    (bits >> 8) as f32 / (1 << 24) as f32
}

/// Photons per task.
const CHUNK: u32 = 256;

/// The random numbers of photon `index` of `count`.
pub(crate) fn numbers(pass: &Pass, index: u32, count: u32) -> Sobol {
    Sobol::start(&SampleId {
        seed: mix64(pass.seed),
        replicate: pass.replicate,
        pixel: (pass.number, ROW),
        sample: index,
        samples_per_replicate: count,
        blocks: 1,
    })
}

/// The results of `trace` for the numbers below `count`, in order for any number of threads; fewer if
/// `placing` is stopped.
pub(crate) fn in_order<T: Send>(
    count: u32,
    placing: &impl Placing,
    trace: impl Fn(u32, &mut Vec<T>) + Sync,
) -> Vec<T> {
    let chunk = |chunk: u32| {
        let mut found = Vec::new();
        let begin = chunk * CHUNK;
        for index in begin..(begin + CHUNK).min(count) {
            if placing.stopped() {
                break;
            }
            trace(index, &mut found);
        }
        found
    };
    let chunks: Vec<Vec<T>> = (0..count.div_ceil(CHUNK))
        .into_par_iter()
        .map(chunk)
        .collect();
    chunks.into_iter().flatten().collect()
}

/// Shoots `count` photons, a multiple of four times the number of sets, unless `placing` says to
/// stop.
pub(crate) fn shoot<W: World>(
    world: &W,
    placing: &impl Placing,
    settings: &PathSettings,
    sets: &WavelengthSets,
    pass: &Pass,
    count: u32,
) -> Vec<Photon> {
    // Successive photons share their wavelengths, so that each share of them is as evenly spread
    // as the whole.
    let share = count / (4 * sets.len() as u32);
    in_order(count, placing, |index, found| {
        let lanes = (index / share) as usize;
        let lanes = WavelengthChoice {
            set: lanes / 4,
            first: lanes % 4,
        };
        let mut sampler = numbers(pass, index, count);
        trace(
            world,
            settings,
            (sets, lanes, moment(pass)),
            &mut sampler,
            found,
        );
    })
}

/// One photon's way.
fn trace<W: World>(
    world: &W,
    settings: &PathSettings,
    (sets, lanes, time): (&WavelengthSets, WavelengthChoice, f32),
    sampler: &mut Sobol,
    found: &mut Vec<Photon>,
) {
    let wavelengths = sets.of(lanes);
    let Some((start, mut particle)) = LightPath::emit(world, &wavelengths, sampler, time) else {
        return;
    };
    if particle.throughput.beta == Vec4::ZERO {
        return;
    }
    let mut kind = match start.origin {
        // No sampling of lights finds it: as if a mirror had sent it here.
        LightKind::Beam => Kind::Caustic,
        _ => Kind::Direct,
    };
    // As many segments as its depth lie behind once it has arrived; the camera adds one at least.
    while particle.depth < settings.max_depth {
        let Some(vertex) = particle.next(world, sampler) else {
            return;
        };
        let LightVertex {
            point, wo, bsdf, ..
        } = &vertex;
        let cos = point.area_cos(*wo);
        if bsdf.has_continuous() && cos > 0.0 {
            let throughput = &particle.throughput;
            let value = throughput.beta * (4.0 / (throughput.r_u.element_sum() * cos));
            found.push(Photon {
                position: point.position,
                normal: point.normal,
                from: *wo,
                value: lanes.to_set(value),
                set: lanes.set as u32,
                segments: particle.depth,
                kind,
                medium: match bsdf.is_in_space() {
                    true => point.media.outside,
                    false => MediumId::NONE,
                },
            });
        }
        let Some(sample) = particle.scatter(&vertex, settings.rr_depth) else {
            return;
        };
        if !sample.is_null {
            // As the camera's paths would call it, which come along the other way.
            let sharp = match sample.chance {
                SamplePdf::Discrete(_) => true,
                SamplePdf::Continuous(_) => is_sharp(bsdf.density(sample.wi, *wo)),
            };
            kind = match kind {
                Kind::Direct | Kind::Caustic if sharp => Kind::Caustic,
                _ => Kind::Indirect,
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A look-up visits a bounded number of photons of each of the nested maps, and the mean of its sum over maps of different
    /// photons is that of all photons (|z| < 4.5, α = 10⁻⁵; a mutant whose thinned photons have a weight that is too small by one
    /// is off by 30 standard errors). Few photons are all found.
    #[test]
    fn a_look_up_visits_a_bounded_number_of_photons_that_stand_for_all() {
        let mut found = Vec::new();
        let (mut sum, mut squares, maps) = (0.0_f64, 0.0_f64, 40_u32);
        for map in 0..maps {
            let photon = |index: u32| Photon {
                position: Vec3::new(index as f32, (index * 7 % 64) as f32, 0.0) * 1e-6,
                normal: Vec3::Z,
                from: Vec3::Z,
                value: Vec4::ONE,
                set: 0,
                segments: 1,
                kind: Kind::Indirect,
                medium: MediumId::NONE,
            };
            let count = 20_000 + 97 * map;
            let placed = PlacedPhotons::new(&(0..count).map(photon).collect::<Vec<_>>());
            let (weight, among) = placed.around(Vec3::ZERO, 1.0, &mut found);
            assert!(found.len() <= MOST_VISITED && among.photons.len() < count as usize);
            let share = f64::from(weight) * found.len() as f64 / f64::from(count);
            sum += share;
            squares += share * share;
            let (weight, among) = placed.around(Vec3::ZERO, 1e-8, &mut found);
            assert_eq!((weight, among.photons.len()), (1.0, count as usize));
            assert!((90..=100).contains(&found.len()), "{}", found.len());
        }
        let n = f64::from(maps);
        let mean = sum / n;
        let error = ((squares / n - mean * mean) / (n - 1.0)).sqrt();
        assert!((mean - 1.0).abs() < 4.5 * error, "{mean} {error}");
    }
}
