//! Driven missions as intervals need them, and the intervals of their annual means.

use cabin::ComfortWindow;
use chrono::{DateTime, TimeDelta, Utc};
use sqlx::sqlite::SqliteConnection;
use sqlx::{AssertSqlSafe, Row};

use crate::row::{ends, high, low, put_all, time, window};
use crate::{Ends, Store, StoreError};

/// How missions were driven.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Driven {
    /// As the optima prescribe.
    Simulated,
    /// By causal controllers.
    Controlled,
}

impl Driven {
    fn missions(self) -> &'static str {
        match self {
            Self::Simulated => "simulated_mission",
            Self::Controlled => "controlled_mission",
        }
    }

    fn intervals(self) -> &'static str {
        match self {
            Self::Simulated => "simulation_interval",
            Self::Controlled => "control_interval",
        }
    }
}

/// A mission that was driven.
#[derive(Debug, Clone, PartialEq)]
pub struct DrivenMission {
    /// Design, comfort window, controller.
    pub point: DrivenPoint,
    /// Its begin.
    pub start: DateTime<Utc>,
    /// The month that it counts to, 1 … 12.
    pub month: u8,
    /// Seconds.
    pub seconds: f64,
    /// Mean power in W.
    pub power_w: f64,
    /// The same of the optima in W.
    pub static_power_w: f64,
}

/// What an annual mean of driven missions is of.
#[derive(Debug, Clone, PartialEq)]
pub struct DrivenPoint {
    /// Design.
    pub design: String,
    /// Comfort window.
    pub window: ComfortWindow,
    /// How the bus was run.
    pub controller: String,
}

/// How sure an annual mean of driven missions is.
#[derive(Debug, Clone, PartialEq)]
pub struct DrivenEnds {
    /// What it is of.
    pub point: DrivenPoint,
    /// Mean power in W.
    pub power_w: Ends,
    /// Relative difference from the power of the optima.
    pub relative_difference: Ends,
}

impl Store {
    /// All driven missions by design, window and controller, in the order of the study.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn driven_missions(&mut self, driven: Driven) -> Result<Vec<DrivenMission>, StoreError> {
        let sql = format!(
            "SELECT d.name, w.pmv_min, w.pmv_max, r.controller, r.month, r.seconds, r.mean_hvac_power_w,
                r.static_mean_hvac_power_w, g.start_utc, g.segment, g.duration_s
            FROM {} AS r
            JOIN hvac_design AS d USING (design_id)
            JOIN comfort_window AS w USING (window_id)
            JOIN mission_segment AS g ON g.source_file_id = r.source_file_id AND g.segment = (
                SELECT min(f.segment) FROM mission_segment AS f WHERE f.source_file_id = r.source_file_id
            )
            ORDER BY d.position, w.position, r.controller, r.mission",
            driven.missions()
        );
        self.drive(async |c| {
            // The text is built from constants alone.
            let rows = sqlx::query(AssertSqlSafe(sql)).fetch_all(c).await?;
            let mission = |r: &sqlx::sqlite::SqliteRow| -> Result<DrivenMission, sqlx::Error> {
                let before_s = r.try_get::<i64, _>("segment")? * r.try_get::<i64, _>("duration_s")?;
                Ok(DrivenMission {
                    point: DrivenPoint {
                        design: r.try_get("name")?,
                        window: window(r)?,
                        controller: r.try_get("controller")?,
                    },
                    start: time(r, "start_utc")? - TimeDelta::seconds(before_s),
                    month: r.try_get("month")?,
                    seconds: r.try_get::<i64, _>("seconds")? as f64,
                    power_w: r.try_get("mean_hvac_power_w")?,
                    static_power_w: r.try_get("static_mean_hvac_power_w")?,
                })
            };
            Ok(rows.iter().map(mission).collect::<Result<_, _>>()?)
        })
    }

    /// The intervals of the annual means.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn driven_intervals(&mut self, driven: Driven) -> Result<Vec<DrivenEnds>, StoreError> {
        let sql = format!("SELECT * FROM {} ORDER BY design, pmv_min, pmv_max, controller", driven.intervals());
        self.drive(async |c| {
            // The text is built from constants alone.
            let rows = sqlx::query(AssertSqlSafe(sql)).fetch_all(c).await?;
            let row = |r: &sqlx::sqlite::SqliteRow| -> Result<DrivenEnds, sqlx::Error> {
                Ok(DrivenEnds {
                    point: DrivenPoint {
                        design: r.try_get("design")?,
                        window: window(r)?,
                        controller: r.try_get("controller")?,
                    },
                    power_w: ends(r, "mean_hvac_power_low_w", "mean_hvac_power_high_w")?,
                    relative_difference: ends(r, "relative_difference_low", "relative_difference_high")?,
                })
            };
            Ok(rows.iter().map(row).collect::<Result<_, _>>()?)
        })
    }
}

/// Replaces the intervals.
pub(crate) async fn put(
    c: &mut SqliteConnection,
    run_id: i64,
    driven: Driven,
    rows: &[DrivenEnds],
) -> Result<(), StoreError> {
    // The text is built from constants alone.
    sqlx::query(AssertSqlSafe(format!("DELETE FROM {}", driven.intervals()))).execute(&mut *c).await?;
    put_all(c, driven.intervals(), rows, |insert, row| {
        insert
            .of_point(&row.point.design, row.point.window)?
            .set("controller", row.point.controller.clone())?
            .set("mean_hvac_power_low_w", low(row.power_w))?
            .set("mean_hvac_power_high_w", high(row.power_w))?
            .set("relative_difference_low", low(row.relative_difference))?
            .set("relative_difference_high", high(row.relative_difference))?
            .set("run_id", run_id)
    })
    .await
}
