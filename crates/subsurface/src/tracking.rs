//! Free flight and transmittance: tentative collisions, closed forms, fixed steps.
//!
//! A homogeneous medium is flown through in closed form: t from the density σt T(t). Any other by delta tracking
//! (E. Woodcock et al. 1965): tentative collisions come with a majorant σ̄ ≥ σt, constant along stretches of the ray; one is
//! real with the probability σt/σ̄, and null otherwise. Lane 0 of the wavelengths chooses both. Transmittance is estimated
//! by ratio tracking (J. Novák, A. Selle, W. Jarosz 2014): the same
//! tentative collisions, all of them null. Residual tracking leaves the density of a control μ̄ ≤ σt, or any other, to the closed
//! form: collisions come with σ̄ − μ̄ in place of σ̄. See [`Tracking`].

use crate::majorants::{MajorantSegment, Segments};
use etalon_math::float;
use etalon_sampling::Sampler;
use etalon_transport::{Coefficients, Collision, FreeFlight, Phase, Ray, Transmission};
use glam::{Vec3, Vec4};

/// How a medium is travelled through.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Tracking {
    /// In closed form: it is the same everywhere.
    Closed,
    /// By tentative collisions with all of the majorant: delta tracking, and ratio tracking of transmittance.
    #[default]
    Ratio,
    /// The same, where transmittance is all or nothing: a tentative collision that is real for every lane ends the way (Woodcock et al. 1965).
    Delta,
    /// The same, where transmittance follows from tentative collisions with what exceeds a control density, and from that itself
    /// in closed form (residual ratio tracking, Novák et al. 2014).
    Residual,
    /// In fixed steps (m), each as dense as its middle: biased.
    RayMarching(f32),
}

/// A medium as tracking asks it; see [`etalon_transport::Medium`] for what is not told here.
pub(crate) trait Tracked {
    type Phase: Phase + Copy;

    fn coefficients(&self, at: Vec3, direction: Vec3) -> Coefficients;

    fn phase(&self, at: Vec3) -> Self::Phase;

    fn emission(&self, at: Vec3, direction: Vec3) -> Vec4;

    /// The stretches that cover `ray` up to `t_max`.
    fn majorants(&self, ray: &Ray, t_max: f32) -> Segments<'_>;

    /// How it is travelled through.
    fn tracking(&self) -> Tracking;
}

/// See [`etalon_transport::Medium::free_flight`].
pub(crate) fn free_flight<M: Tracked>(
    medium: &M,
    ray: &Ray,
    t_max: f32,
    u: f32,
    stream: &mut impl Sampler,
) -> FreeFlight<M::Phase> {
    match medium.tracking() {
        Tracking::Closed => return closed(medium, ray, t_max, u),
        Tracking::RayMarching(step) => return marched(medium, ray, t_max, step, u),
        Tracking::Ratio | Tracking::Delta | Tracking::Residual => {}
    }
    let mut flight = FreeFlight {
        factor: Vec4::ONE,
        emitted: Vec4::ZERO,
        passed: Vec4::ONE,
        scattering: None,
    };
    let mut collisions = Collisions::new(medium.majorants(ray, t_max), t_max, u, false);
    while let Some(MajorantSegment {
        end: t,
        majorant,
        control,
    }) = collisions.next()
    {
        let at = ray.at(t);
        let coefficients = medium.coefficients(at, ray.direction);
        let extinction = coefficients.extinction();
        if stream.next_1d() * majorant < extinction.x {
            let passed = passing_control(collisions.controlled);
            flight.passed *= passed;
            flight.factor *= passed;
            flight.emitted = flight.factor * medium.emission(at, ray.direction);
            flight.factor *= coefficients.scattering;
            flight.scattering = Some(Collision {
                t,
                extinction,
                phase: medium.phase(at),
            });
            return flight;
        }
        let null = null_ratio(extinction, majorant, control);
        flight.factor *= null;
        flight.passed *= null;
        collisions.go_on(stream.next_1d());
    }
    let passed = passing_control(collisions.controlled);
    flight.passed *= passed;
    flight.factor *= passed;
    flight
}

/// See [`etalon_transport::Medium::reach`].
#[inline]
pub(crate) fn reach(medium: &impl Tracked, ray: &Ray, u: f32) -> Option<f32> {
    (medium.tracking() == Tracking::Closed).then(|| {
        let coefficients = medium.coefficients(ray.origin, ray.direction);
        length(coefficients.extinction(), u)
    })
}

