//! Input files, and what was noticed in them.

use chrono::{DateTime, Utc};
use ingest::{FileKind, FileRecord, FileStamp, Finding, FindingKind};
use sqlx::sqlite::{SqliteConnection, SqliteRow};
use sqlx::{AssertSqlSafe, Row};
use std::collections::{BTreeMap, BTreeSet};

use crate::checks::{commit, whole};
use crate::row::{Insert, begin, count, optional_time, put_all, time, time_text, word};
use crate::{Store, StoreError};

/// A file that the database holds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KnownFile {
    /// What its reading was made from.
    pub reading_key: String,
    /// BLAKE3 of its content; empty where it was never read.
    pub blake3: String,
    /// Whether it is used.
    pub accepted: bool,
    /// How it looked then.
    pub stamp: Option<FileStamp>,
}

impl Store {
    /// The files of a kind by path.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn known_files(&mut self, kind: FileKind) -> Result<BTreeMap<String, KnownFile>, StoreError> {
        self.drive_checked(async |c, damage| {
            let sql = "SELECT f.*, f.outcome = 'accepted' AS accepted, s.bytes AS stamp_bytes, s.modified_ns, s.inode
                FROM source_file AS f LEFT JOIN file_stamp AS s USING (source_file_id)
                WHERE f.kind = ? ORDER BY f.path";
            let rows = sqlx::query(sql).bind(kind.name()).fetch_all(c).await?;
            whole(damage, "source_file", &rows)?;
            rows.iter()
                .map(|r| {
                    let (reading_key, blake3) = (r.try_get("reading_key")?, r.try_get("blake3")?);
                    let known = KnownFile { reading_key, blake3, accepted: r.try_get("accepted")?, stamp: stamp(r)? };
                    Ok((r.try_get("path")?, known))
                })
                .collect()
        })
    }

    /// Records how a file looks now, whose content is as it was.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn put_stamp(&mut self, path: &str, stamp: &FileStamp) -> Result<(), StoreError> {
        self.drive(async |c| {
            let sql = "SELECT source_file_id FROM source_file WHERE path = ?";
            let Some(row) = sqlx::query(sql).bind(path).fetch_optional(&mut *c).await? else { return Ok(()) };
            insert_stamp(c, row.try_get("source_file_id")?, stamp).await
        })
    }

    /// A file that lies elsewhere now, with all that came from it. Whatever was known of its new path is forgotten.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn move_file(&mut self, from: &str, to: &str) -> Result<(), StoreError> {
        self.drive(async |c| {
            let mut tx = begin(c).await?;
            sqlx::query("DELETE FROM source_file WHERE path = ?").bind(to).execute(&mut *tx).await?;
            sqlx::query("UPDATE source_file SET path = ? WHERE path = ?").bind(to).bind(from).execute(&mut *tx).await?;
            commit(tx).await
        })
    }

    /// Puts a file into the database that gives no segments: weather, shade, or one that is refused. A file of the same path
    /// and another reading key is replaced, and with it whatever came from it.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn put_file(&mut self, file: &FileRecord, reading_key: &str) -> Result<(), StoreError> {
        self.drive(async |c| {
            let mut tx = begin(c).await?;
            replace_file(&mut tx, file, reading_key).await?;
            commit(tx).await
        })
    }

    /// Forgets files, with all that came from them.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn forget_files(&mut self, paths: &BTreeSet<String>) -> Result<(), StoreError> {
        self.drive(async |c| {
            let mut tx = begin(c).await?;
            for path in paths {
                sqlx::query("DELETE FROM source_file WHERE path = ?").bind(path).execute(&mut *tx).await?;
            }
            commit(tx).await
        })
    }

    /// The files that are recorded as missing.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn missing_files(&mut self) -> Result<BTreeSet<String>, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT path FROM source_file JOIN data_quality AS q USING (source_file_id) WHERE q.kind = ?";
            let rows = sqlx::query(sql).bind(FindingKind::MissingFile.name()).fetch_all(c).await?;
            rows.iter().map(|r| Ok(r.try_get("path")?)).collect()
        })
    }

    /// Records which files are missing, and that others no longer are.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn put_missing(&mut self, paths: &BTreeSet<String>, message: &str) -> Result<(), StoreError> {
        if self.missing_files()? == *paths {
            return Ok(());
        }
        let kind = FindingKind::MissingFile.name();
        self.drive(async |c| {
            let mut tx = begin(c).await?;
            sqlx::query("DELETE FROM data_quality WHERE kind = ?").bind(kind).execute(&mut *tx).await?;
            for path in paths {
                let sql = "SELECT f.source_file_id, 1 + coalesce(max(position), -1) AS position
                    FROM source_file AS f LEFT JOIN data_quality USING (source_file_id) WHERE path = ? GROUP BY 1";
                let Some(row) = sqlx::query(sql).bind(path).fetch_optional(&mut *tx).await? else { continue };
                Insert::into("data_quality")
                    .set("source_file_id", row.try_get::<i64, _>("source_file_id")?)?
                    .set("position", row.try_get::<i64, _>("position")?)?
                    .set("kind", kind)?
                    .set("count", 1_i64)?
                    .set("message", message)?
                    .execute(&mut tx)
                    .await?;
            }
            commit(tx).await
        })
    }

    /// The last second of an accepted file of a kind, and the file.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn newest_file(&mut self, kind: FileKind) -> Result<Option<(DateTime<Utc>, String)>, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT last_utc, path FROM source_file WHERE kind = ? AND outcome = 'accepted' AND last_utc IS NOT NULL
                ORDER BY last_utc DESC, path LIMIT 1";
            let Some(r) = sqlx::query(sql).bind(kind.name()).fetch_optional(c).await? else { return Ok(None) };
            Ok(Some((time(&r, "last_utc")?, r.try_get("path")?)))
        })
    }

    /// The input files by kind and path, with what was noticed in them.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn files(&mut self) -> Result<Vec<FileRecord>, StoreError> {
        self.drive_checked(async |c, damage| {
            let sql = "SELECT * FROM data_quality ORDER BY source_file_id, position";
            let mut findings: BTreeMap<i64, Vec<Finding>> = BTreeMap::new();
            let rows = sqlx::query(sql).fetch_all(&mut *c).await?;
            whole(damage, "data_quality", &rows)?;
            for r in &rows {
                let line: Option<i64> = r.try_get("line")?;
                findings.entry(r.try_get("source_file_id")?).or_default().push(Finding {
                    kind: word(r, "kind", FindingKind::from_name)?,
                    count: count(r, "count")?,
                    line: line.map(i64::cast_unsigned),
                    column: r.try_get("column_name")?,
                    message: r.try_get("message")?,
                });
            }
            let sql = "SELECT f.*, f.outcome = 'accepted' AS accepted, s.bytes AS stamp_bytes, s.modified_ns, s.inode
                FROM source_file AS f LEFT JOIN file_stamp AS s USING (source_file_id) ORDER BY f.kind, f.path";
            let rows = sqlx::query(sql).fetch_all(c).await?;
            whole(damage, "source_file", &rows)?;
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
                        stamp: stamp(r)?,
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
    let sql = "SELECT source_file_id, reading_key = ? AS same FROM source_file WHERE path = ?";
    let known = sqlx::query(sql).bind(reading_key).bind(&file.path).fetch_optional(&mut *c).await?;
    if let Some(known) = known {
        let tables: &[&str] =
            if known.try_get("same")? { &["file_stamp", "data_quality", "mission_segment"] } else { &["source_file"] };
        for table in tables {
            // The text is built from constants alone.
            let sql = AssertSqlSafe(format!("DELETE FROM {table} WHERE source_file_id = ?"));
            sqlx::query(sql).bind(known.try_get::<i64, _>("source_file_id")?).execute(&mut *c).await?;
        }
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
    if let Some(stamp) = &file.stamp {
        insert_stamp(c, id, stamp).await?;
    }
    let findings: Vec<(i64, &Finding)> = (0..).zip(&file.findings).collect();
    put_all(c, "data_quality", &findings, |row, (position, finding)| {
        row.set("source_file_id", id)?
            .set("position", *position)?
            .set("kind", finding.kind.name())?
            .set("count", finding.count.cast_signed())?
            .set("line", finding.line.map(u64::cast_signed))?
            .set("column_name", finding.column.as_deref())?
            .set("message", finding.message.as_str())
    })
    .await?;
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

async fn insert_stamp(c: &mut SqliteConnection, file: i64, stamp: &FileStamp) -> Result<(), StoreError> {
    Insert::replacing("file_stamp")
        .set("source_file_id", file)?
        .set("bytes", stamp.bytes.cast_signed())?
        .set("modified_ns", stamp.modified_ns)?
        .set("inode", stamp.inode.cast_signed())?
        .execute(c)
        .await?;
    Ok(())
}

fn stamp(r: &SqliteRow) -> Result<Option<FileStamp>, sqlx::Error> {
    let Some(bytes) = r.try_get::<Option<i64>, _>("stamp_bytes")? else { return Ok(None) };
    let (bytes, inode) = (bytes.cast_unsigned(), count(r, "inode")?);
    Ok(Some(FileStamp { bytes, modified_ns: r.try_get("modified_ns")?, inode }))
}
