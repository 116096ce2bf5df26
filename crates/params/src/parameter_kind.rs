//! What the values of parameters are, for messages, the documentation of scenes and their schema.

/// What a parameter's value must be.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum ParameterKind {
    /// Nothing was said of it.
    #[default]
    Unsaid,
    /// A number, whole or not.
    Number,
    /// An integer.
    Integer,
    /// True or false.
    Boolean,
    /// A text.
    String,
    /// A point or vector.
    Vector,
    /// A transform; one that moves is held.
    Transform,
    /// A transform that may move.
    Motion,
    /// A number, colour, spectrum or texture.
    SpectrumOrTexture,
    /// A nested object, under any name or none.
    Nested,
    /// One of several of these, or of a form of its own, in words.
    Words(&'static str),
}

impl ParameterKind {
    /// The kind with its article, as messages have it: "a number"; empty if nothing was said.
    pub fn with_article(self) -> &'static str {
        match self {
            Self::Unsaid => "",
            Self::Number => "a number",
            Self::Integer => "an integer",
            Self::Boolean => "a boolean (`true` or `false`)",
            Self::String => "a string",
            Self::Vector => "a point or vector",
            Self::Transform => "a transform",
            Self::Motion => "a transform or an animation",
            Self::SpectrumOrTexture => "a spectrum or texture",
            Self::Nested => "nested",
            Self::Words(words) => words,
        }
    }

    /// The kind alone, as tables have it: "number".
    pub fn noun(self) -> &'static str {
        match self {
            Self::Boolean => "boolean",
            kind => {
                let words = kind.with_article();
                words.trim_start_matches("an ").trim_start_matches("a ")
            }
        }
    }
}
