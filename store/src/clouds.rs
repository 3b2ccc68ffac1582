//! The optima of a design in a comfort window as points of a figure.

use cabin::{ComfortWindow, OperatingMode};
use sqlx::Row;

use crate::{Store, StoreError};

/// The optimum of a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CloudPoint {
    /// Ambient temperature in °C.
    pub ambient_temperature_c: f64,
    /// Cabin temperature in °C.
    pub cabin_temperature_c: f64,
    /// What the air unit does.
    pub mode: OperatingMode,
    /// Heat that it brings in W, negative when cooling.
    pub air_unit_heat_w: f64,
    /// Whether the air curtains run.
    pub air_curtain: bool,
}

/// The optima of a design in a comfort window.
#[derive(Debug, Clone, PartialEq)]
pub struct Cloud {
    /// Design.
    pub design: String,
    /// Comfort window.
    pub window: ComfortWindow,
    /// Solved samples, in the order of their ids.
    pub points: Vec<CloudPoint>,
}

impl Store {
    /// The optima of a design in a comfort window, both of which the study has.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn cloud(&mut self, design: &str, window: ComfortWindow) -> Result<Cloud, StoreError> {
        let points = self.drive(async |c| {
            let sql = "SELECT s.ambient_temperature_k - 273.15 AS ambient_c, p.cabin_k - 273.15 AS cabin_c,
                    p.operating_mode, p.air_unit_heat_w, p.air_curtain_on
                FROM hourly_sample AS s
                JOIN optimum_point AS p USING (sample_id)
                WHERE p.design_id = (SELECT design_id FROM hvac_design WHERE name = ?)
                    AND p.window_id = (SELECT window_id FROM comfort_window WHERE pmv_min = ? AND pmv_max = ?)
                    AND p.status = 0
                ORDER BY sample_id";
            let query = sqlx::query(sql).bind(design).bind(window.pmv_min()).bind(window.pmv_max());
            let rows = query.fetch_all(c).await?;
            let point = |r: &sqlx::sqlite::SqliteRow| {
                Ok(CloudPoint {
                    ambient_temperature_c: r.try_get("ambient_c")?,
                    cabin_temperature_c: r.try_get("cabin_c")?,
                    mode: match r.try_get::<i64, _>("operating_mode")? {
                        1 => OperatingMode::Heating,
                        -1 => OperatingMode::Cooling,
                        _ => OperatingMode::Passive,
                    },
                    air_unit_heat_w: r.try_get("air_unit_heat_w")?,
                    air_curtain: r.try_get("air_curtain_on")?,
                })
            };
            rows.iter().map(point).collect::<Result<Vec<CloudPoint>, StoreError>>()
        })?;
        Ok(Cloud { design: design.to_owned(), window, points })
    }
}
