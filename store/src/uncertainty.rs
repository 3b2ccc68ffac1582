//! How sure a year is: sums of its days, the intervals that are drawn from them, and the year without a part of it.

use chrono::NaiveDate;
use sqlx::Row;
use sqlx::sqlite::SqliteConnection;

use crate::row::{Insert, high, low, pack, put_all, unpack};
use crate::{Store, StoreError, StoredGrid};

/// Sums over the solved samples of the missions that begin on a day.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DaySum {
    /// Samples.
    pub samples: f64,
    /// HVAC power in W.
    pub power_w: f64,
    /// Its square in W².
    pub power_w2: f64,
    /// HVAC power in W of samples in which the air unit heats or rests.
    pub heating_power_w: f64,
    /// HVAC energy in J of samples with a distance.
    pub driven_energy_j: f64,
    /// Distance in m.
    pub distance_m: f64,
}

/// The sums of a month.
#[derive(Debug, Clone, PartialEq)]
pub struct MonthDays {
    /// Local month of the samples, 1 … 12.
    pub month: u8,
    /// Local days on which their missions begin, in rising order.
    pub days: Vec<NaiveDate>,
    /// A sum for each day, for every design and within it every window of the study.
    pub cells: Vec<Vec<DaySum>>,
}

/// Ends of an interval of 90 %; `None` where it cannot be known.
pub type Ends = Option<[f64; 2]>;

/// How sure the annual means of a design and window are.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AnnualEnds {
    /// HVAC power in W.
    pub hvac_power_w: Ends,
    /// Its part while the air unit heats or rests.
    pub heating_power_w: Ends,
    /// Its part while it cools.
    pub cooling_power_w: Ends,
    /// Energy for a distance.
    pub kwh_per_km: Ends,
    /// Fraction saved against the design `ptc`, drawn together with it.
    pub reduction_vs_ptc: Ends,
    /// Power over that of the same design at PMV ±1, less 1, drawn together with it.
    pub change_vs_pmv_1: Ends,
}

/// How sure it is what a design saves against another one in the same window.
#[derive(Debug, Clone, PartialEq)]
pub struct PairEnds {
    /// Places of the design and of the other one in the study.
    pub designs: [usize; 2],
    /// Place of the window.
    pub window: usize,
    /// How much more the other one takes, in W.
    pub other_takes_more_w: Ends,
    /// Fraction of it that the design saves.
    pub saving: Ends,
}

/// How sure a month is.
#[derive(Debug, Clone, PartialEq)]
pub struct MonthSpread {
    /// Places of design and window.
    pub point: [usize; 2],
    /// Local month, 1 … 12.
    pub month: u8,
    /// Solved samples.
    pub samples: u64,
    /// Days on which their missions begin.
    pub days: u64,
    /// Standard error of the mean power in W; `None` with less than two days.
    pub standard_error_w: Option<f64>,
    /// Independent samples that would give the same error.
    pub effective_samples: Option<f64>,
}

/// The year without a part of it.
#[derive(Debug, Clone, PartialEq)]
pub struct LeftOut {
    /// Places of design and window.
    pub point: [usize; 2],
    /// What is left out: `route`, `year`, `month`.
    pub kind: &'static str,
    /// Which one.
    pub name: String,
    /// Solved samples that remain.
    pub samples: u64,
    /// Months that remain.
    pub months: u64,
    /// Annual mean of the others in W.
    pub hvac_power_w: f64,
    /// Relative change against the whole year.
    pub change: f64,
    /// Fraction saved against the design `ptc` in the same hours.
    pub reduction_vs_ptc: Option<f64>,
}

/// What completing the optima writes of how sure they are.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Uncertainty {
    /// Months that have changed.
    pub days: Vec<MonthDays>,
    /// Days on which a mission begins.
    pub day_count: u64,
    /// Months of a single day, whose spread nobody knows.
    pub single_day_months: u64,
    /// By design and within it by window.
    pub annual: Vec<AnnualEnds>,
    /// Every design against every other one.
    pub pairs: Vec<PairEnds>,
    /// Every month.
    pub spreads: Vec<MonthSpread>,
    /// Every route, year and month once.
    pub left_out: Vec<LeftOut>,
}

const SUMS: usize = 6;

impl DaySum {
    fn values(&self) -> [f64; SUMS] {
        let Self { samples, power_w, power_w2, heating_power_w, driven_energy_j, distance_m } = *self;
        [samples, power_w, power_w2, heating_power_w, driven_energy_j, distance_m]
    }

    fn of([samples, power_w, power_w2, heating_power_w, driven_energy_j, distance_m]: [f64; SUMS]) -> Self {
        Self { samples, power_w, power_w2, heating_power_w, driven_energy_j, distance_m }
    }
}

