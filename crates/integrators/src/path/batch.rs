//! Paths that are followed in step: all find their next surface, then all arrive there, then all are scattered, then all trace
//! their shadow rays. So a processor that waits for the memory of one path works on another.

use crate::path::hooks::PathHooks;
use crate::path::state::{PathState, ShadowRay, Step};
use crate::steps::light_connection::UnoccludedPath;
use crate::steps::settings::PathConfig;
use arrayvec::ArrayVec;
use core::ops::ControlFlow;
use etalon_sampling::Sampler;
use etalon_transport::{
    Hit, PixelSample, Ray, ShadowQuery, SurfaceInteraction, Surfaces, Transmission, World,
};

/// A path that has reached a surface.
#[derive(Debug)]
pub(super) struct Arrived {
    /// The index of its ray, and in the list of paths not yet ended.
    pub(super) segment: usize,
    pub(super) vertex: SurfaceInteraction,
}

/// Up to `N` paths. Those not yet ended are listed densely, so that no stage visits the others.
pub(crate) struct PathBatch<'w, W: World + 'w, S, C, const N: usize> {
    pub(crate) paths: ArrayVec<PathState<'w, W, S, C>, N>,
    /// Indices in `paths` of those not yet ended.
    pub(super) active: ArrayVec<usize, N>,
    /// The next ray of each of these.
    pub(super) rays: ArrayVec<Ray, N>,
    /// The nearest surface along it.
    hits: [Option<Hit>; N],
    /// Indices in `active` of those that see lights at infinity.
    pub(super) escaped: ArrayVec<usize, N>,
    /// Those that have reached a surface.
    pub(super) arrived: ArrayVec<Arrived, N>,
    /// Indices in `paths` of those that go on, and their next rays.
    pub(super) continued: ArrayVec<(usize, Ray), N>,
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
            active: ArrayVec::new(),
            rays: ArrayVec::new(),
            hits: [None; N],
            escaped: ArrayVec::new(),
            arrived: ArrayVec::new(),
            continued: ArrayVec::new(),
            waiting: ArrayVec::new(),
            shadow_rays: ArrayVec::new(),
            transmissions: [None; N],
        }
    }

    /// Adds the path of a sample.
    #[inline]
    pub(crate) fn push(
        &mut self,
        (world, config): (&'w W, &PathConfig),
        site: &PixelSample,
        sampler: S,
        hooks: C,
    ) {
        let (path, ray) = PathState::start(world, site, sampler, hooks);
        if let Some(ray) = config.first_segment(ray) {
            self.active.push(self.paths.len());
            self.rays.push(ray);
        }
        self.paths.push(path);
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

    /// Brings every path to its next vertex: to a surface, or past a point where it does not stop at one.
    #[inline]
    pub(crate) fn arrive(
        &mut self,
        (world, config): (&'w W, &PathConfig),
        mut arrive: impl FnMut(
            &mut PathState<'w, W, S, C>,
            &Ray,
            Option<&Hit>,
        ) -> ControlFlow<Step, SurfaceInteraction>,
    ) {
        let lanes = self.background_in_lanes(world);
        for segment in 0..self.active.len() {
            let (path, ray) = (self.active[segment], &self.rays[segment]);
            if lanes.is_some() && self.hits[segment].is_none() && !ray.medium.is_some() {
                if config.limits.sees_background(self.paths[path].alpha()) {
                    self.escaped.push(segment);
                }
                continue;
            }
            match arrive(&mut self.paths[path], ray, self.hits[segment].as_ref()) {
                ControlFlow::Continue(vertex) => self.arrived.push(Arrived { segment, vertex }),
                ControlFlow::Break(step) => self.take(path, step),
            }
        }
        if let Some(lanes) = lanes {
            self.see_background(lanes, config);
        }
    }

    /// Scatters every path that has reached a surface.
    #[inline]
    pub(crate) fn scatter(
        &mut self,
        (world, config): (&'w W, &PathConfig),
        mut scatter: impl FnMut(&mut PathState<'w, W, S, C>, &Ray, &SurfaceInteraction) -> Step,
    ) {
        self.scatter_by_kind((world, config), |batch, place| {
            let Arrived { segment, vertex } = &batch.arrived[place];
            let (path, ray) = (batch.active[*segment], &batch.rays[*segment]);
            let step = scatter(&mut batch.paths[path], ray, vertex);
            batch.take(path, step);
        });
        self.arrived.clear();
        self.active.clear();
        self.rays.clear();
        for (path, ray) in self.continued.drain(..) {
            self.active.push(path);
            self.rays.push(ray);
        }
    }

    /// Queues the rays of a step of a path.
    #[inline]
    fn take(&mut self, path: usize, step: Step) {
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
            self.continued.push((path, next));
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
