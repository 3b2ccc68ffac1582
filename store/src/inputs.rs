//! Input files, mission segments and samples.

use sqlx::sqlite::SqliteConnection;
use sqlx::{Connection, Row};
use std::collections::BTreeMap;

use crate::simulations::{LoadRow, encode_loads};
use crate::{ExclusionRow, FileRow, SampleRow, SegmentRow, Store, StoreError};

/// A file that the database holds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KnownFile {
    /// Path as the study names it.
    pub path: String,
    /// BLAKE3 of the content and of the settings that it was read with.
    pub reading_key: String,
    /// Whether it is used.
    pub accepted: bool,
}

impl Store {
    /// The files of a kind that the database holds, by path.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn known_files(&mut self, kind: &str) -> Result<Vec<KnownFile>, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT path, reading_key, outcome = 'accepted' FROM source_file WHERE kind = ? ORDER BY path";
            let rows = sqlx::query(sql).bind(kind).fetch_all(c).await?;
            rows.iter()
                .map(|r| Ok(KnownFile { path: r.try_get(0)?, reading_key: r.try_get(1)?, accepted: r.try_get(2)? }))
                .collect()
        })
    }

    /// Puts a file with its segments into the database. A file of the same path is replaced, and with it its segments,
    /// samples and their optima; with an unchanged `reading_key` only its record is renewed.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn put_file(&mut self, file: &FileRow, segments: &[SegmentRow]) -> Result<(), StoreError> {
        self.put_mission(file, segments, &[])
    }

    /// As [`Store::put_file`], with what passengers and doors of the mission do in time.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn put_mission(
        &mut self,
        file: &FileRow,
        segments: &[SegmentRow],
        loads: &[LoadRow],
    ) -> Result<(), StoreError> {
        self.drive(async |c| {
            let mut tx = c.begin().await?;
            let same = sqlx::query("SELECT source_file_id FROM source_file WHERE path = ? AND reading_key = ?")
                .bind(&file.path)
                .bind(&file.reading_key)
                .fetch_optional(&mut *tx)
                .await?;
            if same.is_none() {
                sqlx::query("DELETE FROM source_file WHERE path = ?").bind(&file.path).execute(&mut *tx).await?;
            }
            let id = insert_file(&mut tx, file).await?;
            sqlx::query("DELETE FROM mission_segment WHERE source_file_id = ?").bind(id).execute(&mut *tx).await?;
            for segment in segments {
                insert_segment(&mut tx, id, segment).await?;
            }
            if !loads.is_empty() {
                sqlx::query("INSERT OR REPLACE INTO mission_load VALUES (?, ?)")
                    .bind(id)
                    .bind(encode_loads(loads))
                    .execute(&mut *tx)
                    .await?;
            }
            Ok(tx.commit().await?)
        })
    }

    /// Forgets the files of a kind whose path is not among `paths`, with all that came from them.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn keep_files(&mut self, kind: &str, paths: &[String]) -> Result<u64, StoreError> {
        let known = self.known_files(kind)?;
        self.drive(async |c| {
            let mut tx = c.begin().await?;
            let mut forgotten = 0;
            for file in known.iter().filter(|f| !paths.contains(&f.path)) {
                sqlx::query("DELETE FROM source_file WHERE path = ?").bind(&file.path).execute(&mut *tx).await?;
                forgotten += 1;
            }
            tx.commit().await?;
            Ok(forgotten)
        })
    }

    /// The segments of all accepted mission files, with the path of each one's file, by mission and number.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn segments(&mut self) -> Result<Vec<(String, SegmentRow)>, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT f.path, g.mission, g.bus, g.segment, g.start_utc, g.duration_s, g.passengers,
                    g.door_open_fraction, g.first_line, g.last_line, g.excluded
                FROM mission_segment AS g JOIN source_file AS f USING (source_file_id)
                WHERE f.outcome = 'accepted' ORDER BY g.mission, g.segment";
            let rows = sqlx::query(sql).fetch_all(c).await?;
            rows.iter()
                .map(|r| {
                    let excluded: Option<String> = r.try_get(10)?;
                    let content = match excluded {
                        Some(reason) => Err(reason),
                        None => {
                            let [first, last] = [r.try_get::<i64, _>(8)?, r.try_get(9)?].map(i64::cast_unsigned);
                            Ok((r.try_get(6)?, r.try_get(7)?, first, last))
                        }
                    };
                    let segment = SegmentRow {
                        mission: r.try_get(1)?,
                        bus: r.try_get(2)?,
                        segment: r.try_get(3)?,
                        start_utc: r.try_get(4)?,
                        duration_s: r.try_get(5)?,
                        content,
                    };
                    Ok((r.try_get(0)?, segment))
                })
                .collect()
        })
    }

    /// Makes the samples and the excluded segments of the database exactly these. A sample that has not changed keeps
    /// its optima; those of a changed or withdrawn one go. Returns how many samples are new or changed, and how many
    /// went.
    ///
    /// # Errors
    /// [`StoreError::Statement`]; [`StoreError::UnknownFile`] where a sample's file is not stored.
    pub fn put_samples(
        &mut self,
        samples: &[SampleRow],
        exclusions: &[ExclusionRow],
    ) -> Result<(u64, u64), StoreError> {
        self.drive(async |c| {
            let mut tx = c.begin().await?;
            let files: BTreeMap<String, i64> = sqlx::query("SELECT path, source_file_id FROM source_file")
                .fetch_all(&mut *tx)
                .await?
                .iter()
                .map(|r| Ok((r.try_get(0)?, r.try_get(1)?)))
                .collect::<Result<_, sqlx::Error>>()?;
            let mut stored = stored_samples(&mut tx).await?;
            let mut changed = 0;
            for sample in samples {
                let unknown = || StoreError::UnknownFile(sample.mission.clone());
                let file = *files.get(&sample.source_path).ok_or_else(unknown)?;
                if stored.remove(&sample.sample_id).is_some_and(|s| s == *sample) {
                    continue;
                }
                changed += 1;
                insert_sample(&mut tx, file, sample).await?;
            }
            for id in stored.keys() {
                sqlx::query("DELETE FROM hourly_sample WHERE sample_id = ?").bind(id).execute(&mut *tx).await?;
            }
            sqlx::query("DELETE FROM excluded_segment").execute(&mut *tx).await?;
            for e in exclusions {
                sqlx::query("INSERT INTO excluded_segment VALUES (?, ?, ?, ?)")
                    .bind(&e.mission)
                    .bind(e.segment)
                    .bind(&e.start_utc)
                    .bind(&e.reason)
                    .execute(&mut *tx)
                    .await?;
            }
            tx.commit().await?;
            Ok((changed, stored.len() as u64))
        })
    }

    /// All samples by id.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn samples(&mut self) -> Result<Vec<SampleRow>, StoreError> {
        self.drive(async |c| Ok(stored_samples(c).await?.into_values().collect()))
    }
}

