//! The subpath from the camera, and its vertices.

use super::connect::Connector;
use super::path_vertex::{PathVertex, SubpathVertex, counted};
use super::subpath::{Interaction, SubpathEnd, SubpathState, camera_event};
use crate::steps::arrival;
use crate::steps::dimensions::{BounceSamples, draw_flight};
use crate::steps::path_throughput::PathThroughput;
use crate::steps::settings::PathSettings;
use etalon_sampling::Sampler;
use etalon_spectrum::Wavelengths;
use etalon_transport::{Bsdf, Lights, Ray, SurfaceInteraction, Surfaces, TransportMode, World};
use glam::Vec4;

/// A subpath from the camera.
pub(super) struct FromCamera {
    carried: SubpathState,
    /// The product of the indices of refraction passed.
    eta: f32,
    /// Whether it has looked through a hidden light.
    through_hidden: bool,
    goes_on: bool,
    /// 1 if the subpath met anything that it did not pass straight, the background included; where
    /// its length ends at a surface, the probability of that.
    pub(super) alpha: f32,
}

impl FromCamera {
    /// A subpath along the camera's ray.
    pub(super) fn start(ray: Ray, settings: &PathSettings) -> Self {
        Self {
            carried: SubpathState {
                ray,
                throughput: PathThroughput::START,
                density: 0.0,
                passed: Vec4::ONE,
                segments: 1,
            },
            eta: 1.0,
            through_hidden: false,
            goes_on: settings.max_depth > 0,
            alpha: 0.0,
        }
    }

    /// Density of arriving at what has the solid angle `per_area(direction, distance²)` per area or volume.
    fn arrival<W: World>(
        &self,
        connector: &mut Connector<'_, '_, W>,
        point: &SurfaceInteraction,
        extinction: f32,
        vertices: &[SubpathVertex<'_, W>],
    ) -> f32 {
        let carried = &self.carried;
        let cos = point.area_cos(carried.ray.direction) * extinction;
        match vertices.last() {
            None => {
                // One sample per pixel makes one path per unit of the film.
                let seen = connector.camera_density(point);
                let weight = if self.through_hidden { 0.0 } else { seen };
                connector.camera_connects = weight > 0.0;
                weight * cos * carried.passed.x
            }
            Some(last) => {
                let distance_squared = point.position.distance_squared(last.point.position);
                carried.density * cos / counted(distance_squared) * carried.passed.x
            }
        }
    }

    /// Advances to the next vertex; whether the subpath continues.
    pub(super) fn advance<'w, W: World>(
        &mut self,
        world: &'w W,
        wavelengths: &Wavelengths,
        settings: &PathSettings,
        sampler: &mut impl Sampler,
        vertices: &mut Vec<SubpathVertex<'w, W>>,
        connector: &mut Connector<'_, 'w, W>,
    ) -> bool {
        if !self.goes_on {
            return false;
        }
        self.goes_on = false;
        let direction = self.carried.ray.direction;
        let hidden = settings.sees_through_lights(self.carried.segments);
        let origin = self.carried.ray.origin;
        let hit = arrival::next_hit(world, &mut self.carried.ray, hidden);
        self.through_hidden |= self.carried.ray.origin != origin;
        if self.carried.ray.medium.is_some() {
            let u = draw_flight(sampler, camera_event(self.carried.segments - 1));
            let medium = self.carried.ray.medium;
            if let Some(interaction) = self.carried.fly(world, hit.as_ref(), wavelengths, u) {
                self.alpha = 1.0;
                let density = self.arrival(
                    connector,
                    &interaction.point,
                    interaction.extinction.x,
                    vertices,
                );
                if let Some(throughput) = interaction.emission {
                    let arrival = SubpathEnd {
                        throughput,
                        density,
                        passed: self.carried.passed,
                    };
                    connector.hit_medium(&arrival, &interaction.point, medium, vertices);
                }
                if self.carried.segments == settings.max_depth {
                    return false;
                }
                return self.scatter(interaction, density, settings, sampler, vertices, connector);
            }
        }
        let Some(hit) = hit else {
            if settings.sees_background(self.alpha) && world.lights().has_background() {
                self.alpha = 1.0;
                let density = self.carried.density * self.carried.passed.x;
                let arrival = self.carried.arrival(density);
                connector.hit_background(&arrival, &self.carried.ray, vertices);
            }
            return false;
        };
        let point = world.surfaces().vertex(&self.carried.ray, &hit);
        let emits = world.lights().is_emitter(&hit);
        let wo = -direction;
        let arrival = self.arrival(connector, &point, 1.0, vertices);
        if emits {
            let arrival = self.carried.arrival(arrival);
            connector.hit_light(&arrival, &point, wo, vertices);
        }
        let interaction = Interaction::surface(world, point, wo, wavelengths);
        if self.carried.segments == settings.max_depth {
            self.alpha = self.alpha.max(arrival::opacity(&interaction.bsdf));
            return false;
        }
        self.scatter(interaction, arrival, settings, sampler, vertices, connector)
    }

    /// The techniques that end at the vertex of this interaction, and the direction sampled there; whether the subpath continues.
    fn scatter<'w, W: World>(
        &mut self,
        interaction: Interaction<'w, W>,
        arrival: f32,
        settings: &PathSettings,
        sampler: &mut impl Sampler,
        vertices: &mut Vec<SubpathVertex<'w, W>>,
        connector: &mut Connector<'_, 'w, W>,
    ) -> bool {
        let event = BounceSamples::draw(sampler, camera_event(self.carried.segments - 1));
        let mut vertex = self.carried.vertex(interaction, 1.0);
        let PathVertex {
            point, bsdf, wo, ..
        } = vertex;
        vertex.arrival = arrival;
        if bsdf.has_continuous() {
            connector.connect(&vertex, vertices, &event);
        }
        let Some(sample) = bsdf.sample(wo, event.lobe, event.direction, TransportMode::Radiance)
        else {
            self.alpha = 1.0;
            return false;
        };
        if sample.is_null {
            self.carried
                .pass(&point, sample.value, sample.chance.lanes());
            self.goes_on = self.carried.throughput.beta != Vec4::ZERO;
            return self.goes_on;
        }
        self.alpha = 1.0;
        vertex.is_delta = sample.chance.is_delta();
        let [forward, back] = vertex.both_densities(&sample);
        if let Some(before) = vertices.last_mut() {
            let distance_squared = point.position.distance_squared(before.point.position);
            before.pdf_rev = back * vertex.passed * before.per_area(wo, distance_squared);
        }
        let carried = &mut self.carried;
        carried
            .throughput
            .scatter(sample.value, sample.chance.lanes());
        self.eta *= sample.eta;
        if carried.segments >= settings.rr_depth {
            let survival = match bsdf.is_in_space() {
                true => carried.throughput.survival_in_medium(self.eta),
                false => carried.throughput.survival(self.eta),
            };
            if !carried.throughput.survives(survival, event.roulette) {
                return false;
            }
        }
        carried.density = forward.x;
        carried.passed = Vec4::ONE;
        carried.ray = point.spawn(sample.wi);
        carried.segments += 1;
        vertices.push(vertex);
        self.goes_on = carried.throughput.beta != Vec4::ZERO;
        self.goes_on
    }
}
