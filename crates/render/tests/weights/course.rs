//! A complete path from a light to the camera, drawn at random.

use etalon_sampling::{Independent, Sampler};
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Bsdf, Camera, Emission, LightId, LightKind, Lights, Ray, Sensor, SurfaceInteraction, Surfaces,
    TransportMode, World,
};
use glam::{Vec2, Vec3, Vec4};

/// A path x₀x₁…xₙ and the camera: the light, n surfaces, the camera.
#[derive(Clone, Debug)]
pub(crate) struct Course {
    /// Four wavelengths of it; one that chooses may stand anywhere.
    pub(crate) wavelengths: Wavelengths,
    pub(crate) raster: Vec2,
    pub(crate) lens: Vec2,
    /// The camera's ray.
    pub(crate) ray: Ray,
    /// x₁ … xₙ.
    pub(crate) surfaces: Vec<SurfaceInteraction>,
    /// Whether the path is bent there in a discrete direction.
    pub(crate) sharp: Vec<bool>,
    /// How the light emits it; its weight is that of `wavelengths`.
    pub(crate) start: Emission,
    /// The light's surface, if it has one.
    pub(crate) lamp: Option<SurfaceInteraction>,
}

/// Vertices nearer than this (m) to each other make densities too rough for single precision.
const NEAR: f32 = 0.1;

/// The same of cosines.
const GRAZING: f32 = 0.05;

/// Angles between a corner's two sides below this (radians) could not be told from each other.
const NARROW: f32 = 0.05;

/// A direction turned by so much (radians) …
const TURN: f32 = 1e-4;

/// … may change a model's values and densities by this, relative to them.
const STEADY: f32 = 0.005;

impl Course {
    pub(crate) fn segments(&self) -> u32 {
        self.surfaces.len() as u32 + 1
    }

    /// Where node `i` is: 0 the light, unless it is at infinity, then surfaces, then the camera.
    pub(crate) fn position(&self, node: usize) -> Option<Vec3> {
        match node {
            0 if self.start.origin.is_infinite() => None,
            0 => Some(self.start.point.position),
            n => Some(
                self.surfaces
                    .get(n - 1)
                    .map_or(self.ray.origin, |v| v.position),
            ),
        }
    }

    /// Unit direction from node `from` to its neighbour `to`; not from infinity.
    pub(crate) fn direction(&self, from: usize, to: usize) -> Vec3 {
        let here = self
            .position(from)
            .expect("no direction from infinity is asked for");
        match self.position(to) {
            None => -self.start.ray.direction,
            // The camera's ray may begin at its near plane, or anywhere on an orthographic one.
            Some(_) if to > self.surfaces.len() => -self.ray.direction,
            Some(there) => (there - here).normalize(),
        }
    }

    /// Squared distance of neighbours, 1 from infinity.
    pub(crate) fn distance_squared(&self, from: usize, to: usize) -> f32 {
        match (self.position(from), self.position(to)) {
            (Some(a), Some(b)) => a.distance_squared(b),
            _ => 1.0,
        }
    }

    /// The least distance of two of its surfaces.
    pub(crate) fn least_distance(&self) -> f32 {
        let mut least = 1.0_f32;
        for (i, a) in self.surfaces.iter().enumerate() {
            for b in &self.surfaces[..i] {
                least = least.min(a.position.distance(b.position));
            }
        }
        least
    }

    /// Whether single precision is enough for it.
    fn is_tame(&self) -> bool {
        let last = self.surfaces.len();
        let corners = (1..=last).all(|i| {
            let normal = self.surfaces[i - 1].normal;
            let [a, b] = [i - 1, i + 1].map(|to| self.direction(i, to));
            let cos = normal.dot(a).abs().min(normal.dot(b).abs());
            cos > GRAZING && a.distance(b) > NARROW
        });
        let lamp = self
            .lamp
            .as_ref()
            .is_none_or(|lamp| lamp.normal.dot(self.direction(0, 1)).abs() > GRAZING);
        let finite = !self.start.origin.is_infinite();
        let begin = usize::from(!finite);
        let far = (begin..last).all(|i| self.distance_squared(i, i + 1) > NEAR * NEAR);
        corners && lamp && far && self.least_distance() > NEAR
    }
}

/// Surfaces of a walk, whether it was bent sharply at each but the last, and its last direction back.
fn walk<W: World>(
    world: &W,
    wavelengths: &Wavelengths,
    mut ray: Ray,
    count: usize,
    mode: TransportMode,
    dice: &mut Independent,
) -> Option<Vec<(SurfaceInteraction, bool)>> {
    let mut found: Vec<(SurfaceInteraction, bool)> = Vec::new();
    while found.len() < count {
        let hit = world.surfaces().intersect(&ray)?;
        if world.lights().is_emitter(&hit) {
            return None;
        }
        let vertex = world.surfaces().vertex(&ray, &hit);
        found.push((vertex, false));
        if found.len() == count {
            break;
        }
        let wo = -ray.direction;
        let bsdf = world.surfaces().bsdf(&vertex, wo, wavelengths);
        let sample = bsdf.sample(wo, dice.next_1d(), dice.next_2d(), mode)?;
        found.last_mut()?.1 = sample.chance.is_delta();
        ray = vertex.spawn(sample.wi);
    }
    Some(found)
}

