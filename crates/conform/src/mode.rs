//! What a program is to leave out.

/// What a program is to leave out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Everything that biases: paths are as long as they get.
    Measure,
    /// Nothing: the program's own defaults.
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
