//! How the program ends.

use pipeline::PipelineError;
use std::process::ExitCode;
use study::StudyFileError;

/// It finished.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// Exit status 0.
    Done,
    /// Points stayed unsolved, missions were not simulated, inputs were refused or expected ones are missing: exit status 1.
    Losses,
    /// What the database holds is not complete: exit status 6.
    Pending,
}

/// It did not.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// The command line or the study file is wrong: exit status 2.
    #[error("{}", said_once(.0))]
    Usage(anyhow::Error),
    /// Inputs or database cannot be used: exit status 3.
    #[error("{}", said_once(.0))]
    Inputs(anyhow::Error),
    /// A signal came: exit status 4.
    #[error(transparent)]
    Interrupted(PipelineError),
    /// Another run is at work: exit status 5.
    #[error(transparent)]
    Busy(PipelineError),
}

/// An error with its causes, of which a library's message may speak already.
fn said_once(error: &anyhow::Error) -> String {
    let mut text = String::new();
    for cause in error.chain().map(ToString::to_string) {
        if !text.contains(&cause) {
            let joint = if text.is_empty() { "" } else { ": " };
            text = text + joint + &cause;
        }
    }
    text
}

impl Ending {
    pub fn of(complete: bool) -> Self {
        if complete { Self::Done } else { Self::Losses }
    }

    pub fn code(self) -> ExitCode {
        match self {
            Self::Done => ExitCode::SUCCESS,
            Self::Losses => ExitCode::from(1),
            Self::Pending => ExitCode::from(6),
        }
    }
}

impl Failure {
    pub fn code(&self) -> ExitCode {
        ExitCode::from(match self {
            Self::Usage(_) => 2,
            Self::Inputs(_) => 3,
            Self::Interrupted(_) => 4,
            Self::Busy(_) => 5,
        })
    }
}

impl From<StudyFileError> for Failure {
    fn from(error: StudyFileError) -> Self {
        Self::Usage(error.into())
    }
}

impl From<PipelineError> for Failure {
    fn from(error: PipelineError) -> Self {
        match error {
            PipelineError::Request(_) => Self::Usage(error.into()),
            PipelineError::Interrupted => Self::Interrupted(error),
            PipelineError::Busy { .. } => Self::Busy(error),
            _ => Self::Inputs(error.into()),
        }
    }
}