async fn insert_file(c: &mut SqliteConnection, file: &FileRow) -> Result<i64, StoreError> {
    let sql = "INSERT INTO source_file
            (path, kind, blake3, bytes, rows, first_utc, last_utc, outcome, reading_key)
        VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)
        ON CONFLICT (path) DO UPDATE SET kind = excluded.kind, blake3 = excluded.blake3, bytes = excluded.bytes,
            rows = excluded.rows, first_utc = excluded.first_utc, last_utc = excluded.last_utc,
            outcome = excluded.outcome
        RETURNING source_file_id";
    let id: i64 = sqlx::query(sql)
        .bind(&file.path)
        .bind(&file.kind)
        .bind(&file.blake3)
        .bind(file.bytes.cast_signed())
        .bind(file.rows.cast_signed())
        .bind(&file.first_utc)
        .bind(&file.last_utc)
        .bind(if file.accepted { "accepted" } else { "refused" })
        .bind(&file.reading_key)
        .fetch_one(&mut *c)
        .await?
        .try_get(0)?;
    sqlx::query("DELETE FROM data_quality WHERE source_file_id = ?").bind(id).execute(&mut *c).await?;
    for (position, finding) in file.findings.iter().enumerate() {
        sqlx::query("INSERT INTO data_quality VALUES (?, ?, ?, ?, ?, ?, ?)")
            .bind(id)
            .bind(position as i64)
            .bind(&finding.kind)
            .bind(finding.count.cast_signed())
            .bind(finding.line.map(u64::cast_signed))
            .bind(&finding.column)
            .bind(&finding.message)
            .execute(&mut *c)
            .await?;
    }
    Ok(id)
}