/// Draws a path: some surfaces from the light, some from the camera, connected. `None` if it carries no
/// light, or is none that single precision is enough for.
pub(crate) fn draw<W: World>(world: &W, dice: &mut Independent) -> Option<Course> {
    let wavelengths = world.sensor().wavelengths(dice.next_1d());
    let raster = dice.next_2d() * 32.0;
    let lens = dice.next_2d();
    let ray = world.camera().ray(raster, lens, 0.0).ray;
    let from_light = (dice.next_1d() * 4.0) as usize;
    let from_camera = 1 + (dice.next_1d() * 3.0) as usize;
    let mut start = world.emit(
        &wavelengths,
        dice.next_1d(),
        dice.next_2d(),
        dice.next_2d(),
        0.0,
    )?;
    let emitted = start;
    let mut surfaces = walk(
        world,
        &wavelengths,
        start.ray,
        from_light,
        TransportMode::Importance,
        dice,
    )?;
    let seen = walk(
        world,
        &wavelengths,
        ray,
        from_camera,
        TransportMode::Radiance,
        dice,
    )?;
    let last = seen.last()?.0;
    // The connection.
    match (surfaces.last(), start.origin) {
        (Some((corner, _)), _) => {
            let to = corner.origin_toward(last.position);
            let ray = Ray::between(last.origin_toward(corner.position), to, 0.0)?;
            world.transmittance(&ray, &wavelengths, 0)?;
        }
        (None, LightKind::Sky) => {
            let direction = -start.ray.direction;
            world.transmittance(&last.spawn(direction), &wavelengths, 0)?;
            start.ray.origin = last.position + direction * 20.0;
        }
        (None, LightKind::Surface) => {
            let direction = (last.position - start.point.position).try_normalize()?;
            start.ray = Ray::new(start.point.origin_along(direction), direction, 0.0);
        }
        // What they send in other directions than the one drawn is not known.
        (None, LightKind::Point | LightKind::Parallel | LightKind::Beam | LightKind::Medium) => {
            return None;
        }
    }
    surfaces.extend(seen.into_iter().rev());
    let (surfaces, sharp): (Vec<_>, Vec<_>) = surfaces.into_iter().unzip();
    let first = &surfaces[0];
    let mut lamp = None;
    if start.origin == LightKind::Surface {
        let ray = first.spawn((start.point.position - first.position).try_normalize()?);
        let hit = world
            .surfaces()
            .intersect(&ray)
            .filter(|hit| world.lights().is_emitter(hit))?;
        let vertex = world.surfaces().vertex(&ray, &hit);
        if vertex.light != start.light || vertex.position.distance(start.point.position) > 1e-3 {
            return None;
        }
        lamp = Some(vertex);
    }
    let mut course = Course {
        wavelengths,
        raster,
        lens,
        ray,
        surfaces,
        sharp,
        start,
        lamp,
    };
    if !course.is_tame() {
        return None;
    }
    if let Some((weight, density)) = course.emitted(world) {
        course.start.weight = weight;
        course.start.density = density;
    }
    if from_light > 0 {
        agrees(&course.start, &emitted);
    }
    (course.start.weight != Vec4::ZERO && course.carries(world)).then_some(course)
}

/// What a light says of a particle that it emits is what it says of one that it would have emitted.
fn agrees(rebuilt: &Emission, emitted: &Emission) {
    let close = |a: f32, b: f32| (a - b).abs() <= 1e-3 * b.abs();
    let [a, b] = [rebuilt.density, emitted.density];
    let same = close(a.origin, b.origin)
        && close(a.ray, b.ray)
        && (0..4).all(|lane| close(rebuilt.weight[lane], emitted.weight[lane]));
    assert!(same, "{emitted:#?} is called {rebuilt:#?}");
}

impl Course {
    /// The weight and density of its emission, by what the world says of hitting the light.
    fn emitted<W: World>(&self, world: &W) -> Option<(Vec4, etalon_transport::EmissionPdf)> {
        let away = self.start.ray.direction;
        let (radiance, density, cos) = match (self.start.origin, &self.lamp) {
            (LightKind::Surface, Some(lamp)) => {
                let cos = lamp.normal.dot(away).abs();
                let radiance = world.lights().emitted(lamp, away, &self.wavelengths);
                (
                    radiance,
                    world.emission_density(self.start.light, away, cos, 0.0),
                    cos,
                )
            }
            (LightKind::Sky, _) => {
                let radiance = world.lights().background(-away, 0.0, &self.wavelengths);
                (radiance, world.background_emission_density(-away, 0.0), 1.0)
            }
            _ => return None,
        };
        debug_assert!(self.start.light != LightId::NONE);
        Some((radiance * (cos / (density.origin * density.ray)), density))
    }

    /// Whether all of its surfaces scatter the first lane's light along it, and so that single
    /// precision can tell how much: not at the very edge of a lobe.
    fn carries<W: World>(&self, world: &W) -> bool {
        let steady = |a: Vec4, b: Vec4| (a - b).abs().cmple(a.abs() * STEADY).all();
        (1..=self.surfaces.len()).all(|node| {
            let vertex = &self.surfaces[node - 1];
            let (one, other) = (
                self.direction(node, node + 1),
                self.direction(node, node - 1),
            );
            let shines = |wo: Vec3, wi: Vec3, mode: TransportMode| {
                let bsdf = world.surfaces().bsdf(vertex, wo, &self.wavelengths);
                let at = |wi: Vec3| (bsdf.eval(wo, wi, mode), bsdf.density(wo, wi).lanes());
                let (value, density) = at(wi);
                let turns = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| (wi + TURN * axis).normalize());
                value.x > 0.0
                    && turns
                        .into_iter()
                        .map(at)
                        .all(|(v, d)| steady(value, v) && steady(density, d))
            };
            self.sharp[node - 1]
                || shines(one, other, TransportMode::Radiance)
                    && shines(other, one, TransportMode::Importance)
        })
    }
}
