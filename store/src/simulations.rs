//! Simulated missions: which are there, and writing them.

use simulate::{Replay, Summary};
use sqlx::Row;
use sqlx::sqlite::SqliteConnection;
use std::collections::BTreeMap;

use crate::checks::commit;
use crate::row::{Insert, begin, count, window};
use crate::{Store, StoreError, StoredGrid};
use cabin::ComfortWindow;

/// What a simulated mission is found by.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct SimulationId {
    /// Path of the mission's file, as the study names it.
    pub source_path: String,
    /// Place of the design in the stored grid.
    pub design: usize,
    /// Place of the window in the stored grid.
    pub window: usize,
}

/// A mission, to be stored with a design and window.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulationRow {
    /// What it is found by.
    pub id: SimulationId,
    /// What it depends on, hashed.
    pub key: String,
    /// Name of the mission.
    pub mission: String,
    /// Local month of its start.
    pub month: u8,
    /// Mean ambient temperature in K.
    pub ambient_k: f64,
    /// What each replay of its optima came to, or why it cannot be simulated.
    pub result: Result<Vec<(Replay, Summary)>, String>,
}

/// A row of `simulation_annual`.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedYear {
    /// Design.
    pub design: String,
    /// Comfort window.
    pub window: ComfortWindow,
    /// How the bus was run.
    pub controller: String,
    /// Annual mean power in W.
    pub mean_hvac_power_w: f64,
    /// The same of the steady-state optima of the simulated segments in W.
    pub static_mean_hvac_power_w: f64,
    /// Share of the time at a power limit.
    pub saturated_fraction: f64,
    /// Simulated missions.
    pub mission_count: u64,
}

/// A row of `simulation_class`: simulated missions of one class, run as in the paper, with means over all their seconds.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedClass {
    /// What they are sorted by: `month`, `ambient temperature`, `mission length`.
    pub sorted_by: String,
    /// The class.
    pub class: String,
    /// Design.
    pub design: String,
    /// Comfort window.
    pub window: ComfortWindow,
    /// Missions.
    pub mission_count: u64,
    /// Mean power in W.
    pub mean_hvac_power_w: f64,
    /// The same of the steady-state optima in W.
    pub static_mean_hvac_power_w: f64,
    /// The same for a bus that starts in steady state instead of at depot temperature.
    pub warm_start_power_w: f64,
    /// Mean of the missions' largest absolute 15-minute vote.
    pub mean_max_abs_pmv: Option<f64>,
    /// Share of the time at a power limit.
    pub saturated_fraction: f64,
}

/// A row of `simulation_failure`.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulationFailure {
    /// Name of the mission.
    pub mission: String,
    /// Design.
    pub design: String,
    /// Comfort window.
    pub window: ComfortWindow,
    /// Why it is not simulated.
    pub reason: String,
}

