//! Many tests at once: a family that counts its own hypotheses.
//!
//! Of a thousand true hypotheses tested at 1 %, ten are rejected. A [`Family`] keeps the
//! probability of *any* false rejection at α by Holm's procedure (1979), which needs no
//! independence: sorted p₍₁₎ ≤ … ≤ p₍ₘ₎, the adjusted p-value is
//! max over j ≤ i of min(1, (m − j + 1) · p₍ⱼ₎).

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

    /// Decides every hypothesis, in the order they were added.
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

/// Holm's adjusted p-values, in the order given. Valid under any dependence.
#[must_use]
pub fn holm(p_values: &[f64]) -> Vec<f64> {
    let order = ascending(p_values);
    let mut adjusted = vec![0.0; p_values.len()];
    let mut greatest = 0.0_f64;
    for (rank, &index) in order.iter().enumerate() {
        let remaining = (p_values.len() - rank) as f64;
        greatest = greatest.max((remaining * p_values[index]).min(1.0));
        adjusted[index] = greatest;
    }
    adjusted
}

/// Benjamini and Hochberg's (1995) adjusted p-values, in the order given: rejecting those at
/// most q keeps the expected share of false rejections at q. Needs independence or positive
/// dependence; meant for exploration, never for a verdict.
#[must_use]
pub fn benjamini_hochberg(p_values: &[f64]) -> Vec<f64> {
    let order = ascending(p_values);
    let count = p_values.len() as f64;
    let mut adjusted = vec![0.0; p_values.len()];
    let mut least = 1.0_f64;
    for (rank, &index) in order.iter().enumerate().rev() {
        least = least.min(p_values[index] * count / (rank + 1) as f64);
        adjusted[index] = least;
    }
    adjusted
}

/// The probability that the smallest of `count` independent p-values is at most `p` (Šidák
/// 1967): 1 − (1 − p)^count. Needs independence, so not for tiles of one image.
#[must_use]
pub fn sidak(p: f64, count: usize) -> f64 {
    -libm::expm1(count as f64 * libm::log1p(-p))
}

/// The level at which to test each of `count` independent hypotheses for `alpha` together.
#[must_use]
pub fn sidak_level(alpha: f64, count: usize) -> f64 {
    -libm::expm1(libm::log1p(-alpha) / count.max(1) as f64)
}

/// The indices of the p-values from the smallest to the greatest.
fn ascending(p_values: &[f64]) -> Vec<usize> {
    let mut order: Vec<_> = (0..p_values.len()).collect();
    order.sort_by(|&a, &b| p_values[a].total_cmp(&p_values[b]));
    order
}
