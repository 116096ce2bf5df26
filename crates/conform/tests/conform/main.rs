//! Questions to any renderer: the decision, and running programs.

mod judging;
mod running;
