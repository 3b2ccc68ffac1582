//! Loads of missions in time, and simulated missions.

use sqlx::{Connection, Row};
use std::collections::BTreeMap;

use crate::{Store, StoreError};

/// From a second of the mission on, so many passengers are on board and a door is open or not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadRow {
    /// Second since the start of the mission.
    pub second: u32,
    /// Passengers on board.
    pub passengers: f64,
    /// Whether at least one door is open.
    pub door_open: bool,
}

/// Bytes of a load.
const LOAD_BYTES: usize = 13;

/// A simulated mission with one design, window and controller.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulationRow {
    /// Path of the mission's file, as the study names it.
    pub source_path: String,
    /// Design.
    pub design_id: i64,
    /// Comfort window.
    pub window_id: i64,
    /// How the bus was run.
    pub controller: &'static str,
    /// What the row depends on, hashed.
    pub simulation_key: String,
    /// Name of the mission.
    pub mission: String,
    /// Local month of its start.
    pub month: u8,
    /// Mean ambient temperature in K.
    pub ambient_k: f64,
    /// Simulated seconds.
    pub seconds: u32,
    /// Mean power in W.
    pub mean_hvac_power_w: f64,
    /// The same of the steady-state optima in W.
    pub static_mean_hvac_power_w: f64,
    /// Largest absolute 15-minute mean vote while somebody is on board.
    pub max_abs_pmv_15min: Option<f64>,
    /// Largest absolute vote of the optima.
    pub static_max_abs_pmv: f64,
    /// Share of the time at a power limit.
    pub saturated_fraction: f64,
    /// Root mean square of the tracking error in K.
    pub tracking_error_k: f64,
}

/// A row of `simulation_annual`.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedYear {
    /// Design.
    pub design: String,
    /// Lower limit of the window.
    pub pmv_min: f64,
    /// Upper limit of the window.
    pub pmv_max: f64,
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

