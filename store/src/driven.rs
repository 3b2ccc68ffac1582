//! Driven missions as intervals need them, and the intervals of their annual means.

use cabin::ComfortWindow;
use chrono::{DateTime, TimeDelta, Utc};
use futures_util::TryStreamExt;
use sqlx::sqlite::{SqliteConnection, SqliteRow};
use sqlx::{AssertSqlSafe, Row};
use std::collections::BTreeMap;

use crate::row::{ends, high, low, put_all, time, window};
use crate::{Ends, Store, StoreError, StoredGrid};

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

/// The missions that were driven with one design, comfort window and controller.
#[derive(Debug, Clone, PartialEq)]
pub struct DrivenMissions {
    /// Design, comfort window, controller.
    pub point: DrivenPoint,
    /// The missions, in the order of their names.
    pub missions: Vec<DrivenMission>,
}

/// A mission that was driven.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrivenMission {
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
    /// All driven missions by design and window, in the order of the grid, and controller.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn driven_missions(&mut self, grid: &StoredGrid, driven: Driven) -> Result<Vec<DrivenMissions>, StoreError> {
        let sql = format!(
            "SELECT source_file_id, design_id, window_id, controller, month, seconds, mean_hvac_power_w,
                static_mean_hvac_power_w
            FROM {}",
            driven.missions()
        );
        self.drive(async |c| {
            let begins = begins(c).await?;
            let mut controllers: Vec<String> = Vec::new();
            // With the places of design, window, controller and mission.
            let mut all: Vec<([usize; 4], DrivenMission)> = Vec::new();
            // The text is built from constants alone.
            let mut rows = sqlx::query(AssertSqlSafe(sql)).fetch(c);
            while let Some(row) = rows.try_next().await? {
                let (mission, start) = *begins.get(&row.try_get(0)?).ok_or(sqlx::Error::RowNotFound)?;
                let name: &str = row.try_get(3)?;
                let controller = controllers.iter().position(|known| known == name).unwrap_or_else(|| {
                    controllers.push(name.to_owned());
                    controllers.len() - 1
                });
                let places = [grid.design(row.try_get(1)?)?, grid.window(row.try_get(2)?)?, controller, mission];
                let mission = DrivenMission {
                    start,
                    month: row.try_get(4)?,
                    seconds: row.try_get::<i64, _>(5)? as f64,
                    power_w: row.try_get(6)?,
                    static_power_w: row.try_get(7)?,
                };
                all.push((places, mission));
            }
            all.sort_unstable_by_key(|(places, _)| *places);
            let of_point = |missions: &[([usize; 4], DrivenMission)]| {
                let [design, window, controller, _] = missions[0].0;
                DrivenMissions {
                    point: DrivenPoint {
                        design: grid.designs[design].name.clone(),
                        window: grid.windows[window],
                        controller: controllers[controller].clone(),
                    },
                    missions: missions.iter().map(|(_, mission)| *mission).collect(),
                }
            };
            Ok(all.chunk_by(|(a, _), (b, _)| a[..3] == b[..3]).map(of_point).collect())
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
            let row = |r: &SqliteRow| -> Result<DrivenEnds, sqlx::Error> {
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

/// The missions' places in the order of their names, and when they begin, by their files.
async fn begins(c: &mut SqliteConnection) -> Result<BTreeMap<i64, (usize, DateTime<Utc>)>, StoreError> {
    // What stands beside a minimum is of its row.
    let sql = "SELECT source_file_id, start_utc, segment * duration_s AS before_s, min(segment)
        FROM mission_segment GROUP BY source_file_id ORDER BY mission";
    let begin = |(place, r): (usize, &SqliteRow)| {
        let start = time(r, "start_utc")? - TimeDelta::seconds(r.try_get("before_s")?);
        Ok((r.try_get("source_file_id")?, (place, start)))
    };
    let rows = sqlx::query(sql).fetch_all(c).await?;
    Ok(rows.iter().enumerate().map(begin).collect::<Result<_, sqlx::Error>>()?)
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
