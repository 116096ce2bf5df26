//! Free flight and transmittance: tentative collisions, closed forms, ray marching.

use crate::{Coefficients, Collision, FreeFlight, MajorantSegment, Medium, Ray};
use etalon_math::float;
use glam::Vec4;

/// Limit on tentative collisions or steps of one flight, for media without bounds.
const MOST_COLLISIONS: u32 = 1 << 20;

/// Tentative collisions along a ray, whose optical depth by the majorants is exponentially distributed.
pub(crate) struct Collisions<I> {
    segments: I,
    segment: MajorantSegment,
    t_max: f32,
    /// Whether the rate of collisions is σ̄ − μ̄ (residual tracking) instead of σ̄.
    residual: bool,
    /// Position of the last one (m).
    t: f32,
    /// The optical depth to the next one.
    depth: f32,
    /// The optical depth of the control up to there.
    pub(crate) controlled: f32,
    /// Remaining number of collisions.
    left: u32,
}

impl<I: Iterator<Item = MajorantSegment>> Collisions<I> {
    /// With the number `u` in [0, 1) for the first.
    #[inline]
    pub(crate) fn new(segments: I, t_max: f32, u: f32, residual: bool) -> Self {
        Self {
            segments,
            segment: MajorantSegment {
                end: 0.0,
                majorant: 0.0,
                control: 0.0,
            },
            t_max,
            residual,
            t: 0.0,
            depth: -float::ln(1.0 - u),
            controlled: 0.0,
            left: MOST_COLLISIONS,
        }
    }

    /// Chooses the optical depth to the next one with `u`.
    #[inline]
    pub(crate) fn go_on(&mut self, u: f32) {
        self.depth = -float::ln(1.0 - u);
    }

    /// Advances to `t`, through a stretch with this control density.
    #[inline]
    fn advance(&mut self, t: f32, control: f32) {
        if control > 0.0 {
            self.controlled += (t - self.t) * control;
        }
        self.t = t;
    }

    /// The next one, as the stretch that ends there; `None` if there is none before the ray's end.
    #[inline]
    pub(crate) fn next(&mut self) -> Option<MajorantSegment> {
        self.left = self.left.checked_sub(1)?;
        loop {
            let MajorantSegment {
                end,
                majorant,
                control,
            } = self.segment;
            let end = end.min(self.t_max).max(self.t);
            let rate = if self.residual {
                majorant - control
            } else {
                majorant
            };
            if rate > 0.0 {
                let t = self.t + self.depth / rate;
                if t < end {
                    self.advance(t, control);
                    return Some(MajorantSegment {
                        end: t,
                        majorant,
                        control,
                    });
                }
                self.depth = (self.depth - (end - self.t) * rate).max(0.0);
            }
            self.advance(end, control);
            self.segment = self.segments.next()?;
        }
    }
}

/// Weight of a null collision, per lane: (σ̄ − σt) / (σ̄ − μ̄).
#[inline]
pub(crate) fn ratio(extinction: Vec4, majorant: f32, control: f32) -> Vec4 {
    let beyond = extinction - Vec4::splat(control);
    (Vec4::ONE - beyond / (majorant - control)).max(Vec4::ZERO)
}

/// Transmittance of the control, of this optical depth.
#[inline]
pub(crate) fn passing_control(depth: f32) -> f32 {
    if depth > 0.0 { float::exp(-depth) } else { 1.0 }
}

/// T of an optical depth, per lane.
#[inline]
fn attenuated(depth: Vec4) -> Vec4 {
    float::exp4(-depth)
}

/// T over a distance, per lane.
#[inline]
pub(crate) fn passing(extinction: Vec4, t: f32) -> Vec4 {
    // 0 · ∞ is no attenuation.
    attenuated(extinction * t.min(f32::MAX))
}

/// A flight to `end`, where light is scattered with the given coefficients, or where the ray ends.
#[inline]
fn flown<M: Medium + ?Sized>(
    medium: &M,
    ray: &Ray,
    passed: Vec4,
    end: Option<(f32, Coefficients)>,
) -> FreeFlight<M::Phase> {
    let Some((t, coefficients)) = end else {
        return FreeFlight {
            factor: passed,
            emitted: Vec4::ZERO,
            passed,
            scattering: None,
        };
    };
    FreeFlight {
        factor: passed * coefficients.scattering,
        emitted: passed * medium.emission(ray.at(t), ray.direction),
        passed,
        scattering: Some(Collision {
            t,
            extinction: coefficients.extinction(),
            phase: medium.phase(ray.at(t)),
        }),
    }
}

/// Length of lane 0's free flight in closed form, along an unbounded ray.
#[inline]
pub(crate) fn reach(extinction: Vec4, u: f32) -> f32 {
    -float::ln(1.0 - u) / extinction.x
}

/// A flight in closed form, through a medium that is the same everywhere.
#[inline]
pub(crate) fn closed<M: Medium + ?Sized>(
    medium: &M,
    ray: &Ray,
    t_max: f32,
    u: f32,
) -> FreeFlight<M::Phase> {
    let coefficients = medium.coefficients(ray.origin, ray.direction);
    let extinction = coefficients.extinction();
    let t = reach(extinction, u);
    // False where lane 0 is not attenuated, and for NaN.
    let end = (t < t_max).then_some((t, coefficients));
    let way = if end.is_some() { t } else { t_max };
    flown(medium, ray, passing(extinction, way), end)
}

/// Fixed steps along a ray: the optical depth up to where it ends, which is where that of lane 0 reaches `depth` if it does; with
/// the coefficients there.
fn steps<M: Medium + ?Sized>(
    medium: &M,
    ray: &Ray,
    t_max: f32,
    step: f32,
    depth: f32,
) -> (Vec4, Option<(f32, Coefficients)>) {
    // From the first stretch with a density to the last.
    let (mut t, mut from, mut to) = (0.0_f32, f32::INFINITY, 0.0);
    for segment in medium.majorants(ray, t_max) {
        if segment.majorant > 0.0 {
            from = t.min(from);
            to = segment.end.min(t_max);
        }
        t = segment.end;
    }
    let (mut begin, mut passed, mut left) = (from, Vec4::ZERO, depth);
    for _ in 0..MOST_COLLISIONS {
        // Light attenuated this much is invisible.
        if !(begin < to) || passed.min_element() > 80.0 {
            break;
        }
        let end = (begin + step).min(to);
        let coefficients = medium.coefficients(ray.at(0.5 * (begin + end)), ray.direction);
        let extinction = coefficients.extinction();
        let through = extinction * (end - begin);
        if through.x > left {
            let t = begin + left / extinction.x;
            return (passed + extinction * (t - begin), Some((t, coefficients)));
        }
        left -= through.x;
        passed += through;
        begin = end;
    }
    (passed, None)
}

/// A flight in fixed steps.
#[inline]
pub(crate) fn marched<M: Medium + ?Sized>(
    medium: &M,
    ray: &Ray,
    t_max: f32,
    step: f32,
    u: f32,
) -> FreeFlight<M::Phase> {
    let (depth, end) = steps(medium, ray, t_max, step, -float::ln(1.0 - u));
    flown(medium, ray, attenuated(depth), end)
}

/// Transmittance in fixed steps (m) through a medium, per lane.
pub fn march<M: Medium + ?Sized>(medium: &M, ray: &Ray, t_max: f32, step: f32) -> Vec4 {
    attenuated(steps(medium, ray, t_max, step, f32::INFINITY).0)
}
