//! `moment`: first and second moments of nested integrators.
//!
//! ```text
//! M₁ = 1/n Σᵢ wᵢ cᵢ,   M₂ = 1/n Σᵢ wᵢ cᵢ²
//! ```
//!
//! with cᵢ what the pixel's i-th sample found and wᵢ its weight in the pixel's filter: the sample moments
//! of Pearson 1894. Where all wᵢ are 1, so without negative lobes of the filter, M₂ − M₁² estimates the
//! variance of a single sample less that of the mean. It says how noisy the integrator is, not how large
//! the error of the mean: the samples of a replicate need not be independent.
//!
//! For each nested integrator `NAME`: its own channels, then its colour as CIE XYZ in `NAME.X`,
//! `NAME.Y`, `NAME.Z`, and after all of those the mean of every sample's square in `m2_…`, as
//! Mitsuba names them. The picture is that of the first nested integrator.

use crate::list::Nested;
use etalon_params::Params;
use etalon_sampling::{ReplicateKind, Sampler};
use etalon_spectrum::colour_space::rgb_to_xyz;
use etalon_transport::{
    Channel, Incompatibility, Integrator, Pass, PixelSample, Placing, SceneCapabilities, Sink,
    World, one_by_one,
};
use glam::Vec2;

/// The moment integrator.
#[derive(Clone, Debug)]
pub struct Moment {
    nested: Vec<Nested>,
    first_moments: usize,
}

impl Moment {
    /// Reads the integrator and the integrators nested in it.
    pub fn from_params(params: &Params<'_>) -> Option<Self> {
        let nested = Nested::all(params)?;
        if nested.is_empty() {
            params.error("`moment` needs a nested integrator");
            return None;
        }
        let first_moments = nested.iter().map(|n| n.channels + 3).sum();
        Some(Self {
            nested,
            first_moments,
        })
    }
}

impl Integrator for Moment {
    const UNBIASED: bool = false;
    /// Its nested integrators decide.
    const MEDIA: bool = true;
    const DIFFUSION: bool = true;
    const FOLLOWS_LIGHT: bool = false;

    type State = ();

    fn channels(&self) -> Vec<Channel> {
        let mut names = Vec::new();
        for Nested {
            name, integrator, ..
        } in &self.nested
        {
            for Channel(channel) in integrator.channels() {
                names.push(format!("{name}.{channel}"));
            }
            names.extend(["X", "Y", "Z"].map(|c| format!("{name}.{c}")));
        }
        let squares: Vec<String> = names.iter().map(|n| format!("m2_{n}")).collect();
        names.into_iter().chain(squares).map(Channel).collect()
    }

    fn splats(&self) -> bool {
        false
    }

    /// Those of the integrators inside.
    fn incompatibilities(&self, capabilities: &SceneCapabilities) -> Vec<Incompatibility> {
        Nested::incompatibilities(&self.nested, capabilities)
    }

    fn replicate_kind(&self) -> ReplicateKind {
        Nested::replicate_kind(&self.nested)
    }

    fn samples_per_pass(&self) -> Option<u32> {
        None
    }

    fn prepare<W: World>(&self, _: &W, _: &impl Placing, _: &Pass, _: Option<()>) {}

    fn sample<W: World, S: Sampler, K: Sink>(
        &self,
        world: &W,
        (): &(),
        site: &PixelSample,
        sampler: &mut S,
        sink: &mut K,
    ) {
        let mut base = 0;
        for (index, nested) in self.nested.iter().enumerate() {
            let own = nested.channels;
            let mut squaring = Squaring {
                sink: &mut *sink,
                base,
                squares: self.first_moments,
                colour: base + own,
                picture: index == 0,
            };
            nested
                .integrator
                .sample_nested(world, site, sampler, &mut squaring);
            base += own + 3;
        }
    }

    one_by_one!();
}

/// Passes a nested integrator's findings on, with their squares.
struct Squaring<'a> {
    sink: &'a mut dyn Sink,
    base: usize,
    squares: usize,
    colour: usize,
    picture: bool,
}

impl Squaring<'_> {
    fn both(&mut self, index: usize, value: f32) {
        self.sink.channel(index, value);
        self.sink.channel(index + self.squares, value * value);
    }
}

impl Sink for Squaring<'_> {
    fn radiance(&mut self, rgb: [f32; 3], alpha: f32) {
        if self.picture {
            self.sink.radiance(rgb, alpha);
        }
        for (i, value) in rgb_to_xyz(rgb.map(f64::from)).into_iter().enumerate() {
            self.both(self.colour + i, value as f32);
        }
    }

    fn splat(&mut self, _: Vec2, _: [f32; 3]) {
        unreachable!("integrators that splat are refused when the scene is read");
    }

    fn channel(&mut self, index: usize, value: f32) {
        self.both(self.base + index, value);
    }
}
