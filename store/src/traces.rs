//! The missions that the report shows in time.

use cabin::{ComfortWindow, Operation};
use ingest::sample::Sample;
use simulate::TraceMinute;
use sqlx::Row;
use sqlx::sqlite::SqliteRow;

use crate::checks::{commit, whole};
use crate::optima::operation;
use crate::row::{Insert, begin, window};
use crate::samples::sample;
use crate::{SimulationId, Store, StoreError, StoredGrid};

/// A mission, to be stored minute by minute.
#[derive(Debug, Clone, PartialEq)]
pub struct TraceRow {
    /// `cold` or `hot`.
    pub label: &'static str,
    /// Mission, design and window.
    pub id: SimulationId,
    /// Key of its simulation.
    pub key: String,
    /// Whether it is named like a mission that the paper shows.
    pub of_paper: bool,
    /// Segments that it covers.
    pub segment_count: u32,
    /// Its minutes.
    pub minutes: Vec<TraceMinute>,
}

/// A stored mission in time, beside its segments in steady state.
#[derive(Debug, Clone, PartialEq)]
pub struct MissionTrace {
    /// `cold` or `hot`.
    pub label: String,
    /// Design.
    pub design: String,
    /// Comfort window.
    pub window: ComfortWindow,
    /// Whether it is named like a mission that the paper shows.
    pub of_paper: bool,
    /// Its segments, with the optima that it follows.
    pub segments: Vec<(Sample, Operation)>,
    /// Its minutes.
    pub minutes: Vec<TraceMinute>,
}

/// What a mission of a trace comes to in one of the windows that are simulated.
#[derive(Debug, Clone, PartialEq)]
pub struct TraceWindow {
    /// `cold` or `hot`.
    pub label: String,
    /// Comfort window.
    pub window: ComfortWindow,
    /// Mean power of the steady-state optima in W.
    pub static_mean_hvac_power_w: f64,
    /// Their largest absolute vote.
    pub static_max_abs_pmv: f64,
    /// Mean power of the simulation in W.
    pub mean_hvac_power_w: f64,
    /// Its largest absolute 15-minute mean vote; `None` where nobody is ever on board.
    pub max_abs_pmv_15min: Option<f64>,
}

