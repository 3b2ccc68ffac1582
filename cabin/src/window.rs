//! The comfort that is asked for.

/// A window of the predicted mean vote.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ComfortWindow {
    pmv_min: f64,
    pmv_max: f64,
}

/// The window is empty or leaves the scale.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("comfort window [{pmv_min}, {pmv_max}]: the lower limit must not exceed the upper one, and both lie in -3 … 3")]
pub struct WindowError {
    /// Lower limit that was asked for.
    pub pmv_min: f64,
    /// Upper limit that was asked for.
    pub pmv_max: f64,
}

impl ComfortWindow {
    /// Limit of the window that is shown where only one is: the one that the paper compares designs with.
    const SHOWN_LIMIT: f64 = 1.0;

    /// A window `[pmv_min, pmv_max]` within the scale −3 … 3.
    ///
    /// # Errors
    /// [`WindowError`] where the window is empty or leaves the scale.
    pub fn new(pmv_min: f64, pmv_max: f64) -> Result<Self, WindowError> {
        let scale = -3.0..=3.0;
        if pmv_min > pmv_max || !scale.contains(&pmv_min) || !scale.contains(&pmv_max) {
            return Err(WindowError { pmv_min, pmv_max });
        }
        // `+ 0.0` turns -0 into 0, so that equal windows are equal bits.
        Ok(Self { pmv_min: pmv_min + 0.0, pmv_max: pmv_max + 0.0 })
    }

    /// The window `[-limit, limit]` for `limit` in 0 … 3.
    ///
    /// # Errors
    /// [`WindowError`] where the limit is negative or beyond the scale.
    pub fn symmetric(limit: f64) -> Result<Self, WindowError> {
        Self::new(-limit, limit)
    }

    /// Lower limit.
    #[must_use]
    pub fn pmv_min(&self) -> f64 {
        self.pmv_min
    }

    /// Upper limit.
    #[must_use]
    pub fn pmv_max(&self) -> f64 {
        self.pmv_max
    }

    /// Whether it is `[-L, L]`.
    #[must_use]
    pub fn is_symmetric(&self) -> bool {
        self.pmv_min == -self.pmv_max
    }

    /// Whether it is `[-limit, limit]`.
    #[must_use]
    pub fn is_plus_minus(&self, limit: f64) -> bool {
        self.is_symmetric() && self.pmv_max == limit
    }

    /// The window that stands for several where only one is shown: ±1, or else the middle one; `None` of none.
    #[must_use]
    pub fn shown(windows: &[Self]) -> Option<Self> {
        windows.iter().find(|w| w.is_plus_minus(Self::SHOWN_LIMIT)).or_else(|| windows.get(windows.len() / 2)).copied()
    }

    /// The larger distance of a limit from neutral; for `[-L, L]` it is `L`.
    #[must_use]
    pub fn pmv_limit(&self) -> f64 {
        self.pmv_min.abs().max(self.pmv_max.abs())
    }
}
