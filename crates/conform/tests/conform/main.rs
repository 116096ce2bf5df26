//! Questions to any renderer: the decision, running programs, and the page.

mod judging;
mod page;
mod pbrt;
mod running;
