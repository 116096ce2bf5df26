//! A cache of rendered batches.
//!
//! The estimators of a claim are compared with one oracle, rendered with one seed: its batches are shared by all of
//! them and kept in memory until the next claim. So are pictures for planted faults of the report, which the sound
//! comparison has rendered already. Comparisons are therefore dependent; no correction in this crate assumes
//! independence. A full run keeps all batches on disk as well ([`crate::state`]).

use crate::state::State;
use etalon_film::RenderedImage;
use etalon_integrators::RenderPlan;
use etalon_render::pipeline::Loaded;
use std::cell::RefCell;
use std::collections::HashMap;

/// What there is already.
pub(crate) struct BatchCache<'a> {
    state: Option<&'a State>,
    shared: RefCell<Shared>,
}

/// What the comparisons of one claim share.
#[derive(Default)]
struct Shared {
    claim: String,
    pictures: HashMap<String, RenderedImage>,
}

/// Which batch.
pub(crate) struct Wanted<'a> {
    /// The claim it belongs to.
    pub(crate) claim: &'a str,
    /// What tells it from all others of the claim.
    pub(crate) name: &'a str,
    /// Whether other comparisons of the claim want it, too.
    pub(crate) shared: bool,
    /// How it is rendered.
    pub(crate) plan: &'a RenderPlan,
    /// Its scene.
    pub(crate) loaded: &'a Loaded,
}

impl<'a> BatchCache<'a> {
    /// Empty, except for the batches on disk.
    pub(crate) fn new(state: Option<&'a State>) -> Self {
        Self {
            state,
            shared: RefCell::default(),
        }
    }

    /// A batch that there is, or else the one that is rendered.
    ///
    /// # Errors
    /// If it cannot be rendered, or not be kept on disk.
    pub(crate) fn or_else(
        &self,
        wanted: &Wanted<'_>,
        render: impl FnOnce() -> Result<RenderedImage, String>,
    ) -> Result<RenderedImage, String> {
        if wanted.shared {
            return self.shared(wanted.claim, wanted.name, || self.stored(wanted, render));
        }
        self.stored(wanted, render)
    }

    /// What the comparisons of a claim share in memory, or else what is rendered.
    ///
    /// # Errors
    /// If it cannot be rendered.
    pub(crate) fn shared(
        &self,
        claim: &str,
        name: &str,
        render: impl FnOnce() -> Result<RenderedImage, String>,
    ) -> Result<RenderedImage, String> {
        if let Some(picture) = self.shared.borrow().get(claim, name) {
            return Ok(picture.clone());
        }
        let picture = render()?;
        self.shared.borrow_mut().put(claim, name, &picture);
        Ok(picture)
    }

    /// What is on disk, or else what is rendered and put there.
    fn stored(
        &self,
        wanted: &Wanted<'_>,
        render: impl FnOnce() -> Result<RenderedImage, String>,
    ) -> Result<RenderedImage, String> {
        let file = format!("{}-{}", wanted.claim, wanted.name);
        let read = |state: &State| state.read(&file, wanted.plan, wanted.loaded);
        let batch = match self.state.and_then(read) {
            Some(batch) => batch,
            None => {
                let batch = render()?;
                if let Some(state) = self.state {
                    state.write(&file, &batch)?;
                }
                batch
            }
        };
        Ok(batch)
    }
}

impl Shared {
    fn get(&self, claim: &str, name: &str) -> Option<&RenderedImage> {
        if self.claim != claim {
            return None;
        }
        self.pictures.get(name)
    }

    fn put(&mut self, claim: &str, name: &str, picture: &RenderedImage) {
        if self.claim != claim {
            self.claim = claim.to_owned();
            self.pictures.clear();
        }
        self.pictures.insert(name.to_owned(), picture.clone());
    }
}
