//! Critical values of a test that is repeated as data accrue.
//!
//! With information I₁ < I₂ < … the statistics Zₖ √Iₖ have independent increments N(θΔ, Δ), Δ =
//! Iₖ − Iₖ₋₁. The density of Zₖ among the runs that have not stopped follows by the recursion of
//! Armitage, McPherson & Rowe (1969),
//!
//! gₖ(z) = ∫_{−cₖ₋₁}^{cₖ₋₁} gₖ₋₁(u) φ((z√Iₖ − u√Iₖ₋₁ − θΔ)/√Δ) √(Iₖ/Δ) du,
//!
//! here on Gauss–Legendre panels. The probability of stopping at look k is the same integral with
//! the normal tails beyond ±cₖ in place of φ: all terms positive, so levels of 10⁻⁹ keep their
//! digits. Boundaries solve it for what the spending function grants the look (Lan & DeMets
//! 1983; Jennison & Turnbull 2000, chapters 7 and 19).

use crate::normal;
use crate::quadrature::nodes;
use crate::spending::Spending;
use std::f64::consts::PI;

/// Beyond this many standard deviations from its mean a statistic is not followed: 10⁻²³.
const REACH: f64 = 10.0;

/// Looks must be at least this far apart, as a share of the information.
pub const LEAST_STEP: f64 = 1e-3;

/// Why a look is refused.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LookError {
    /// The information did not grow by [`LEAST_STEP`] since the last look, exceeds the plan, or
    /// is not a number.
    BadInformation {
        /// At the last look; 0 before the first.
        previous: f64,
        /// At the refused look.
        information: f64,
    },
}

impl std::fmt::Display for LookError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::BadInformation {
                previous,
                information,
            } => write!(
                f,
                "a look at {information} of the planned information must come after {previous}, \
                 by at least {LEAST_STEP}, and not beyond 1"
            ),
        }
    }
}

impl std::error::Error for LookError {}

/// What a look may use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound {
    /// The share of the planned information.
    pub information: f64,
    /// The critical value of |Z|; infinite where nothing is to be spent.
    pub critical: f64,
    /// The two-sided level of that critical value alone, 2 Φ̄(c).
    pub nominal: f64,
    /// What this look adds to what has been spent: a level that single looks may use under any
    /// dependence between them.
    pub granted: f64,
    /// What has been spent of α, this look included.
    pub spent: f64,
}

/// The looks of one claim, made as they come.
#[derive(Clone, Debug, PartialEq)]
pub struct Boundaries {
    alpha: f64,
    spending: Spending,
    bounds: Vec<Bound>,
    recursion: Recursion,
}

impl Boundaries {
    /// Of a two-sided level `alpha`, spent by `spending`; `None` unless 0 < `alpha` < 1 and the
    /// function is valid.
    #[must_use]
    pub fn new(alpha: f64, spending: Spending) -> Option<Self> {
        (alpha > 0.0 && alpha < 1.0 && spending.is_valid()).then(|| Self {
            alpha,
            spending,
            bounds: Vec::new(),
            recursion: Recursion::new(0.0),
        })
    }

    /// The level to be spent by the end.
    #[must_use]
    pub fn alpha(&self) -> f64 {
        self.alpha
    }

    /// The looks made.
    #[must_use]
    pub fn looks(&self) -> &[Bound] {
        &self.bounds
    }

    /// The critical value of the next look, at this share of the planned information. When the
    /// looks happen may depend on anything but the data themselves.
    ///
    /// # Errors
    /// [`LookError::BadInformation`]; nothing is spent then.
    pub fn look(&mut self, information: f64) -> Result<Bound, LookError> {
        let previous = self.bounds.last().map_or(0.0, |bound| bound.information);
        if !(information >= previous + LEAST_STEP && information <= 1.0) {
            return Err(LookError::BadInformation {
                previous,
                information,
            });
        }
        let before = self.bounds.last().map_or(0.0, |bound| bound.spent);
        let spent = self.spending.spent(self.alpha, information).max(before);
        self.recursion.advance(information);
        let critical = self.recursion.critical(spent - before);
        self.recursion.stop_beyond(critical);
        let bound = Bound {
            information,
            critical,
            nominal: 2.0 * normal::sf(critical),
            granted: spent - before,
            spent,
        };
        self.bounds.push(bound);
        Ok(bound)
    }
}

