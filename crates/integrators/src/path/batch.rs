//! Paths that are followed in step: all find their next surface, then all are scattered there, then all trace their shadow rays. So
//! a processor that waits for the memory of one path works on another.

use crate::path::hooks::PathHooks;
use crate::path::state::{PathState, ShadowRay, Step};
use crate::steps::camera_ray::draw_lens;
use crate::steps::light_connection::UnoccludedPath;
use crate::steps::settings::PathConfig;
use arrayvec::ArrayVec;
use etalon_math::lane::{F32x8, Lane};
use etalon_sampling::Sampler;
use etalon_transport::{
    Camera, CameraRay, Hit, Media, PixelSample, Ray, Sensor, ShadowQuery, Surfaces, Transmission,
    World,
};
use glam::Vec2;

/// The lanes in use.
pub(super) type Lanes = F32x8;

/// Where, through which point of the lens, and when a camera looks.
#[derive(Clone, Copy, Debug)]
struct View {
    raster: Vec2,
    lens: Vec2,
    time: f32,
}

/// Up to `N` paths. Those not yet ended are listed densely, so that no stage visits the others.
pub(crate) struct PathBatch<'w, W: World + 'w, S, C, const N: usize> {
    pub(crate) paths: ArrayVec<PathState<'w, W, S, C>, N>,
    /// How the camera looks along each.
    views: ArrayVec<View, N>,
    /// Indices in `paths` of those not yet ended.
    pub(super) active: ArrayVec<usize, N>,
    /// The next ray of each of these.
    pub(super) rays: ArrayVec<Ray, N>,
    /// The nearest surface along it.
    pub(super) hits: [Option<Hit>; N],
    /// Indices in `active` of those that see lights at infinity.
    pub(super) escaped: ArrayVec<usize, N>,
    /// Indices in `paths` of those that go on.
    pub(super) continued: ArrayVec<usize, N>,
    /// Their next rays.
    pub(super) next_rays: ArrayVec<Ray, N>,
    /// Indices in `paths` of those with a shadow ray, and their light samples.
    pub(super) waiting: ArrayVec<(usize, UnoccludedPath), N>,
    /// The shadow rays.
    pub(super) shadow_rays: ArrayVec<ShadowQuery, N>,
    /// Their transmittance.
    transmissions: [Option<Transmission>; N],
}

impl<'w, W: World, S: Sampler, C: PathHooks, const N: usize> PathBatch<'w, W, S, C, N> {
    /// No paths.
    pub(crate) fn new() -> Self {
        Self {
            paths: ArrayVec::new(),
            views: ArrayVec::new(),
            active: ArrayVec::new(),
            rays: ArrayVec::new(),
            hits: [None; N],
            escaped: ArrayVec::new(),
            continued: ArrayVec::new(),
            next_rays: ArrayVec::new(),
            waiting: ArrayVec::new(),
            shadow_rays: ArrayVec::new(),
            transmissions: [None; N],
        }
    }

    /// Adds the path of a sample.
    #[inline]
    pub(crate) fn push(&mut self, world: &'w W, site: &PixelSample, mut sampler: S, hooks: C) {
        let (lens, u, time) = draw_lens(&mut sampler);
        let wavelengths = world.sensor().wavelengths(u);
        (self.paths).push(PathState::new(world, wavelengths, sampler, hooks));
        self.views.push(View {
            raster: site.raster,
            lens,
            time: world.moment(site.raster, time),
        });
    }

    /// Sends the paths that were added into the scene, if a path may have a segment at all.
    #[inline]
    pub(crate) fn start(&mut self, world: &W, config: &PathConfig) {
        if config.limits.max_depth == 0 {
            return;
        }
        let medium = world.media().around_camera();
        let mut index = 0;
        for views in self.views.chunks(Lanes::WIDTH) {
            let [x, y, a, b, time, ..] = Lanes::columns(|i| {
                let View { raster, lens, time } = views[i.min(views.len() - 1)];
                [raster.x, raster.y, lens.x, lens.y, time, 0.0, 0.0, 0.0]
            });
            let rays = world.camera().rays::<Lanes>([x, y], [a, b], time).lanes();
            for (i, view) in views.iter().enumerate() {
                let CameraRay { mut ray, weight } = rays(i, view.time);
                ray.medium = medium;
                self.paths[index].weight = weight;
                self.active.push(index);
                self.rays.push(ray);
                index += 1;
            }
        }
    }

    /// Whether any path has not ended.
    #[inline]
    pub(crate) fn goes_on(&self) -> bool {
        !self.active.is_empty()
    }

    /// Finds the next surface of every path.
    #[inline]
    pub(crate) fn intersect(&mut self, world: &W, config: &PathConfig) {
        for (path, ray) in self.active.iter().zip(&mut self.rays) {
            self.paths[*path].plan_flight(config, ray);
        }
        let hits = &mut self.hits[..self.rays.len()];
        world.surfaces().intersect_batch(&self.rays, hits);
    }

    /// Brings every path to its next vertex, and scatters it there.
    #[inline]
    pub(crate) fn advance(&mut self, world: &'w W, config: &PathConfig) {
        match world.lanes().filter(|_| C::LANES) {
            Some(lanes) => self.advance_by_kind((world, lanes, config)),
            None => (0..self.active.len()).for_each(|segment| {
                self.advance_alone((world, config), segment);
            }),
        }
        self.active.clone_from(&self.continued);
        self.continued.clear();
        self.rays.clone_from(&self.next_rays);
        self.next_rays.clear();
    }

    /// The same of one path.
    #[inline]
    pub(super) fn advance_alone(&mut self, (world, config): (&'w W, &PathConfig), segment: usize) {
        let (path, ray) = (self.active[segment], &self.rays[segment]);
        let hit = self.hits[segment].as_ref();
        let step = super::advance(world, config, &mut self.paths[path], (ray, hit));
        self.take(path, step);
    }

    /// Queues the rays of a step of a path.
    #[inline]
    pub(super) fn take(&mut self, path: usize, step: Step) {
        if let Some(ShadowRay {
            ray,
            crossings,
            unoccluded,
        }) = step.shadow
        {
            self.waiting.push((path, unoccluded));
            self.shadow_rays.push(ShadowQuery {
                ray,
                wavelengths: self.paths[path].wavelengths,
                crossings,
            });
        }
        if let Some(next) = step.ray {
            self.continued.push(path);
            self.next_rays.push(next);
        }
    }

    /// Traces the shadow rays, and adds the contributions of their light samples.
    #[inline]
    pub(crate) fn trace_shadows(&mut self, world: &W) {
        let transmissions = &mut self.transmissions[..self.waiting.len()];
        world.transmittance_batch(&self.shadow_rays, transmissions);
        for ((path, unoccluded), transmission) in self.waiting.drain(..).zip(transmissions) {
            if let Some(transmission) = transmission {
                self.paths[path].add_light(&unoccluded, transmission);
            }
        }
        self.shadow_rays.clear();
    }
}
