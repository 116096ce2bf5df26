//! The walk from the camera, and the corners it leaves behind.

use super::connect::Connector;
use super::path_vertex::{Corner, PathVertex, counted};
use super::subpath::{Met, SubpathEnd, SubpathState, camera_event};
use crate::steps::arrival;
use crate::steps::dimensions::{BounceSamples, draw_flight};
use crate::steps::path_throughput::PathThroughput;
use crate::steps::settings::PathSettings;
use etalon_sampling::Sampler;
use etalon_spectrum::Wavelengths;
use etalon_transport::{Bsdf, Lights, Ray, SurfaceInteraction, Surfaces, TransportMode, World};
use glam::Vec4;

/// A walk from the camera.
pub(super) struct FromCamera {
    carried: SubpathState,
    /// The product of the indices of refraction passed.
    eta: f32,
    /// Whether it has looked through a hidden light.
    through_hidden: bool,
    goes_on: bool,
    /// 1 if the walk met anything that it did not pass straight, the background included; where
    /// its length ends at a surface, the probability of that.
    pub(super) alpha: f32,
}

impl FromCamera {
    /// A walk along the camera's ray.
    pub(super) fn start(ray: Ray, settings: &PathSettings) -> Self {
        Self {
            carried: SubpathState {
                ray,
                prefix: PathThroughput::START,
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
        vertex: &SurfaceInteraction,
        extinction: f32,
        corners: &[Corner<'_, W>],
    ) -> f32 {
        let carried = &self.carried;
        let cos = vertex.area_cos(carried.ray.direction) * extinction;
        match corners.last() {
            None => {
                // One sample per pixel makes one path per unit of the film.
                let seen = connector.camera_density(vertex);
                let weight = if self.through_hidden { 0.0 } else { seen };
                connector.camera_connects = weight > 0.0;
                weight * cos * carried.passed.x
            }
            Some(last) => {
                let distance_squared = vertex.position.distance_squared(last.vertex.position);
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
        corners: &mut Vec<Corner<'w, W>>,
        connector: &mut Connector<'_, 'w, W>,
    ) -> bool {
        if !self.goes_on {
            return false;
        }
        self.goes_on = false;
        let direction = self.carried.ray.direction;
        let hidden = settings.hide_emitters && self.carried.segments == 1;
        let origin = self.carried.ray.origin;
        let hit = arrival::next_hit(world, &mut self.carried.ray, hidden);
        self.through_hidden |= self.carried.ray.origin != origin;
        if self.carried.ray.medium.is_some() {
            let u = draw_flight(sampler, camera_event(self.carried.segments - 1));
            let medium = self.carried.ray.medium;
            if let Some(met) = self.carried.fly(world, hit.as_ref(), wavelengths, u) {
                self.alpha = 1.0;
                let density = self.arrival(connector, &met.vertex, met.extinction.x, corners);
                if let Some(prefix) = met.shining {
                    let arrival = SubpathEnd {
                        prefix,
                        density,
                        passed: self.carried.passed,
                    };
                    connector.meet_medium(&arrival, &met.vertex, medium, corners);
                }
                if self.carried.segments == settings.max_depth {
                    return false;
                }
                return self.turn(met, density, settings, sampler, corners, connector);
            }
        }
        let Some(hit) = hit else {
            // A hidden sky stays hidden to rays that only went straight.
            let visible = !settings.hide_emitters || self.alpha > 0.0;
            if visible && world.lights().has_background() {
                self.alpha = 1.0;
                let density = self.carried.density * self.carried.passed.x;
                let arrival = self.carried.arrival(density);
                connector.meet_background(&arrival, direction, corners);
            }
            return false;
        };
        let vertex = world.surfaces().vertex(&self.carried.ray, &hit);
        let emits = world.lights().is_emitter(&hit);
        let wo = -direction;
        let arrival = self.arrival(connector, &vertex, 1.0, corners);
        if emits {
            let arrival = self.carried.arrival(arrival);
            connector.meet_light(&arrival, &vertex, wo, corners);
        }
        let met = Met::surface(world, vertex, wo, wavelengths);
        if self.carried.segments == settings.max_depth {
            self.alpha = self.alpha.max(arrival::opacity(&met.bsdf));
            return false;
        }
        self.turn(met, arrival, settings, sampler, corners, connector)
    }

    /// All that ends at the corner `met`, and the way on from there; whether there is more.
    fn turn<'w, W: World>(
        &mut self,
        met: Met<'w, W>,
        arrival: f32,
        settings: &PathSettings,
        sampler: &mut impl Sampler,
        corners: &mut Vec<Corner<'w, W>>,
        connector: &mut Connector<'_, 'w, W>,
    ) -> bool {
        let event = BounceSamples::draw(sampler, camera_event(self.carried.segments - 1));
        let mut corner = self.carried.corner(met, 1.0);
        let PathVertex {
            vertex, bsdf, wo, ..
        } = corner;
        corner.arrival = arrival;
        if bsdf.has_continuous() {
            connector.connect(&corner, corners, &event);
        }
        let Some(sample) = bsdf.sample(wo, event.lobe, event.direction, TransportMode::Radiance)
        else {
            self.alpha = 1.0;
            return false;
        };
        if sample.is_null {
            self.carried
                .pass(&vertex, sample.value, sample.chance.lanes());
            self.goes_on = self.carried.prefix.beta != Vec4::ZERO;
            return self.goes_on;
        }
        self.alpha = 1.0;
        corner.is_delta = sample.chance.is_delta();
        let [forward, back] = corner.both_densities(&sample);
        if let Some(before) = corners.last_mut() {
            let distance_squared = vertex.position.distance_squared(before.vertex.position);
            before.pdf_rev = back * corner.passed * before.per_area(wo, distance_squared);
        }
        let carried = &mut self.carried;
        carried.prefix.scatter(sample.value, sample.chance.lanes());
        self.eta *= sample.eta;
        if carried.segments >= settings.rr_depth {
            let survival = match bsdf.is_in_space() {
                true => carried.prefix.survival_in_medium(self.eta),
                false => carried.prefix.survival(self.eta),
            };
            if !carried.prefix.survives(survival, event.roulette) {
                return false;
            }
        }
        carried.density = forward.x;
        carried.passed = Vec4::ONE;
        carried.ray = vertex.spawn(sample.wi);
        carried.segments += 1;
        corners.push(corner);
        self.goes_on = carried.prefix.beta != Vec4::ZERO;
        self.goes_on
    }
}
