//! Questions that people ask of a database, each with the query that answers it: `questions.toml`.

use serde::Deserialize;

use crate::StoreError;

const TEXT: &str = include_str!("../questions.toml");

/// A question and its answer in SQL, which SQLite and DuckDB take alike.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Question {
    /// Name, unique.
    pub name: String,
    /// Who asks: planning, operation, research.
    pub who: String,
    /// The question.
    pub asks: String,
    /// The query.
    pub sql: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Questions {
    question: Vec<Question>,
}

/// All questions.
///
/// # Errors
/// [`StoreError::Refused`] where their text is broken.
pub fn questions() -> Result<Vec<Question>, StoreError> {
    let Questions { question } = toml::from_str(TEXT).map_err(|e| sqlx::Error::Decode(e.into()))?;
    Ok(question)
}
