//! What a controller can learn from the optima: profiles and thresholds.

use cabin::{ComfortWindow, OperatingMode};
use setpoints::{CurtainThreshold, Curve, HeaterThreshold, Profile, Setpoints, Shape, Threshold};
use sqlx::Row;
use sqlx::sqlite::{SqliteConnection, SqliteRow};

use crate::row::{Insert, count, window};
use crate::{Store, StoreError};

/// The setpoints of a design in a comfort window.
#[derive(Debug, Clone, PartialEq)]
pub struct SetpointRow {
    /// Name of the design.
    pub design: String,
    /// The comfort window.
    pub window: ComfortWindow,
    /// What was extracted.
    pub setpoints: Setpoints,
}

const MODES: [(OperatingMode, &str); 2] = [(OperatingMode::Heating, "heating"), (OperatingMode::Cooling, "cooling")];

/// What is stored of one operating mode.
struct OfMode {
    design: String,
    window: ComfortWindow,
    profile: Result<Profile, String>,
    curtain: Option<CurtainThreshold>,
    heaters: Option<HeaterThreshold>,
}

impl Store {
    /// The tables `setpoint_profile`, `curtain_threshold` and `heater_threshold`, in the order of the study.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn setpoints(&mut self) -> Result<Vec<SetpointRow>, StoreError> {
        let sql = "SELECT
                a.design, a.pmv_min, a.pmv_max, a.mode, a.kind, a.parameters, a.valid_from_ambient_c,
                a.valid_to_ambient_c, a.coverage, a.hour_count, a.reason,
                c.mode AS curtain_mode, c.threshold_k, c.analytic_threshold_k, c.misclassified_weight,
                h.below_ambient_c, h.misclassified_weight AS heater_misclassified, h.heater_temperature_c
            FROM setpoint_profile AS a
            JOIN hvac_design AS d ON d.name = a.design JOIN comfort_window AS w USING (pmv_min, pmv_max)
            LEFT JOIN curtain_threshold AS c USING (design, pmv_min, pmv_max, mode)
            LEFT JOIN heater_threshold AS h USING (design, pmv_min, pmv_max)
            ORDER BY d.position, w.position, a.mode DESC";
        let modes = self.select(sql, |r| {
            Ok(OfMode {
                design: r.try_get("design")?,
                window: window(r)?,
                profile: profile(r)?,
                curtain: curtain(r)?,
                heaters: heaters(r)?,
            })
        })?;
        // Heating, then cooling.
        let row = |modes: &[OfMode]| {
            let [heating, cooling] = modes else { return None };
            let setpoints = Setpoints {
                heating: heating.profile.clone(),
                cooling: cooling.profile.clone(),
                curtains: [heating.curtain, cooling.curtain].into_iter().flatten().collect(),
                heaters: heating.heaters,
            };
            Some(SetpointRow { design: heating.design.clone(), window: heating.window, setpoints })
        };
        Ok(modes.chunks(2).filter_map(row).collect())
    }
}

/// Replaces all of them.
pub(crate) async fn put(c: &mut SqliteConnection, run_id: i64, rows: &[SetpointRow]) -> Result<(), StoreError> {
    for table in ["setpoint_profile", "curtain_threshold", "heater_threshold"] {
        // The text is built from constants alone.
        sqlx::query(sqlx::AssertSqlSafe(format!("DELETE FROM {table}"))).execute(&mut *c).await?;
    }
    for row in rows {
        let into = |table: &'static str| Insert::into(table).of_point(&row.design, row.window)?.set("run_id", run_id);
        for ((_, mode), profile) in MODES.iter().zip([&row.setpoints.heating, &row.setpoints.cooling]) {
            let insert = into("setpoint_profile")?.set("mode", *mode)?;
            let insert = match profile {
                Err(reason) => insert.set("reason", reason.as_str())?,
                Ok(p) => insert
                    .set("kind", p.curve.shape.kind())?
                    .set("parameters", p.curve.shape.parameters())?
                    .set("valid_from_ambient_c", p.curve.valid_c[0])?
                    .set("valid_to_ambient_c", p.curve.valid_c[1])?
                    .set("coverage", p.coverage)?
                    .set("hour_count", p.points as i64)?,
            };
            insert.execute(&mut *c).await?;
        }
        for t in &row.setpoints.curtains {
            let mode = MODES.iter().find(|(mode, _)| *mode == t.mode).map_or("passive", |(_, name)| name);
            let insert = into("curtain_threshold")?
                .set("mode", mode)?
                .set("threshold_k", t.of_optima.map(|t| t.value))?
                .set("analytic_threshold_k", t.analytic_k)?
                .set("misclassified_weight", t.of_optima.map(|t| t.misclassified))?;
            insert.execute(&mut *c).await?;
        }
        if let Some(t) = &row.setpoints.heaters {
            let insert = into("heater_threshold")?
                .set("below_ambient_c", t.below_c)?
                .set("misclassified_weight", t.misclassified)?
                .set("heater_temperature_c", t.temperature_c)?;
            insert.execute(&mut *c).await?;
        }
    }
    Ok(())
}

fn profile(r: &SqliteRow) -> Result<Result<Profile, String>, sqlx::Error> {
    let Some(kind) = r.try_get::<Option<String>, _>("kind")? else {
        return Ok(Err(r.try_get("reason")?));
    };
    let parameters: String = r.try_get("parameters")?;
    let invalid = |e: serde_json::Error| sqlx::Error::ColumnDecode { index: "parameters".to_owned(), source: e.into() };
    let shape = match kind.as_str() {
        "quadratic" => Shape::Quadratic(serde_json::from_str(&parameters).map_err(invalid)?),
        _ => Shape::PiecewiseLinear(serde_json::from_str(&parameters).map_err(invalid)?),
    };
    let valid_c = [r.try_get("valid_from_ambient_c")?, r.try_get("valid_to_ambient_c")?];
    let points = usize::try_from(count(r, "hour_count")?).unwrap_or(usize::MAX);
    Ok(Ok(Profile { curve: Curve { shape, valid_c }, coverage: r.try_get("coverage")?, points }))
}

fn curtain(r: &SqliteRow) -> Result<Option<CurtainThreshold>, sqlx::Error> {
    let Some(name) = r.try_get::<Option<String>, _>("curtain_mode")? else { return Ok(None) };
    let mode = MODES.iter().find(|(_, known)| *known == name).map_or(OperatingMode::Passive, |(mode, _)| *mode);
    let threshold = |value| {
        let misclassified = r.try_get("misclassified_weight")?;
        Ok::<_, sqlx::Error>(Threshold { value, misclassified })
    };
    let of_optima = r.try_get::<Option<f64>, _>("threshold_k")?.map(threshold).transpose()?;
    Ok(Some(CurtainThreshold { mode, of_optima, analytic_k: r.try_get("analytic_threshold_k")? }))
}

fn heaters(r: &SqliteRow) -> Result<Option<HeaterThreshold>, sqlx::Error> {
    let Some(below_c) = r.try_get("below_ambient_c")? else { return Ok(None) };
    let (misclassified, temperature_c) = (r.try_get("heater_misclassified")?, r.try_get("heater_temperature_c")?);
    Ok(Some(HeaterThreshold { below_c, misclassified, temperature_c }))
}
