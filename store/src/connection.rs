//! Opening the database, and the one runtime that drives it.

use sqlx::migrate::Migrator;
use sqlx::sqlite::{SqliteConnectOptions, SqliteConnection, SqliteJournalMode, SqliteSynchronous};
use sqlx::{ConnectOptions, Connection, Row};
use std::fs::File;
use std::future::Future;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use tokio::runtime::Runtime;

use crate::checks::Damage;
use crate::{StoreError, dictionary};

static MIGRATIONS: Migrator = sqlx::migrate!("../migrations");

/// How long a statement waits for another writer to finish its transaction.
const BUSY_TIMEOUT: Duration = Duration::from_secs(10);

/// How long a writer waits at its start for readers to leave. Those of one process share their lock and may overlap for long.
const PATIENCE: Duration = Duration::from_secs(60);

/// A connection to an experiment database.
#[derive(Debug)]
pub struct Store {
    runtime: Runtime,
    pub(crate) connection: SqliteConnection,
    path: PathBuf,
    read_only: bool,
    refuses_damage: bool,
}

/// The file whose lock the writer of a database holds.
#[must_use]
pub fn lock_path(database: &Path) -> PathBuf {
    let mut path = database.as_os_str().to_owned();
    path.push(".lock");
    PathBuf::from(path)
}

/// Rows that SQLite's thread reads ahead: with fewer, the two threads wait for each other.
pub(crate) const ROWS_AHEAD: usize = 1024;

/// Whether a transaction is half written in the file, or one is being written.
fn has_journal(path: &Path) -> bool {
    let mut journal = path.as_os_str().to_owned();
    journal.push("-journal");
    Path::new(&journal).exists()
}

/// How a database is read.
fn reading(path: &Path) -> SqliteConnectOptions {
    SqliteConnectOptions::new()
        .filename(path)
        .read_only(true)
        .busy_timeout(BUSY_TIMEOUT)
        .row_buffer_size(ROWS_AHEAD)
        // 64 MiB of pages: a study's tables are read back from memory.
        .pragma("cache_size", "-65536")
}

