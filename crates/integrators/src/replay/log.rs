//! What is written down of a sample, line by line, and which walk a line belongs to.
//!
//! Four numbers in brackets belong to the four wavelengths; lane 0, the first, chose. `f/p` and `p/p₀` are those of
//! [`crate::path_throughput`], by the densities of the scattering models and without Russian roulette, which only the
//! estimator knows of. Walks, such as those from the camera and from a light, are counted from the last camera ray.

use crate::path_throughput::PathThroughput;
use core::fmt::Write;
use etalon_spectrum::Wavelengths;
use etalon_transport::{SamplePdf, ShapeId, SurfaceInteraction};
use glam::{Vec3, Vec4};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// What a surface is called.
pub type Describe<'a> = dyn Fn(&SurfaceInteraction) -> String + Sync + 'a;

/// What has been written.
#[derive(Default)]
pub(super) struct Log {
    text: String,
    /// How many walks have begun.
    walks: usize,
    /// Where they may go next, and what was met on the way.
    ways: Vec<(Vec3, Place)>,
    met: Vec<(Vec3, ShapeId, Option<Place>)>,
    /// The wavelengths that were told last.
    lambda: Option<Vec4>,
}

/// Where a walk is; without throughput if the estimator chose a direction by itself.
#[derive(Clone, Copy)]
pub(super) struct Place {
    walk: usize,
    throughput: Option<PathThroughput>,
}

impl Place {
    /// After a step with this value and these densities; none if the walk does not tell them.
    pub(super) fn after(mut self, step: Option<(Vec4, SamplePdf)>) -> Self {
        self.throughput = self
            .throughput
            .zip(step)
            .map(|(mut path, (value, chance))| {
                path.scatter(value, chance.lanes());
                path
            });
        self
    }

    /// The throughput in words.
    pub(super) fn carried(self) -> String {
        match self.throughput {
            Some(PathThroughput { beta, r_u }) => {
                format!("f/p {}  p/p₀ {}", lanes(beta), lanes(r_u))
            }
            None => "f/p known to the estimator only".to_owned(),
        }
    }
}

/// The walk of a place in words; the first is not worth mentioning.
pub(super) fn walk(place: Option<Place>) -> String {
    match place {
        Some(Place { walk: 0, .. }) => String::new(),
        Some(Place { walk, .. }) => format!("walk {}: ", walk + 1),
        None => "no walk: ".to_owned(),
    }
}

impl Log {
    /// Adds a line.
    pub(super) fn line(&mut self, line: impl core::fmt::Display) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.text, "{line}");
    }

    /// The wavelengths to which the next lines belong.
    pub(super) fn wavelengths(&mut self, of: &Wavelengths) {
        if self.lambda.replace(of.lambda) != Some(of.lambda) {
            let (lambda, density) = (lanes(of.lambda), lanes(of.density));
            self.line(format!("wavelengths {lambda} nm, density {density} nm⁻¹"));
        }
    }

    /// A path begins, whose walks are its own.
    pub(super) fn begin_path(&mut self) {
        *self = Self {
            text: core::mem::take(&mut self.text),
            ..Self::default()
        };
    }

    /// Begins a walk that counts so much and goes along a direction.
    pub(super) fn begin(&mut self, beta: Vec4, direction: Vec3) -> Place {
        let start = PathThroughput::START;
        let place = Place {
            walk: self.walks,
            throughput: Some(PathThroughput { beta, ..start }),
        };
        self.walks += 1;
        self.may_go(place, direction);
        place
    }

    /// A walk may go along a direction from a place.
    pub(super) fn may_go(&mut self, place: Place, direction: Vec3) {
        self.ways.push((direction, place));
    }

    /// The walk that goes along a direction: sampled, or else only asked for.
    pub(super) fn along(&self, direction: Vec3) -> Option<Place> {
        let same = self.ways.iter().rev().filter(|way| way.0 == direction);
        let mut places = same.map(|way| way.1);
        let known = places.clone().find(|place| place.throughput.is_some());
        known.or_else(|| places.next())
    }

    /// A surface was met along a direction.
    pub(super) fn meet(&mut self, vertex: &SurfaceInteraction, what: &str, direction: Vec3) {
        let place = self.along(direction);
        self.met.push((vertex.position, vertex.shape, place));
        self.line(format!(
            "{}surface at {}",
            walk(place),
            vector(vertex.position)
        ));
        self.line(format!("    {what}"));
        self.line(format!(
            "    normal {}, shading normal {}, uv ({}, {})",
            vector(vertex.normal),
            vector(vertex.shading.n),
            vertex.uv.x,
            vertex.uv.y
        ));
        if let Some(place) = place {
            self.line(format!("    {}", place.carried()));
        }
    }

    /// The arrival of a walk at a surface.
    pub(super) fn place(&self, vertex: &SurfaceInteraction) -> Option<Place> {
        let mut met = self.met.iter().rev();
        met.find(|(position, shape, _)| *position == vertex.position && *shape == vertex.shape)
            .and_then(|met| met.2)
    }
}

/// A log that many may write to.
pub(super) struct SharedLog<'a> {
    log: Mutex<Log>,
    pub(super) describe: &'a Describe<'a>,
}

impl<'a> SharedLog<'a> {
    /// An empty one.
    pub(super) fn new(describe: &'a Describe<'a>) -> Self {
        Self {
            log: Mutex::default(),
            describe,
        }
    }

    /// The log, for this one to write to.
    pub(super) fn write(&self) -> MutexGuard<'_, Log> {
        self.log.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Adds a line.
    pub(super) fn line(&self, line: impl core::fmt::Display) {
        self.write().line(line);
    }

    /// Adds a line whose lanes are of these wavelengths.
    pub(super) fn line_at(&self, of: &Wavelengths, line: impl core::fmt::Display) {
        let mut log = self.write();
        log.wavelengths(of);
        log.line(line);
    }

    /// Everything that was written.
    pub(super) fn into_text(self) -> String {
        let log = self.log.into_inner();
        log.unwrap_or_else(PoisonError::into_inner).text
    }
}

/// Three numbers.
pub(super) fn vector(v: Vec3) -> String {
    format!("({}, {}, {})", v.x, v.y, v.z)
}

/// One number per wavelength.
pub(super) fn lanes(v: Vec4) -> String {
    format!("[{} {} {} {}]", v.x, v.y, v.z, v.w)
}

/// Density per steradian, or probability.
pub(super) fn chance(chance: SamplePdf) -> String {
    let kind = match chance.is_delta() {
        true => "probability",
        false => "density",
    };
    format!("{kind} {}", lanes(chance.lanes()))
}
