//! How optima are found.

use crate::METHOD_VERSION;
use crate::nlp::{NLP_VERSION, SURROGATE_VERSION};

/// How optima are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Global by construction, exact door law and vote.
    Fast,
    /// The paper's nonlinear programs with its smooth door law, and the exact vote.
    Nlp,
    /// The paper's nonlinear programs with its smooth door law and its network for the vote.
    NlpSurrogate,
}

impl Method {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Fast, Self::Nlp, Self::NlpSurrogate];

    /// The name on the command line and in the database.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Fast => "fast",
            Self::Nlp => "nlp",
            Self::NlpSurrogate => "nlp-surrogate",
        }
    }

    /// The method of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.name() == name)
    }

    /// Version of its results, for keys.
    #[must_use]
    pub fn version(self) -> String {
        match self {
            Self::Fast => METHOD_VERSION.to_string(),
            Self::Nlp => NLP_VERSION.to_string(),
            Self::NlpSurrogate => format!("{NLP_VERSION} {SURROGATE_VERSION}"),
        }
    }
}
