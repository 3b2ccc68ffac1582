//! The database as files for other tools: tables as Parquet and CSV, look-up tables for fleet planners, and the words that say
//! what is what.

mod chunk;
mod lut;
mod package;
mod tables;
mod words;

pub use chunk::{ChunkRow, chunk_bytes, chunk_rows};
pub use lut::{Loading, look_up_tables};
pub use tables::tables;
pub use words::{datasette, json, markdown, questions_markdown};

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use store::Relation;

/// The file that says what an export holds, and by which a folder is known as one.
pub const PACKAGE: &str = "datapackage.json";

/// What exports of any kind put into their folder, files and folders by name.
#[must_use]
pub fn names(relations: &[Relation]) -> Vec<&str> {
    let of_tables = relations.iter().map(|r| r.name.as_str());
    of_tables.chain([PACKAGE, lut::CONSUMPTION, lut::HVAC_POWER]).collect()
}

/// How tables are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Apache Parquet.
    Parquet,
    /// Comma-separated values; what is missing is empty.
    Csv,
}

impl Format {
    /// What files of the format end with.
    #[must_use]
    pub fn extension(self) -> &'static str {
        match self {
            Self::Parquet => "parquet",
            Self::Csv => "csv",
        }
    }
}

/// What the numbers come from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Provenance {
    /// Name of the study.
    pub study: String,
    /// BLAKE3 of the study with all defaults.
    pub study_hash: String,
    /// BLAKE3 over all inputs of the last run; empty before one.
    pub input_hash: String,
    /// Version of the program.
    pub program_version: String,
}

impl Provenance {
    fn pairs(&self) -> impl Iterator<Item = (&'static str, String)> {
        let Self { study, study_hash, input_hash, program_version } = self.clone();
        [("study", study), ("study_hash", study_hash), ("input_hash", input_hash), ("program_version", program_version)]
            .into_iter()
    }

    /// A name of lower-case letters, digits and hyphens, as data packages ask for.
    fn name(&self) -> String {
        let letter = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
        self.study.chars().map(letter).collect()
    }
}

/// Why nothing was exported.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The database.
    #[error(transparent)]
    Store(#[from] store::StoreError),
    /// A file or folder cannot be written.
    #[error("cannot write {path}: {error}; check permissions and free space", path = .0.display(), error = .1)]
    Write(PathBuf, #[source] std::io::Error),
    /// A file cannot be made.
    #[error("cannot write {path}: {error}", path = .0.display(), error = .1)]
    Polars(PathBuf, #[source] polars::error::PolarsError),
    /// A look-up table cannot be written.
    #[error("cannot write {path}: {error}", path = .0.display(), error = .1)]
    Csv(PathBuf, #[source] csv::Error),
    /// There are no samples to take weather from.
    #[error("the database has no samples to take weather, sun and doors from; run `busclimate run` first")]
    NoSamples,
}

/// Writes a file that lasts.
fn write_synced(path: &Path, text: &str) -> Result<(), ExportError> {
    let written = File::create(path).and_then(|mut file| {
        file.write_all(text.as_bytes())?;
        file.sync_all()
    });
    written.map_err(|e| ExportError::Write(path.to_owned(), e))
}

/// Makes the folder that a file lies in.
fn make_folder_of(path: &Path) -> Result<(), ExportError> {
    let Some(folder) = path.parent() else { return Ok(()) };
    std::fs::create_dir_all(folder).map_err(|e| ExportError::Write(folder.to_owned(), e))
}
