//! Building nodes of the description tree for pbrt's entities.

use super::super::parameters::Parameters;
pub(crate) use crate::draft::{Draft, Given, given, vector, word};
use etalon_params::{Class, Value};

impl Draft {
    /// A node for an entity.
    pub(crate) fn of(params: &Parameters<'_>, class: Class, plugin: &str) -> Self {
        Self::new(class, plugin, params.entity.span)
    }

    /// Adds a property from the parameter `source`.
    pub(crate) fn from(
        self,
        params: &Parameters<'_>,
        source: &str,
        name: &str,
        value: Value,
    ) -> Self {
        self.with(name, value, params.span(source))
    }
}
