//! Input files, and what was noticed in them.

use ingest::{FileKind, FileRecord, Finding, FindingKind};
use sqlx::sqlite::SqliteConnection;
use sqlx::{Connection, Row};
use std::collections::BTreeMap;

use crate::row::{Insert, count, optional_time, time_text, word};
use crate::{Store, StoreError};

/// What the readings of the stored files were made from, by path.
pub type ReadingKeys = BTreeMap<String, String>;

impl Store {
    /// The reading keys of the files of a kind.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn reading_keys(&mut self, kind: FileKind) -> Result<ReadingKeys, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT path, reading_key FROM source_file WHERE kind = ? ORDER BY path";
            let rows = sqlx::query(sql).bind(kind.name()).fetch_all(c).await?;
            rows.iter().map(|r| Ok((r.try_get("path")?, r.try_get("reading_key")?))).collect()
        })
    }

    /// Puts a file into the database that gives no segments: weather, shade, or one that is refused. A file of the same path
    /// and another reading key is replaced, and with it whatever came from it.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn put_file(&mut self, file: &FileRecord, reading_key: &str) -> Result<(), StoreError> {
        self.drive(async |c| {
            let mut tx = c.begin().await?;
            replace_file(&mut tx, file, reading_key).await?;
            Ok(tx.commit().await?)
        })
    }

    /// Forgets the files of a kind whose path is not among `paths`, with all that came from them.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn keep_files(&mut self, kind: FileKind, paths: &[String]) -> Result<u64, StoreError> {
        let known = self.reading_keys(kind)?;
        self.drive(async |c| {
            let mut tx = c.begin().await?;
            let forgotten = forget_others(&mut tx, known.keys(), paths).await?;
            tx.commit().await?;
            Ok(forgotten)
        })
    }

    /// The input files by kind and path, with what was noticed in them.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn files(&mut self) -> Result<Vec<FileRecord>, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT source_file_id, kind, count, line, column_name, message FROM data_quality
                ORDER BY source_file_id, position";
            let mut findings: BTreeMap<i64, Vec<Finding>> = BTreeMap::new();
            for r in sqlx::query(sql).fetch_all(&mut *c).await? {
                let line: Option<i64> = r.try_get("line")?;
                findings.entry(r.try_get("source_file_id")?).or_default().push(Finding {
                    kind: word(&r, "kind", FindingKind::from_name)?,
                    count: count(&r, "count")?,
                    line: line.map(i64::cast_unsigned),
                    column: r.try_get("column_name")?,
                    message: r.try_get("message")?,
                });
            }
            let sql = "SELECT source_file_id, path, kind, blake3, bytes, rows, first_utc, last_utc,
                outcome = 'accepted' AS accepted FROM source_file ORDER BY kind, path";
            let rows = sqlx::query(sql).fetch_all(c).await?;
            rows.iter()
                .map(|r| {
                    Ok(FileRecord {
                        path: r.try_get("path")?,
                        kind: word(r, "kind", FileKind::from_name)?,
                        blake3: r.try_get("blake3")?,
                        bytes: count(r, "bytes")?,
                        rows: count(r, "rows")?,
                        first: optional_time(r, "first_utc")?,
                        last: optional_time(r, "last_utc")?,
                        accepted: r.try_get("accepted")?,
                        findings: findings.remove(&r.try_get("source_file_id")?).unwrap_or_default(),
                    })
                })
                .collect()
        })
    }
}

/// The row of a file, old or new; without segments and findings of an earlier reading.
pub(crate) async fn replace_file(
    c: &mut SqliteConnection,
    file: &FileRecord,
    reading_key: &str,
) -> Result<i64, StoreError> {
    let same = sqlx::query("SELECT source_file_id FROM source_file WHERE path = ? AND reading_key = ?")
        .bind(&file.path)
        .bind(reading_key)
        .fetch_optional(&mut *c)
        .await?;
    if same.is_none() {
        sqlx::query("DELETE FROM source_file WHERE path = ?").bind(&file.path).execute(&mut *c).await?;
    }
    let sql = "INSERT INTO source_file (path, kind, blake3, bytes, rows, first_utc, last_utc, outcome, reading_key)
        VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)
        ON CONFLICT (path) DO UPDATE SET kind = excluded.kind, blake3 = excluded.blake3, bytes = excluded.bytes,
            rows = excluded.rows, first_utc = excluded.first_utc, last_utc = excluded.last_utc,
            outcome = excluded.outcome
        RETURNING source_file_id";
    let id: i64 = sqlx::query(sql)
        .bind(&file.path)
        .bind(file.kind.name())
        .bind(&file.blake3)
        .bind(file.bytes.cast_signed())
        .bind(file.rows.cast_signed())
        .bind(file.first.map(time_text))
        .bind(file.last.map(time_text))
        .bind(if file.accepted { "accepted" } else { "refused" })
        .bind(reading_key)
        .fetch_one(&mut *c)
        .await?
        .try_get("source_file_id")?;
    sqlx::query("DELETE FROM data_quality WHERE source_file_id = ?").bind(id).execute(&mut *c).await?;
    sqlx::query("DELETE FROM mission_segment WHERE source_file_id = ?").bind(id).execute(&mut *c).await?;
    for (position, finding) in file.findings.iter().enumerate() {
        Insert::into("data_quality")
            .set("source_file_id", id)?
            .set("position", position as i64)?
            .set("kind", finding.kind.name())?
            .set("count", finding.count.cast_signed())?
            .set("line", finding.line.map(u64::cast_signed))?
            .set("column_name", finding.column.as_deref())?
            .set("message", finding.message.as_str())?
            .execute(c)
            .await?;
    }
    Ok(id)
}

pub(crate) async fn forget_others<'p>(
    c: &mut SqliteConnection,
    known: impl Iterator<Item = &'p String>,
    paths: &[String],
) -> Result<u64, StoreError> {
    let mut forgotten = 0;
    for path in known.filter(|path| !paths.contains(path)) {
        sqlx::query("DELETE FROM source_file WHERE path = ?").bind(path).execute(&mut *c).await?;
        forgotten += 1;
    }
    Ok(forgotten)
}
