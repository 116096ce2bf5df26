//! The walk from a light, and the corners it leaves behind.

use super::path_vertex::{Corner, PathVertex, counted};
use super::subpath::{Met, SubpathState, light_event};
use crate::steps::arrival;
use crate::steps::dimensions::{BounceSamples, draw_flight};
use crate::steps::path_throughput::PathThroughput;
use crate::steps::settings::PathSettings;
use etalon_sampling::Sampler;
use etalon_spectrum::Wavelengths;
use etalon_transport::{Bsdf, Emission, LightKind, Surfaces, TransportMode, World};
use glam::{Vec3, Vec4};

/// A particle's start, and what its first corner's neighbours say of it.
pub(super) struct FromLight {
    /// The emission.
    pub(super) emission: Emission,
    /// Density with which a walk from the camera arrives at the light from the first corner, per lane; known
    /// once the particle has left that.
    pub(super) pdf_rev: Vec4,
}

impl FromLight {
    /// Emits a particle at the moment `time`.
    pub(super) fn start<W: World>(
        world: &W,
        wavelengths: &Wavelengths,
        settings: &PathSettings,
        sampler: &mut impl Sampler,
        time: f32,
    ) -> Option<Self> {
        if settings.max_depth < 2 {
            return None;
        }
        let event = BounceSamples::draw(sampler, light_event(0));
        let (choice, position, direction) = (event.light_choice, event.light, event.direction);
        let emission = world.emit(wavelengths, choice, position, direction, time)?;
        (emission.weight != Vec4::ZERO).then_some(Self {
            emission,
            pdf_rev: Vec4::ZERO,
        })
    }

    /// What makes a density per solid angle at the first corner one at the light, per lane: per area of a
    /// surface, per volume of a medium; of the sky's directions it is one.
    #[inline]
    pub(super) fn per_area(&self, distance_squared: f32) -> Vec4 {
        match self.emission.origin {
            LightKind::Surface => Vec4::splat(self.cos() / distance_squared),
            LightKind::Sky => Vec4::ONE,
            LightKind::Medium => self.emission.extinction / counted(distance_squared),
            LightKind::Point | LightKind::Parallel | LightKind::Beam => Vec4::ZERO,
        }
    }

    /// Cosine of the angle of departure.
    fn cos(&self) -> f32 {
        let normal = self.emission.point.normal;
        normal.dot(self.emission.ray.direction).abs()
    }

    /// Squared distance to a point of the first corner.
    #[inline]
    pub(super) fn distance_squared(&self, to: Vec3) -> f32 {
        self.emission.point.position.distance_squared(to)
    }

    /// Density per area of arriving at the first corner, which sees the light along −`direction`.
    #[inline]
    pub(super) fn arrival<B: Bsdf>(
        emission_ray: f32,
        parallel: bool,
        corner: &PathVertex<B>,
        from: Vec3,
    ) -> f32 {
        let distance_squared = match parallel {
            true => 1.0,
            false => corner.vertex.position.distance_squared(from),
        };
        emission_ray * corner.per_area(corner.wo, distance_squared).x
    }

    /// The density with which light sampling at the first corner would have chosen this start, in
    /// the measure of the emission's.
    #[inline]
    pub(super) fn sampled<W: World>(&self, world: &W, at: &Corner<'_, W>) -> f32 {
        let density = world.light_sample_density(&at.receiver(), &self.emission);
        match self.emission.origin {
            LightKind::Surface => {
                density * self.per_area(self.distance_squared(at.vertex.position)).x
            }
            _ => density,
        }
    }

    /// Follows the particle around at most `limit` corners, and notes them.
    pub(super) fn walk<'w, W: World>(
        &mut self,
        world: &'w W,
        wavelengths: &Wavelengths,
        settings: &PathSettings,
        sampler: &mut impl Sampler,
        corners: &mut Vec<Corner<'w, W>>,
        limit: usize,
    ) {
        let emission = &self.emission;
        let mut carried = SubpathState {
            ray: emission.ray,
            prefix: PathThroughput {
                beta: emission.weight,
                r_u: Vec4::ONE,
            },
            density: emission.density.ray,
            passed: Vec4::ONE,
            segments: 1,
        };
        let mut parent: Option<usize> = None;
        let mut rounded = 0;
        // The throughput where the walk left the last corner.
        let mut departed = carried.prefix.throughput();
        // One more segment, at least, leads from a corner to the camera.
        while carried.segments < settings.max_depth && rounded < limit {
            let hit = arrival::next_hit(world, &mut carried.ray, false);
            let wo = -carried.ray.direction;
            let mut met = None;
            if carried.ray.medium.is_some() {
                let u = draw_flight(sampler, light_event(carried.segments));
                met = carried.fly(world, hit.as_ref(), wavelengths, u);
            }
            let Some(met) = met.or_else(|| {
                let vertex = world.surfaces().vertex(&carried.ray, &hit?);
                Some(Met::surface(world, vertex, wo, wavelengths))
            }) else {
                return;
            };
            let mut corner = carried.corner(met, 0.0);
            let PathVertex { vertex, bsdf, .. } = corner;
            corner.parent = parent;
            corner.arrival = carried.passed.x
                * match parent {
                    None => Self::arrival(
                        carried.density,
                        self.emission.origin.is_parallel(),
                        &corner,
                        self.emission.point.position,
                    ),
                    Some(parent) => {
                        let from = corners[parent].vertex.position;
                        let distance_squared = vertex.position.distance_squared(from);
                        carried.density * corner.per_area(wo, distance_squared).x
                    }
                };
            if !(corner.arrival > 0.0 && corner.arrival.is_finite()) {
                return;
            }
            if parent.is_none() {
                corner.direct = self.sampled(world, &corner);
            }
            let place = corners.len();
            if bsdf.has_continuous() {
                corners.push(corner);
            }
            let event = BounceSamples::draw(sampler, light_event(carried.segments));
            let sampled = bsdf.sample(wo, event.lobe, event.direction, TransportMode::Importance);
            let Some(sample) = sampled else {
                return;
            };
            if sample.is_null {
                carried.pass(&vertex, sample.value, sample.chance.lanes());
                if carried.prefix.beta == Vec4::ZERO {
                    return;
                }
                continue;
            }
            if corners.len() == place {
                corners.push(corner);
            }
            corners[place].is_delta = sample.chance.is_delta();
            let [forward, back] = corner.both_densities(&sample);
            match parent {
                None => {
                    let distance_squared = self.distance_squared(vertex.position);
                    self.pdf_rev = back * corner.passed * self.per_area(distance_squared);
                }
                Some(parent) => {
                    let before = &mut corners[parent];
                    let distance_squared = vertex.position.distance_squared(before.vertex.position);
                    before.pdf_rev = back * corner.passed * before.per_area(wo, distance_squared);
                }
            }
            carried.prefix.scatter(sample.value, sample.chance.lanes());
            if carried.prefix.beta == Vec4::ZERO {
                return;
            }
            if carried.segments >= settings.rr_depth {
                let survival = carried
                    .prefix
                    .survival_of_flux(departed, bsdf.is_in_space());
                if !carried.prefix.survives(survival, event.roulette) {
                    return;
                }
            }
            departed = carried.prefix.throughput();
            carried.density = forward.x;
            carried.passed = Vec4::ONE;
            carried.ray = vertex.spawn(sample.wi);
            carried.segments += 1;
            parent = Some(place);
            rounded += 1;
        }
    }
}
