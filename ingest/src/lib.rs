//! Mission telemetry and weather files become hourly samples, with a record of what is wrong in the files.
//!
//! Bad data is data here: a file or row that cannot be used ends up in a [`FileRecord`], a segment in an
//! [`ExcludedSegment`], each with its reason; [`IngestError`] is for input without which nothing can be done.
//!
//! - [`mission`]: ZTBus missions at 1 Hz, from a folder, a glob, or an archive → [`mission::Segment`]
//! - [`weather`]: station files and reference years → [`weather::Weather`], which knows its mean over any segment
//! - [`sample`]: both together, with sun and shade → [`sample::Sample`]
//!
//! Nothing depends on the order of files or on the number of threads.

mod files;
pub mod irradiance;
pub mod mission;
mod parse;
mod quality;
pub mod sample;
mod scan;
mod segments;
mod stamp;
mod telemetry;
mod walk;
pub mod weather;

pub use files::{Content, FileReader, FileStamp, check_archive, check_lines, write_whole};
pub use quality::{ExcludedSegment, ExclusionReason, FileKind, FileRecord, Finding, FindingKind};
pub use stamp::Clock;

use std::path::PathBuf;

/// Input without which nothing can be done.
#[derive(Debug, thiserror::Error)]
pub enum IngestError {
    /// A path of the study does not exist or cannot be listed.
    #[error("{path}: {reason}; check the path, it is relative to the study file")]
    Path {
        /// The path.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// No mission was found.
    #[error("{path}: no missions {detail}")]
    NoMissions {
        /// Where they were looked for.
        path: PathBuf,
        /// What was found instead.
        detail: String,
    },
    /// The weather files do not make one series.
    #[error("{path}: {reason}")]
    Weather {
        /// Where they were looked for.
        path: PathBuf,
        /// What is wrong and what to do.
        reason: String,
    },
    /// No weather file can be used.
    #[error("{path}: {message}")]
    WeatherRefused {
        /// The first refused file.
        path: String,
        /// What is wrong and what to do.
        message: String,
    },
}
