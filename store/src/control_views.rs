//! What missions under causal controllers come to: rows of the database for reports.

use cabin::ComfortWindow;
use sqlx::Row;
use sqlx::sqlite::{SqliteConnection, SqliteRow};

use crate::row::{Insert, count, window};
use crate::{Store, StoreError};

/// What a controller comes to, judged by a comfort window.
#[derive(Debug, Clone, PartialEq)]
pub struct ControlPoint {
    /// Design.
    pub design: String,
    /// Comfort window: of the profile, or by which published setpoints are judged.
    pub window: ComfortWindow,
    /// Controller.
    pub controller: String,
    /// Mean power in W.
    pub mean_hvac_power_w: f64,
    /// The same of the steady-state optima in W.
    pub static_mean_hvac_power_w: f64,
    /// Mean absolute vote of the passengers; `None` where there are none.
    pub mean_abs_pmv: Option<f64>,
    /// The same of the steady-state optima.
    pub static_mean_abs_pmv: Option<f64>,
    /// Share of the passenger-hours outside the window.
    pub outside_fraction: Option<f64>,
    /// Missions.
    pub mission_count: u64,
}

/// A row of `control_annual`.
#[derive(Debug, Clone, PartialEq)]
pub struct ControlYear {
    /// Annual means.
    pub point: ControlPoint,
    /// Passenger-hours of all missions.
    pub passenger_hours: f64,
    /// Those outside the window.
    pub passenger_hours_outside: f64,
    /// Share of the time at a power limit.
    pub saturated_fraction: f64,
}

/// A row of `control_class`.
#[derive(Debug, Clone, PartialEq)]
pub struct ControlClass {
    /// What missions are sorted by: `month`, `ambient temperature in °C`.
    pub sorted_by: String,
    /// The class.
    pub class: String,
    /// Means over the class.
    pub point: ControlPoint,
}

/// A row of `control_outside`.
#[derive(Debug, Clone, PartialEq)]
pub struct Outside {
    /// Design.
    pub design: String,
    /// Controller.
    pub controller: String,
    /// The window whose profile it follows; `None` for setpoints that no window belongs to.
    pub profile: Option<ComfortWindow>,
    /// The window by which it is judged.
    pub window: ComfortWindow,
    /// Annual mean power in W.
    pub mean_hvac_power_w: f64,
    /// Share of the passenger-hours outside the window; `None` where nobody ever is on board.
    pub outside_fraction: Option<f64>,
}

/// A mission in time under a controller.
#[derive(Debug, Clone, PartialEq)]
pub struct ControlTrace {
    /// Design.
    pub design: String,
    /// Comfort window: of the profile, or by which published setpoints are judged.
    pub window: ComfortWindow,
    /// Controller.
    pub controller: String,
    /// Name of the mission.
    pub mission: String,
    /// Its minutes from the first on.
    pub minutes: Vec<ControlMinute>,
}

/// Means over a minute.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ControlMinute {
    /// Ambient temperature in °C.
    pub ambient_temperature_c: f64,
    /// Setpoint in °C over the seconds in which the air unit is on; `None` where it never is.
    pub setpoint_c: Option<f64>,
    /// Cabin air in °C.
    pub cabin_temperature_c: f64,
    /// Mean vote of the passengers.
    pub pmv: f64,
    /// Its mean over the last 15 minutes.
    pub pmv_15min: f64,
    /// Electric power of the air unit in W; negative where it cools.
    pub air_unit_power_w: f64,
    /// All electric power in W.
    pub hvac_power_w: f64,
}

