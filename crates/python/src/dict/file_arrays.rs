//! Which plugins take an array in place of a file.

use super::plugins;
use serde::Deserialize;

/// What an array is the contents of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum FileArray {
    /// Height × width, or with 1, 3 or 4 channels.
    Picture,
    /// Along z, y and x, or with 1, 3 or 6 channels.
    Volume,
}

impl FileArray {
    /// What a plugin's file holds.
    pub(crate) fn of(plugin: &str) -> Option<Self> {
        plugins::plugin(plugin)?.file
    }

    /// That of a plugin's key, if it is one for arrays.
    pub(super) fn of_key(plugin: &str, key: &str) -> Option<Self> {
        Self::of(plugin).filter(|file| file.keys().contains(&key))
    }

    /// The names of the array: ours, and another that Mitsuba has for it.
    pub(crate) fn keys(self) -> [&'static str; 2] {
        match self {
            Self::Picture => ["data", "bitmap"],
            Self::Volume => ["data", "grid"],
        }
    }
}
