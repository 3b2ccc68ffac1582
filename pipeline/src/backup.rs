//! A copy of a study's database.

use std::path::Path;
use study::Study;

use crate::{PipelineError, open};

/// Copies the database of a study as it is at one moment, while anything runs. The copy is whole or not there.
///
/// # Errors
/// [`PipelineError::Request`] where the file is there already; [`PipelineError::Store`], [`PipelineError::Write`].
pub fn backup(study: &Study, to: &Path) -> Result<(), PipelineError> {
    if to.exists() {
        return Err(PipelineError::Request(format!("{} is there already; it is left as it is", to.display())));
    }
    let mut store = open::for_reading(study)?;
    let mut part = to.as_os_str().to_owned();
    part.push(".part");
    let part = Path::new(&part);
    let write = |source| PipelineError::Write { path: to.to_owned(), source };
    if part.exists() {
        // What a killed copy has left.
        std::fs::remove_file(part).map_err(write)?;
    }
    store.copy_to(part)?;
    store.close()?;
    std::fs::rename(part, to).map_err(write)
}
