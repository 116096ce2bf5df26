//! The viewers of a running `render`: the page, `tev`, both or none.

use super::feed::Feed;
use super::tev::Tev;
use crate::args::RenderArgs;
use crate::say;
use etalon_film::{Glance, RenderedImage};
use etalon_images::Development;
use etalon_render::watcher::Watcher;
use std::sync::Arc;

/// Those who look on, for all frames of a render.
#[derive(Clone, Debug, Default)]
pub struct Onlookers {
    feed: Option<Arc<Feed>>,
    tev: Option<Arc<Tev>>,
}

impl Onlookers {
    /// Opens what the command line asks for.
    ///
    /// # Errors
    /// One sentence, if it cannot be had.
    pub fn of(args: &RenderArgs) -> Result<Self, String> {
        let title = args.scene.display().to_string();
        let mut onlookers = Self::default();
        if let Some(port) = args.preview.preview {
            let development: Development = args.shown.development()?;
            let feed = Arc::new(Feed::new(title.clone(), development));
            let address = super::open(&feed, port.0)?;
            if !args.quiet {
                say::remark(&format!("note: look on at {address}\n"));
            }
            onlookers.feed = Some(feed);
        }
        if let Some(address) = &args.preview.tev {
            let failed = |reason: &str| {
                say::remark(&format!(
                    "warning: `tev` is gone, the render goes on: {reason}\n"
                ));
            };
            onlookers.tev = Some(Arc::new(Tev::connect(address, title, failed)?));
        }
        Ok(onlookers)
    }

    /// The watcher of the film; `None` without viewers.
    pub fn watcher(&self) -> Option<Arc<dyn Watcher>> {
        let anybody = self.feed.is_some() || self.tev.is_some();
        anybody.then(|| Arc::new(self.clone()) as Arc<dyn Watcher>)
    }

    /// A render of so many samples begins.
    pub fn begin(&self, name: &str, samples: u64) {
        if let Some(feed) = &self.feed {
            feed.begin(name.to_owned(), samples);
        }
    }

    /// So many samples more are done.
    pub fn advance(&self, samples: u64) {
        if let Some(feed) = &self.feed {
            feed.advance(samples);
        }
    }

    /// Shows the picture that came of it.
    pub fn end(&self, picture: &RenderedImage) {
        if let Some(feed) = &self.feed {
            feed.end(picture);
        }
        if let Some(tev) = &self.tev {
            tev.send(&picture.image);
        }
    }

    /// Nothing more will be shown.
    pub fn finish(&self) {
        if let Some(feed) = &self.feed {
            feed.finish();
        }
    }
}

impl Watcher for Onlookers {
    fn see(&self, glance: Glance) {
        if let Some(tev) = &self.tev {
            tev.send(&glance.image);
        }
        if let Some(feed) = &self.feed {
            feed.see(glance);
        }
    }
}
