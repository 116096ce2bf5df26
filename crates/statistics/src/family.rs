//! Many tests at once: a family that counts its own hypotheses.
//!
//! Of a thousand true hypotheses tested at 1 %, ten are rejected. A [`Family`] keeps the
//! probability of *any* false rejection at α by Holm's procedure (1979), which needs no
//! independence.
//!
//! A hypothesis may be declared before its test has run, so that tests which were never made, or
//! which broke, still count: the size of a family is decided by the plan, not by the outcomes.

/// A p-value must be in [0, 1]; this one is not.
#[derive(Clone, Debug, PartialEq)]
pub struct NotAProbability {
    /// The hypothesis.
    pub name: String,
    /// Its alleged p-value.
    pub value: f64,
}

impl std::fmt::Display for NotAProbability {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "the p-value of {} is {}", self.name, self.value)
    }
}

impl std::error::Error for NotAProbability {}

/// Hypotheses that are decided together.
#[derive(Clone, Debug, PartialEq)]
pub struct Family {
    alpha: f64,
    names: Vec<String>,
    p_values: Vec<f64>,
}

/// What became of one hypothesis.
#[derive(Clone, Debug, PartialEq)]
pub struct Decision {
    /// Its name.
    pub name: String,
    /// Its own p-value.
    pub p_value: f64,
    /// The smallest level at which the family would reject it.
    pub adjusted: f64,
    /// Whether the family rejects it at its level.
    pub rejected: bool,
}

impl Family {
    /// A family whose probability of any false rejection is at most `alpha`; `None` unless
    /// 0 < `alpha` < 1.
    #[must_use]
    pub fn new(alpha: f64) -> Option<Self> {
        (alpha > 0.0 && alpha < 1.0).then(|| Self {
            alpha,
            names: Vec::new(),
            p_values: Vec::new(),
        })
    }

    /// Adds a hypothesis, and returns its index in [`Family::decide`]'s answer.
    ///
    /// # Errors
    /// [`NotAProbability`] for a p-value outside [0, 1], NaN included.
    pub fn push(
        &mut self,
        name: impl Into<String>,
        p_value: f64,
    ) -> Result<usize, NotAProbability> {
        let name = name.into();
        if !(0.0..=1.0).contains(&p_value) {
            return Err(NotAProbability {
                name,
                value: p_value,
            });
        }
        self.names.push(name);
        self.p_values.push(p_value);
        Ok(self.names.len() - 1)
    }

    /// Declares a hypothesis that has not been tested yet, and returns its index. Until
    /// [`Family::record`] gives its p-value it counts with a p-value of 1: it cannot be rejected,
    /// but the others pay for it.
    pub fn declare(&mut self, name: impl Into<String>) -> usize {
        self.names.push(name.into());
        self.p_values.push(1.0);
        self.names.len() - 1
    }

    /// Records the p-value of a declared hypothesis, in place of the last one.
    ///
    /// # Errors
    /// [`NotAProbability`] for a p-value outside [0, 1], NaN included; nothing is changed then.
    ///
    /// # Panics
    /// If no hypothesis has this index.
    pub fn record(&mut self, index: usize, p_value: f64) -> Result<(), NotAProbability> {
        if !(0.0..=1.0).contains(&p_value) {
            return Err(NotAProbability {
                name: self.names[index].clone(),
                value: p_value,
            });
        }
        self.p_values[index] = p_value;
        Ok(())
    }

    /// The level of the whole family.
    #[must_use]
    pub fn alpha(&self) -> f64 {
        self.alpha
    }

    /// The number of hypotheses so far.
    #[must_use]
    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// Whether there are no hypotheses yet.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// The level each member's interval needs for all of them to cover together with
    /// probability 1 − α (Bonferroni): α over the number of hypotheses.
    #[must_use]
    pub fn level_of_each(&self) -> f64 {
        self.alpha / self.names.len().max(1) as f64
    }

    /// Decides every hypothesis by Holm's procedure, in the order they were added.
    #[must_use]
    pub fn decide(&self) -> Vec<Decision> {
        holm(&self.p_values)
            .into_iter()
            .zip(self.names.iter().zip(&self.p_values))
            .map(|(adjusted, (name, &p_value))| Decision {
                name: name.clone(),
                p_value,
                adjusted,
                rejected: adjusted <= self.alpha,
            })
            .collect()
    }
}

/// Holm's (1979) adjusted p-values, in the order given: for m hypotheses with sorted p₍₁₎ ≤ … ≤ p₍ₘ₎,
/// maxⱼ≤ᵢ min(1, (m − j + 1) p₍ⱼ₎). Valid under any dependence.
#[must_use]
pub fn holm(p_values: &[f64]) -> Vec<f64> {
    let mut order: Vec<_> = (0..p_values.len()).collect();
    order.sort_by(|&a, &b| p_values[a].total_cmp(&p_values[b]));
    let mut adjusted = vec![0.0; p_values.len()];
    let mut greatest = 0.0_f64;
    for (rank, &index) in order.iter().enumerate() {
        let remaining = p_values.len() - rank;
        greatest = greatest.max((remaining as f64 * p_values[index]).min(1.0));
        adjusted[index] = greatest;
    }
    adjusted
}
