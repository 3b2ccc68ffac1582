//! Why a pipeline ends early.

use ::export::ExportError;
use chrono::{DateTime, Utc};
use ingest::{Finding, IngestError};
use report::ReportError;
use setpoints::OwnError;
use shading::ShadowError;
use std::path::PathBuf;
use store::StoreError;

use crate::Stale;

/// Why a pipeline ends early.
#[derive(Debug, thiserror::Error)]
pub enum PipelineError {
    /// What was asked for cannot be: a wrong argument.
    #[error("{0}")]
    Request(String),
    /// Missions or weather cannot be used.
    #[error(transparent)]
    Ingest(#[from] IngestError),
    /// A file that the study names cannot be read.
    #[error("{path}: {finding}")]
    InputFile {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        finding: Finding,
    },
    /// The shadow file's content cannot be used.
    #[error("{path}: {source}")]
    Shadow {
        /// The file, as the study names it.
        path: String,
        /// What is wrong with it.
        source: ShadowError,
    },
    /// Setpoints of one's own cannot be used.
    #[error("{path}: {source}")]
    Setpoints {
        /// The file, as the study names it.
        path: String,
        /// What is wrong with it.
        source: OwnError,
    },
    /// More than one input cannot be used.
    #[error("{} inputs cannot be used: {}", .0.len(), .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
    Several(Vec<PipelineError>),
    /// No segment gives a sample.
    #[error("no samples: {excluded} segments are excluded, the first one: {reason}")]
    NoSamples {
        /// Segments without a sample.
        excluded: usize,
        /// Why the first one has none.
        reason: String,
    },
    /// Weather of stored samples is no longer there.
    #[error(
        "the weather of {samples} samples is no longer there, the first: {mission} at {start}, {reason}; nothing was withdrawn: \
         bring the files back, or run with --forget-missing"
    )]
    WeatherGone {
        /// Samples that would go.
        samples: usize,
        /// Mission of the first.
        mission: String,
        /// Its start.
        start: DateTime<Utc>,
        /// Why it would go.
        reason: String,
    },
    /// What a stage builds on was made from something else.
    #[error(transparent)]
    Stale(#[from] Stale),
    /// The database holds nothing to work on.
    #[error("the database holds no optima yet; run the study first")]
    NoOptima,
    /// The database was filled by another study.
    #[error(
        "the database holds optima of other designs, windows, constants or methods than the study file asks for; run the study \
         first"
    )]
    OtherStudy,
    /// The database cannot be used.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// The report cannot be made.
    #[error(transparent)]
    Report(#[from] ReportError),
    /// Files for other tools cannot be made.
    #[error(transparent)]
    Export(#[from] ExportError),
    /// A file cannot be written.
    #[error("cannot write {path}: {source}; check permissions and free space")]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// Another run is at work on the database.
    #[error("{database} is being written by another run ({holder}); wait for it, or give --wait SECONDS", database = database.display())]
    Busy {
        /// The database.
        database: PathBuf,
        /// Who writes it, and since when.
        holder: String,
    },
    /// Somebody asked to stop.
    #[error("interrupted; everything finished so far is stored: run again to resume")]
    Interrupted,
}