/// Simulated missions of one class, run as in the paper: means over all their seconds.
#[derive(Debug, Clone, PartialEq)]
pub struct SimulatedClass {
    /// What they are sorted by: `month`, `ambient temperature`, `mission length`.
    pub sorted_by: String,
    /// The class.
    pub class: String,
    /// Design.
    pub design: String,
    /// Lower limit of the window.
    pub pmv_min: f64,
    /// Upper limit of the window.
    pub pmv_max: f64,
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

/// What a simulated mission is found by: path of its file, design, window.
pub type SimulationId = (String, i64, i64);

impl Store {
    /// The loads of a mission file; none where it has none stored.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn loads(&mut self, source_path: &str) -> Result<Vec<LoadRow>, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT loads FROM mission_load JOIN source_file USING (source_file_id) WHERE path = ?";
            let row = sqlx::query(sql).bind(source_path).fetch_optional(c).await?;
            let bytes: Vec<u8> = row.map(|r| r.try_get(0)).transpose()?.unwrap_or_default();
            Ok(bytes.chunks_exact(LOAD_BYTES).map(decode).collect())
        })
    }

    /// The keys of all simulated missions.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn simulation_keys(&mut self) -> Result<BTreeMap<SimulationId, String>, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT DISTINCT path, design_id, window_id, simulation_key
                FROM simulated_mission JOIN source_file USING (source_file_id)";
            let rows = sqlx::query(sql).fetch_all(c).await?;
            rows.iter().map(|r| Ok(((r.try_get(0)?, r.try_get(1)?, r.try_get(2)?), r.try_get(3)?))).collect()
        })
    }

    /// The view `simulation_annual`, in the order of the study.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn simulated_years(&mut self) -> Result<Vec<SimulatedYear>, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT a.design, a.pmv_min, a.pmv_max, a.controller, a.mean_hvac_power_w,
                    a.static_mean_hvac_power_w, a.saturated_fraction, a.mission_count
                FROM simulation_annual AS a
                JOIN hvac_design AS d ON d.name = a.design
                JOIN comfort_window AS w USING (pmv_min, pmv_max)
                ORDER BY d.position, w.position, a.controller";
            let rows = sqlx::query(sql).fetch_all(c).await?;
            rows.iter()
                .map(|r| {
                    Ok(SimulatedYear {
                        design: r.try_get(0)?,
                        pmv_min: r.try_get(1)?,
                        pmv_max: r.try_get(2)?,
                        controller: r.try_get(3)?,
                        mean_hvac_power_w: r.try_get(4)?,
                        static_mean_hvac_power_w: r.try_get(5)?,
                        saturated_fraction: r.try_get(6)?,
                        mission_count: r.try_get::<i64, _>(7)?.cast_unsigned(),
                    })
                })
                .collect()
        })
    }

    /// Simulated missions by month, ambient temperature and length.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn simulated_classes(&mut self) -> Result<Vec<SimulatedClass>, StoreError> {
        self.drive(async |c| {
            let sql = "WITH classed AS (
                    SELECT s.*, v.mean_hvac_power_w AS warm_w, 0 AS sorting, 'month' AS sorted_by, s.month AS place,
                        printf('%02d', s.month) AS class
                    FROM simulation AS s JOIN simulation AS v USING (mission, design, pmv_min, pmv_max)
                    WHERE s.controller = 'paper' AND v.controller = 'warm-start'
                ),
                all_classed AS (
                    SELECT * FROM classed
                    UNION ALL
                    SELECT mission, design, pmv_limit, pmv_min, pmv_max, controller, mean_hvac_power_w,
                        static_mean_hvac_power_w, max_abs_pmv_15min, static_max_abs_pmv, saturated_fraction,
                        tracking_error_k, seconds, month, ambient_temperature_c, warm_w, 1, 'ambient temperature in °C',
                        CAST(ambient_temperature_c / 5 + 100 AS INTEGER) - 100,
                        printf('%d … %d', 5 * (CAST(ambient_temperature_c / 5 + 100 AS INTEGER) - 100),
                            5 * (CAST(ambient_temperature_c / 5 + 100 AS INTEGER) - 99))
                    FROM classed
                    UNION ALL
                    SELECT mission, design, pmv_limit, pmv_min, pmv_max, controller, mean_hvac_power_w,
                        static_mean_hvac_power_w, max_abs_pmv_15min, static_max_abs_pmv, saturated_fraction,
                        tracking_error_k, seconds, month, ambient_temperature_c, warm_w, 2, 'mission length in h',
                        min(seconds / 14400, 4),
                        CASE WHEN seconds >= 57600 THEN '16 and more'
                            ELSE printf('%d … %d', 4 * (seconds / 14400), 4 * (seconds / 14400 + 1)) END
                    FROM classed
                )
                SELECT sorted_by, class, design, pmv_min, pmv_max, count(*),
                    sum(mean_hvac_power_w * seconds) / sum(seconds), sum(static_mean_hvac_power_w * seconds) / sum(seconds),
                    sum(warm_w * seconds) / sum(seconds), avg(max_abs_pmv_15min),
                    sum(saturated_fraction * seconds) / sum(seconds)
                FROM all_classed AS a
                JOIN hvac_design AS d ON d.name = a.design
                JOIN comfort_window AS w USING (pmv_min, pmv_max)
                GROUP BY d.position, w.position, sorting, place
                ORDER BY d.position, w.position, sorting, place";
            let rows = sqlx::query(sql).fetch_all(c).await?;
            rows.iter()
                .map(|r| {
                    Ok(SimulatedClass {
                        sorted_by: r.try_get(0)?,
                        class: r.try_get(1)?,
                        design: r.try_get(2)?,
                        pmv_min: r.try_get(3)?,
                        pmv_max: r.try_get(4)?,
                        mission_count: r.try_get::<i64, _>(5)?.cast_unsigned(),
                        mean_hvac_power_w: r.try_get(6)?,
                        static_mean_hvac_power_w: r.try_get(7)?,
                        warm_start_power_w: r.try_get(8)?,
                        mean_max_abs_pmv: r.try_get(9)?,
                        saturated_fraction: r.try_get(10)?,
                    })
                })
                .collect()
        })
    }

    /// Forgets simulated missions.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn forget_simulations(&mut self, ids: &[SimulationId]) -> Result<(), StoreError> {
        self.drive(async |c| {
            let mut tx = c.begin().await?;
            for (path, design, window) in ids {
                let sql = "DELETE FROM simulated_mission WHERE design_id = ? AND window_id = ?
                    AND source_file_id = (SELECT source_file_id FROM source_file WHERE path = ?)";
                sqlx::query(sql).bind(design).bind(window).bind(path).execute(&mut *tx).await?;
            }
            Ok(tx.commit().await?)
        })
    }

    /// Writes simulated missions in one transaction; a row that is there is replaced.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn put_simulations(&mut self, rows: &[SimulationRow]) -> Result<(), StoreError> {
        self.drive(async |c| {
            let mut tx = c.begin().await?;
            for r in rows {
                let sql = "INSERT OR REPLACE INTO simulated_mission VALUES
                    ((SELECT source_file_id FROM source_file WHERE path = ?), ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)";
                sqlx::query(sql)
                    .bind(&r.source_path)
                    .bind(r.design_id)
                    .bind(r.window_id)
                    .bind(r.controller)
                    .bind(&r.simulation_key)
                    .bind(&r.mission)
                    .bind(r.month)
                    .bind(r.ambient_k)
                    .bind(r.seconds)
                    .bind(r.mean_hvac_power_w)
                    .bind(r.static_mean_hvac_power_w)
                    .bind(r.max_abs_pmv_15min)
                    .bind(r.static_max_abs_pmv)
                    .bind(r.saturated_fraction)
                    .bind(r.tracking_error_k)
                    .execute(&mut *tx)
                    .await?;
            }
            Ok(tx.commit().await?)
        })
    }
}

pub(crate) fn encode_loads(loads: &[LoadRow]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(loads.len() * LOAD_BYTES);
    for load in loads {
        bytes.extend(load.second.to_le_bytes());
        bytes.extend(load.passengers.to_le_bytes());
        bytes.push(u8::from(load.door_open));
    }
    bytes
}

fn decode(bytes: &[u8]) -> LoadRow {
    let second = std::array::from_fn(|i| bytes[i]);
    let passengers = std::array::from_fn(|i| bytes[4 + i]);
    LoadRow {
        second: u32::from_le_bytes(second),
        passengers: f64::from_le_bytes(passengers),
        door_open: bytes[12] != 0,
    }
}
