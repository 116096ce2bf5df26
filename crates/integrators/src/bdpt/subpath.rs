//! Walks from the camera and from a light, and the corners they leave behind.

use super::connect::{Arrival, Connector};
use super::path_vertex::{Corner, PathVertex, counted};
use crate::dimensions::{BounceSamples, draw_flight};
use crate::path_throughput::PathThroughput;
use crate::settings::PathSettings;
use crate::steps;
use etalon_sampling::Sampler;
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Bsdf, Emission, Hit, LightKind, Ray, Scatterer, ScattererOf, SurfaceInteraction, TransportMode,
    World,
};
use glam::{Vec3, Vec4};

/// The numbers of the camera walk's events, of the emission, and of the light walk's events lie
/// side by side, the camera's first.
fn camera_event(index: u32) -> u32 {
    2 * index
}

fn light_event(index: u32) -> u32 {
    2 * index + 1
}

/// What a walk carries from surface to surface.
struct SubpathState {
    ray: Ray,
    prefix: PathThroughput,
    /// Density of `ray`'s direction at the last corner, of the lane that chose.
    density: f32,
    /// Probability of passing surfaces since the last corner, per lane.
    passed: Vec4,
    /// Segments behind, that of `ray` included.
    segments: u32,
}

/// What a walk comes to.
struct Met<'w, W: World + 'w> {
    vertex: SurfaceInteraction,
    bsdf: ScattererOf<'w, W>,
    /// See [`PathVertex::extinction`].
    extinction: Vec4,
    /// The walk up to what a medium emits there, if it does.
    shining: Option<PathThroughput>,
}

impl<'w, W: World> Met<'w, W> {
    /// A surface.
    fn surface(
        world: &'w W,
        vertex: SurfaceInteraction,
        wo: Vec3,
        wavelengths: &Wavelengths,
    ) -> Self {
        Self {
            vertex,
            bsdf: Scatterer::Surface(world.bsdf(&vertex, wo, wavelengths)),
            extinction: Vec4::ONE,
            shining: None,
        }
    }
}

impl SubpathState {
    /// Goes straight on through a surface.
    fn pass(&mut self, vertex: &SurfaceInteraction, value: Vec4, chance: Vec4) {
        self.prefix.scatter(value, chance);
        self.passed *= chance;
        self.ray = vertex.spawn(self.ray.direction);
        self.segments += 1;
    }

    /// The arrival at a light.
    fn arrival(&self, density: f32) -> Arrival {
        Arrival {
            prefix: self.prefix,
            density,
            passed: self.passed,
        }
    }

    /// Flies through the medium, to where light is scattered before its `hit`, if it is.
    #[cold]
    #[inline(never)]
    fn fly<'w, W: World>(
        &mut self,
        world: &'w W,
        hit: Option<&Hit>,
        wavelengths: &Wavelengths,
        u: f32,
    ) -> Option<Met<'w, W>> {
        let flight = steps::free_flight(world, &self.ray, hit, wavelengths, u)?;
        let density = flight.density();
        let before = self.prefix;
        self.prefix.scatter(flight.factor, density);
        self.passed *= flight.passed;
        let collision = flight.scattering?;
        let shining = (flight.emitted != Vec4::ZERO).then(|| {
            let mut emitted = before;
            emitted.scatter(flight.emitted, density);
            emitted
        });
        Some(Met {
            vertex: SurfaceInteraction::in_space(&self.ray, collision.t),
            bsdf: Scatterer::Space(collision.phase),
            extinction: collision.extinction,
            shining,
        })
    }

    /// The corner at what was met, arrived at with this density per solid angle at the last one.
    fn corner<'w, W: World>(&self, met: Met<'w, W>, arrival: f32) -> Corner<'w, W> {
        let Met {
            vertex,
            bsdf,
            extinction,
            ..
        } = met;
        PathVertex {
            vertex,
            bsdf,
            extinction,
            wo: -self.ray.direction,
            prefix: self.prefix,
            arrival: arrival * self.passed.x,
            pdf_rev: Vec4::ZERO,
            passed: self.passed,
            is_delta: false,
            segments: self.segments,
            parent: None,
            direct: 0.0,
        }
    }
}

/// A particle's start, and what its first corner's neighbours say of it.
pub(super) struct FromLight {
    /// What was emitted.
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
    pub(super) fn arrival<B>(
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
            let hit = steps::next_hit(world, &mut carried.ray, false);
            let wo = -carried.ray.direction;
            let mut met = None;
            if carried.ray.medium.is_some() {
                let u = draw_flight(sampler, light_event(carried.segments));
                met = carried.fly(world, hit.as_ref(), wavelengths, u);
            }
            let Some(met) = met.or_else(|| {
                let vertex = world.vertex(&carried.ray, &hit?);
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

    /// Goes on to the next surface; whether there is more.
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
        let hit = steps::next_hit(world, &mut self.carried.ray, hidden);
        self.through_hidden |= self.carried.ray.origin != origin;
        if self.carried.ray.medium.is_some() {
            let u = draw_flight(sampler, camera_event(self.carried.segments - 1));
            let medium = self.carried.ray.medium;
            if let Some(met) = self.carried.fly(world, hit.as_ref(), wavelengths, u) {
                self.alpha = 1.0;
                if let Some(prefix) = met.shining {
                    let arrival = Arrival {
                        prefix,
                        density: self.arrival(connector, &met.vertex, met.extinction.x, corners),
                        passed: self.carried.passed,
                    };
                    connector.meet_medium(&arrival, &met.vertex, medium, corners);
                }
                if self.carried.segments == settings.max_depth {
                    return false;
                }
                let arrival = self.arrival(connector, &met.vertex, met.extinction.x, corners);
                return self.turn(met, arrival, settings, sampler, corners, connector);
            }
        }
        let Some(hit) = hit else {
            // A hidden sky stays hidden to rays that only went straight.
            let visible = !settings.hide_emitters || self.alpha > 0.0;
            if visible && world.has_background() {
                self.alpha = 1.0;
                let density = self.carried.density * self.carried.passed.x;
                let arrival = self.carried.arrival(density);
                connector.meet_background(&arrival, direction, corners);
            }
            return false;
        };
        let vertex = world.vertex(&self.carried.ray, &hit);
        let emits = world.is_emitter(&hit);
        let wo = -direction;
        let arrival = self.arrival(connector, &vertex, 1.0, corners);
        if emits {
            let arrival = self.carried.arrival(arrival);
            connector.meet_light(&arrival, &vertex, wo, corners);
        }
        let met = Met::surface(world, vertex, wo, wavelengths);
        if self.carried.segments == settings.max_depth {
            self.alpha = self.alpha.max(steps::opacity(&met.bsdf));
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