/// See [`etalon_transport::Medium::transmittance`].
pub(crate) fn transmittance(
    medium: &impl Tracked,
    ray: &Ray,
    t_max: f32,
    stream: &mut impl Sampler,
) -> Transmission {
    let closed = match medium.tracking() {
        Tracking::Closed => {
            let extinction = medium.coefficients(ray.origin, ray.direction).extinction();
            Some(passing(extinction, t_max))
        }
        Tracking::RayMarching(step) => Some(march(medium, ray, t_max, step)),
        Tracking::Ratio | Tracking::Delta | Tracking::Residual => None,
    };
    if let Some(transmittance) = closed {
        return Transmission {
            transmittance,
            probability: transmittance,
        };
    }
    let all_or_nothing = medium.tracking() == Tracking::Delta;
    let mut ratio = Vec4::ONE;
    // What passes in the mean of those that go on.
    let mut kept = 1.0;
    let majorants = medium.majorants(ray, t_max);
    let mut collisions = Collisions::new(majorants, t_max, stream.next_1d(), true);
    while let Some(MajorantSegment {
        end: t,
        majorant,
        control,
    }) = collisions.next()
    {
        let extinction = medium.coefficients(ray.at(t), ray.direction).extinction();
        let null = null_ratio(extinction, majorant, control);
        ratio *= null;
        if all_or_nothing {
            // By the lane that is attenuated least, so that no lane is lost.
            let most = null.max_element();
            if stream.next_1d() >= most {
                ratio = Vec4::ZERO;
            } else {
                kept *= most;
            }
        }
        if ratio == Vec4::ZERO {
            break;
        }
        collisions.go_on(stream.next_1d());
    }
    ratio *= passing_control(collisions.controlled);
    Transmission {
        transmittance: ratio / kept,
        probability: ratio,
    }
}

/// No flight makes more tentative collisions, or steps: one in a medium without end has to end.
const MOST_COLLISIONS: u32 = 1 << 20;

/// Tentative collisions along a ray, whose optical depth by the majorants is exponentially distributed.
struct Collisions<I> {
    segments: I,
    segment: MajorantSegment,
    t_max: f32,
    /// Whether they come with what exceeds the control only.
    residual: bool,
    /// Where the last one was (m).
    t: f32,
    /// The optical depth to the next one.
    depth: f32,
    /// The optical depth of the control up to there.
    controlled: f32,
    /// How many more there may be.
    left: u32,
}

impl<I: Iterator<Item = MajorantSegment>> Collisions<I> {
    /// With the number `u` in [0, 1) for the first.
    #[inline]
    fn new(segments: I, t_max: f32, u: f32, residual: bool) -> Self {
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
    fn go_on(&mut self, u: f32) {
        self.depth = -float::ln(1.0 - u);
    }

    /// Goes on to `t`.
    #[inline]
    fn advance(&mut self, t: f32, control: f32) {
        if control > 0.0 {
            self.controlled += (t - self.t) * control;
        }
        self.t = t;
    }

    /// The next one, as the stretch that ends there; `None` if there is none before the ray's end.
    #[inline]
    fn next(&mut self) -> Option<MajorantSegment> {
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

/// What a null collision leaves of the light, per lane.
#[inline]
fn null_ratio(extinction: Vec4, majorant: f32, control: f32) -> Vec4 {
    let beyond = extinction - Vec4::splat(control);
    (Vec4::ONE - beyond / (majorant - control)).max(Vec4::ZERO)
}

/// What the control leaves of the light.
#[inline]
fn passing_control(depth: f32) -> f32 {
    if depth > 0.0 { float::exp(-depth) } else { 1.0 }
}

/// T of an optical depth, per lane.
#[inline]
fn attenuated(depth: Vec4) -> Vec4 {
    float::exp4(-depth)
}

/// T over a distance, per lane.
#[inline]
fn passing(extinction: Vec4, t: f32) -> Vec4 {
    // An endless way through nothing is free.
    attenuated(extinction * t.min(f32::MAX))
}

/// A flight to `end`: where light is scattered by the coefficients at hand, or where the ray ends.
#[inline]
fn flown<M: Tracked>(
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

/// How far lane 0 flies in closed form if nothing ends the ray before.
#[inline]
fn length(extinction: Vec4, u: f32) -> f32 {
    -float::ln(1.0 - u) / extinction.x
}

/// A flight in closed form, through a medium that is the same everywhere.
#[inline]
fn closed<M: Tracked>(medium: &M, ray: &Ray, t_max: f32, u: f32) -> FreeFlight<M::Phase> {
    let coefficients = medium.coefficients(ray.origin, ray.direction);
    let extinction = coefficients.extinction();
    let t = length(extinction, u);
    // False where lane 0 is not attenuated, and for NaN.
    let end = (t < t_max).then_some((t, coefficients));
    let way = if end.is_some() { t } else { t_max };
    flown(medium, ray, passing(extinction, way), end)
}

/// Fixed steps along a ray: the optical depth up to where it ends, which is where that of lane 0 reaches `depth` if it does; with
/// the coefficients there.
fn steps<M: Tracked>(
    medium: &M,
    ray: &Ray,
    t_max: f32,
    step: f32,
    depth: f32,
) -> (Vec4, Option<(f32, Coefficients)>) {
    // From where there is something to where there is nothing more.
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
        // The light of a beam that has come to this depth is not to be seen.
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
fn marched<M: Tracked>(
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
pub(crate) fn march<M: Tracked>(medium: &M, ray: &Ray, t_max: f32, step: f32) -> Vec4 {
    attenuated(steps(medium, ray, t_max, step, f32::INFINITY).0)
}
