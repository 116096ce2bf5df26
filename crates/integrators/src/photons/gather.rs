//! The camera path, which gathers photons at scattering surfaces.
//!
//! It follows sharp directions to their end, as `path` does, including light sampling. At other surfaces indirect light
//! comes from photons, and the path ends. With a final gather it continues once in such a direction, and gathers photons
//! at the next surface.

use super::camera_path::{CameraPath, CameraVertex};
use super::sets::{WavelengthChoice, WavelengthSets};
use super::shoot::{FACING, Kind, Photon, PhotonMap};
use super::{is_sharp, kernel::KernelLookup};
use crate::steps::arrival::{self, Arrival, Arriving};
use crate::steps::camera_ray::{draw_lens, ray_at};
use crate::steps::dimensions::{BounceSamples, draw_flight};
use crate::steps::light_connection::LightConnection;
use crate::steps::light_mis::LightMis;
use crate::steps::path_throughput::PathThroughput;
use crate::steps::settings::PathSettings;
use etalon_sampling::Sampler;
use etalon_spectrum::Wavelengths;
use etalon_transport::{
    Bsdf, LightSampleContext, PixelSample, Ray, SampleJob, SamplePdf, Scatterer, ScattererOf, Sink,
    SurfaceInteraction, Surfaces, TileSink, TransportMode, World,
};
use glam::{Vec3, Vec4};
use std::vec::Drain;

/// A photon map, its kernel, and the photons of it that count.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layer<'a> {
    pub(crate) map: &'a PhotonMap,
    /// The look-up on surfaces, …
    pub(crate) lookup: KernelLookup,
    /// … and in media.
    pub(crate) in_space: KernelLookup,
    /// Number of photons shot.
    pub(crate) shot: u32,
    /// Whether these photons count where the path has only followed sharp directions, …
    pub(crate) first: fn(Kind) -> bool,
    /// … and where it has left in another one.
    pub(crate) second: fn(Kind) -> bool,
}

/// The configuration of a camera path.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GatherConfig<'a> {
    pub(crate) settings: &'a PathSettings,
    pub(crate) sets: &'a WavelengthSets,
    pub(crate) layers: &'a [Layer<'a>],
    /// The moment of the pass, see [`moment`](super::shoot::moment).
    pub(crate) time: f32,
    pub(crate) final_gather: bool,
    /// Whether direct light is sampled, not left to photons where a direction is not sharp.
    pub(crate) sample_lights: bool,
}

/// Buffers that paths reuse.
struct Scratch<B> {
    path: Vec<CameraVertex>,
    /// The model of the surface at hand for each set, once needed, and what its photons add.
    at: Vec<(Option<B>, Vec4)>,
    nearest: Vec<super::kdtree::Neighbour>,
}

impl<B> Default for Scratch<B> {
    fn default() -> Self {
        Self {
            path: Vec::new(),
            at: Vec::new(),
            nearest: Vec::new(),
        }
    }
}

/// A path from the camera that gathers photons.
struct GatherPath<'a, 'w, W: World> {
    world: &'w W,
    plan: &'a GatherConfig<'a>,
    lanes: WavelengthChoice,
    wavelengths: Wavelengths,
    scratch: &'a mut Scratch<ScattererOf<'w, W>>,
    throughput: PathThroughput,
    /// Whether smooth dispersion has left one wavelength.
    alone: bool,
    /// Whether it has left in a direction that is not sharp.
    second: bool,
    light_mis: LightMis,
    depth: u32,
    /// Radiance at the path's own wavelengths, per lane, …
    radiance: Vec4,
    /// … and at those of photons.
    rgb: Vec3,
}

/// Follows one sample by itself.
pub(crate) fn follow_one<W: World>(
    world: &W,
    plan: &GatherConfig<'_>,
    site: &PixelSample,
    sampler: &mut impl Sampler,
    sink: &mut impl Sink,
) {
    follow(world, plan, site, sampler, &mut Scratch::default(), sink);
}

/// Follows samples one after the other.
pub(crate) fn follow_all<W: World, S: Sampler>(
    world: &W,
    plan: &GatherConfig<'_>,
    jobs: Drain<'_, SampleJob<S>>,
    sink: &mut impl TileSink,
) {
    let mut scratch = Scratch::default();
    for mut job in jobs {
        sink.begin_placed(job.site.pixel, &job.placement());
        let (site, sampler) = (&job.site, &mut job.sampler);
        follow(world, plan, site, sampler, &mut scratch, sink);
    }
}

