//! `photonmap`: photon mapping in two passes.
//!
//! First, photons are shot and stored in two maps (Jensen 1996): the *caustic* map holds those that
//! were scattered in sharp directions only, the *global* map all. Then paths from the camera gather
//! them ([`crate::photons`]); at the first surface x that is not sharp,
//!
//! ```text
//! L = L_direct (sampled) + L_sharp (followed) + L_caustic (caustic map) + L_indirect
//! ```
//!
//! L_indirect comes from the photons of the global map that belong to neither of the other terms. With
//! `final_gather` it comes from the whole global map at the next surface y along a non-sharp direction
//! from x, and at those that follow y in sharp directions.
//!
//! With M photons shot, of which the i-th in the map, of flux Φᵢ, arrives along ωᵢ at the distance dᵢ
//! from x, a map adds
//!
//! ```text
//! L(x, ω) ≈ 1/M · Σ_{dᵢ ≤ r} K(dᵢ) · f(x, ωᵢ, ω) · Φᵢ
//! box:   K(d) = 1 / (π r²)
//! cone:  K(d) = (1 − d/(c r)) / ((1 − 2/(3c)) π r²),   c ≥ 1
//! ```
//!
//! (Jensen 1996; 2001, *Realistic Image Synthesis Using Photon Mapping*, chapter 7). Either kernel has
//! the integral one over the disc of radius r. Distances are those in space. Photons on surfaces that face
//! elsewhere, that arrive from directions which are followed, or whose path would be too long are
//! ignored. Every photon contributes at its own wavelengths, see [`crate::photons`].
//!
//! r is given, or the distance d₍ₖ₎ of the k-th nearest photon of the map if that is less. That photon
//! then defines the radius only, and the sum is over the k − 1 nearer ones: given d₍ₖ₎, these are
//! distributed like independent photons within a fixed radius, so that the expectation is correct under
//! uniform light,
//!
//! ```text
//! E[ (k − 1) / (π d₍ₖ₎²) ] = photons per area
//! ```
//!
//! while with a box all k would bring k/(k − 1) of it (García, Ureña, Sbert 2012, "Description and
//! Solution of an Unreported Intrinsic Bias in Photon Mapping Density Estimation with Constant Kernel").
//!
//! Without a radius and a number of nearest photons, r is the width of two pixels, or less where the map
//! is so dense that a look-up would find more than 32 photons on average ([`crate::photons::radius`]).
//!
//! If more than 1024 photons are within r, one in 4, 16, … of them, chosen at random beforehand, is visited with that weight:
//! the expectation is the same, and the time of a look-up stays bounded under a narrow beam.
//!
//! In a medium, photons are stored where they are scattered, and K is normalised over a ball: the box 1/(4/3 π r³), the cone
//! with 3/(4c) instead of 2/(3c). Photons are gathered around the end of a free flight of the camera's path
//! (Jensen & Christensen 1998, "Efficient Simulation of Light Transport in Scenes with Participating Media using
//! Photon Maps"). Without a radius and a number the 32 nearest are looked for.
//!
//! Every replicate has maps of its own. A given radius stays as it is, so its bias vanishes neither with
//! samples and replicates nor with photons; that of the k nearest does with more photons.

use crate::photons::gather::{GatherConfig, Layer, follow_all, follow_one};
use crate::photons::kernel::{Kernel, KernelLookup};
use crate::photons::radius::{ANYWHERE, MOST_FOUND, from_pixels, held, read};
use crate::photons::sets::WavelengthSets;
use crate::photons::shoot::{Kind, PhotonMap, PlacedPhotons, moment, shoot};
use crate::photons::{read_count, read_nearest, read_sets, rounded};
use crate::steps::settings::PathSettings;
use etalon_params::Params;
use etalon_sampling::{ReplicateKind, Sampler};
use etalon_transport::{
    Channel, Incompatibility, Integrator, LightSearch, Pass, PixelSample, Placing, Preparation,
    SampleJob, SceneCapabilities, Sink, TileSink, World,
};
use std::vec::Drain;

