//! Paths that are followed in step: all find their next surface, then all are extended there, then all trace their shadow
//! rays. So a processor that waits for the memory of one path works on another.

use crate::path::hooks::PathHooks;
use crate::path::state::{PathState, ShadowRay, Step};
use crate::steps::light_connection::UnoccludedPath;
use crate::steps::settings::PathConfig;
use arrayvec::ArrayVec;
use etalon_sampling::Sampler;
use etalon_transport::{Hit, PixelSample, Ray, ShadowQuery, Surfaces, Transmission, World};

/// Up to `N` paths. Those not yet ended are listed densely, so that no stage visits the others.
pub(crate) struct PathBatch<'w, W: World + 'w, S, C, const N: usize> {
    pub(crate) paths: ArrayVec<PathState<'w, W, S, C>, N>,
    /// Indices in `paths` of those not yet ended.
    active: ArrayVec<usize, N>,
    /// The next ray of each of these.
    rays: ArrayVec<Ray, N>,
    /// The nearest surface along it.
    hits: [Option<Hit>; N],
    /// Indices in `paths` of those with a shadow ray, and their light samples.
    waiting: ArrayVec<(usize, UnoccludedPath), N>,
    /// The shadow rays.
    shadow_rays: ArrayVec<ShadowQuery, N>,
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

    /// Extends every path past its next vertex, and drops those that end there from the list.
    #[inline]
    pub(crate) fn advance(
        &mut self,
        mut extend: impl FnMut(&mut PathState<'w, W, S, C>, &Ray, Option<&Hit>) -> Step,
    ) {
        let mut kept = 0;
        for place in 0..self.active.len() {
            let index = self.active[place];
            let path = &mut self.paths[index];
            let step = extend(path, &self.rays[place], self.hits[place].as_ref());
            if let Some(ShadowRay {
                ray,
                crossings,
                unoccluded,
            }) = step.shadow
            {
                self.waiting.push((index, unoccluded));
                self.shadow_rays.push(ShadowQuery {
                    ray,
                    wavelengths: path.wavelengths,
                    crossings,
                });
            }
            if let Some(next) = step.ray {
                self.active[kept] = index;
                self.rays[kept] = next;
                kept += 1;
            }
        }
        self.active.truncate(kept);
        self.rays.truncate(kept);
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
