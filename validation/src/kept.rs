//! What is not rendered twice.
//!
//! The estimators of a claim are held against one oracle, rendered with one seed: its batches are the
//! same for all of them, and are kept in memory until the next claim's turn. (That their comparisons
//! depend on each other so is nothing new, and no correction of this crate assumes otherwise.) A full
//! run keeps all batches on disk, too ([`crate::state`]).

use crate::state::State;
use etalon::pipeline::Loaded;
use etalon_film::RenderedImage;
use etalon_integrators::RenderPlan;
use std::cell::RefCell;
use std::collections::HashMap;

/// What there is already.
pub(crate) struct BatchCache<'a> {
    state: Option<&'a State>,
    oracles: RefCell<Oracles>,
}

/// The batches of one claim's oracle.
#[derive(Default)]
struct Oracles {
    claim: String,
    batches: HashMap<String, RenderedImage>,
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
    /// Nothing yet, but for what is on disk.
    pub(crate) fn new(state: Option<&'a State>) -> Self {
        Self {
            state,
            oracles: RefCell::default(),
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
        if let Some(batch) = self.oracles.borrow().get(wanted) {
            return Ok(batch.clone());
        }
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
        if wanted.shared {
            self.oracles.borrow_mut().put(wanted, &batch);
        }
        Ok(batch)
    }
}

impl Oracles {
    fn get(&self, wanted: &Wanted<'_>) -> Option<&RenderedImage> {
        if !wanted.shared || self.claim != wanted.claim {
            return None;
        }
        self.batches.get(wanted.name)
    }

    fn put(&mut self, wanted: &Wanted<'_>, batch: &RenderedImage) {
        if self.claim != wanted.claim {
            self.claim = wanted.claim.to_owned();
            self.batches.clear();
        }
        self.batches.insert(wanted.name.to_owned(), batch.clone());
    }
}