/// The photon mapper.
#[derive(Clone, Debug)]
pub struct PhotonMapper {
    /// Limits of the path.
    pub settings: PathSettings,
    /// Photons per replicate.
    pub photons: u32,
    /// Sets of wavelengths.
    pub sets: u32,
    /// Whether light that is neither direct nor a caustic is gathered one bounce away.
    pub final_gather: bool,
    /// Density estimation in the global map.
    pub global: Estimate,
    /// Density estimation in the caustic map.
    pub caustic: Estimate,
    /// The cone's k; a box if there is none.
    pub cone: Option<f32>,
}

/// The parameters of density estimation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// The radius, or the largest if the nearest photons are looked for (m); `None` for the width
    /// of some pixels or less, or as large as need be.
    pub radius: Option<f32>,
    /// Number of nearest photons; all within the radius if zero.
    pub nearest: usize,
}

/// Photons where the scene does not say.
const PHOTONS: u32 = 1 << 18;

/// Sets of wavelengths where the scene does not say.
const SETS: u32 = 16;

impl Default for PhotonMapper {
    fn default() -> Self {
        Self {
            settings: PathSettings::default(),
            photons: PHOTONS,
            sets: SETS,
            final_gather: false,
            global: Estimate::default(),
            caustic: Estimate::default(),
            cone: None,
        }
    }
}

/// The maps of a replicate.
#[derive(Debug)]
pub struct State {
    sets: WavelengthSets,
    /// The moment of the pass.
    time: f32,
    caustic: PhotonMap,
    global: PhotonMap,
    shot: u32,
    /// The radii of both (m), …
    radii: [f32; 2],
    /// … and that of two pixels where it was too much for a map (m).
    held: [Option<f32>; 2],
}

impl PhotonMapper {
    /// Reads the integrator from its description: Mitsuba's parameters of paths, `photons`,
    /// `wavelength_sets`, `final_gather`, `filter` (`box` or `cone`), `cone`, and for both maps
    /// `global_radius`, `global_nearest`, `caustic_radius` and `caustic_nearest`.
    pub fn from_params(params: &Params<'_>) -> Self {
        let estimate = |radius: &str, count: &str| Estimate {
            radius: read(params, radius),
            nearest: read_nearest(params, count),
        };
        let filter = params.choice("filter", "box", &["box", "cone"]);
        let what = "a number from 1: where the cone ends, in radii";
        let cone = params.float_where("cone", 1.1, what, |k| (1.0..=1e6).contains(&k));
        if filter != "cone" && params.has("cone") {
            params.error_at("cone", "`cone` has no effect unless `filter` is `cone`");
        }
        Self {
            settings: PathSettings::from_params(params),
            photons: read_count(params).unwrap_or(PHOTONS),
            sets: read_sets(params, SETS),
            final_gather: params.boolean_or("final_gather", false),
            global: estimate("global_radius", "global_nearest"),
            caustic: estimate("caustic_radius", "caustic_nearest"),
            cone: (filter == "cone").then_some(cone as f32),
        }
    }

