//! Which files a study names as weather.

use std::path::{Path, PathBuf};

use super::WeatherFormat;
use super::format::Format;
use crate::files::{check_archive, extension};
use crate::walk::{Found, Place, walk};
use crate::{FileKind, FileRecord, FileStamp, IngestError};

/// Extensions of weather files in a folder or an archive.
const EXTENSIONS: [&str; 3] = ["csv", "txt", "epw"];
/// So much of a file tells its format.
const HEAD_BYTES: usize = 64 << 10;

/// A weather file that was found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WeatherFile(pub(super) Found);

/// The weather files that a path of a study names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WeatherFiles {
    /// The files, by path.
    pub files: Vec<WeatherFile>,
    /// What lies there and cannot be used.
    pub refused: Vec<FileRecord>,
    /// Where they were looked for.
    pub(super) place: PathBuf,
}

impl WeatherFile {
    /// Path as the study names it; the entry of an archive follows a `!`.
    #[must_use]
    pub fn path(&self) -> &str {
        &self.0.label
    }

    /// The stamp of the file, or of the archive that it lies in.
    #[must_use]
    pub fn stamp(&self) -> Option<FileStamp> {
        self.0.place.stamp()
    }
}

/// The weather files that a path of the study names, relative to `base`: a folder with all below it, a glob, one file, or an
/// archive (`.zip`); each may be compressed (`.gz`). What a file is, its beginning tells, not its name: in a folder, files of
/// other formats and metadata are left alone; what a name or a glob says is taken.
///
/// # Errors
/// [`IngestError`] where the path does not exist or holds no such file.
pub fn discover(base: &Path, pattern: &str, format: &WeatherFormat) -> Result<WeatherFiles, IngestError> {
    let reader = format.reader();
    let walked = walk(base, pattern, &EXTENSIONS)?;
    let in_folder = base.join(pattern).is_dir();
    let refused = |(path, finding): (String, _)| FileRecord::refused(&path, FileKind::Weather, "", 0, finding);
    let (meant, others): (Vec<_>, Vec<_>) =
        walked.found.into_iter().partition(|found| is_meant(found, reader, in_folder));
    let files: Vec<WeatherFile> = meant.into_iter().map(WeatherFile).collect();
    let refused: Vec<FileRecord> = walked.refused.into_iter().map(refused).collect();
    let place = base.join(pattern);
    if files.is_empty() && refused.is_empty() {
        let other = others.iter().find_map(|found| {
            let head = found.place.head(HEAD_BYTES).ok()?;
            let format = WeatherFormat::of_text(&encoding_rs::UTF_8.decode(&head).0)?;
            Some(format!("; {} is of the format {}", found.label, format.name()))
        });
        let (name, known_by, other) = (reader.name(), reader.known_by(), other.unwrap_or_default());
        let reason = format!("no weather files there of the format {name}, known by {known_by}{other}");
        return Err(IngestError::Weather { path: place, reason });
    }
    Ok(WeatherFiles { files, refused, place })
}

/// Whether a file that was just fetched looks like weather of a format, whatever its name, to its end.
///
/// # Errors
/// What is wrong with it.
pub fn looks_like(path: &Path, format: &WeatherFormat) -> Result<(), String> {
    let place = Place::File(path.to_owned());
    let head = place.head(HEAD_BYTES).map_err(|finding| finding.to_string())?;
    if head.starts_with(b"PK") {
        return check_archive(path);
    }
    if !format.reader().fits(&encoding_rs::UTF_8.decode(&head).0) {
        return Err(format!("it is not of the format {}, known by {}", format.name(), format.reader().known_by()));
    }
    match std::fs::read(path).map(|bytes| bytes.ends_with(b"\n")) {
        Ok(true) => Ok(()),
        Ok(false) => Err("its last line is not whole".to_owned()),
        Err(error) => Err(error.to_string()),
    }
}

/// Whether a file is one of the study's. What is not of its format, and nothing else that is known either, is taken too: that
/// it cannot be read is to be said.
fn is_meant(found: &Found, format: &dyn Format, in_folder: bool) -> bool {
    let Ok(head) = found.place.head(HEAD_BYTES) else { return true };
    let head = encoding_rs::UTF_8.decode(&head).0;
    if format.fits(&head) {
        return true;
    }
    if found.name.to_lowercase().contains("meta") {
        return false;
    }
    !in_folder || (extension(Path::new(&found.name)) == "csv" && WeatherFormat::of_text(&head).is_none())
}
