//! Buses that differ from the study's, beside it.

use cabin::ComfortWindow;
use solve::AnnualMean;
use sqlx::Row;
use sqlx::sqlite::{SqliteConnection, SqliteRow};

use crate::row::{count, put_all, window};
use crate::{Store, StoreError, StoredGrid};

/// What a variant overrides, and its year beside that of the bus.
#[derive(Debug, Clone, PartialEq)]
pub struct NewVariant {
    /// Its name.
    pub name: String,
    /// Inputs with the value of the variant and that of the bus.
    pub settings: Vec<(String, f64, Option<f64>)>,
    /// Places of designs and windows with the means of the variant and of the bus.
    pub years: Vec<([usize; 2], [AnnualMean; 2])>,
}

/// A row of `variant_annual`.
#[derive(Debug, Clone, PartialEq)]
pub struct VariantYear {
    /// Name of the variant.
    pub variant: String,
    /// Design.
    pub design: String,
    /// Comfort window.
    pub window: ComfortWindow,
    /// Annual mean power of the variant in W.
    pub hvac_power_w: Option<f64>,
    /// Its part while the air unit heats or rests.
    pub heating_power_w: Option<f64>,
    /// Its part while it cools.
    pub cooling_power_w: Option<f64>,
    /// Annual mean power of the bus in W.
    pub base_hvac_power_w: Option<f64>,
    /// Samples that are not solved.
    pub unsolved: u64,
    /// Samples in which the variant misses the window, for want of power.
    pub limited: u64,
    /// Samples in which the bus does.
    pub base_limited: u64,
}

/// A row of `variant_setting`.
#[derive(Debug, Clone, PartialEq)]
pub struct VariantSetting {
    /// Name of the variant.
    pub variant: String,
    /// Name of the input.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// That of the bus.
    pub base_value: Option<f64>,
}

impl Store {
    /// The table `variant_annual`, in the order of the study.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn variant_years(&mut self) -> Result<Vec<VariantYear>, StoreError> {
        let sql = "SELECT v.* FROM variant_annual AS v
            JOIN hvac_design AS d ON d.name = v.design
            JOIN comfort_window AS w ON w.pmv_min = v.pmv_min AND w.pmv_max = v.pmv_max
            ORDER BY v.variant_order, d.position, w.position";
        self.select(sql, |r: &SqliteRow| {
            Ok(VariantYear {
                variant: r.try_get("variant")?,
                design: r.try_get("design")?,
                window: window(r)?,
                hvac_power_w: r.try_get("hvac_power_w")?,
                heating_power_w: r.try_get("heating_power_w")?,
                cooling_power_w: r.try_get("cooling_power_w")?,
                base_hvac_power_w: r.try_get("base_hvac_power_w")?,
                unsolved: count(r, "unsolved_count")?,
                limited: count(r, "limited_count")?,
                base_limited: count(r, "base_limited_count")?,
            })
        })
    }

    /// The table `variant_setting`, by name.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn variant_settings(&mut self) -> Result<Vec<VariantSetting>, StoreError> {
        self.select("SELECT * FROM variant_setting ORDER BY variant, name", |r: &SqliteRow| {
            Ok(VariantSetting {
                variant: r.try_get("variant")?,
                name: r.try_get("name")?,
                value: r.try_get("value")?,
                base_value: r.try_get("base_value")?,
            })
        })
    }
}

/// Replaces all variants.
pub(crate) async fn put(
    c: &mut SqliteConnection,
    run_id: i64,
    grid: &StoredGrid,
    variants: &[NewVariant],
) -> Result<(), StoreError> {
    for sql in ["DELETE FROM variant_setting", "DELETE FROM variant_annual"] {
        sqlx::query(sql).execute(&mut *c).await?;
    }
    for (order, variant) in variants.iter().enumerate() {
        put_all(c, "variant_setting", &variant.settings, |insert, (name, value, base_value)| {
            insert
                .set("variant", variant.name.clone())?
                .set("name", name.clone())?
                .set("value", *value)?
                .set("base_value", *base_value)?
                .set("run_id", run_id)
        })
        .await?;
        put_all(c, "variant_annual", &variant.years, |insert, ([design, window], [own, base])| {
            let powers = own.hvac_power_w.zip(base.hvac_power_w);
            insert
                .of_point(&grid.designs[*design].name, grid.windows[*window])?
                .set("variant", variant.name.clone())?
                .set("variant_order", order as i64)?
                .set("hvac_power_w", own.hvac_power_w)?
                .set("heating_power_w", own.heating_power_w)?
                .set("cooling_power_w", own.cooling_power_w)?
                .set("base_hvac_power_w", base.hvac_power_w)?
                .set("base_heating_power_w", base.heating_power_w)?
                .set("base_cooling_power_w", base.cooling_power_w)?
                .set("difference_w", powers.map(|(own, base)| own - base))?
                .set("relative_change", powers.filter(|(_, base)| *base > 0.0).map(|(own, base)| own / base - 1.0))?
                .set("sample_count", own.samples.cast_signed())?
                .set("unsolved_count", own.unsolved.cast_signed())?
                .set("limited_count", own.limited.cast_signed())?
                .set("base_limited_count", base.limited.cast_signed())?
                .set("run_id", run_id)
        })
        .await?;
    }
    Ok(())
}