impl Store {
    /// The keys of all missions that were simulated, or cannot be.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn simulation_keys(&mut self, grid: &StoredGrid) -> Result<BTreeMap<SimulationId, String>, StoreError> {
        self.drive(async |c| {
            // The rows of all ways to run the bus are written together.
            let sql = "SELECT path, design_id, window_id, simulation_key
                FROM (SELECT source_file_id, design_id, window_id, simulation_key FROM simulated_mission
                        WHERE controller = 'paper'
                    UNION ALL SELECT source_file_id, design_id, window_id, simulation_key FROM unsimulated_mission)
                JOIN source_file USING (source_file_id)";
            let rows = sqlx::query(sql).fetch_all(c).await?;
            rows.iter()
                .map(|r| {
                    let id = SimulationId {
                        source_path: r.try_get("path")?,
                        design: grid.design(r.try_get("design_id")?)?,
                        window: grid.window(r.try_get("window_id")?)?,
                    };
                    Ok((id, r.try_get("simulation_key")?))
                })
                .collect()
        })
    }

    /// Forgets simulated missions.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn forget_simulations(&mut self, grid: &StoredGrid, ids: &[SimulationId]) -> Result<(), StoreError> {
        self.drive(async |c| {
            let mut tx = begin(c).await?;
            for id in ids {
                forget(&mut tx, grid, id).await?;
            }
            commit(tx).await
        })
    }

    /// Writes missions, of which nothing is there yet, in one transaction.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn put_simulations(&mut self, grid: &StoredGrid, rows: &[SimulationRow]) -> Result<(), StoreError> {
        self.drive(async |c| {
            let mut tx = begin(c).await?;
            // The rows of a mission follow each other.
            for rows in rows.chunk_by(|a, b| a.id.source_path == b.id.source_path) {
                let sql = "SELECT source_file_id FROM source_file WHERE path = ?";
                let found = sqlx::query(sql).bind(&rows[0].id.source_path).fetch_optional(&mut *tx).await?;
                let found = found.ok_or_else(|| StoreError::UnknownFile(rows[0].mission.clone()))?;
                let file: i64 = found.try_get("source_file_id")?;
                for row in rows {
                    put(&mut tx, grid, file, row).await?;
                }
            }
            commit(tx).await
        })
    }

    /// The table `simulation_annual`, in the order of the study.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn simulated_years(&mut self) -> Result<Vec<SimulatedYear>, StoreError> {
        self.in_study_order("simulation_annual", ", t.controller", |r| {
            Ok(SimulatedYear {
                design: r.try_get("design")?,
                window: window(r)?,
                controller: r.try_get("controller")?,
                mean_hvac_power_w: r.try_get("mean_hvac_power_w")?,
                static_mean_hvac_power_w: r.try_get("static_mean_hvac_power_w")?,
                saturated_fraction: r.try_get("saturated_fraction")?,
                mission_count: count(r, "mission_count")?,
            })
        })
    }

    /// The table `simulation_class`, in the order of the study and of the classes.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn simulated_classes(&mut self) -> Result<Vec<SimulatedClass>, StoreError> {
        self.in_study_order("simulation_class", ", t.class_order", |r| {
            Ok(SimulatedClass {
                sorted_by: r.try_get("sorted_by")?,
                class: r.try_get("class")?,
                design: r.try_get("design")?,
                window: window(r)?,
                mission_count: count(r, "mission_count")?,
                mean_hvac_power_w: r.try_get("mean_hvac_power_w")?,
                static_mean_hvac_power_w: r.try_get("static_mean_hvac_power_w")?,
                warm_start_power_w: r.try_get("warm_start_power_w")?,
                mean_max_abs_pmv: r.try_get("mean_max_abs_pmv_15min")?,
                saturated_fraction: r.try_get("saturated_fraction")?,
            })
        })
    }

    /// The view `simulation_failure`, by mission and in the order of the study.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn simulation_failures(&mut self) -> Result<Vec<SimulationFailure>, StoreError> {
        let sql = "SELECT a.* FROM simulation_failure AS a
            JOIN hvac_design AS d ON d.name = a.design JOIN comfort_window AS w USING (pmv_min, pmv_max)
            ORDER BY a.mission, d.position, w.position";
        self.select(sql, |r| {
            Ok(SimulationFailure {
                mission: r.try_get("mission")?,
                design: r.try_get("design")?,
                window: window(r)?,
                reason: r.try_get("reason")?,
            })
        })
    }
}

async fn forget(c: &mut SqliteConnection, grid: &StoredGrid, id: &SimulationId) -> Result<(), StoreError> {
    for sql in [
        "DELETE FROM simulated_mission WHERE design_id = ? AND window_id = ?
            AND source_file_id = (SELECT source_file_id FROM source_file WHERE path = ?)",
        "DELETE FROM unsimulated_mission WHERE design_id = ? AND window_id = ?
            AND source_file_id = (SELECT source_file_id FROM source_file WHERE path = ?)",
    ] {
        sqlx::query(sql)
            .bind(grid.design_ids[id.design])
            .bind(grid.window_ids[id.window])
            .bind(&id.source_path)
            .execute(&mut *c)
            .await?;
    }
    Ok(())
}

async fn put(c: &mut SqliteConnection, grid: &StoredGrid, file: i64, row: &SimulationRow) -> Result<(), StoreError> {
    let keyed = |insert: Insert| {
        insert
            .set("source_file_id", file)?
            .set("design_id", grid.design_ids[row.id.design])?
            .set("window_id", grid.window_ids[row.id.window])?
            .set("simulation_key", row.key.as_str())?
            .set("mission", row.mission.as_str())
    };
    let replays = match &row.result {
        Err(reason) => {
            let insert = keyed(Insert::into("unsimulated_mission"))?.set("reason", reason.as_str())?;
            return insert.execute(c).await.map(|_| ());
        }
        Ok(replays) => replays,
    };
    let mut insert = Insert::into("simulated_mission");
    for (n, (replay, s)) in replays.iter().enumerate() {
        insert = keyed(if n == 0 { insert } else { insert.another() })?
            .set("controller", replay.name)?
            .set("month", row.month)?
            .set("ambient_k", row.ambient_k)?
            .set("seconds", s.seconds)?
            .set("mean_hvac_power_w", s.mean_hvac_power_w)?
            .set("static_mean_hvac_power_w", s.static_mean_hvac_power_w)?
            .set("max_abs_pmv_15min", s.max_abs_pmv_15min)?
            .set("static_max_abs_pmv", s.static_max_abs_pmv)?
            .set("saturated_fraction", s.saturated_fraction)?
            .set("tracking_error_k", s.tracking_error_k)?;
    }
    insert.execute(c).await.map(|_| ())
}
