//! Files that are whole or not there.

use std::path::Path;

use crate::DemoError;

pub(crate) fn folder(path: &Path) -> Result<(), DemoError> {
    std::fs::create_dir_all(path).map_err(|source| DemoError::Write { path: path.to_owned(), source })
}

pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), DemoError> {
    ingest::write_whole(path, bytes).map_err(|source| DemoError::Write { path: path.to_owned(), source })
}
