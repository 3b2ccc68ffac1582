//! Opening the database, and the one runtime that drives it.

use sqlx::migrate::{MigrateError, Migrator};
use sqlx::sqlite::{SqliteConnectOptions, SqliteConnection, SqliteJournalMode, SqliteSynchronous};
use sqlx::{ConnectOptions, Connection, Row};
use std::future::Future;
use std::path::{Path, PathBuf};
use std::time::Duration;
use tokio::runtime::Runtime;

static MIGRATIONS: Migrator = sqlx::migrate!("../migrations");

/// How long a statement waits for another writer to finish its transaction.
const BUSY_TIMEOUT: Duration = Duration::from_secs(10);

/// A connection to an experiment database.
#[derive(Debug)]
pub struct Store {
    runtime: Runtime,
    pub(crate) connection: SqliteConnection,
    path: PathBuf,
}

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
    /// The schema is not one that this program knows.
    #[error(
        "the schema of the database {path} does not fit this program: {source}; it was probably written by a newer version"
    )]
    Schema {
        /// The file.
        path: PathBuf,
        /// What does not fit.
        source: MigrateError,
    },
    /// A statement failed.
    #[error("the database refused a statement: {0}")]
    Statement(#[from] sqlx::Error),
    /// A sample refers to a mission file that is not stored.
    #[error("the sample of mission {0:?} refers to a file that the database does not hold")]
    UnknownFile(String),
    /// The thread that drives the database could not start.
    #[error("cannot start the database runtime: {0}")]
    Runtime(std::io::Error),
}

impl Store {
    /// Opens the database for writing; creates it and brings its schema up to date.
    ///
    /// # Errors
    /// [`StoreError`] where the file cannot be opened or its schema is unknown.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let options = SqliteConnectOptions::new()
            .filename(path)
            .create_if_missing(true)
            .journal_mode(SqliteJournalMode::Wal)
            .synchronous(SqliteSynchronous::Normal)
            .foreign_keys(true)
            .busy_timeout(BUSY_TIMEOUT)
            // 64 MiB of pages: a study's tables are read back from memory.
            .pragma("cache_size", "-65536")
            // Folds the log into the file every 64 MiB instead of every 4: each time waits for the disk twice.
            .pragma("wal_autocheckpoint", "16384");
        let mut store = Self::connect(path, &options)?;
        let migrated = {
            let Self { runtime, connection, .. } = &mut store;
            runtime.block_on(MIGRATIONS.run(connection))
        };
        migrated.map_err(|source| StoreError::Schema { path: path.to_owned(), source })?;
        Ok(store)
    }

    /// Opens an existing database for reading. One of an earlier version is brought up to date first, which needs to write.
    ///
    /// # Errors
    /// [`StoreError`] where there is none or it cannot be opened.
    pub fn open_read_only(path: &Path) -> Result<Self, StoreError> {
        if !path.exists() {
            return Err(StoreError::Missing(path.to_owned()));
        }
        let options = SqliteConnectOptions::new()
            .filename(path)
            .read_only(true)
            .busy_timeout(BUSY_TIMEOUT)
            .pragma("cache_size", "-65536");
        let mut store = Self::connect(path, &options)?;
        if store.is_current()? {
            return Ok(store);
        }
        store.close()?;
        Self::open(path)?.close()?;
        Self::connect(path, &options)
    }

    /// Whether the schema is that of this program.
    fn is_current(&mut self) -> Result<bool, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT count(*) AS applied FROM _sqlx_migrations WHERE success";
            let row = sqlx::query(sql).fetch_one(c).await?;
            Ok(row.try_get::<i64, _>("applied")? >= MIGRATIONS.iter().count() as i64)
        })
    }

    fn connect(path: &Path, options: &SqliteConnectOptions) -> Result<Self, StoreError> {
        let runtime =
            tokio::runtime::Builder::new_current_thread().enable_time().build().map_err(StoreError::Runtime)?;
        let options = options.clone().disable_statement_logging();
        let connection =
            runtime.block_on(options.connect()).map_err(|source| StoreError::Open { path: path.to_owned(), source })?;
        Ok(Self { runtime, connection, path: path.to_owned() })
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Closes the connection after it has folded the write-ahead log into the database file.
    ///
    /// # Errors
    /// [`StoreError::Statement`] where the last writes cannot be completed.
    pub fn close(self) -> Result<(), StoreError> {
        Ok(self.runtime.block_on(self.connection.close())?)
    }

    /// Runs a future that works on the connection.
    pub(crate) fn drive<T>(
        &mut self,
        work: impl AsyncFnOnce(&mut SqliteConnection) -> Result<T, StoreError>,
    ) -> Result<T, StoreError> {
        let Self { runtime, connection, .. } = self;
        block_on(runtime, work(connection))
    }
}

fn block_on<T>(runtime: &Runtime, future: impl Future<Output = T>) -> T {
    runtime.block_on(future)
}
