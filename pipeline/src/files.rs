//! Writing files.

use std::path::Path;

use crate::PipelineError;

/// Writes a file that is whole or not there.
///
/// # Errors
/// [`PipelineError::Write`].
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), PipelineError> {
    ingest::write_whole(path, bytes).map_err(|source| PipelineError::Write { path: path.to_owned(), source })
}

/// Makes a folder with all above it.
pub(crate) fn make_folder(path: &Path) -> Result<(), PipelineError> {
    std::fs::create_dir_all(path).map_err(|source| PipelineError::Write { path: path.to_owned(), source })
}
