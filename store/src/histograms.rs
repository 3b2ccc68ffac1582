//! How often what: disturbances and votes in bins, as reports read them.

use cabin::ComfortWindow;
use sqlx::Row;

use crate::row::{count, window};
use crate::{Store, StoreError};

/// A row of `disturbance_histogram`.
#[derive(Debug, Clone, PartialEq)]
pub struct DisturbanceBin {
    /// A column of the view `sample`.
    pub quantity: String,
    /// Lower end, which is in it, and upper end.
    pub ends: [f64; 2],
    /// Samples.
    pub samples: u64,
}

/// A row of `pmv_histogram`.
#[derive(Debug, Clone, PartialEq)]
pub struct VoteBin {
    /// Design.
    pub design: String,
    /// Comfort window.
    pub window: ComfortWindow,
    /// Ends of the bin.
    pub ends: [f64; 2],
    /// Samples.
    pub samples: u64,
    /// Share in the year.
    pub weight: f64,
}

impl Store {
    /// The table `disturbance_histogram`.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn disturbance_bins(&mut self) -> Result<Vec<DisturbanceBin>, StoreError> {
        let sql = "SELECT * FROM disturbance_histogram ORDER BY quantity, bin_from";
        self.select(sql, |r| {
            Ok(DisturbanceBin {
                quantity: r.try_get("quantity")?,
                ends: [r.try_get("bin_from")?, r.try_get("bin_to")?],
                samples: count(r, "sample_count")?,
            })
        })
    }

    /// The view `pmv_histogram`, in the order of the study.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn vote_bins(&mut self) -> Result<Vec<VoteBin>, StoreError> {
        self.in_study_order("pmv_histogram", ", t.bin_from", |r| {
            Ok(VoteBin {
                design: r.try_get("design")?,
                window: window(r)?,
                ends: [r.try_get("bin_from")?, r.try_get("bin_to")?],
                samples: count(r, "sample_count")?,
                weight: r.try_get("weight")?,
            })
        })
    }
}
