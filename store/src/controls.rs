//! Missions under causal controllers: which are there, and writing them.

use sqlx::Row;
use sqlx::sqlite::SqliteConnection;
use std::collections::BTreeMap;

use crate::checks::commit;
use crate::row::{Insert, begin};
use crate::{Store, StoreError, StoredGrid};

/// What the controlled missions of a design are found by.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct ControlId {
    /// Path of the mission's file, as the study names it.
    pub source_path: String,
    /// Place of the design in the stored grid.
    pub design: usize,
}

/// A mission, to be stored with a design under all its controllers.
#[derive(Debug, Clone, PartialEq)]
pub struct ControlRow {
    /// What it is found by.
    pub id: ControlId,
    /// What it depends on, hashed.
    pub key: String,
    /// Name of the mission.
    pub mission: String,
    /// Local month of its start.
    pub month: u8,
    /// Mean ambient temperature in K.
    pub ambient_k: f64,
    /// What it comes to, or why it cannot be driven.
    pub result: Result<Vec<ControlledMission>, String>,
}

/// What a controller comes to on a mission, judged by a comfort window.
#[derive(Debug, Clone, PartialEq)]
pub struct ControlledMission {
    /// Name of the controller.
    pub controller: String,
    /// Place of the window in the stored grid.
    pub window: usize,
    /// Simulated seconds.
    pub seconds: u32,
    /// Mean HVAC power in W.
    pub mean_hvac_power_w: f64,
    /// The same of the steady-state optima within the window in W.
    pub static_mean_hvac_power_w: f64,
    /// Largest absolute 15-minute mean vote; `None` where nobody is ever on board.
    pub max_abs_pmv_15min: Option<f64>,
    /// Largest absolute vote of the steady-state optima.
    pub static_max_abs_pmv: f64,
    /// Mean absolute 15-minute vote of the passengers; `None` where nobody is ever on board.
    pub mean_abs_pmv: Option<f64>,
    /// The same of the steady-state optima.
    pub static_mean_abs_pmv: Option<f64>,
    /// Passengers times hours on board.
    pub passenger_hours: f64,
    /// Those with a 15-minute vote outside the window.
    pub passenger_hours_outside: f64,
    /// The same for each window that judges it besides, by its place in the stored grid.
    pub outside: Vec<(usize, f64)>,
    /// Share of the time at a power limit.
    pub saturated_fraction: f64,
    /// Root mean square of cabin temperature less setpoint in K, while the air unit is on.
    pub tracking_error_k: f64,
}

impl Store {
    /// The keys of all missions that were driven by controllers, or cannot be.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn control_keys(&mut self, grid: &StoredGrid) -> Result<BTreeMap<ControlId, String>, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT path, design_id, control_key
                FROM controlled_mission_key JOIN source_file USING (source_file_id)";
            let rows = sqlx::query(sql).fetch_all(c).await?;
            let keyed = |r: &sqlx::sqlite::SqliteRow| {
                let id = ControlId { source_path: r.try_get("path")?, design: grid.design(r.try_get("design_id")?)? };
                Ok((id, r.try_get("control_key")?))
            };
            rows.iter().map(keyed).collect()
        })
    }

    /// Forgets controlled missions.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn forget_controls(&mut self, grid: &StoredGrid, ids: &[ControlId]) -> Result<(), StoreError> {
        self.drive(async |c| {
            let mut tx = begin(c).await?;
            for id in ids {
                // What it comes to goes with its key.
                let sql = "DELETE FROM controlled_mission_key WHERE design_id = ?
                    AND source_file_id = (SELECT source_file_id FROM source_file WHERE path = ?)";
                let delete = sqlx::query(sql).bind(grid.design_ids[id.design]).bind(&id.source_path);
                delete.execute(&mut *tx).await?;
            }
            commit(tx).await
        })
    }

    /// Writes missions, of which nothing is there yet, in one transaction.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn put_controls(&mut self, grid: &StoredGrid, rows: &[ControlRow]) -> Result<(), StoreError> {
        self.drive(async |c| {
            let mut tx = begin(c).await?;
            for row in rows {
                put(&mut tx, grid, row).await?;
            }
            commit(tx).await
        })
    }
}

async fn put(c: &mut SqliteConnection, grid: &StoredGrid, row: &ControlRow) -> Result<(), StoreError> {
    let found = sqlx::query("SELECT source_file_id FROM source_file WHERE path = ?").bind(&row.id.source_path);
    let found = found.fetch_optional(&mut *c).await?;
    let file: i64 = found.ok_or_else(|| StoreError::UnknownFile(row.mission.clone()))?.try_get("source_file_id")?;
    let design = grid.design_ids[row.id.design];
    let key = Insert::into("controlled_mission_key")
        .set("source_file_id", file)?
        .set("design_id", design)?
        .set("control_key", row.key.as_str())?
        .set("mission", row.mission.as_str())?;
    let missions = match &row.result {
        Err(reason) => return key.set("reason", reason.as_str())?.execute(c).await.map(|_| ()),
        Ok(missions) => missions,
    };
    key.execute(&mut *c).await?;
    let mut insert = Insert::into("controlled_mission");
    for (n, m) in missions.iter().enumerate() {
        insert = (if n == 0 { insert } else { insert.another() })
            .set("source_file_id", file)?
            .set("design_id", design)?
            .set("window_id", grid.window_ids[m.window])?
            .set("controller", m.controller.as_str())?
            .set("mission", row.mission.as_str())?
            .set("month", row.month)?
            .set("ambient_k", row.ambient_k)?
            .set("seconds", m.seconds)?
            .set("mean_hvac_power_w", m.mean_hvac_power_w)?
            .set("static_mean_hvac_power_w", m.static_mean_hvac_power_w)?
            .set("max_abs_pmv_15min", m.max_abs_pmv_15min)?
            .set("static_max_abs_pmv", m.static_max_abs_pmv)?
            .set("mean_abs_pmv", m.mean_abs_pmv)?
            .set("static_mean_abs_pmv", m.static_mean_abs_pmv)?
            .set("passenger_hours", m.passenger_hours)?
            .set("passenger_hours_outside", m.passenger_hours_outside)?
            .set("saturated_fraction", m.saturated_fraction)?
            .set("tracking_error_k", m.tracking_error_k)?;
    }
    if missions.is_empty() {
        return Ok(());
    }
    insert.execute(&mut *c).await?;
    let mut outside = Insert::into("controlled_outside");
    let all = missions.iter().flat_map(|m| m.outside.iter().map(|(window, hours)| (m.window, *window, *hours)));
    let mut count = 0;
    for (profile, window, hours) in all {
        outside = (if count == 0 { outside } else { outside.another() })
            .set("source_file_id", file)?
            .set("design_id", design)?
            .set("profile_id", grid.window_ids[profile])?
            .set("window_id", grid.window_ids[window])?
            .set("passenger_hours_outside", hours)?;
        count += 1;
    }
    if count == 0 { Ok(()) } else { outside.execute(c).await.map(|_| ()) }
}