    fn plan<R>(&self, state: &State, with: impl FnOnce(&GatherConfig<'_>) -> R) -> R {
        let kernel = self.cone.map_or(Kernel::Box, Kernel::Cone);
        let [global_radius, caustic_radius] = state.radii;
        let maps = [
            (self.global, &state.global, global_radius),
            (self.caustic, &state.caustic, caustic_radius),
        ];
        let lookups = maps.map(|(estimate, map, radius)| {
            let among = |placed: &PlacedPhotons, nearest: usize, radius| KernelLookup {
                radius,
                nearest: match estimate.radius {
                    // With fewer photons than k, the farthest of them defines the radius.
                    None if nearest > 0 => nearest.min(placed.photons.len().max(1)),
                    _ => nearest,
                },
                kernel,
            };
            let in_space = match (estimate.radius, estimate.nearest) {
                // Pixels say nothing of a ball.
                (None, 0) => among(&map.space, MOST_FOUND, ANYWHERE),
                (_, nearest) => among(&map.space, nearest, radius),
            };
            [among(&map.surfaces, estimate.nearest, radius), in_space]
        });
        let [global, caustic] = lookups;
        let first: fn(Kind) -> bool = if self.final_gather {
            |_| false
        } else {
            |kind| kind == Kind::Indirect
        };
        let layers = [
            Layer {
                map: &state.global,
                lookup: global[0],
                in_space: global[1],
                shot: state.shot,
                first,
                second: |_| true,
            },
            Layer {
                map: &state.caustic,
                lookup: caustic[0],
                in_space: caustic[1],
                shot: state.shot,
                first: |_| true,
                second: |_| false,
            },
        ];
        with(&GatherConfig {
            settings: &self.settings,
            sets: &state.sets,
            layers: &layers,
            time: state.time,
            final_gather: self.final_gather,
            sample_lights: true,
        })
    }
}

impl Preparation for State {
    fn remarks(&self) -> Vec<String> {
        let names = ["global_radius", "caustic_radius"];
        let held = (names.into_iter().zip(self.held).zip(self.radii))
            .filter_map(|((name, wide), radius)| Some((name, wide?, radius)));
        held.map(|(name, wide, radius)| {
            format!(
                "`{name}` is {radius:.3} m instead of two pixels ({wide:.3} m), within which a \
                 look-up would find more than {MOST_FOUND} photons on average; give `{name}` to \
                 have another"
            )
        })
        .collect()
    }
}

impl Integrator for PhotonMapper {
    const UNBIASED: bool = false;
    const MEDIA: bool = true;
    const DIFFUSION: bool = false;
    const FOLLOWS_LIGHT: bool = true;

    type State = State;

    fn channels(&self) -> Vec<Channel> {
        Vec::new()
    }

    fn splats(&self) -> bool {
        false
    }

    /// Photons come from lights that were chosen; one that can only be hit is seen itself, and nothing that it
    /// shines on.
    fn incompatibilities(&self, capabilities: &SceneCapabilities) -> Vec<Incompatibility> {
        let mut incompatibilities = capabilities.incompatibilities(LightSearch::Choosing);
        incompatibilities.extend(capabilities.rows_in_turn());
        incompatibilities
    }

    fn replicate_kind(&self) -> ReplicateKind {
        ReplicateKind::Independent
    }

    fn samples_per_pass(&self) -> Option<u32> {
        None
    }

    fn prepare<W: World>(
        &self,
        world: &W,
        placing: &impl Placing,
        pass: &Pass,
        _: Option<State>,
    ) -> State {
        let sets = WavelengthSets::new(world, pass, self.sets as usize);
        let shot = rounded(self.photons, self.sets);
        let mut photons = shoot(world, placing, &self.settings, &sets, pass, shot);
        let caustic = photons.iter().filter(|p| p.kind == Kind::Caustic);
        let caustic = PhotonMap::new(caustic.copied().collect());
        if !self.final_gather {
            // Other photons of the global map are needed for final gathering only.
            photons.retain(|photon| photon.kind == Kind::Indirect);
        }
        let global = PhotonMap::new(photons);
        let mut limits = [None; 2];
        let maps = [(self.global, &global), (self.caustic, &caustic)];
        let radii = core::array::from_fn(|i| {
            let (estimate, map) = maps[i];
            match (estimate.radius, estimate.nearest) {
                (Some(radius), _) => radius,
                (None, 0) => {
                    let wide = from_pixels(world, pass);
                    let radius = held(world, pass, &map.surfaces.tree, wide);
                    limits[i] = (radius < wide).then_some(wide);
                    radius
                }
                (None, _) => ANYWHERE,
            }
        });
        State {
            time: moment(pass),
            sets,
            caustic,
            global,
            shot,
            radii,
            held: limits,
        }
    }

    fn sample<W: World, S: Sampler, K: Sink>(
        &self,
        world: &W,
        state: &State,
        site: &PixelSample,
        sampler: &mut S,
        sink: &mut K,
    ) {
        self.plan(state, |plan| follow_one(world, plan, site, sampler, sink));
    }

    fn sample_batch<W: World, S: Sampler, K: TileSink>(
        &self,
        world: &W,
        state: &State,
        jobs: Drain<'_, SampleJob<S>>,
        sink: &mut K,
    ) {
        self.plan(state, |plan| follow_all(world, plan, jobs, sink));
    }
}
