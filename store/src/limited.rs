//! How often and how far the limits of designs keep them from their comfort windows.

use cabin::ComfortWindow;
use sqlx::Row;
use sqlx::sqlite::SqliteRow;

use crate::row::{count, window};
use crate::{Store, StoreError};

/// A row of `limited_annual`.
#[derive(Debug, Clone, PartialEq)]
pub struct LimitedRow {
    /// Design.
    pub design: String,
    /// Comfort window.
    pub window: ComfortWindow,
    /// Samples whose window is not met.
    pub limited: u64,
    /// Share of the year in them.
    pub weight: f64,
    /// Heat in W that is missing at the limit of the window: mean over them, and the largest.
    pub unmet_heat_w: [f64; 2],
    /// Distance of the vote from the window: mean over them, and the largest.
    pub pmv_miss: [f64; 2],
    /// Power of the back-up heater in W, mean over the year.
    pub backup_heater_power_w: f64,
}

impl Store {
    /// The table `limited_annual`, in the order of the study.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn limited(&mut self) -> Result<Vec<LimitedRow>, StoreError> {
        self.in_study_order("limited_annual", "", |r: &SqliteRow| {
            Ok(LimitedRow {
                design: r.try_get("design")?,
                window: window(r)?,
                limited: count(r, "limited_count")?,
                weight: r.try_get("limited_weight")?,
                unmet_heat_w: [r.try_get("mean_unmet_heat_w")?, r.try_get("largest_unmet_heat_w")?],
                pmv_miss: [r.try_get("mean_pmv_miss")?, r.try_get("largest_pmv_miss")?],
                backup_heater_power_w: r.try_get("backup_heater_power_w")?,
            })
        })
    }
}
