//! One run at a time: a lock beside the database, which the system releases even where the run is killed.

use chrono::{SecondsFormat, Utc};
use std::fs::{File, TryLockError};
use std::io::{Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use store::lock_path;

use crate::{PipelineError, Progress};

/// What is waited for in any case: a reader may be bringing the schema up to date.
const LEAST_WAIT: Duration = Duration::from_secs(1);
/// How often a waiting run looks again.
const LOOK: Duration = Duration::from_millis(50);

/// Whether a run holds the lock of a database.
pub(crate) fn is_held(database: &Path) -> bool {
    File::open(lock_path(database)).is_ok_and(|file| matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)))
}

/// The right to write a database; gives it back when it goes.
#[derive(Debug)]
pub(crate) struct RunLock {
    path: PathBuf,
    /// Holds the system's lock as long as it is open.
    _file: File,
}

impl RunLock {
    /// Takes the lock of a database, or waits so long for it.
    pub fn take(database: &Path, wait: Duration, progress: &dyn Progress) -> Result<Self, PipelineError> {
        let path = lock_path(database);
        let error = |source| PipelineError::Write { path: path.clone(), source };
        let since = Instant::now();
        loop {
            let mut file =
                File::options().read(true).write(true).create(true).truncate(false).open(&path).map_err(error)?;
            match file.try_lock() {
                // A run that ended between our opening and locking has taken the file away: this one is nobody's.
                Ok(()) if !is_at(&file, &path) => continue,
                Ok(()) => {
                    let now = Utc::now().to_rfc3339_opts(SecondsFormat::Secs, true);
                    let text = format!("process {} since {now}\n", std::process::id());
                    file.set_len(0).and_then(|()| file.write_all(text.as_bytes())).map_err(error)?;
                    return Ok(Self { path, _file: file });
                }
                Err(TryLockError::Error(source)) => return Err(error(source)),
                Err(TryLockError::WouldBlock) => {}
            }
            if progress.stop() {
                return Err(PipelineError::Interrupted);
            }
            if since.elapsed() >= wait.max(LEAST_WAIT) {
                let mut holder = String::new();
                // Who holds it is news, not a condition.
                let _ = file.rewind().and_then(|()| file.read_to_string(&mut holder));
                return Err(PipelineError::Busy { database: database.to_owned(), holder: holder.trim().to_owned() });
            }
            std::thread::sleep(LOOK);
        }
    }
}

impl Drop for RunLock {
    fn drop(&mut self) {
        // Still locked: whoever waits finds a file that is no longer at its place, and makes a new one.
        let _ = std::fs::remove_file(&self.path);
    }
}

/// Whether an open file is the one at a path.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    match (file.metadata(), std::fs::metadata(path)) {
        (Ok(open), Ok(there)) => (open.dev(), open.ino()) == (there.dev(), there.ino()),
        _ => false,
    }
}

#[cfg(not(unix))]
fn is_at(_: &File, path: &Path) -> bool {
    path.exists()
}
