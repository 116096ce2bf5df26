//! What a program is to leave out.

use serde::{Deserialize, Serialize};
use std::str::FromStr;

/// What a program is to leave out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Mode {
    /// Everything that biases: paths are as long as they get. This decides whether it is right.
    #[default]
    Measure,
    /// Nothing: the program's own defaults. This tells what a user gets.
    Shipped,
}

impl Mode {
    /// As drivers are told.
    pub fn name(self) -> &'static str {
        match self {
            Self::Measure => "measure",
            Self::Shipped => "shipped",
        }
    }
}

impl FromStr for Mode {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let mut all = [Self::Measure, Self::Shipped].into_iter();
        all.find(|mode| mode.name() == name)
            .ok_or_else(|| "expected `measure` or `shipped`".to_owned())
    }
}
