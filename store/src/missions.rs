//! Missions: their segments, and how their load changes in time.

use cabin::LoadChange;
use ingest::ExcludedSegment;
use ingest::mission::{MissionReading, Segment};
use sqlx::Row;
use sqlx::sqlite::{SqliteConnection, SqliteRow};

use crate::checks::{commit, whole};
use crate::files::replace_file;
use crate::row::{Insert, begin, count, put_all, time, time_text};
use crate::{Store, StoreError};

/// A stored segment: its mission's reading key, and the segment or why there is none.
pub type StoredSegment = (String, Result<Segment, ExcludedSegment>);

impl Store {
    /// Puts missions with their reading keys into the database, all in one transaction: their files, their segments, and what
    /// passengers and doors do in time. Each replaces the mission of the same path, with its samples and whatever came from them.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn put_missions<'m>(
        &mut self,
        missions: impl IntoIterator<Item = (&'m MissionReading, &'m str)>,
    ) -> Result<(), StoreError> {
        self.drive(async |c| {
            let mut tx = begin(c).await?;
            for (reading, reading_key) in missions {
                put_mission(&mut tx, reading, reading_key).await?;
            }
            commit(tx).await
        })
    }

    /// The segments of all accepted mission files, by mission and number.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn segments(&mut self) -> Result<Vec<StoredSegment>, StoreError> {
        self.drive_checked(async |c, damage| {
            let sql = "SELECT g.*, f.path AS source_path, f.reading_key
                FROM mission_segment AS g JOIN source_file AS f USING (source_file_id)
                WHERE f.outcome = 'accepted' ORDER BY g.mission, g.segment";
            let rows = sqlx::query(sql).fetch_all(c).await?;
            whole(damage, "mission_segment", &rows)?;
            rows.iter()
                .map(|r| {
                    let excluded: Option<String> = r.try_get("excluded")?;
                    let content = match excluded {
                        Some(reason) => Err(ExcludedSegment {
                            mission: r.try_get("mission")?,
                            bus: r.try_get("bus")?,
                            segment: r.try_get("segment")?,
                            start: time(r, "start_utc")?,
                            duration_s: r.try_get("duration_s")?,
                            reason,
                        }),
                        None => Ok(segment(r)?),
                    };
                    Ok((r.try_get("reading_key")?, content))
                })
                .collect()
        })
    }

    /// How the load of a mission changes; nothing where nothing is stored.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn loads(&mut self, source_path: &str) -> Result<Vec<LoadChange>, StoreError> {
        self.drive_checked(async |c, damage| {
            let sql = "SELECT l.* FROM mission_load AS l JOIN source_file AS f USING (source_file_id) WHERE f.path = ?";
            let rows = sqlx::query(sql).bind(source_path).fetch_all(c).await?;
            whole(damage, "mission_load", &rows)?;
            let bytes: Vec<u8> = rows.first().map(|r| r.try_get("loads")).transpose()?.unwrap_or_default();
            Ok(bytes.chunks_exact(LOAD_BYTES).map(decode_load).collect())
        })
    }
}

async fn put_mission(c: &mut SqliteConnection, reading: &MissionReading, reading_key: &str) -> Result<(), StoreError> {
    let id = replace_file(c, &reading.file, reading_key).await?;
    put_all(c, "mission_segment", &reading.segments, |row, s| {
        row.set("source_file_id", id)?
            .set("segment", s.segment)?
            .set("mission", s.mission.as_str())?
            .set("bus", s.bus)?
            .set("start_utc", time_text(s.start))?
            .set("duration_s", s.duration_s)?
            .set("passengers", s.passengers)?
            .set("door_open_fraction", s.door_open_fraction)?
            .set("distance_m", s.distance_m)?
            .set("vehicle_power_w", s.vehicle_power_w)?
            .set("route", s.route.as_deref())?
            .set("first_line", s.first_line.cast_signed())?
            .set("last_line", s.last_line.cast_signed())
    })
    .await?;
    put_all(c, "mission_segment", &reading.excluded, |row, e| {
        row.set("source_file_id", id)?
            .set("segment", e.segment)?
            .set("mission", e.mission.as_str())?
            .set("bus", e.bus)?
            .set("start_utc", time_text(e.start))?
            .set("duration_s", e.duration_s)?
            .set("excluded", e.reason.as_str())
    })
    .await?;
    if !reading.loads.is_empty() {
        let row = Insert::replacing("mission_load").set("source_file_id", id)?;
        row.set("loads", encode_loads(&reading.loads))?.execute(c).await?;
    }
    Ok(())
}

pub(crate) fn segment(r: &SqliteRow) -> Result<Segment, sqlx::Error> {
    Ok(Segment {
        mission: r.try_get("mission")?,
        source_path: r.try_get("source_path")?,
        bus: r.try_get("bus")?,
        segment: r.try_get("segment")?,
        start: time(r, "start_utc")?,
        duration_s: r.try_get("duration_s")?,
        passengers: r.try_get("passengers")?,
        door_open_fraction: r.try_get("door_open_fraction")?,
        distance_m: r.try_get("distance_m")?,
        vehicle_power_w: r.try_get("vehicle_power_w")?,
        route: r.try_get("route")?,
        first_line: count(r, "first_line")?,
        last_line: count(r, "last_line")?,
    })
}

/// Bytes of a load change.
const LOAD_BYTES: usize = 13;

fn encode_loads(loads: &[LoadChange]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(loads.len() * LOAD_BYTES);
    for load in loads {
        bytes.extend(load.second.to_le_bytes());
        bytes.extend(load.passengers.to_le_bytes());
        // Shut, open, or between in steps.
        bytes.push(match load.door_open {
            0.0 => 0,
            1.0 => 1,
            between => 2 + (between * LoadChange::DOOR_STEPS).round() as u8,
        });
    }
    bytes
}

fn decode_load(bytes: &[u8]) -> LoadChange {
    let second = std::array::from_fn(|i| bytes[i]);
    let passengers = std::array::from_fn(|i| bytes[4 + i]);
    LoadChange {
        second: u32::from_le_bytes(second),
        passengers: f64::from_le_bytes(passengers),
        door_open: match bytes[12] {
            byte @ (0 | 1) => f64::from(byte),
            byte => f64::from(byte - 2) / LoadChange::DOOR_STEPS,
        },
    }
}