impl Store {
    /// Label, design and key of the simulation of each stored trace.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn trace_keys(&mut self) -> Result<Vec<[String; 3]>, StoreError> {
        let sql = "SELECT t.label, d.name, t.simulation_key
            FROM mission_trace AS t JOIN hvac_design AS d USING (design_id) ORDER BY t.label";
        self.select(sql, |r| Ok([r.try_get("label")?, r.try_get("name")?, r.try_get("simulation_key")?]))
    }

    /// Makes the traces of the database exactly these labels': `rows` are new, those of the labels in `kept` stay.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn put_traces(&mut self, grid: &StoredGrid, rows: &[TraceRow], kept: &[&str]) -> Result<(), StoreError> {
        self.drive(async |c| {
            let mut tx = begin(c).await?;
            for r in sqlx::query("SELECT label FROM mission_trace").fetch_all(&mut *tx).await? {
                let label: String = r.try_get("label")?;
                if !kept.contains(&label.as_str()) {
                    sqlx::query("DELETE FROM mission_trace WHERE label = ?").bind(&label).execute(&mut *tx).await?;
                }
            }
            for row in rows {
                let sql = "SELECT source_file_id FROM source_file WHERE path = ?";
                let file: i64 =
                    sqlx::query(sql).bind(&row.id.source_path).fetch_one(&mut *tx).await?.try_get("source_file_id")?;
                let id = Insert::into("mission_trace")
                    .set("label", row.label)?
                    .set("source_file_id", file)?
                    .set("design_id", grid.design_ids[row.id.design])?
                    .set("window_id", grid.window_ids[row.id.window])?
                    .set("of_paper", row.of_paper)?
                    .set("segment_count", row.segment_count)?
                    .set("simulation_key", row.key.as_str())?
                    .execute(&mut tx)
                    .await?;
                for minute in &row.minutes {
                    insert_minute(id, minute)?.execute(&mut tx).await?;
                }
            }
            commit(tx).await
        })
    }

    /// The missions that the report shows in time: cold, then hot.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn traces(&mut self) -> Result<Vec<MissionTrace>, StoreError> {
        self.drive_checked(async |c, damage| {
            let sql = "SELECT t.trace_id, t.label, d.name AS design, w.pmv_min, w.pmv_max, t.of_paper
                FROM mission_trace AS t JOIN hvac_design AS d USING (design_id) JOIN comfort_window AS w USING (window_id)
                ORDER BY t.label";
            let mut traces = Vec::new();
            for r in sqlx::query(sql).fetch_all(&mut *c).await? {
                let id: i64 = r.try_get("trace_id")?;
                let sql = "SELECT s.*, f.path AS source_path, g.distance_m, g.vehicle_power_w, g.route, k.local_hour, k.weekday, p.*
                    FROM mission_trace AS t
                    JOIN hourly_sample AS s USING (source_file_id) JOIN source_file AS f USING (source_file_id)
                    LEFT JOIN sample_clock AS k ON k.sample_id = s.sample_id
                    LEFT JOIN mission_segment AS g ON g.source_file_id = s.source_file_id AND g.segment = s.segment
                    JOIN optimum_point AS p
                        ON p.sample_id = s.sample_id AND p.design_id = t.design_id AND p.window_id = t.window_id
                    WHERE t.trace_id = ? ORDER BY s.segment LIMIT (SELECT segment_count FROM mission_trace WHERE trace_id = ?)";
                let mut segments = Vec::new();
                let rows = sqlx::query(sql).bind(id).bind(id).fetch_all(&mut *c).await?;
                whole(damage, "hourly_sample", &rows)?;
                for s in &rows {
                    segments.extend(operation(damage, s)?.map(|o| Ok::<_, StoreError>((sample(s)?, o))).transpose()?);
                }
                let sql = "SELECT * FROM trace_minute WHERE trace_id = ? ORDER BY minute";
                let minutes = sqlx::query(sql).bind(id).fetch_all(&mut *c).await?;
                whole(damage, "trace_minute", &minutes)?;
                traces.push(MissionTrace {
                    label: r.try_get("label")?,
                    design: r.try_get("design")?,
                    window: window(&r)?,
                    of_paper: r.try_get("of_paper")?,
                    segments,
                    minutes: minutes.iter().map(minute).collect::<Result<_, _>>()?,
                });
            }
            Ok(traces)
        })
    }

    /// What the missions of the traces come to, with the same design and driven as in the paper: cold, then hot, windows in the
    /// order of the study.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn trace_windows(&mut self) -> Result<Vec<TraceWindow>, StoreError> {
        let sql =
            "SELECT t.label, w.pmv_min, w.pmv_max, r.static_mean_hvac_power_w, r.static_max_abs_pmv, r.mean_hvac_power_w, r.max_abs_pmv_15min
            FROM mission_trace AS t
            JOIN simulated_mission AS r ON r.source_file_id = t.source_file_id AND r.design_id = t.design_id
            JOIN comfort_window AS w ON w.window_id = r.window_id
            WHERE r.controller = 'paper' ORDER BY t.label, w.position";
        self.select(sql, |r| {
            Ok(TraceWindow {
                label: r.try_get("label")?,
                window: window(r)?,
                static_mean_hvac_power_w: r.try_get("static_mean_hvac_power_w")?,
                static_max_abs_pmv: r.try_get("static_max_abs_pmv")?,
                mean_hvac_power_w: r.try_get("mean_hvac_power_w")?,
                max_abs_pmv_15min: r.try_get("max_abs_pmv_15min")?,
            })
        })
    }
}

fn insert_minute(trace: i64, m: &TraceMinute) -> Result<Insert, StoreError> {
    Insert::into("trace_minute")
        .set("trace_id", trace)?
        .set("minute", m.minute)?
        .set("ambient_k", m.ambient_k)?
        .set("passengers", m.passengers)?
        .set("door_open_fraction", m.door_open_fraction)?
        .set("cabin_k", m.cabin_k)?
        .set("interior_k", m.interior_k)?
        .set("shell_inside_k", m.shell_inside_k)?
        .set("shell_outside_k", m.shell_outside_k)?
        .set("radiant_heater_k", m.radiant_heater_k)?
        .set("pmv", m.pmv)?
        .set("pmv_15min", m.pmv_15min)?
        .set("air_unit_power_w", m.air_unit_power_w)?
        .set("radiant_heater_power_w", m.radiant_heater_power_w)?
        .set("air_curtain_power_w", m.air_curtain_power_w)?
        .set("hvac_power_w", m.hvac_power_w)
}

fn minute(r: &SqliteRow) -> Result<TraceMinute, sqlx::Error> {
    Ok(TraceMinute {
        minute: r.try_get("minute")?,
        ambient_k: r.try_get("ambient_k")?,
        passengers: r.try_get("passengers")?,
        door_open_fraction: r.try_get("door_open_fraction")?,
        cabin_k: r.try_get("cabin_k")?,
        interior_k: r.try_get("interior_k")?,
        shell_inside_k: r.try_get("shell_inside_k")?,
        shell_outside_k: r.try_get("shell_outside_k")?,
        radiant_heater_k: r.try_get("radiant_heater_k")?,
        pmv: r.try_get("pmv")?,
        pmv_15min: r.try_get("pmv_15min")?,
        air_unit_power_w: r.try_get("air_unit_power_w")?,
        radiant_heater_power_w: r.try_get("radiant_heater_power_w")?,
        air_curtain_power_w: r.try_get("air_curtain_power_w")?,
        hvac_power_w: r.try_get("hvac_power_w")?,
    })
}
