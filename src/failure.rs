//! How the program ends.

use ingest::IngestError;
use std::process::ExitCode;
use store::StoreError;

use crate::study::file::StudyFileError;

/// It finished.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// Exit status 0.
    Done,
    /// Points stayed unsolved or inputs were refused: exit status 1.
    Losses,
}

/// It did not.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// The command line or the study file is wrong: exit status 2.
    #[error("{0:#}")]
    Usage(anyhow::Error),
    /// Inputs or database cannot be used: exit status 3.
    #[error("{0:#}")]
    Inputs(anyhow::Error),
    /// A signal came: exit status 4.
    #[error("interrupted; everything finished so far is stored: run again to resume")]
    Interrupted,
}

impl Ending {
    pub fn code(self) -> ExitCode {
        match self {
            Self::Done => ExitCode::SUCCESS,
            Self::Losses => ExitCode::from(1),
        }
    }
}

impl Failure {
    pub fn code(&self) -> ExitCode {
        ExitCode::from(match self {
            Self::Usage(_) => 2,
            Self::Inputs(_) => 3,
            Self::Interrupted => 4,
        })
    }
}

impl From<StudyFileError> for Failure {
    fn from(error: StudyFileError) -> Self {
        Self::Usage(error.into())
    }
}

impl From<IngestError> for Failure {
    fn from(error: IngestError) -> Self {
        Self::Inputs(error.into())
    }
}

impl From<StoreError> for Failure {
    fn from(error: StoreError) -> Self {
        Self::Inputs(error.into())
    }
}
