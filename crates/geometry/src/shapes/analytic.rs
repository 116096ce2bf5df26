//! What shapes that intersect rays by a formula of their own share.

pub(crate) mod chart;
pub(crate) mod clip_box;
pub(crate) mod crossing;
pub(crate) mod field;
pub(crate) mod placed;
pub(crate) mod sign_changes;