impl Store {
    /// The days of the months that are not to be averaged anew, in rising order.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn month_days(&mut self, grid: &StoredGrid) -> Result<Vec<MonthDays>, StoreError> {
        self.drive(async |c| {
            let mut all = Vec::new();
            let sql = "SELECT * FROM day_month WHERE month NOT IN (SELECT month FROM stale_month) ORDER BY month";
            for r in sqlx::query(sql).fetch_all(&mut *c).await? {
                let month: u8 = r.try_get("month")?;
                let days: Vec<NaiveDate> =
                    serde_json::from_str(r.try_get("days")?).map_err(|e| sqlx::Error::Decode(e.into()))?;
                let mut cells = vec![Vec::new(); grid.designs.len() * grid.windows.len()];
                let sql = "SELECT * FROM day_sum WHERE month = ?";
                for r in sqlx::query(sql).bind(month).fetch_all(&mut *c).await? {
                    let (design, window) =
                        (grid.design(r.try_get("design_id")?)?, grid.window(r.try_get("window_id")?)?);
                    let sums = unpack::<SUMS>(r.try_get("sums")?).into_iter().map(DaySum::of);
                    cells[design * grid.windows.len() + window] = sums.collect();
                }
                cells.iter_mut().for_each(|cell| cell.resize(days.len(), DaySum::default()));
                all.push(MonthDays { month, days, cells });
            }
            Ok(all)
        })
    }
}

/// Replaces intervals and spreads, and of the days those of months that have changed.
pub(crate) async fn put(
    c: &mut SqliteConnection,
    run_id: i64,
    grid: &StoredGrid,
    all: &Uncertainty,
) -> Result<(), StoreError> {
    for table in ["day_month", "day_sum"] {
        // The text is built from constants alone.
        let sql = format!("DELETE FROM {table} WHERE month IN (SELECT month FROM stale_month)");
        sqlx::query(sqlx::AssertSqlSafe(sql)).execute(&mut *c).await?;
    }
    for table in ["annual_interval", "design_interval", "month_spread", "left_out"] {
        sqlx::query(sqlx::AssertSqlSafe(format!("DELETE FROM {table}"))).execute(&mut *c).await?;
    }
    for month in &all.days {
        let days = serde_json::json!(month.days).to_string();
        Insert::into("day_month").set("month", month.month)?.set("days", days)?.execute(&mut *c).await?;
        for (n, cell) in month.cells.iter().enumerate() {
            let (design, window) = (n / grid.windows.len(), n % grid.windows.len());
            let row = Insert::into("day_sum")
                .set("month", month.month)?
                .set("design_id", grid.design_ids[design])?
                .set("window_id", grid.window_ids[window])?
                .set("sums", pack(cell.iter().flat_map(DaySum::values)))?;
            row.execute(&mut *c).await?;
        }
    }
    for (n, ends) in all.annual.iter().enumerate() {
        let (design, window) = (n / grid.windows.len(), n % grid.windows.len());
        put_annual(c, run_id, grid, [design, window], ends, all).await?;
    }
    put_all(c, "design_interval", &all.pairs, |insert, row| {
        let [design, other] = row.designs;
        insert
            .of_point(&grid.designs[design].name, grid.windows[row.window])?
            .set("other_design", grid.designs[other].name.clone())?
            .set("other_takes_more_low_w", low(row.other_takes_more_w))?
            .set("other_takes_more_high_w", high(row.other_takes_more_w))?
            .set("saving_low", low(row.saving))?
            .set("saving_high", high(row.saving))?
            .set("run_id", run_id)
    })
    .await?;
    put_all(c, "month_spread", &all.spreads, |insert, row| {
        let [design, window] = row.point;
        insert
            .of_point(&grid.designs[design].name, grid.windows[window])?
            .set("month", row.month)?
            .set("sample_count", row.samples.cast_signed())?
            .set("day_count", row.days.cast_signed())?
            .set("standard_error_w", row.standard_error_w)?
            .set("effective_sample_count", row.effective_samples)?
            .set("run_id", run_id)
    })
    .await?;
    put_all(c, "left_out", &all.left_out, |insert, row| {
        let [design, window] = row.point;
        insert
            .of_point(&grid.designs[design].name, grid.windows[window])?
            .set("kind", row.kind)?
            .set("name", row.name.clone())?
            .set("sample_count", row.samples.cast_signed())?
            .set("month_count", row.months.cast_signed())?
            .set("hvac_power_w", row.hvac_power_w)?
            .set("relative_change", row.change)?
            .set("reduction_vs_ptc", row.reduction_vs_ptc)?
            .set("run_id", run_id)
    })
    .await
}

async fn put_annual(
    c: &mut SqliteConnection,
    run_id: i64,
    grid: &StoredGrid,
    [design, window]: [usize; 2],
    ends: &AnnualEnds,
    all: &Uncertainty,
) -> Result<(), StoreError> {
    let row = Insert::into("annual_interval")
        .of_point(&grid.designs[design].name, grid.windows[window])?
        .set("hvac_power_low_w", low(ends.hvac_power_w))?
        .set("hvac_power_high_w", high(ends.hvac_power_w))?
        .set("heating_power_low_w", low(ends.heating_power_w))?
        .set("heating_power_high_w", high(ends.heating_power_w))?
        .set("cooling_power_low_w", low(ends.cooling_power_w))?
        .set("cooling_power_high_w", high(ends.cooling_power_w))?
        .set("kwh_per_km_low", low(ends.kwh_per_km))?
        .set("kwh_per_km_high", high(ends.kwh_per_km))?
        .set("reduction_vs_ptc_low", low(ends.reduction_vs_ptc))?
        .set("reduction_vs_ptc_high", high(ends.reduction_vs_ptc))?
        .set("change_vs_pmv_1_low", low(ends.change_vs_pmv_1))?
        .set("change_vs_pmv_1_high", high(ends.change_vs_pmv_1))?
        .set("day_count", all.day_count.cast_signed())?
        .set("single_day_month_count", all.single_day_months.cast_signed())?
        .set("run_id", run_id)?;
    row.execute(c).await.map(|_| ())
}
