//! Why a file is not fetched.

use std::path::PathBuf;

/// Why a file is not fetched.
#[derive(Debug, thiserror::Error)]
pub enum FetchError {
    /// The server refuses, or the address is wrong.
    #[error("{url}: {reason}")]
    Refused {
        /// The address.
        url: String,
        /// What the server says, and what to do.
        reason: String,
    },
    /// What came is not what was asked for.
    #[error("{url}: {reason}; nothing of it is kept")]
    Wrong {
        /// The address.
        url: String,
        /// What is wrong with it.
        reason: String,
    },
    /// It failed again and again.
    #[error("{url}: {reason}, after {attempts} attempts; what has come is kept: try again, and it goes on from there")]
    GaveUp {
        /// The address.
        url: String,
        /// How many attempts.
        attempts: u32,
        /// How the last one failed.
        reason: String,
    },
    /// The file cannot be written.
    #[error("cannot write {path}: {source}; check permissions and free space")]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// Somebody asked to stop.
    #[error("interrupted; what has come is kept: run again to resume")]
    Interrupted,
}
