//! How sure a year is, as reports read it.

use cabin::ComfortWindow;
use sqlx::Row;

use crate::row::{count, ends, window};
use crate::{Ends, Store, StoreError};

/// A row of `annual_interval`.
#[derive(Debug, Clone, PartialEq)]
pub struct AnnualInterval {
    /// Design.
    pub design: String,
    /// Comfort window.
    pub window: ComfortWindow,
    /// HVAC power in W.
    pub hvac_power_w: Ends,
    /// Fraction saved against the design `ptc`.
    pub reduction_vs_ptc: Ends,
    /// Power over that of the same design at PMV ±1, less 1.
    pub change_vs_pmv_1: Ends,
}

/// A row of `design_interval`.
#[derive(Debug, Clone, PartialEq)]
pub struct DesignInterval {
    /// Design, and the one that it is compared with.
    pub designs: [String; 2],
    /// Comfort window.
    pub window: ComfortWindow,
    /// Fraction of the power of the other one that the design saves.
    pub saving: f64,
    /// Its interval.
    pub ends: Ends,
}

/// A row of `month_spread`.
#[derive(Debug, Clone, PartialEq)]
pub struct SpreadRow {
    /// Design.
    pub design: String,
    /// Comfort window.
    pub window: ComfortWindow,
    /// Local month, 1 … 12.
    pub month: u8,
    /// Solved samples.
    pub samples: u64,
    /// Days on which their missions begin.
    pub days: u64,
    /// Standard error of the mean power in W.
    pub standard_error_w: Option<f64>,
    /// Independent samples that would be as sure.
    pub effective_samples: Option<f64>,
}

/// A row of `left_out`.
#[derive(Debug, Clone, PartialEq)]
pub struct LeftOutRow {
    /// Design.
    pub design: String,
    /// Comfort window.
    pub window: ComfortWindow,
    /// What is left out: `route`, `year`, `month`.
    pub kind: String,
    /// Which one.
    pub name: String,
    /// Solved samples that remain.
    pub samples: u64,
    /// Annual mean of the others in W.
    pub hvac_power_w: f64,
    /// Relative change against the whole year.
    pub change: f64,
    /// Fraction saved against the design `ptc`.
    pub reduction_vs_ptc: Option<f64>,
}

impl Store {
    /// The table `annual_interval`, in the order of the study.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn annual_intervals(&mut self) -> Result<Vec<AnnualInterval>, StoreError> {
        self.in_study_order("annual_interval", "", |r| {
            Ok(AnnualInterval {
                design: r.try_get("design")?,
                window: window(r)?,
                hvac_power_w: ends(r, "hvac_power_low_w", "hvac_power_high_w")?,
                reduction_vs_ptc: ends(r, "reduction_vs_ptc_low", "reduction_vs_ptc_high")?,
                change_vs_pmv_1: ends(r, "change_vs_pmv_1_low", "change_vs_pmv_1_high")?,
            })
        })
    }

    /// The table `design_interval`, in the order of the study.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn design_intervals(&mut self) -> Result<Vec<DesignInterval>, StoreError> {
        let sql = "SELECT i.* FROM design_interval AS i
            JOIN hvac_design AS d ON d.name = i.design
            JOIN hvac_design AS o ON o.name = i.other_design
            JOIN comfort_window AS w ON w.pmv_min = i.pmv_min AND w.pmv_max = i.pmv_max
            WHERE i.saving IS NOT NULL
            ORDER BY d.position, o.position, w.position";
        self.select(sql, |r| {
            Ok(DesignInterval {
                designs: [r.try_get("design")?, r.try_get("other_design")?],
                window: window(r)?,
                saving: r.try_get("saving")?,
                ends: ends(r, "saving_low", "saving_high")?,
            })
        })
    }

    /// The table `month_spread`, in the order of the study.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn month_spreads(&mut self) -> Result<Vec<SpreadRow>, StoreError> {
        self.in_study_order("month_spread", ", t.month", |r| {
            Ok(SpreadRow {
                design: r.try_get("design")?,
                window: window(r)?,
                month: r.try_get("month")?,
                samples: count(r, "sample_count")?,
                days: count(r, "day_count")?,
                standard_error_w: r.try_get("standard_error_w")?,
                effective_samples: r.try_get("effective_sample_count")?,
            })
        })
    }

    /// The table `left_out`, in the order of the study; years, months, routes.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn left_out(&mut self) -> Result<Vec<LeftOutRow>, StoreError> {
        self.in_study_order("left_out", ", t.kind DESC, t.name", |r| {
            Ok(LeftOutRow {
                design: r.try_get("design")?,
                window: window(r)?,
                kind: r.try_get("kind")?,
                name: r.try_get("name")?,
                samples: count(r, "sample_count")?,
                hvac_power_w: r.try_get("hvac_power_w")?,
                change: r.try_get("relative_change")?,
                reduction_vs_ptc: r.try_get("reduction_vs_ptc")?,
            })
        })
    }
}
