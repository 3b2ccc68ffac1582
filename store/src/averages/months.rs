//! What the optima come to in each month. They are added up as their rows are read for other sums: SQLite would sort all of them
//! once more.

use cabin::{ComfortWindow, OperatingMode, Operation, StandardRange};
use solve::PowerSums;
use sqlx::sqlite::SqliteConnection;

use crate::row::put_all;
use crate::{StoreError, StoredGrid, StoredOptimum};

/// A limit that binds is met to rounding; the next state inside is many orders of magnitude away.
const AT_LIMIT: f64 = 1e-6;

/// Averages of a month that is being added up.
#[derive(Debug, Clone)]
pub struct MonthAverages {
    month: u8,
    windows: Vec<ComfortWindow>,
    /// For every design and within it every window.
    points: Vec<OfPoint>,
}

/// Of a design and window.
#[derive(Debug, Clone, Copy, Default)]
struct OfPoint {
    samples: u64,
    lower: i64,
    upper: i64,
    heating: i64,
    cooling: i64,
    outside_range: i64,
    powers: PowerSums,
}

impl MonthAverages {
    /// Nothing yet, of a local month.
    #[must_use]
    pub fn new(month: u8, grid: &StoredGrid) -> Self {
        let points = vec![OfPoint::default(); grid.designs.len() * grid.windows.len()];
        Self { month, windows: grid.windows.clone(), points }
    }

    /// Counts an optimum of the month, whose design and window are places in its grid. Those of the same design and window come
    /// in the order of their samples' ids: sums depend on it in their last digits.
    pub fn add(&mut self, optimum: &StoredOptimum) {
        let point = &mut self.points[optimum.design * self.windows.len() + optimum.window];
        point.samples += 1;
        if let Some(o) = optimum.outcome.as_ref().and_then(|outcome| outcome.operation()) {
            point.add(o, self.windows[optimum.window]);
        }
    }
}

impl OfPoint {
    fn add(&mut self, o: &Operation, window: ComfortWindow) {
        self.powers.add(o.mode, o.hvac_power_w());
        self.lower += i64::from(o.pmv < window.pmv_min() + AT_LIMIT);
        self.upper += i64::from(o.pmv > window.pmv_max() - AT_LIMIT);
        self.heating += i64::from(o.mode == OperatingMode::Heating);
        self.cooling += i64::from(o.mode == OperatingMode::Cooling);
        self.outside_range += i64::from(o.standard_range == StandardRange::Outside);
    }
}

/// Replaces the averages of the months whose samples, designs or windows have changed.
pub(super) async fn put(
    c: &mut SqliteConnection,
    run_id: i64,
    grid: &StoredGrid,
    months: &[MonthAverages],
) -> Result<(), StoreError> {
    let sql = "DELETE FROM monthly_average WHERE month IN (SELECT month FROM stale_month)";
    sqlx::query(sql).execute(&mut *c).await?;
    for of_month in months {
        let present: Vec<(usize, OfPoint)> =
            of_month.points.iter().copied().enumerate().filter(|(_, point)| point.samples > 0).collect();
        put_all(c, "monthly_average", &present, |insert, (place, point)| {
            let (design, window) = (place / grid.windows.len(), place % grid.windows.len());
            let means_w = point.powers.means_w();
            let mean_w = |of: usize| means_w.map(|means_w| means_w[of]);
            insert
                .of_point(&grid.designs[design].name, grid.windows[window])?
                .set("month", of_month.month)?
                .set("hvac_power_w", mean_w(0))?
                .set("heating_power_w", mean_w(1))?
                .set("cooling_power_w", mean_w(2))?
                .set("sample_count", point.samples.cast_signed())?
                .set("unsolved_count", (point.samples - point.powers.solved()).cast_signed())?
                .set("lower_count", point.lower)?
                .set("upper_count", point.upper)?
                .set("heating_count", point.heating)?
                .set("cooling_count", point.cooling)?
                .set("outside_range_count", point.outside_range)?
                .set("run_id", run_id)
        })
        .await?;
    }
    Ok(())
}