impl Store {
    /// The table `control_annual`, in the order of the study.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn control_years(&mut self) -> Result<Vec<ControlYear>, StoreError> {
        self.in_study_order("control_annual", ", t.controller", |r| {
            Ok(ControlYear {
                point: point(r)?,
                passenger_hours: r.try_get("passenger_hours")?,
                passenger_hours_outside: r.try_get("passenger_hours_outside")?,
                saturated_fraction: r.try_get("saturated_fraction")?,
            })
        })
    }

    /// The table `control_class`, in the order of the study and of the classes.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn control_classes(&mut self) -> Result<Vec<ControlClass>, StoreError> {
        self.in_study_order("control_class", ", t.controller, t.class_order", |r| {
            Ok(ControlClass { sorted_by: r.try_get("sorted_by")?, class: r.try_get("class")?, point: point(r)? })
        })
    }

    /// The table `control_outside`, in the order of the study: profiles by their windows.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn control_outside(&mut self) -> Result<Vec<Outside>, StoreError> {
        let sql = "SELECT a.* FROM control_outside AS a
            JOIN hvac_design AS d ON d.name = a.design JOIN comfort_window AS w USING (pmv_min, pmv_max)
            LEFT JOIN comfort_window AS p ON p.pmv_min = a.profile_pmv_min AND p.pmv_max = a.profile_pmv_max
            ORDER BY d.position, w.position, a.controller, p.position";
        self.select(sql, |r| {
            let limits: (Option<f64>, Option<f64>) = (r.try_get("profile_pmv_min")?, r.try_get("profile_pmv_max")?);
            let profile = match limits {
                (Some(low), Some(high)) => ComfortWindow::new(low, high).ok(),
                _ => None,
            };
            Ok(Outside {
                design: r.try_get("design")?,
                controller: r.try_get("controller")?,
                profile,
                window: window(r)?,
                mean_hvac_power_w: r.try_get("mean_hvac_power_w")?,
                outside_fraction: r.try_get("outside_fraction")?,
            })
        })
    }

    /// The mission that is shown in time, in the order of the study and of the controllers.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn control_traces(&mut self) -> Result<Vec<ControlTrace>, StoreError> {
        let sql = "SELECT a.* FROM control_trace AS a
            JOIN hvac_design AS d ON d.name = a.design JOIN comfort_window AS w USING (pmv_min, pmv_max)
            ORDER BY a.controller, d.position, w.position, a.minute";
        let rows = self.select(sql, |r| {
            let of = |minutes| {
                Ok::<_, sqlx::Error>(ControlTrace {
                    design: r.try_get("design")?,
                    window: window(r)?,
                    controller: r.try_get("controller")?,
                    mission: r.try_get("mission")?,
                    minutes,
                })
            };
            of(vec![minute(r)?])
        })?;
        let mut traces: Vec<ControlTrace> = Vec::new();
        for row in rows {
            let same = |t: &&mut ControlTrace| {
                (&t.controller, &t.design, t.window) == (&row.controller, &row.design, row.window)
            };
            match traces.last_mut().filter(same) {
                Some(trace) => trace.minutes.extend(row.minutes),
                None => traces.push(row),
            }
        }
        Ok(traces)
    }

    /// What the mission that is shown in time comes to under all controllers, by its largest absolute 15-minute vote, beside the
    /// largest of the optima: in the order of the study.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn control_trace_points(&mut self) -> Result<Vec<(ControlPoint, Option<f64>, f64)>, StoreError> {
        let sql = "SELECT c.*, d.name AS design, w.pmv_min, w.pmv_max, 1 AS mission_count,
                c.passenger_hours_outside / nullif(c.passenger_hours, 0.0) AS outside_fraction
            FROM controlled_mission AS c
            JOIN hvac_design AS d USING (design_id) JOIN comfort_window AS w USING (window_id)
            WHERE c.mission = (SELECT mission FROM control_trace LIMIT 1)
            ORDER BY d.position, w.position, c.controller";
        self.select(sql, |r| Ok((point(r)?, r.try_get("max_abs_pmv_15min")?, r.try_get("static_max_abs_pmv")?)))
    }

    /// The view `control_failure`: mission, design and reason.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn control_failures(&mut self) -> Result<Vec<[String; 3]>, StoreError> {
        let sql = "SELECT mission, design, reason FROM control_failure ORDER BY mission, design";
        self.select(sql, |r| Ok([r.try_get("mission")?, r.try_get("design")?, r.try_get("reason")?]))
    }
}

fn point(r: &SqliteRow) -> Result<ControlPoint, sqlx::Error> {
    Ok(ControlPoint {
        design: r.try_get("design")?,
        window: window(r)?,
        controller: r.try_get("controller")?,
        mean_hvac_power_w: r.try_get("mean_hvac_power_w")?,
        static_mean_hvac_power_w: r.try_get("static_mean_hvac_power_w")?,
        mean_abs_pmv: r.try_get("mean_abs_pmv")?,
        static_mean_abs_pmv: r.try_get("static_mean_abs_pmv")?,
        outside_fraction: r.try_get("outside_fraction")?,
        mission_count: count(r, "mission_count")?,
    })
}

fn minute(r: &SqliteRow) -> Result<ControlMinute, sqlx::Error> {
    Ok(ControlMinute {
        ambient_temperature_c: r.try_get("ambient_temperature_c")?,
        setpoint_c: r.try_get("setpoint_c")?,
        cabin_temperature_c: r.try_get("cabin_temperature_c")?,
        pmv: r.try_get("pmv")?,
        pmv_15min: r.try_get("pmv_15min")?,
        air_unit_power_w: r.try_get("air_unit_power_w")?,
        hvac_power_w: r.try_get("hvac_power_w")?,
    })
}

/// Replaces the mission that is shown in time.
pub(crate) async fn put_traces(
    c: &mut SqliteConnection,
    run_id: i64,
    traces: &[ControlTrace],
) -> Result<(), StoreError> {
    sqlx::query("DELETE FROM control_trace").execute(&mut *c).await?;
    for trace in traces {
        for (n, m) in trace.minutes.iter().enumerate() {
            let insert = Insert::into("control_trace")
                .set("design", trace.design.as_str())?
                .set("pmv_min", trace.window.pmv_min())?
                .set("pmv_max", trace.window.pmv_max())?
                .set("controller", trace.controller.as_str())?
                .set("mission", trace.mission.as_str())?
                .set("minute", n as i64)?
                .set("ambient_temperature_c", m.ambient_temperature_c)?
                .set("setpoint_c", m.setpoint_c)?
                .set("cabin_temperature_c", m.cabin_temperature_c)?
                .set("pmv", m.pmv)?
                .set("pmv_15min", m.pmv_15min)?
                .set("air_unit_power_w", m.air_unit_power_w)?
                .set("hvac_power_w", m.hvac_power_w)?
                .set("run_id", run_id)?;
            insert.execute(&mut *c).await?;
        }
    }
    Ok(())
}
