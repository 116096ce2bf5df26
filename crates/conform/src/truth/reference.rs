//! Pictures of scenes that have no closed form: by two unbiased estimators of Etalon that agree, path tracing and bidirectional path
//! tracing, put together by the inverse of their variances.
//!
//! `cargo xtask conform-references` renders them and writes `references.json`.

use super::Picture;
use crate::scene::Scene;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// All of them, by the names of their questions.
pub type References = BTreeMap<String, Reference>;

/// The picture of a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reference {
    /// [`fingerprint`] of the scene.
    pub scene: String,
    /// What it is made of.
    pub estimates: Vec<Estimate>,
    /// The mean of each pixel, row by row, the top row first.
    pub means: Vec<f64>,
}

/// What one estimator found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Estimate {
    /// Etalon's integrator.
    pub integrator: String,
    /// Pictures with seeds of their own.
    pub pictures: u32,
    /// Samples per pixel of each.
    pub samples: u32,
    /// The mean of all pixels.
    pub mean: f64,
    /// Its standard error, from the spread of the pictures.
    pub standard_error: f64,
}

impl Estimate {
    /// Its weight among others.
    pub fn weight(&self) -> f64 {
        1.0 / (self.standard_error * self.standard_error)
    }
}

impl Reference {
    /// The standard error of its mean, as a share of it.
    pub fn error(&self) -> f64 {
        let weights: f64 = self.estimates.iter().map(Estimate::weight).sum();
        let mean = self.means.iter().sum::<f64>() / self.means.len() as f64;
        1.0 / (weights.sqrt() * mean)
    }
}

/// Those that were made.
pub static ALL: LazyLock<References> = LazyLock::new(|| {
    serde_json::from_str(include_str!("references.json")).expect("references.json is JSON")
});

/// Twelve hexadecimal digits that change when the scene does, whatever question it poses.
pub fn fingerprint(scene: &Scene) -> String {
    let scene = Scene {
        question: String::new(),
        ..scene.clone()
    };
    blake3::hash(scene.to_json().as_bytes()).to_hex()[..12].to_owned()
}

/// The reference of a question; not a number where it is still to be made.
pub fn picture(question: &str, pixels: u32) -> Picture {
    match ALL.get(question) {
        Some(reference) => Picture {
            error: reference.error(),
            ..Picture::exact(pixels, reference.means.clone())
        },
        None => Picture {
            error: f64::NAN,
            ..Picture::even(pixels, f64::NAN)
        },
    }
}

#[cfg(test)]
mod tests {
    use super::{ALL, fingerprint};
    use crate::questions;

    /// Of each question that has one there is a reference of its present scene, whose mean is known to 0.03 %, and whose estimators are
    /// no farther from each other than 4 standard errors (6·10⁻⁵ of right ones are).
    #[test]
    fn references_are_of_their_scenes() {
        let mut count = 0;
        for question in questions::ALL {
            let (scene, truth) = (question.ask)();
            if truth.error == 0.0 {
                continue;
            }
            let reference = ALL
                .get(question.name)
                .unwrap_or_else(|| panic!("{}: run cargo xtask conform-references", question.name));
            assert_eq!(reference.scene, fingerprint(&scene), "{}", question.name);
            assert!(truth.error < 3e-4, "{}: {}", question.name, truth.error);
            let [a, b] = &reference.estimates[..] else {
                panic!("{}: two estimators", question.name);
            };
            let apart = (a.mean - b.mean).abs();
            let error = (a.standard_error.powi(2) + b.standard_error.powi(2)).sqrt();
            assert!(apart < 4.0 * error, "{}: {apart} {error}", question.name);
            count += 1;
        }
        assert_eq!(count, ALL.len(), "a reference has no question");
    }
}
