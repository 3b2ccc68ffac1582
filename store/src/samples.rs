//! Hourly samples, and segments that gave none.

use cabin::Disturbances;
use ingest::sample::{LocalClock, Sample};
use ingest::{ExcludedSegment, FileKind, FileRecord};
use sqlx::Row;
use sqlx::sqlite::{SqliteConnection, SqliteRow};
use std::collections::BTreeMap;

use crate::checks::{Damage, commit, whole};
use crate::files::{forget_others, replace_file};
use crate::missions::segment;
use crate::row::{Insert, begin, count, time_text};
use crate::{Store, StoreError};

impl Store {
    /// How many segments of accepted missions have neither a sample nor a reason why not.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn unjoined_segments(&mut self) -> Result<u64, StoreError> {
        let sql = "SELECT count(*) AS open FROM mission_segment AS g JOIN source_file AS f USING (source_file_id)
            WHERE f.outcome = 'accepted'
                AND NOT EXISTS (SELECT 1 FROM hourly_sample AS s
                    WHERE s.source_file_id = g.source_file_id AND s.segment = g.segment)
                AND NOT EXISTS (SELECT 1 FROM excluded_segment AS e
                    WHERE e.mission = g.mission AND e.segment = g.segment)";
        self.drive(async |c| Ok(count(&sqlx::query(sql).fetch_one(c).await?, "open")?))
    }

    /// Makes the samples and the excluded segments of the database exactly these, and with them the records of the files that
    /// they were joined with: weather and shade, each with its reading key. A sample with the values that are stored keeps its
    /// optima; those of a changed or withdrawn one go. Returns how many samples are new or changed, and how many went.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`]; [`StoreError::UnknownFile`] where a sample's file is not stored.
    pub fn put_samples(
        &mut self,
        samples: &[Sample],
        excluded: &[ExcludedSegment],
        joined_with: &[(FileRecord, String)],
    ) -> Result<(u64, u64), StoreError> {
        self.drive(async |c| {
            let mut tx = begin(c).await?;
            for kind in [FileKind::Weather, FileKind::Shadow] {
                let of_kind = || joined_with.iter().filter(|(f, _)| f.kind == kind);
                let paths: Vec<String> = of_kind().map(|(f, _)| f.path.clone()).collect();
                let sql = "SELECT path FROM source_file WHERE kind = ?";
                let rows = sqlx::query(sql).bind(kind.name()).fetch_all(&mut *tx).await?;
                let known = rows.iter().map(|r| r.try_get("path")).collect::<Result<Vec<String>, _>>()?;
                forget_others(&mut tx, known.iter(), &paths).await?;
                for (file, reading_key) in of_kind() {
                    replace_file(&mut tx, file, reading_key).await?;
                }
            }
            let files: BTreeMap<String, i64> = sqlx::query("SELECT path, source_file_id FROM source_file")
                .fetch_all(&mut *tx)
                .await?
                .iter()
                .map(|r| Ok((r.try_get("path")?, r.try_get("source_file_id")?)))
                .collect::<Result<_, sqlx::Error>>()?;
            let mut stored = stored_samples(&mut tx, Damage::Reported).await?;
            let mut changed = 0;
            for sample in samples {
                let unknown = || StoreError::UnknownFile(sample.segment.mission.clone());
                let file = *files.get(&sample.segment.source_path).ok_or_else(unknown)?;
                match stored.remove(&sample.id) {
                    Some(s) if s == *sample => {}
                    // The same values, made from something that differs elsewhere, or by another clock.
                    Some(s) if (Sample { key: sample.key.clone(), clock: sample.clock, ..s.clone() }) == *sample => {
                        if s.clock != sample.clock {
                            put_clock(&mut tx, sample).await?;
                            // Its optima stay, what they come to by the hour does not.
                            let sql = "INSERT OR IGNORE INTO stale_month VALUES (?)";
                            sqlx::query(sql).bind(sample.month).execute(&mut *tx).await?;
                        }
                        let sql = "UPDATE hourly_sample SET sample_key = ? WHERE sample_id = ?";
                        sqlx::query(sql).bind(&sample.key).bind(sample.id).execute(&mut *tx).await?;
                    }
                    _ => {
                        changed += 1;
                        insert_sample(&mut tx, file, sample).await?;
                    }
                }
            }
            for id in stored.keys() {
                sqlx::query("DELETE FROM hourly_sample WHERE sample_id = ?").bind(id).execute(&mut *tx).await?;
            }
            put_excluded(&mut tx, excluded).await?;
            commit(tx).await?;
            Ok((changed, stored.len() as u64))
        })
    }

    /// All samples by id.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn samples(&mut self) -> Result<Vec<Sample>, StoreError> {
        self.drive_checked(async |c, damage| Ok(stored_samples(c, damage).await?.into_values().collect()))
    }
}