/// Follows one sample.
fn follow<'w, W: World>(
    world: &'w W,
    plan: &GatherConfig<'_>,
    site: &PixelSample,
    sampler: &mut impl Sampler,
    scratch: &mut Scratch<ScattererOf<'w, W>>,
    sink: &mut impl Sink,
) {
    let (lens, u, _) = draw_lens(sampler);
    let lanes = plan.sets.choose(u);
    let (ray, weight) = ray_at(world, site, lens, plan.time);
    scratch.path.clear();
    let mut path = GatherPath {
        world,
        plan,
        lanes,
        wavelengths: plan.sets.of(lanes),
        scratch,
        throughput: PathThroughput::START,
        alone: false,
        second: false,
        light_mis: LightMis::NONE,
        depth: 1,
        radiance: Vec4::ZERO,
        rgb: Vec3::ZERO,
    };
    let alpha = path.trace(ray, sampler);
    let own = lanes.to_set(path.radiance);
    let rgb = plan.sets.sensor(lanes.set).rgb(own) + path.rgb;
    sink.radiance((rgb * weight).to_array(), alpha);
}

impl<'w, W: World> GatherPath<'_, 'w, W> {
    /// Follows the path; its alpha, as in `path`.
    fn trace(&mut self, mut ray: Ray, sampler: &mut impl Sampler) -> f32 {
        let (world, settings) = (self.world, self.plan.settings);
        let mut alpha = 0.0_f32;
        let mut eta = 1.0;
        while self.depth <= settings.max_depth && self.throughput.beta != Vec4::ZERO {
            let hidden = settings.sees_through_lights(self.depth);
            let hit = arrival::next_hit(world, &mut ray, hidden);
            // Gathering in a medium excludes σs, which photons include.
            let mut gathering = self.throughput;
            let mut scattering = None;
            if ray.medium.is_some() {
                let u = draw_flight(sampler, self.depth - 1);
                let waves = &self.wavelengths;
                if let Some(flight) = arrival::free_flight(world, &ray, hit.as_ref(), waves, u) {
                    // It cannot be evaluated at other wavelengths.
                    self.alone = true;
                    let density = flight.density();
                    self.light_mis.r_l /= density.x;
                    if !self.second {
                        self.radiance += self.arriving().emitted_by_medium(world, &flight, &ray);
                    }
                    self.throughput.scatter(flight.factor, density);
                    gathering.scatter(flight.passed, density);
                    if let Some(collision) = flight.scattering {
                        alpha = 1.0;
                        let vertex = SurfaceInteraction::in_space(&ray, collision.t);
                        scattering = Some((vertex, Scatterer::Space(collision.phase)));
                    }
                }
            }
            let wo = -ray.direction;
            let (vertex, bsdf) = match scattering {
                Some(vertex) => vertex,
                None => {
                    let sees_background = settings.sees_background(alpha);
                    let arrival = self
                        .arriving()
                        .at(world, &ray, hit.as_ref(), sees_background);
                    let (vertex, emission) = match arrival {
                        Arrival::Surface(vertex, emission) => (Some(vertex), emission),
                        Arrival::Background(emission) => (None, emission),
                        Arrival::Nothing => break,
                    };
                    if !self.second {
                        self.radiance += emission;
                    }
                    let Some(vertex) = vertex else {
                        alpha = 1.0;
                        break;
                    };
                    gathering = self.throughput;
                    let bsdf = world.surfaces().bsdf(&vertex, wo, &self.wavelengths);
                    (vertex, Scatterer::Surface(bsdf))
                }
            };
            if self.depth == settings.max_depth {
                alpha = alpha.max(arrival::opacity(&bsdf));
                break;
            }
            let event = BounceSamples::draw(sampler, self.depth - 1);
            // Scattering is weighed against light sampling in sharp directions only.
            let from = LightSampleContext::new(&vertex, wo, &bsdf);
            if bsdf.has_continuous() {
                if !self.second {
                    self.trace_shadow(&vertex, &from, &bsdf, wo, &event);
                }
                self.gather(&vertex, &bsdf, wo, &gathering);
            }
            let sampled = bsdf.sample(wo, event.lobe, event.direction, TransportMode::Radiance);
            let Some(sample) = sampled else {
                alpha = 1.0;
                break;
            };
            if !sample.is_null {
                alpha = 1.0;
            }
            match sample.chance {
                SamplePdf::Continuous(density) if !is_sharp(density) => {
                    if self.second || !self.plan.final_gather {
                        break;
                    }
                    self.second = true;
                }
                SamplePdf::Discrete(atom) if sample.eta != 1.0 => {
                    self.alone |= atom.0.min_element() == 0.0;
                }
                _ => {}
            }
            let mut left = CameraVertex::new(vertex, wo, &sample, event.lobe, event.direction);
            self.light_mis = self.light_mis.after(&self.throughput, &from, &sample);
            self.throughput.scatter(sample.value, sample.chance.lanes());
            eta *= sample.eta;
            ray = vertex.spawn(sample.wi);
            if self.depth >= settings.rr_depth {
                let survival = self.throughput.survival(eta);
                if !self.throughput.survives(survival, event.roulette) {
                    break;
                }
                left.roulette(survival);
            }
            self.scratch.path.push(left);
            self.depth += 1;
        }
        alpha
    }

    /// The path as it arrives somewhere.
    fn arriving(&self) -> Arriving<'_> {
        Arriving {
            wavelengths: &self.wavelengths,
            throughput: &self.throughput,
            light_mis: &self.light_mis,
        }
    }

    /// Adds direct light, weighed against following the same direction if that is sharp.
    fn trace_shadow(
        &mut self,
        vertex: &SurfaceInteraction,
        from: &LightSampleContext,
        bsdf: &ScattererOf<'w, W>,
        wo: Vec3,
        event: &BounceSamples,
    ) {
        let world = self.world;
        let (choice, u) = (event.light_choice, event.light);
        let Some(light) = world.sample_light(from, &self.wavelengths, choice, u) else {
            return;
        };
        let (value, density) = bsdf.eval_and_density(wo, light.direction, TransportMode::Radiance);
        let contribution = value * light.radiance;
        let sharp = is_sharp(density);
        if contribution == Vec4::ZERO || !(sharp || self.plan.sample_lights) {
            return;
        }
        let max_null = self.plan.settings.max_depth - self.depth - 1;
        // Directions that are not sharp are left to light sampling and photons.
        let counts = [1.0, f32::from(sharp)];
        let connection = LightConnection::of(
            &light,
            &self.throughput,
            self.throughput.r_u,
            contribution,
            density,
            counts,
        );
        self.radiance += connection.traced(world, vertex, &self.wavelengths, max_null);
    }

    /// Adds the light that photons bring to a path of this throughput.
    fn gather(
        &mut self,
        vertex: &SurfaceInteraction,
        own: &ScattererOf<'w, W>,
        wo: Vec3,
        throughput: &PathThroughput,
    ) {
        let GatherConfig { sets, layers, .. } = *self.plan;
        let scratch = &mut *self.scratch;
        scratch.at.clear();
        scratch.at.resize_with(sets.len(), || (None, Vec4::ZERO));
        let at = &mut scratch.at;
        let (world, depth, alone) = (self.world, self.depth, self.alone);
        let (max_depth, lanes) = (self.plan.settings.max_depth, self.lanes);
        let camera_path = CameraPath {
            sets,
            lanes,
            alone,
            throughput,
            path: &scratch.path,
        };
        let in_space = own.is_in_space();
        let shares = |photon: &Photon| match in_space {
            true => photon.medium == vertex.media.outside,
            false => photon.normal.dot(vertex.normal) >= FACING,
        };
        let mut any = false;
        for layer in layers {
            let counts = if self.second {
                layer.second
            } else {
                layer.first
            };
            let mut merge = |photon: &Photon, kernel: f32| {
                let set = photon.set as usize;
                if !counts(photon.kind)
                    || depth.saturating_add(photon.segments) > max_depth
                    || (alone && set != lanes.set)
                    || !shares(photon)
                {
                    return;
                }
                if is_sharp(own.density(wo, photon.from)) {
                    return; // For the path's own wavelengths.
                }
                let (model, sum) = &mut at[set];
                let model = model.get_or_insert_with(|| match own {
                    // Only the path's own set is looked for.
                    Scatterer::Space(_) => *own,
                    Scatterer::Surface(_) => {
                        Scatterer::Surface(world.surfaces().bsdf(vertex, wo, sets.get(set)))
                    }
                });
                let value = match model.is_in_space() {
                    // For flakes, only the direction of the light matters.
                    true => model.eval(photon.from, wo, TransportMode::Radiance),
                    false => model.eval(wo, photon.from, TransportMode::Radiance),
                };
                *sum += value * photon.value * kernel;
                any = true;
            };
            let (lookup, placed) = match in_space {
                false => (&layer.lookup, &layer.map.surfaces),
                true => (&layer.in_space, &layer.map.space),
            };
            let scale = 1.0 / layer.shot as f32;
            let (at, near) = (vertex.position, &mut scratch.nearest);
            let merge = |photon: &Photon, kernel: f32| merge(photon, kernel * scale);
            lookup.visit(placed, at, in_space, near, merge);
        }
        if any {
            self.rgb = camera_path.carried(world, at.iter().map(|(_, sum)| *sum), self.rgb);
        }
    }
}
