//! What electricity and designs cost: the user's own figures, none of ours.

use solve::Grid;

use crate::file;

/// The figures of a design.
#[derive(Debug, Clone, PartialEq)]
pub struct DesignCost {
    /// Place of the design.
    pub design: usize,
    /// What it costs to buy.
    pub investment: f64,
    /// What it costs to keep, a year.
    pub maintenance_per_year: f64,
    /// How long it lasts in years.
    pub life_years: f64,
}

/// What electricity and designs cost.
#[derive(Debug, Clone, PartialEq)]
pub struct Economics {
    /// Currency of all costs.
    pub currency: String,
    /// Price of a kWh.
    pub price_per_kwh: f64,
    /// Emissions of a kWh in kg of CO₂ equivalents.
    pub carbon_kg_per_kwh: Option<f64>,
    /// Interest a year, as a fraction.
    pub interest: f64,
    /// The designs that have figures, in the order of the study file: the first one is what the others are compared with.
    pub designs: Vec<DesignCost>,
}

impl Economics {
    /// What a payment of 1 at the end of every year of a life is worth at its beginning.
    #[must_use]
    pub fn present_value_factor(&self, life_years: f64) -> f64 {
        if self.interest == 0.0 {
            return life_years;
        }
        -(-life_years * self.interest.ln_1p()).exp_m1() / self.interest
    }
}

pub(crate) fn economics(typed: &file::Economics, grid: &Grid) -> Result<Economics, String> {
    let within = |key: &str, value: f64, low: f64, high: f64| {
        let error = || format!("[economics] {key} = {value} must lie between {low} and {high}");
        if (low..=high).contains(&value) { Ok(value) } else { Err(error()) }
    };
    let design = |(name, cost): &(String, file::DesignCost)| {
        let known = || grid.designs().iter().map(|d| d.name.as_str()).collect::<Vec<_>>().join(", ");
        let place = grid.designs().iter().position(|design| design.name == *name);
        let design =
            place.ok_or_else(|| format!("[economics.designs] {name:?} is not one of the study's: {}", known()))?;
        let of = |key: &str| format!("designs.{name:?}.{key}");
        Ok(DesignCost {
            design,
            investment: within(&of("investment"), cost.investment, 0.0, 1e12)?,
            maintenance_per_year: within(&of("maintenance_per_year"), cost.maintenance_per_year, 0.0, 1e12)?,
            life_years: within(&of("life_years"), cost.life_years.unwrap_or(typed.life_years), 0.1, 100.0)?,
        })
    };
    let designs = typed.designs.iter().map(design).collect::<Result<Vec<_>, String>>()?;
    if designs.is_empty() {
        return Err("[economics.designs] is empty; give at least one design its investment".to_owned());
    }
    if typed.currency.is_empty() {
        return Err("[economics] currency is empty; give one such as \"CHF\"".to_owned());
    }
    Ok(Economics {
        currency: typed.currency.clone(),
        price_per_kwh: within("price_per_kwh", typed.price_per_kwh, 0.0, 1e6)?,
        carbon_kg_per_kwh: typed.carbon_kg_per_kwh.map(|kg| within("carbon_kg_per_kwh", kg, 0.0, 10.0)).transpose()?,
        interest: within("interest", typed.interest, 0.0, 1.0)?,
        designs,
    })
}