async fn insert_segment(c: &mut SqliteConnection, file: i64, segment: &SegmentRow) -> Result<(), StoreError> {
    let content = segment.content.as_ref().ok();
    sqlx::query("INSERT INTO mission_segment VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
        .bind(file)
        .bind(segment.segment)
        .bind(&segment.mission)
        .bind(segment.bus)
        .bind(&segment.start_utc)
        .bind(segment.duration_s)
        .bind(content.map(|c| c.0))
        .bind(content.map(|c| c.1))
        .bind(content.map(|c| c.2.cast_signed()))
        .bind(content.map(|c| c.3.cast_signed()))
        .bind(segment.content.as_ref().err())
        .execute(c)
        .await?;
    Ok(())
}

async fn insert_sample(c: &mut SqliteConnection, file: i64, s: &SampleRow) -> Result<(), StoreError> {
    // A changed sample is deleted first, which takes its optima along.
    sqlx::query("DELETE FROM hourly_sample WHERE sample_id = ?").bind(s.sample_id).execute(&mut *c).await?;
    sqlx::query("INSERT INTO hourly_sample VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)")
        .bind(s.sample_id)
        .bind(file)
        .bind(&s.mission)
        .bind(s.bus)
        .bind(s.segment)
        .bind(s.first_line.cast_signed())
        .bind(s.last_line.cast_signed())
        .bind(&s.start_utc)
        .bind(s.duration_s)
        .bind(s.month)
        .bind(s.ambient_temperature_k)
        .bind(s.dni_w_m2)
        .bind(s.dhi_w_m2)
        .bind(s.passengers)
        .bind(s.door_open_fraction)
        .bind(s.solar_altitude_rad)
        .bind(s.solar_azimuth_rad)
        .bind(s.shadow_fraction)
        .bind(s.interpolated_s)
        .execute(c)
        .await?;
    Ok(())
}

async fn stored_samples(c: &mut SqliteConnection) -> Result<BTreeMap<i64, SampleRow>, StoreError> {
    let sql = "SELECT s.sample_id, s.mission, f.path, s.bus, s.segment, s.first_line, s.last_line, s.start_utc,
            s.duration_s, s.month, s.ambient_temperature_k, s.dni_w_m2, s.dhi_w_m2, s.passengers, s.door_open_fraction,
            s.solar_altitude_rad, s.solar_azimuth_rad, s.shadow_fraction, s.interpolated_s
        FROM hourly_sample AS s JOIN source_file AS f USING (source_file_id)";
    let rows = sqlx::query(sql).fetch_all(c).await?;
    rows.iter()
        .map(|r| {
            let sample_id = r.try_get(0)?;
            let sample = SampleRow {
                sample_id,
                mission: r.try_get(1)?,
                source_path: r.try_get(2)?,
                bus: r.try_get(3)?,
                segment: r.try_get(4)?,
                first_line: r.try_get::<i64, _>(5)?.cast_unsigned(),
                last_line: r.try_get::<i64, _>(6)?.cast_unsigned(),
                start_utc: r.try_get(7)?,
                duration_s: r.try_get(8)?,
                month: r.try_get(9)?,
                ambient_temperature_k: r.try_get(10)?,
                dni_w_m2: r.try_get(11)?,
                dhi_w_m2: r.try_get(12)?,
                passengers: r.try_get(13)?,
                door_open_fraction: r.try_get(14)?,
                solar_altitude_rad: r.try_get(15)?,
                solar_azimuth_rad: r.try_get(16)?,
                shadow_fraction: r.try_get(17)?,
                interpolated_s: r.try_get(18)?,
            };
            Ok((sample_id, sample))
        })
        .collect()
}
