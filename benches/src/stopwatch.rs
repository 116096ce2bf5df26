//! Rays per second of several contenders, by turns, so that a busy machine disturbs all of them alike.

use crate::contender::Contender;
use crate::rays::Kind;
use etalon_transport::Ray;
use rayon::prelude::*;
use std::time::Instant;

/// Millions of rays per second.
#[derive(Clone, Copy, Debug)]
pub struct Rate {
    /// On one thread.
    pub one: f64,
    /// On all.
    pub all: f64,
}

/// Counts hits, so that no work can be left out.
fn hits(contender: &impl Contender, kind: Kind, rays: &[Ray]) -> usize {
    let hit = |ray: &&Ray| match kind {
        Kind::Shadow => contender.occluded(ray),
        _ => contender.nearest(ray) < f32::INFINITY,
    };
    rays.iter().filter(hit).count()
}

/// A stopwatch on rays of one kind: the best times so far.
#[derive(Clone, Copy, Debug)]
pub struct Stopwatch {
    rays: usize,
    best: [f64; 2],
    /// Rays that hit something.
    pub hits: usize,
}

impl Stopwatch {
    /// Nothing measured yet.
    pub fn new() -> Self {
        Self {
            rays: 0,
            best: [f64::INFINITY; 2],
            hits: 0,
        }
    }

    /// Traces all rays once on one thread and once on all.
    pub fn run(&mut self, contender: &impl Contender, kind: Kind, rays: &[Ray]) {
        self.rays = rays.len();
        let start = Instant::now();
        self.hits = hits(contender, kind, rays);
        self.best[0] = self.best[0].min(start.elapsed().as_secs_f64());
        let start = Instant::now();
        let parts = rays.par_chunks(1024);
        let again: usize = parts.map(|part| hits(contender, kind, part)).sum();
        self.best[1] = self.best[1].min(start.elapsed().as_secs_f64());
        assert_eq!(again, self.hits, "threads change what is hit");
    }

    /// The rates of the best times.
    pub fn rate(&self) -> Rate {
        let [one, all] = self.best.map(|seconds| self.rays as f64 / seconds * 1e-6);
        Rate { one, all }
    }
}

impl Default for Stopwatch {
    fn default() -> Self {
        Self::new()
    }
}
