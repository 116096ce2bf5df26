//! The subpath from a light, and its vertices.

use super::path_vertex::{PathVertex, SubpathVertex, counted};
use super::subpath::{Interaction, SubpathState, light_event};
use crate::steps::arrival;
use crate::steps::dimensions::{BounceSamples, draw_flight};
use crate::steps::path_throughput::PathThroughput;
use crate::steps::settings::PathSettings;
use etalon_sampling::Sampler;
use etalon_spectrum::Wavelengths;
use etalon_transport::{Bsdf, Emission, LightKind, Surfaces, TransportMode, World};
use glam::{Vec3, Vec4};

/// A particle's start, and what its first vertex's neighbours say of it.
pub(super) struct FromLight {
    /// The emission.
    pub(super) emission: Emission,
    /// Density with which a subpath from the camera arrives at the light from the first vertex, per lane; known
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

    /// What makes a density per solid angle at the first vertex one at the light, per lane: per area of a
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

    /// Squared distance to a point of the first vertex.
    #[inline]
    pub(super) fn distance_squared(&self, to: Vec3) -> f32 {
        self.emission.point.position.distance_squared(to)
    }

    /// Density per area of arriving at the first vertex, which sees the light along −`direction`.
    #[inline]
    pub(super) fn arrival<B: Bsdf>(
        emission_ray: f32,
        parallel: bool,
        vertex: &PathVertex<B>,
        from: Vec3,
    ) -> f32 {
        let distance_squared = match parallel {
            true => 1.0,
            false => vertex.point.position.distance_squared(from),
        };
        emission_ray * vertex.per_area(vertex.wo, distance_squared).x
    }

    /// The density with which light sampling at the first vertex would have chosen this start, in
    /// the measure of the emission's.
    #[inline]
    pub(super) fn sampled<W: World>(&self, world: &W, at: &SubpathVertex<'_, W>) -> f32 {
        let density = world.light_sample_density(&at.receiver(), &self.emission);
        match self.emission.origin {
            LightKind::Surface => {
                density * self.per_area(self.distance_squared(at.point.position)).x
            }
            _ => density,
        }
    }

    /// Traces the subpath to at most `limit` vertices, and appends them.
    pub(super) fn trace<'w, W: World>(
        &mut self,
        world: &'w W,
        wavelengths: &Wavelengths,
        settings: &PathSettings,
        sampler: &mut impl Sampler,
        vertices: &mut Vec<SubpathVertex<'w, W>>,
        limit: usize,
    ) {
        let emission = &self.emission;
        let mut carried = SubpathState {
            ray: emission.ray,
            throughput: PathThroughput {
                beta: emission.weight,
                r_u: Vec4::ONE,
            },
            density: emission.density.ray,
            passed: Vec4::ONE,
            segments: 1,
        };
        let mut parent: Option<usize> = None;
        let mut traced = 0;
        // The throughput where the subpath left the last vertex.
        let mut departed = carried.throughput.magnitude();
        // One more segment, at least, leads from a vertex to the camera.
        while carried.segments < settings.max_depth && traced < limit {
            let hit = arrival::next_hit(world, &mut carried.ray, false);
            let wo = -carried.ray.direction;
            let mut interaction = None;
            if carried.ray.medium.is_some() {
                let u = draw_flight(sampler, light_event(carried.segments));
                interaction = carried.fly(world, hit.as_ref(), wavelengths, u);
            }
            let Some(interaction) = interaction.or_else(|| {
                let point = world.surfaces().vertex(&carried.ray, &hit?);
                Some(Interaction::surface(world, point, wo, wavelengths))
            }) else {
                return;
            };
            let mut vertex = carried.vertex(interaction, 0.0);
            let PathVertex { point, bsdf, .. } = vertex;
            vertex.parent = parent;
            vertex.arrival = carried.passed.x
                * match parent {
                    None => Self::arrival(
                        carried.density,
                        self.emission.origin.is_parallel(),
                        &vertex,
                        self.emission.point.position,
                    ),
                    Some(parent) => {
                        let from = vertices[parent].point.position;
                        let distance_squared = point.position.distance_squared(from);
                        carried.density * vertex.per_area(wo, distance_squared).x
                    }
                };
            if !(vertex.arrival > 0.0 && vertex.arrival.is_finite()) {
                return;
            }
            if parent.is_none() {
                vertex.direct = self.sampled(world, &vertex);
            }
            let place = vertices.len();
            if bsdf.has_continuous() {
                vertices.push(vertex);
            }
            let event = BounceSamples::draw(sampler, light_event(carried.segments));
            let sampled = bsdf.sample(wo, event.lobe, event.direction, TransportMode::Importance);
            let Some(sample) = sampled else {
                return;
            };
            if sample.is_null {
                carried.pass(&point, sample.value, sample.chance.lanes());
                if carried.throughput.beta == Vec4::ZERO {
                    return;
                }
                continue;
            }
            if vertices.len() == place {
                vertices.push(vertex);
            }
            vertices[place].is_delta = sample.chance.is_delta();
            let [forward, back] = vertex.both_densities(&sample);
            match parent {
                None => {
                    let distance_squared = self.distance_squared(point.position);
                    self.pdf_rev = back * vertex.passed * self.per_area(distance_squared);
                }
                Some(parent) => {
                    let before = &mut vertices[parent];
                    let distance_squared = point.position.distance_squared(before.point.position);
                    before.pdf_rev = back * vertex.passed * before.per_area(wo, distance_squared);
                }
            }
            carried
                .throughput
                .scatter(sample.value, sample.chance.lanes());
            if carried.throughput.beta == Vec4::ZERO {
                return;
            }
            if carried.segments >= settings.rr_depth {
                let survival = carried
                    .throughput
                    .survival_of_flux(departed, bsdf.is_in_space());
                if !carried.throughput.survives(survival, event.roulette) {
                    return;
                }
            }
            departed = carried.throughput.magnitude();
            carried.density = forward.x;
            carried.passed = Vec4::ONE;
            carried.ray = point.spawn(sample.wi);
            carried.segments += 1;
            parent = Some(place);
            traced += 1;
        }
    }
}
