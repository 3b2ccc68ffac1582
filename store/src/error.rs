//! Why the database cannot be used.

use sqlx::migrate::MigrateError;
use std::path::{Path, PathBuf};

/// The database cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// The file cannot be opened.
    #[error("cannot open the database {path}: {source}; check the path, its permissions and the free space")]
    Open {
        /// The file.
        path: PathBuf,
        /// What SQLite says.
        source: sqlx::Error,
    },
    /// There is no such file.
    #[error("there is no database {0}; run the study first")]
    Missing(PathBuf),
    /// A file without a single table.
    #[error(
        "the database {0} holds nothing: no run has begun on it, or it is a copy by `cp` of one that a run was writing; copy with \
         `busclimate backup`"
    )]
    Empty(PathBuf),
    /// The database is that of another study.
    #[error("the database {path} holds the study {holds:?}, not {asked:?}; give this study a `database` of its own")]
    OtherStudy {
        /// The file.
        path: PathBuf,
        /// The study that it holds.
        holds: String,
        /// The study that asks for it.
        asked: String,
    },
    /// A SQLite database that is none of ours.
    #[error("{0} is a SQLite database of something else; it is left as it is: name another file as `database`")]
    Foreign(PathBuf),
    /// The schema is one of a version to come.
    #[error("the database {0} was written by a newer version of busclimate; update the program")]
    Newer(PathBuf),
    /// The schema cannot be brought up to date.
    #[error(
        "the schema of the database {path} cannot be brought up to date: {source}; check its permissions and the free space"
    )]
    Schema {
        /// The file.
        path: PathBuf,
        /// What does not fit.
        source: MigrateError,
    },
    /// Something stored is not as it was written.
    #[error(
        "the database {path} is damaged: {what} is not as it was written; restore the last backup, or move the file away: a run \
         makes it anew (`busclimate verify` looks at all of it)"
    )]
    Damaged {
        /// The file.
        path: PathBuf,
        /// Table, and row where it is known.
        what: String,
    },
    /// A statement failed.
    #[error("the database {path} refused a statement: {error}; check its permissions and the free space")]
    Refused {
        /// The file.
        path: PathBuf,
        /// What SQLite says.
        error: sqlx::Error,
    },
    /// The same on its way to where the file is known; nothing public ends with it.
    #[error("the database refused a statement: {0}")]
    Statement(#[from] sqlx::Error),
    /// A sample refers to a mission file that is not stored.
    #[error("the sample of mission {0:?} refers to a file that the database does not hold")]
    UnknownFile(String),
    /// An optimum refers to what is not stored.
    #[error("an optimum refers to row {id} of {table}, which the database does not hold")]
    UnknownPoint {
        /// The table.
        table: &'static str,
        /// The row's id.
        id: i64,
    },
    /// The thread that drives the database could not start.
    #[error("cannot start the database runtime: {0}")]
    Runtime(std::io::Error),
}

/// What SQLite calls a file whose pages do not fit together, and one that is no database (`SQLITE_CORRUPT`, `SQLITE_NOTADB`).
const MALFORMED: [u32; 2] = [11, 26];

impl StoreError {
    /// The error of a statement with the file's name; values that mean nothing are damage.
    pub(crate) fn of(self, path: &Path) -> Self {
        let Self::Statement(error) = self else { return self };
        let malformed = match &error {
            sqlx::Error::Database(e) => {
                // The lower byte is the kind, the upper ones say more.
                let code = e.code().and_then(|code| code.parse::<u32>().ok());
                code.is_some_and(|code| MALFORMED.contains(&(code & 0xff)))
            }
            sqlx::Error::ColumnDecode { .. } => true,
            _ => false,
        };
        let path = path.to_owned();
        if malformed { Self::Damaged { path, what: error.to_string() } } else { Self::Refused { path, error } }
    }
}
