//! Parameters that several integrators share.

use core::num::NonZeroU32;
use etalon_params::{Diagnostic, Params};
use etalon_transport::Ray;

/// Path length limits and the visibility of lights, with Mitsuba's meaning.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathSettings {
    /// Longest path in segments: 1 shows lights only, 2 adds direct light; unlimited is
    /// `u32::MAX`.
    pub max_depth: u32,
    /// The depth at which Russian roulette begins.
    pub rr_depth: u32,
    /// Whether lights are invisible to the camera.
    pub hide_emitters: bool,
}

impl Default for PathSettings {
    fn default() -> Self {
        Self {
            max_depth: u32::MAX,
            rr_depth: 5,
            hide_emitters: false,
        }
    }
}

impl PathSettings {
    /// Reads `max_depth`, `rr_depth` and `hide_emitters`.
    pub fn from_params(params: &Params<'_>) -> Self {
        let rr_depth = params.integer_or("rr_depth", 5);
        if rr_depth < 1 || rr_depth > i64::from(i32::MAX) {
            params.refuse("rr_depth", rr_depth, "1, 2, …");
        }
        Self {
            max_depth: read_max_depth(params),
            rr_depth: u32::try_from(rr_depth).unwrap_or(5),
            hide_emitters: params.boolean_or("hide_emitters", false),
        }
    }

    /// Whether lights are looked through along a path's segment number `depth`: they are hidden from the camera ray.
    #[inline]
    pub(crate) fn sees_through_lights(&self, depth: u32) -> bool {
        depth == 1 && self.hide_emitters
    }

    /// Whether a path sees lights at infinity. Hidden ones stay hidden behind null surfaces, until something scatters the path or
    /// is opaque to it (`alpha` > 0).
    #[inline]
    pub(crate) fn sees_background(&self, alpha: f32) -> bool {
        !self.hide_emitters || alpha > 0.0
    }
}

/// The configuration of path tracing, the same for all paths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PathConfig {
    pub(crate) limits: PathSettings,
    /// Number of light samples that are resampled for a shadow ray, before the path has scattered at random.
    pub(crate) candidates: LightCandidates,
    /// Whether passing straight through a surface makes a path longer: so count Mitsuba's `path`, and not its
    /// `volpath`.
    pub(crate) counts_null: bool,
    /// Whether light is looked for along flights through media, see [`crate::path::equiangular`].
    pub(crate) equiangular: bool,
    /// Whether alpha says if the camera sees any surface, as Mitsuba's `direct` has it.
    pub(crate) alpha_of_surfaces: bool,
}

impl PathConfig {
    /// One light sample for a shadow ray, and every segment counts.
    pub(crate) const fn plain(limits: PathSettings) -> Self {
        Self {
            limits,
            candidates: LightCandidates::ONE,
            counts_null: true,
            equiangular: false,
            alpha_of_surfaces: false,
        }
    }

    /// The camera's ray, if a path may have a segment at all.
    #[inline]
    pub(crate) fn first_segment(&self, camera_ray: Ray) -> Option<Ray> {
        (self.limits.max_depth > 0).then_some(camera_ray)
    }

    /// The most null surfaces that a shadow ray may cross from a path of `depth` segments.
    #[inline]
    pub(crate) fn null_crossings(&self, depth: u32) -> u32 {
        if self.counts_null {
            self.limits.max_depth - depth - 1
        } else {
            u32::MAX
        }
    }
}

/// Number of light samples that are resampled for a shadow ray; `None` lets the lights decide.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LightCandidates(pub Option<NonZeroU32>);

impl LightCandidates {
    /// One: each light sample gets its shadow ray.
    pub const ONE: Self = Self(Some(NonZeroU32::MIN));

    /// The most that may.
    const MOST: u32 = 64;

    /// Reads `light_candidates`.
    pub fn from_params(params: &Params<'_>) -> Self {
        const NAME: &str = "light_candidates";
        let Some(value) = params.integer(NAME) else {
            return Self(None);
        };
        let count = u32::try_from(value).ok().filter(|n| *n <= Self::MOST);
        let count = count.and_then(NonZeroU32::new);
        if count.is_none() {
            params.refuse(NAME, value, "1, 2, … 64");
        }
        Self(count)
    }
}

/// Reads `max_depth`: the longest path in segments, or −1 for unlimited.
pub(crate) fn read_max_depth(params: &Params<'_>) -> u32 {
    let max_depth = params.integer_or("max_depth", -1);
    if max_depth < -1 || max_depth > i64::from(i32::MAX) {
        params.refuse("max_depth", max_depth, "-1 (unlimited), 0, 1, 2, …");
    }
    if max_depth == 0 {
        let diagnostic = Diagnostic::note(
            params
                .property("max_depth")
                .map_or(params.node.plugin.span, |p| p.span),
            "no path has 0 segments: the picture will be black",
        );
        params.diagnostics.push(diagnostic);
    }
    u32::try_from(max_depth).unwrap_or(u32::MAX)
}
