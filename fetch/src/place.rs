//! Where a download lies while it comes.

use chrono::{DateTime, NaiveDateTime, Utc};
use std::fs::{self, File, OpenOptions};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use crate::FetchError;

/// The form of times in HTTP (RFC 9110, 5.6.7).
const HTTP_DATE: &str = "%a, %d %b %Y %H:%M:%S GMT";

/// The place of a file, and what lies beside it.
pub(crate) struct Place {
    to: PathBuf,
    part: PathBuf,
    from: PathBuf,
}

impl Place {
    pub fn of(to: &Path) -> Result<Self, FetchError> {
        let beside = |extension: &str| {
            let mut name = to.as_os_str().to_owned();
            name.push(extension);
            PathBuf::from(name)
        };
        if let Some(folder) = to.parent() {
            fs::create_dir_all(folder).map_err(|source| FetchError::Write { path: folder.to_owned(), source })?;
        }
        Ok(Self { to: to.to_owned(), part: beside(".part"), from: beside(".part.from") })
    }

    pub fn part(&self) -> &Path {
        &self.part
    }

    pub fn error(&self, source: std::io::Error) -> FetchError {
        FetchError::Write { path: self.part.clone(), source }
    }

    /// How many bytes have come of which version; nothing where there is none to go on from.
    pub fn begun(&self) -> Option<(u64, String)> {
        let bytes = fs::metadata(&self.part).ok()?.len();
        let version = fs::read_to_string(&self.from).ok()?.trim().to_owned();
        (bytes > 0 && !version.is_empty()).then_some((bytes, version))
    }

    /// When the file that is there was modified, as HTTP says it.
    pub fn modified(&self) -> Option<String> {
        let modified: SystemTime = fs::metadata(&self.to).ok()?.modified().ok()?;
        Some(DateTime::<Utc>::from(modified).format(HTTP_DATE).to_string())
    }

    /// Begins anew with a version of the server's.
    pub fn begin(&self, version: Option<&str>) -> std::io::Result<File> {
        self.discard();
        if let Some(version) = version {
            fs::write(&self.from, version)?;
        }
        File::create(&self.part)
    }

    pub fn go_on(&self) -> std::io::Result<File> {
        OpenOptions::new().append(true).open(&self.part)
    }

    /// Forgets what has come.
    pub fn discard(&self) {
        let _ = fs::remove_file(&self.part);
        let _ = fs::remove_file(&self.from);
    }

    /// Puts what is complete into its place.
    pub fn finish(&self, last_modified: Option<&str>) -> std::io::Result<()> {
        let file = OpenOptions::new().append(true).open(&self.part)?;
        file.sync_all()?;
        if let Some(time) = last_modified.and_then(|text| NaiveDateTime::parse_from_str(text, HTTP_DATE).ok()) {
            file.set_modified(SystemTime::from(time.and_utc()))?;
        }
        fs::rename(&self.part, &self.to)?;
        let _ = fs::remove_file(&self.from);
        Ok(())
    }
}
