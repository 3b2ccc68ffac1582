//! What comfort costs in money and emissions.

use cabin::ComfortWindow;
use sqlx::Row;
use sqlx::sqlite::{SqliteConnection, SqliteRow};

use crate::row::{put_all, window};
use crate::{Store, StoreError};

/// The user's figures of a design.
#[derive(Debug, Clone, PartialEq)]
pub struct EconomicInput {
    /// Design.
    pub design: String,
    /// Currency of all costs.
    pub currency: String,
    /// Price of a kWh.
    pub price_per_kwh: f64,
    /// Emissions of a kWh in kg of CO₂ equivalents.
    pub carbon_kg_per_kwh: Option<f64>,
    /// Interest a year, as a fraction.
    pub interest: f64,
    /// What it costs to buy.
    pub investment: f64,
    /// What it costs to keep, a year.
    pub maintenance_per_year: f64,
    /// How long it lasts in years.
    pub life_years: f64,
    /// What a payment of 1 at the end of every year of its life is worth at its beginning.
    pub present_value_factor: f64,
}

/// A row of `economics`.
#[derive(Debug, Clone, PartialEq)]
pub struct EconomicRow {
    /// Design, and the one that it is compared with.
    pub designs: [String; 2],
    /// Comfort window.
    pub window: ComfortWindow,
    /// Currency of all costs.
    pub currency: String,
    /// HVAC energy of a bus in kWh a year.
    pub kwh_per_bus_year: Option<f64>,
    /// What it costs.
    pub energy_cost_per_year: Option<f64>,
    /// Energy, maintenance and investment spread over the life, a year.
    pub annual_cost: Option<f64>,
    /// All of it over the life, at its beginning.
    pub net_present_cost: Option<f64>,
    /// Emissions in kg of CO₂ equivalents a year.
    pub emissions_kg_per_year: Option<f64>,
    /// What it saves against the other design, in kWh a year.
    pub saved_kwh_per_year: Option<f64>,
    /// What that costs a kWh.
    pub cost_per_saved_kwh: Option<f64>,
    /// Price of a kWh at which both cost the same.
    pub break_even_price_per_kwh: Option<f64>,
}

impl Store {
    /// The table `economics`, in the order of the study.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn economics(&mut self) -> Result<Vec<EconomicRow>, StoreError> {
        self.in_study_order("economics", "", |r: &SqliteRow| {
            Ok(EconomicRow {
                designs: [r.try_get("design")?, r.try_get("reference_design")?],
                window: window(r)?,
                currency: r.try_get("currency")?,
                kwh_per_bus_year: r.try_get("kwh_per_bus_year")?,
                energy_cost_per_year: r.try_get("energy_cost_per_year")?,
                annual_cost: r.try_get("annual_cost")?,
                net_present_cost: r.try_get("net_present_cost")?,
                emissions_kg_per_year: r.try_get("emissions_kg_per_year")?,
                saved_kwh_per_year: r.try_get("saved_kwh_per_year")?,
                cost_per_saved_kwh: r.try_get("cost_per_saved_kwh")?,
                break_even_price_per_kwh: r.try_get("break_even_price_per_kwh")?,
            })
        })
    }
}

/// Replaces the user's figures.
pub(crate) async fn put(c: &mut SqliteConnection, run_id: i64, inputs: &[EconomicInput]) -> Result<(), StoreError> {
    sqlx::query("DELETE FROM economic_input").execute(&mut *c).await?;
    let rows: Vec<(i64, &EconomicInput)> = (0..).zip(inputs).collect();
    put_all(c, "economic_input", &rows, |insert, (order, row)| {
        insert
            .set("design", row.design.clone())?
            .set("design_order", *order)?
            .set("currency", row.currency.clone())?
            .set("price_per_kwh", row.price_per_kwh)?
            .set("carbon_kg_per_kwh", row.carbon_kg_per_kwh)?
            .set("interest", row.interest)?
            .set("investment", row.investment)?
            .set("maintenance_per_year", row.maintenance_per_year)?
            .set("life_years", row.life_years)?
            .set("present_value_factor", row.present_value_factor)?
            .set("run_id", run_id)
    })
    .await
}
