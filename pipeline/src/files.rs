//! Writing files.

use std::path::Path;

use crate::PipelineError;

/// Writes beside the place and renames, so that a file that is there is whole.
///
/// # Errors
/// [`PipelineError::Write`].
pub fn write_beside(path: &Path, bytes: &[u8]) -> Result<(), PipelineError> {
    let mut beside = path.as_os_str().to_owned();
    beside.push(".part");
    std::fs::write(&beside, bytes)
        .and_then(|()| std::fs::rename(&beside, path))
        .map_err(|source| PipelineError::Write { path: path.to_owned(), source })
}

/// Makes a folder with all above it.
pub(crate) fn make_folder(path: &Path) -> Result<(), PipelineError> {
    std::fs::create_dir_all(path).map_err(|source| PipelineError::Write { path: path.to_owned(), source })
}
