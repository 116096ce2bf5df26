//! What a question is.

use crate::pose::{Freedom, Pose};
use crate::scene::Scene;
use crate::truth::Picture;

/// A question: a scene whose picture is known.
#[derive(Clone, Copy)]
pub struct Question {
    /// Its name.
    pub name: &'static str,
    /// What is asked, in one line.
    pub title: &'static str,
    /// The formula of its truth.
    pub formula: &'static str,
    /// Who found it: author, year, place.
    pub source: &'static str,
    /// How freely its scene may be posed.
    pub freedom: Freedom,
    /// Samples per pixel of one replicate, such that a good path tracer has a standard error of about 0.3 % in the picture's mean.
    pub samples: u32,
    /// The scene as it is written, and its picture.
    pub ask: fn() -> (Scene, Picture),
}

impl std::fmt::Debug for Question {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Question").field(&self.name).finish()
    }
}

impl Question {
    /// The seed of its pictures number `index`: those of other questions are other numbers, below 2³⁰.
    pub fn seed(&self, index: u32) -> u32 {
        const PICTURES: u32 = 1 << 10;
        let place = (name_hash(self.name) % (1 << 20)) as u32;
        PICTURES * place + index % PICTURES + 1
    }

    /// The scene in pose number `index` of a suite's seed, and its picture, which no pose changes.
    pub fn posed(&self, seed: u64, index: u32) -> (Scene, Picture) {
        let (mut scene, truth) = (self.ask)();
        scene.question = self.name.to_owned();
        let pose = Pose::draw(seed ^ name_hash(self.name), index, self.freedom);
        (scene.posed(&pose), truth)
    }
}

/// A number for a name, so that questions are posed independently.
fn name_hash(name: &str) -> u64 {
    let hash = blake3::hash(name.as_bytes());
    let (eight, _) = hash.as_bytes().split_at(8);
    u64::from_le_bytes(eight.try_into().expect("eight bytes"))
}