impl Store {
    /// Opens the database for writing; creates it and brings its schema up to date. A file of something else, or of a newer
    /// version, is only read.
    ///
    /// # Errors
    /// [`StoreError`] where the file cannot be opened or its schema is unknown.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        if path.exists() {
            Self::roll_back(path);
            let mut looked_at = Self::connect(path, &reading(path), true)?;
            let current = looked_at.is_current();
            looked_at.close()?;
            current?;
        }
        let options = SqliteConnectOptions::new()
            .filename(path)
            .create_if_missing(true)
            .journal_mode(SqliteJournalMode::Wal)
            .synchronous(SqliteSynchronous::Normal)
            .foreign_keys(true)
            .busy_timeout(PATIENCE)
            .row_buffer_size(ROWS_AHEAD)
            // 64 MiB of pages: a study's tables are read back from memory.
            .pragma("cache_size", "-65536")
            // Folds the log into the file every 64 MiB instead of every 4: each time waits for the disk twice.
            .pragma("wal_autocheckpoint", "16384");
        let mut store = Self::connect(path, &options, false)?;
        let migrated = {
            let Self { runtime, connection, .. } = &mut store;
            runtime.block_on(MIGRATIONS.run(connection))
        };
        migrated.map_err(|source| StoreError::Schema { path: path.to_owned(), source })?;
        store.drive(async |c| dictionary::describe(c).await)?;
        Ok(store)
    }

    /// An empty database that goes with the value: what there is where there is none yet.
    ///
    /// # Errors
    /// [`StoreError::Schema`].
    pub fn in_memory() -> Result<Self, StoreError> {
        let path = Path::new(":memory:");
        let mut store = Self::connect(path, &SqliteConnectOptions::new().filename(path), false)?;
        let Self { runtime, connection, .. } = &mut store;
        let migrated = runtime.block_on(MIGRATIONS.run(connection));
        migrated.map_err(|source| StoreError::Schema { path: path.to_owned(), source })?;
        store.drive(async |c| dictionary::describe(c).await)?;
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
        Self::roll_back_for_reader(path);
        let options = reading(path);
        let mut store = Self::connect(path, &options, true)?;
        if store.is_current()? {
            return Ok(store);
        }
        store.close()?;
        Self::bring_up_to_date(path, &options)?;
        Self::connect(path, &options, true)
    }

    /// Undoes the transaction that a killed run has left half written in the file, which SQLite does at the first read of somebody
    /// who may write. Where it cannot be done, the next reading says so. Whoever calls holds the lock.
    fn roll_back(path: &Path) {
        if has_journal(path) {
            let options = SqliteConnectOptions::new().filename(path).busy_timeout(BUSY_TIMEOUT);
            let _ = Self::connect(path, &options, true).and_then(|mut store| {
                store.is_empty()?;
                store.close()
            });
        }
    }

    /// The same for a reader, who takes the lock for it where no run has it: a run's journal is its own.
    fn roll_back_for_reader(path: &Path) {
        if !has_journal(path) {
            return;
        }
        let lock = lock_path(path);
        let Ok(file) = File::options().write(true).create(true).truncate(false).open(&lock) else { return };
        if file.try_lock().is_err() {
            return;
        }
        Self::roll_back(path);
        let _ = std::fs::remove_file(&lock);
    }

    /// Renews the schema for a reader, or waits for the run that is about to: only one of them may.
    fn bring_up_to_date(path: &Path, options: &SqliteConnectOptions) -> Result<(), StoreError> {
        let (lock, since) = (lock_path(path), Instant::now());
        let cannot = |source| StoreError::Open { path: path.to_owned(), source: sqlx::Error::Io(source) };
        while since.elapsed() < BUSY_TIMEOUT {
            let file = File::options().write(true).create(true).truncate(false).open(&lock).map_err(cannot)?;
            if file.try_lock().is_ok() {
                // No run is about to fill it.
                let mut store = Self::connect(path, options, true)?;
                let empty = store.is_empty()?;
                store.close()?;
                let renewed = match empty {
                    true => Err(StoreError::Empty(path.to_owned())),
                    false => Self::open(path).and_then(Self::close),
                };
                let _ = std::fs::remove_file(&lock);
                return renewed;
            }
            std::thread::sleep(Duration::from_millis(20));
            let mut store = Self::connect(path, options, true)?;
            let current = store.is_current();
            store.close()?;
            if current? {
                return Ok(());
            }
        }
        Err(cannot(std::io::Error::new(std::io::ErrorKind::WouldBlock, "a run is bringing it up to date")))
    }

    fn is_empty(&mut self) -> Result<bool, StoreError> {
        self.drive(async |c| {
            let row = sqlx::query("SELECT count(*) AS tables FROM sqlite_schema").fetch_one(c).await?;
            Ok(row.try_get::<i64, _>("tables")? == 0)
        })
    }

    /// Whether the schema is that of this program; not yet that of a new or earlier database. That of a newer version, or of
    /// something else, is an error.
    fn is_current(&mut self) -> Result<bool, StoreError> {
        let path = self.path.clone();
        self.drive(async |c| {
            let sql =
                "SELECT count(*) AS tables, coalesce(sum(name = '_sqlx_migrations'), 0) AS ours FROM sqlite_schema";
            let row = sqlx::query(sql).fetch_one(&mut *c).await?;
            match (row.try_get::<i64, _>("tables")?, row.try_get::<i64, _>("ours")?) {
                (0, _) => return Ok(false),
                (_, 0) => return Err(StoreError::Foreign(path)),
                _ => {}
            }
            let sql = "SELECT coalesce(max(version), 0) AS newest FROM _sqlx_migrations WHERE success";
            let newest: i64 = sqlx::query(sql).fetch_one(c).await?.try_get("newest")?;
            let ours = MIGRATIONS.iter().map(|m| m.version).max().unwrap_or(0);
            if newest > ours { Err(StoreError::Newer(path)) } else { Ok(newest == ours) }
        })
    }

    /// Checks that the database is that of a study; a new one becomes it.
    ///
    /// # Errors
    /// [`StoreError::OtherStudy`] where it holds another one.
    pub fn belongs_to(&mut self, study: &str) -> Result<(), StoreError> {
        let (path, read_only) = (self.path.clone(), self.read_only);
        self.drive(async |c| {
            let row = sqlx::query("SELECT name FROM study").fetch_optional(&mut *c).await?;
            match row.map(|r| r.try_get::<String, _>("name")).transpose()? {
                Some(holds) if holds != study => Err(StoreError::OtherStudy { path, holds, asked: study.to_owned() }),
                Some(_) => Ok(()),
                None if read_only => Ok(()),
                None => {
                    sqlx::query("INSERT OR IGNORE INTO study VALUES (1, ?)").bind(study).execute(c).await?;
                    Ok(())
                }
            }
        })
    }

    fn connect(path: &Path, options: &SqliteConnectOptions, read_only: bool) -> Result<Self, StoreError> {
        let runtime =
            tokio::runtime::Builder::new_current_thread().enable_time().build().map_err(StoreError::Runtime)?;
        let options = options.clone().disable_statement_logging();
        let connection =
            runtime.block_on(options.connect()).map_err(|source| StoreError::Open { path: path.to_owned(), source })?;
        Ok(Self { runtime, connection, path: path.to_owned(), read_only, refuses_damage: true })
    }

    /// Reads several things as they are at one moment, whatever is written meanwhile.
    ///
    /// # Errors
    /// Those of `read`, and [`StoreError::Refused`].
    pub fn at_one_moment<T, E: From<StoreError>>(
        &mut self,
        read: impl FnOnce(&mut Self) -> Result<T, E>,
    ) -> Result<T, E> {
        self.execute("BEGIN")?;
        let outcome = read(self);
        self.execute("COMMIT")?;
        outcome
    }

    fn execute(&mut self, sql: &'static str) -> Result<(), StoreError> {
        self.drive(async |c| {
            sqlx::query(sql).execute(c).await?;
            Ok(())
        })
    }

    /// Copies the database as it is at one moment into a new file, compact and without a log, while anything runs.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`] where the file is there already or cannot be written.
    pub fn copy_to(&mut self, path: &Path) -> Result<(), StoreError> {
        let target = path.to_string_lossy().into_owned();
        self.drive(async |c| {
            sqlx::query("VACUUM INTO ?").bind(target).execute(c).await?;
            Ok(())
        })
    }

    /// Closes the connection. One that wrote folds the write-ahead log into the database file first and leaves the file alone
    /// at its place, readable without a log; while others read, the last of them does that.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`] where the last writes cannot be completed.
    pub fn close(mut self) -> Result<(), StoreError> {
        if !self.read_only {
            self.drive(async |c| {
                sqlx::query("PRAGMA wal_checkpoint(TRUNCATE)").execute(&mut *c).await?;
                // Readers keep the log: then it stays, and says so by its answer.
                sqlx::query("PRAGMA busy_timeout = 0").execute(&mut *c).await?;
                let _ = sqlx::query("PRAGMA journal_mode = DELETE").fetch_optional(c).await;
                Ok(())
            })?;
        }
        Ok(self.runtime.block_on(self.connection.close())?)
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Reads damaged rows as they are from now on: for whoever looks at all checks.
    pub fn report_damage(&mut self) {
        self.refuses_damage = false;
    }

    /// Runs a future that works on the connection, told what is done about damaged rows.
    pub(crate) fn drive_checked<T>(
        &mut self,
        work: impl AsyncFnOnce(&mut SqliteConnection, Damage<'_>) -> Result<T, StoreError>,
    ) -> Result<T, StoreError> {
        let Self { runtime, connection, path, refuses_damage, .. } = self;
        let damage = if *refuses_damage { Damage::Refused(path) } else { Damage::Reported };
        block_on(runtime, work(connection, damage)).map_err(|error| error.of(path))
    }

    /// Runs a future that works on the connection.
    pub(crate) fn drive<T>(
        &mut self,
        work: impl AsyncFnOnce(&mut SqliteConnection) -> Result<T, StoreError>,
    ) -> Result<T, StoreError> {
        let Self { runtime, connection, path, .. } = self;
        block_on(runtime, work(connection)).map_err(|error| error.of(path))
    }
}

fn block_on<T>(runtime: &Runtime, future: impl Future<Output = T>) -> T {
    runtime.block_on(future)
}