/// The probability of stopping at each of the looks, for |Zₖ| beyond `critical[k]`, where Zₖ has
/// mean `drift` · √(information); `None` unless there is one critical value for each look and the
/// information is positive and increases.
#[must_use]
pub fn stopping(information: &[f64], critical: &[f64], drift: f64) -> Option<Vec<f64>> {
    let increasing = information.first().is_some_and(|&first| first > 0.0)
        && information.windows(2).all(|pair| pair[0] < pair[1]);
    let sensible = critical.iter().all(|c| *c >= 0.0) && drift.is_finite();
    if !increasing || !sensible || information.len() != critical.len() {
        return None;
    }
    let mut recursion = Recursion::new(drift);
    let mut probabilities = Vec::with_capacity(critical.len());
    for (&at, &c) in information.iter().zip(critical) {
        recursion.advance(at);
        probabilities.push(recursion.beyond(c));
        recursion.stop_beyond(c);
    }
    Some(probabilities)
}

/// The state of the recursion at a look.
#[derive(Clone, Debug, PartialEq)]
struct Recursion {
    drift: f64,
    /// The information of the look before and of this one.
    before: f64,
    now: f64,
    /// Quadrature points of the look before: z and its mass.
    points: Vec<(f64, f64)>,
    /// The critical value of this look, once decided.
    stop: f64,
}

impl Recursion {
    fn new(drift: f64) -> Self {
        Self {
            drift,
            before: 0.0,
            now: 0.0,
            points: Vec::new(),
            stop: f64::INFINITY,
        }
    }

    /// Advances to the next look: the density of this one, cut at its critical value, is put on
    /// panels that are fine enough for the next step.
    fn advance(&mut self, next: f64) {
        if self.now > 0.0 {
            let mean = self.drift * self.now.sqrt();
            let (low, high) = ((-self.stop).max(mean - REACH), self.stop.min(mean + REACH));
            let narrowest = ((next - self.now).min(self.now - self.before) / self.now)
                .sqrt()
                .min(1.0);
            let panels = ((high - low) / (2.5 * narrowest)).ceil().max(1.0) as usize;
            self.points = if high > low {
                nodes(low, high, panels)
                    .map(|(z, weight)| (z, weight * self.density(z)))
                    .collect()
            } else {
                Vec::new()
            };
        }
        self.before = self.now;
        self.now = next;
        self.stop = f64::INFINITY;
    }

    fn stop_beyond(&mut self, critical: f64) {
        self.stop = critical;
    }

    /// Where the increment must end, in its standard deviations, for Z to be `z` from `u`.
    fn increment(&self, z: f64, u: f64) -> f64 {
        let step = self.now - self.before;
        (z * self.now.sqrt() - u * self.before.sqrt() - self.drift * step) / step.sqrt()
    }

    /// The density of Z at this look among runs that did not stop before.
    fn density(&self, z: f64) -> f64 {
        let normal = |x: f64| libm::exp(-0.5 * x * x) / (2.0 * PI).sqrt();
        if self.before == 0.0 {
            return normal(self.increment(z, 0.0));
        }
        let sum: f64 = self
            .points
            .iter()
            .map(|&(u, mass)| mass * normal(self.increment(z, u)))
            .sum();
        sum * (self.now / (self.now - self.before)).sqrt()
    }

    /// The probability of |Z| > `c` at this look, not having stopped before.
    fn beyond(&self, c: f64) -> f64 {
        let tails = |u: f64| normal::sf(self.increment(c, u)) + normal::sf(-self.increment(-c, u));
        if self.before == 0.0 {
            return tails(0.0);
        }
        self.points.iter().map(|&(u, mass)| mass * tails(u)).sum()
    }

    /// The c at which |Z| > c has this probability, to thirteen digits.
    fn critical(&self, probability: f64) -> f64 {
        if !(probability > 0.0) {
            return f64::INFINITY;
        }
        let (mut low, mut high) = (0.0, 1.0);
        while self.beyond(high) > probability {
            low = high;
            high *= 2.0;
        }
        while high - low > 1e-13 * high {
            let middle = 0.5 * (low + high);
            if self.beyond(middle) > probability {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }
}
