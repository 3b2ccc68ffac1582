//! The bus that the optima were found with, and what it can give.

use cabin::HeatTransfer;
use sqlx::Row;
use sqlx::sqlite::SqliteConnection;
use std::collections::BTreeSet;

use crate::checks::{commit, seal_averages};
use crate::row::{Insert, begin};
use crate::{Store, StoreError, StoredGrid};

/// What the optima are found with, besides the designs.
#[derive(Debug, Clone, PartialEq)]
pub struct BusRow {
    /// Coefficients.
    pub transfer: HeatTransfer,
    /// Heat of a passenger in W.
    pub passenger_heat_w: f64,
    /// Heat of electric components in W.
    pub other_heat_w: f64,
    /// Electric power of the air unit in W that the vehicle can give in heating and in cooling, by design.
    pub limits_w: Vec<[f64; 2]>,
}

impl Store {
    /// Makes the bus of the database this one. What rests on another goes, or is added up again.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn put_bus(&mut self, grid: &StoredGrid, bus: &BusRow) -> Result<(), StoreError> {
        self.drive(async |c| {
            let mut tx = begin(c).await?;
            put_transfer(&mut tx, bus).await?;
            let mut stored = BTreeSet::new();
            for r in sqlx::query("SELECT * FROM power_limit").fetch_all(&mut *tx).await? {
                let limits: [f64; 2] = [r.try_get("heating_limit_w")?, r.try_get("cooling_limit_w")?];
                stored.insert((r.try_get::<i64, _>("design_id")?, limits.map(f64::to_bits)));
            }
            let wanted = |(id, limits): (&i64, &[f64; 2])| (*id, limits.map(f64::to_bits));
            if stored != grid.design_ids.iter().zip(&bus.limits_w).map(wanted).collect() {
                for (id, [heating_w, cooling_w]) in grid.design_ids.iter().zip(&bus.limits_w) {
                    let row = Insert::replacing("power_limit").set("design_id", id)?;
                    row.set("heating_limit_w", heating_w)?.set("cooling_limit_w", cooling_w)?.execute(&mut tx).await?;
                }
                for month in 1..=12 {
                    sqlx::query("INSERT OR IGNORE INTO stale_month VALUES (?)").bind(month).execute(&mut *tx).await?;
                }
            }
            seal_averages(&mut tx).await?;
            commit(tx).await
        })
    }
}

async fn put_transfer(c: &mut SqliteConnection, bus: &BusRow) -> Result<(), StoreError> {
    let t = &bus.transfer;
    let row = Insert::replacing("heat_transfer")
        .set("one", 1)?
        .set("convection_shell_inside_w_k", t.convection_shell_inside_w_k)?
        .set("convection_interior_w_k", t.convection_interior_w_k)?
        .set("convection_radiant_heater_w_k", t.convection_radiant_heater_w_k)?
        .set("convection_shell_outside_w_k", t.convection_shell_outside_w_k)?
        .set("conduction_shell_w_k", t.conduction_shell_w_k)?
        .set("radiation_heater_interior_w_k4", t.radiation_heater_interior_w_k4)?
        .set("radiation_heater_shell_w_k4", t.radiation_heater_shell_w_k4)?
        .set("radiation_interior_shell_w_k4", t.radiation_interior_shell_w_k4)?
        .set("radiation_shell_outside_w_k4", t.radiation_shell_outside_w_k4)?
        .set("passenger_heat_w", bus.passenger_heat_w)?
        .set("other_heat_w", bus.other_heat_w)?;
    row.execute(c).await.map(|_| ())
}
