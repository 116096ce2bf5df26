//! What the page shows: pictures, each with a number that grows when it changes, and how far the render is.

use super::layers::{self, Planes};
use crate::interrupt;
use etalon_film::{Glance, RenderedImage};
use etalon_images::{Development, Image};
use etalon_render::watcher::Watcher;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant, SystemTime};

/// How long the last picture waits for a page that looks on, and how long if somebody asked to stop.
const FAREWELL: [Duration; 2] = [Duration::from_secs(3), Duration::from_secs(1)];

/// A page that has not asked for so long is gone.
const GONE: Duration = Duration::from_secs(2);

/// What is shown.
#[derive(Debug)]
pub struct Feed {
    title: String,
    development: Development,
    pictures: Mutex<Vec<Shown>>,
    progress: Mutex<Option<Run>>,
    done: AtomicU64,
    finished: AtomicBool,
    /// When the page last asked, and the version of the first picture that it has.
    asked: Mutex<Option<Instant>>,
    fetched: AtomicU64,
}

/// A running render.
#[derive(Clone, Debug)]
struct Run {
    /// What stands before it, such as the number of a frame.
    name: String,
    total: u64,
    begin: Instant,
}

/// A picture with its version.
#[derive(Clone, Debug)]
struct Shown {
    name: String,
    version: u64,
    image: Arc<Image>,
    layers: Vec<String>,
    /// Samples per pixel and replicates, as far as they are known.
    samples: Option<f64>,
    replicates: u32,
    /// The file that it was read from, and when that was written.
    file: Option<(PathBuf, Option<SystemTime>)>,
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

fn written(path: &Path) -> Option<SystemTime> {
    path.metadata().and_then(|m| m.modified()).ok()
}

impl Feed {
    /// Nothing yet, shown like this.
    #[must_use]
    pub fn new(title: String, development: Development) -> Self {
        Self {
            title,
            development,
            pictures: Mutex::default(),
            progress: Mutex::default(),
            done: AtomicU64::new(0),
            finished: AtomicBool::new(false),
            asked: Mutex::default(),
            fetched: AtomicU64::new(0),
        }
    }

    /// Adds a finished picture, which is read again whenever its file changes.
    pub fn add(&self, path: &Path, picture: RenderedImage) {
        let shown = Shown::of_file(path, picture, 1);
        lock(&self.pictures).push(shown);
    }

    /// A render of so many samples begins.
    pub fn begin(&self, name: String, samples: u64) {
        self.done.store(0, Ordering::Relaxed);
        let begin = Instant::now();
        *lock(&self.progress) = Some(Run {
            name,
            total: samples,
            begin,
        });
    }

    /// So many samples more are done.
    pub fn advance(&self, samples: u64) {
        self.done.fetch_add(samples, Ordering::Relaxed);
    }

    /// Shows the picture that came of it.
    pub fn end(&self, picture: &RenderedImage) {
        let metadata = picture.metadata.as_ref();
        let samples = metadata.map(|m| m.spp as f64);
        self.replace(
            picture.image.clone(),
            samples,
            metadata.map_or(0, |m| m.replicates),
        );
    }

    /// Nothing more will be shown: waits for a page that looks on to have the last picture, but not for long.
    pub fn finish(&self) {
        self.finished.store(true, Ordering::Relaxed);
        let newest = lock(&self.pictures).first().map_or(0, |p| p.version);
        let begin = Instant::now();
        let patience = FAREWELL[usize::from(interrupt::asked())];
        let mut told = 0;
        let waiting = || {
            let asked = *lock(&self.asked);
            asked.is_some_and(|asked| asked.elapsed() < GONE) && begin.elapsed() < patience
        };
        // The state that says so must have been asked for, too.
        while waiting() && (self.fetched.load(Ordering::Relaxed) < newest || told < 3) {
            std::thread::sleep(Duration::from_millis(100));
            told += 1;
        }
    }

    fn replace(&self, image: Image, samples: Option<f64>, replicates: u32) {
        let layers = layers::names(&image);
        let mut pictures = lock(&self.pictures);
        let version = pictures.first().map_or(1, |picture| picture.version + 1);
        let shown = Shown {
            name: self.title.clone(),
            version,
            layers,
            image: Arc::new(image),
            samples,
            replicates,
            file: None,
        };
        match pictures.first_mut() {
            Some(first) => *first = shown,
            None => pictures.push(shown),
        }
    }

    /// What the page asks for again and again.
    pub(super) fn state(&self) -> Value {
        *lock(&self.asked) = Some(Instant::now());
        self.refresh();
        let pictures: Vec<Value> = lock(&self.pictures).iter().map(Shown::described).collect();
        let progress = lock(&self.progress).as_ref().map(|run| {
            let seconds = run.begin.elapsed().as_secs_f64();
            let done = self.done.load(Ordering::Relaxed).min(run.total);
            let rate = done as f64 / seconds.max(1e-9);
            let left = (done > 0).then(|| (run.total - done) as f64 / rate);
            json!({ "name": run.name, "done": done, "total": run.total, "seconds": seconds, "left": left, "rate": rate })
        });
        json!({
            "title": self.title,
            "exposure": self.development.exposure,
            "view": self.development.view.name(),
            "pictures": pictures,
            "progress": progress,
            "finished": self.finished.load(Ordering::Relaxed),
        })
    }

    /// Reads files again that have changed; what cannot be read just now stays what it was.
    fn refresh(&self) {
        let mut pictures = lock(&self.pictures);
        for shown in pictures.iter_mut() {
            let Some((path, when)) = &shown.file else {
                continue;
            };
            let now = written(path);
            if now == *when {
                continue;
            }
            let path = path.clone();
            match layers::read(&path) {
                Ok(picture) => *shown = Shown::of_file(&path, picture, shown.version + 1),
                Err(_) => shown.file = Some((path, now)),
            }
        }
    }

    /// The numbers of a layer of a picture, and the version that they are of.
    pub(super) fn planes(&self, picture: usize, layer: usize) -> Option<(Planes, u64)> {
        let shown = lock(&self.pictures).get(picture)?.clone();
        let planes = layers::planes(&shown.image, shown.layers.get(layer)?)?;
        if picture == 0 {
            self.fetched.fetch_max(shown.version, Ordering::Relaxed);
        }
        Some((planes, shown.version))
    }
}

impl Shown {
    fn of_file(path: &Path, picture: RenderedImage, version: u64) -> Self {
        let metadata = picture.metadata.as_ref();
        Self {
            name: path.display().to_string(),
            version,
            samples: metadata.map(|m| m.spp as f64),
            replicates: metadata.map_or(0, |m| m.replicates),
            layers: layers::names(&picture.image),
            image: Arc::new(picture.image),
            file: Some((path.to_owned(), written(path))),
        }
    }

    fn described(&self) -> Value {
        json!({
            "name": self.name,
            "version": self.version,
            "width": self.image.width(),
            "height": self.image.height(),
            "layers": self.layers,
            "samples": self.samples,
            "replicates": self.replicates,
        })
    }
}

impl Watcher for Feed {
    fn see(&self, glance: Glance) {
        self.replace(glance.image, Some(glance.samples), glance.replicates);
    }
}