/// Makes the excluded segments exactly these; those that are there already stay.
async fn put_excluded(c: &mut SqliteConnection, excluded: &[ExcludedSegment]) -> Result<(), StoreError> {
    let mut stored: BTreeMap<(String, u32), (String, String)> = BTreeMap::new();
    for r in sqlx::query("SELECT * FROM excluded_segment").fetch_all(&mut *c).await? {
        let key = (r.try_get("mission")?, r.try_get("segment")?);
        stored.insert(key, (r.try_get("start_utc")?, r.try_get("reason")?));
    }
    for e in excluded {
        let (key, value) = ((e.mission.clone(), e.segment), (time_text(e.start), e.reason.clone()));
        if stored.remove(&key).is_some_and(|before| before == value) {
            continue;
        }
        let row = Insert::replacing("excluded_segment").set("mission", key.0)?.set("segment", key.1)?;
        row.set("start_utc", value.0)?.set("reason", value.1)?.execute(c).await?;
    }
    for (mission, segment) in stored.keys() {
        let sql = "DELETE FROM excluded_segment WHERE mission = ? AND segment = ?";
        sqlx::query(sql).bind(mission).bind(segment).execute(&mut *c).await?;
    }
    Ok(())
}

async fn insert_sample(c: &mut SqliteConnection, file: i64, s: &Sample) -> Result<(), StoreError> {
    // A changed sample is deleted first, which takes its optima along.
    sqlx::query("DELETE FROM hourly_sample WHERE sample_id = ?").bind(s.id).execute(&mut *c).await?;
    let (segment, d) = (&s.segment, &s.disturbances);
    Insert::into("hourly_sample")
        .set("sample_id", s.id)?
        .set("source_file_id", file)?
        .set("mission", segment.mission.as_str())?
        .set("bus", segment.bus)?
        .set("segment", segment.segment)?
        .set("first_line", segment.first_line.cast_signed())?
        .set("last_line", segment.last_line.cast_signed())?
        .set("start_utc", time_text(segment.start))?
        .set("duration_s", segment.duration_s)?
        .set("month", s.month)?
        .set("ambient_temperature_k", d.ambient_temperature_k)?
        .set("dni_w_m2", d.dni_w_m2)?
        .set("dhi_w_m2", d.dhi_w_m2)?
        .set("passengers", d.passengers)?
        .set("door_open_fraction", d.door_open_fraction)?
        .set("solar_altitude_rad", d.solar_altitude_rad)?
        .set("solar_azimuth_rad", s.solar_azimuth_rad)?
        .set("shadow_fraction", d.shadow_fraction)?
        .set("interpolated_s", s.interpolated_s)?
        .set("sample_key", s.key.as_str())?
        .execute(&mut *c)
        .await?;
    put_clock(c, s).await
}

async fn put_clock(c: &mut SqliteConnection, s: &Sample) -> Result<(), StoreError> {
    let Some(clock) = s.clock else { return Ok(()) };
    let row = Insert::replacing("sample_clock").set("sample_id", s.id)?;
    row.set("local_hour", clock.hour)?.set("weekday", clock.weekday)?.execute(c).await.map(|_| ())
}

fn clock(r: &SqliteRow) -> Result<Option<LocalClock>, sqlx::Error> {
    let hour: Option<u8> = r.try_get("local_hour")?;
    hour.map(|hour| Ok(LocalClock { hour, weekday: r.try_get("weekday")? })).transpose()
}

pub(crate) fn sample(r: &SqliteRow) -> Result<Sample, sqlx::Error> {
    let segment = segment(r)?;
    Ok(Sample {
        id: r.try_get("sample_id")?,
        month: r.try_get("month")?,
        disturbances: Disturbances {
            ambient_temperature_k: r.try_get("ambient_temperature_k")?,
            dni_w_m2: r.try_get("dni_w_m2")?,
            dhi_w_m2: r.try_get("dhi_w_m2")?,
            solar_altitude_rad: r.try_get("solar_altitude_rad")?,
            shadow_fraction: r.try_get("shadow_fraction")?,
            passengers: segment.passengers,
            door_open_fraction: segment.door_open_fraction,
        },
        solar_azimuth_rad: r.try_get("solar_azimuth_rad")?,
        interpolated_s: r.try_get("interpolated_s")?,
        clock: clock(r)?,
        key: r.try_get("sample_key")?,
        segment,
    })
}

async fn stored_samples(c: &mut SqliteConnection, damage: Damage<'_>) -> Result<BTreeMap<i64, Sample>, StoreError> {
    let sql = "SELECT s.*, f.path AS source_path, g.distance_m, g.vehicle_power_w, g.route, k.local_hour, k.weekday
        FROM hourly_sample AS s JOIN source_file AS f USING (source_file_id)
        LEFT JOIN sample_clock AS k ON k.sample_id = s.sample_id
        LEFT JOIN mission_segment AS g ON g.source_file_id = s.source_file_id AND g.segment = s.segment";
    let rows = sqlx::query(sql).fetch_all(c).await?;
    whole(damage, "hourly_sample", &rows)?;
    rows.iter().map(sample).map(|s| s.map(|s| (s.id, s)).map_err(StoreError::from)).collect()
}
