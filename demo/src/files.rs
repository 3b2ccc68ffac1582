//! Files that are whole or not there.

use std::path::Path;

use crate::DemoError;

pub(crate) fn folder(path: &Path) -> Result<(), DemoError> {
    std::fs::create_dir_all(path).map_err(|source| DemoError::Write { path: path.to_owned(), source })
}

/// Writes beside the place and renames.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), DemoError> {
    let mut beside = path.as_os_str().to_owned();
    beside.push(".part");
    std::fs::write(&beside, bytes)
        .and_then(|()| std::fs::rename(&beside, path))
        .map_err(|source| DemoError::Write { path: path.to_owned(), source })
}
