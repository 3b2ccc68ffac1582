//! How sure a year is: sums of its days, the intervals that are drawn from them, and the year without a part of it.

use sqlx::Row;
use sqlx::sqlite::SqliteConnection;

use crate::row::{Insert, count, pack, unpack, window};
use crate::{Store, StoreError, StoredGrid};
use cabin::ComfortWindow;
use chrono::NaiveDate;

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
    /// Days of the year, and how many months have a single one.
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

const SUMS: usize = 6;
/// Rows of one INSERT.
const ROWS: usize = 256;

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

    /// The table `annual_interval`, in the order of the study.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn annual_intervals(&mut self) -> Result<Vec<AnnualInterval>, StoreError> {
        let sql = "SELECT i.* FROM annual_interval AS i
            JOIN hvac_design AS d ON d.name = i.design
            JOIN comfort_window AS w ON w.pmv_min = i.pmv_min AND w.pmv_max = i.pmv_max
            ORDER BY d.position, w.position";
        self.select(sql, |r| {
            Ok(AnnualInterval {
                design: r.try_get("design")?,
                window: window(r)?,
                hvac_power_w: ends(r, "hvac_power_low_w", "hvac_power_high_w")?,
                reduction_vs_ptc: ends(r, "reduction_vs_ptc_low", "reduction_vs_ptc_high")?,
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
}

impl Store {
    /// The table `month_spread`, in the order of the study.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn month_spreads(&mut self) -> Result<Vec<SpreadRow>, StoreError> {
        let sql = "SELECT i.* FROM month_spread AS i
            JOIN hvac_design AS d ON d.name = i.design
            JOIN comfort_window AS w ON w.pmv_min = i.pmv_min AND w.pmv_max = i.pmv_max
            ORDER BY d.position, w.position, i.month";
        self.select(sql, |r| {
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
        let sql = "SELECT i.* FROM left_out AS i
            JOIN hvac_design AS d ON d.name = i.design
            JOIN comfort_window AS w ON w.pmv_min = i.pmv_min AND w.pmv_max = i.pmv_max
            ORDER BY d.position, w.position, i.kind DESC, i.name";
        self.select(sql, |r| {
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

fn ends(r: &sqlx::sqlite::SqliteRow, low: &str, high: &str) -> Result<Ends, sqlx::Error> {
    let (low, high): (Option<f64>, Option<f64>) = (r.try_get(low)?, r.try_get(high)?);
    Ok(low.zip(high).map(|(low, high)| [low, high]))
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
    for rows in all.pairs.chunks(ROWS) {
        put_pairs(c, run_id, grid, rows).await?;
    }
    for rows in all.spreads.chunks(ROWS) {
        put_spreads(c, run_id, grid, rows).await?;
    }
    for rows in all.left_out.chunks(ROWS) {
        put_left_out(c, run_id, grid, rows).await?;
    }
    Ok(())
}

fn low(ends: Ends) -> Option<f64> {
    ends.map(|[low, _]| low)
}

fn high(ends: Ends) -> Option<f64> {
    ends.map(|[_, high]| high)
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
        .set("day_count", all.day_count.cast_signed())?
        .set("single_day_month_count", all.single_day_months.cast_signed())?
        .set("run_id", run_id)?;
    row.execute(c).await.map(|_| ())
}

async fn put_pairs(
    c: &mut SqliteConnection,
    run_id: i64,
    grid: &StoredGrid,
    rows: &[PairEnds],
) -> Result<(), StoreError> {
    let mut insert = Insert::into("design_interval");
    for (n, row) in rows.iter().enumerate() {
        insert = if n == 0 { insert } else { insert.another() };
        let [design, other] = row.designs;
        insert = insert
            .of_point(&grid.designs[design].name, grid.windows[row.window])?
            .set("other_design", grid.designs[other].name.clone())?
            .set("other_takes_more_low_w", low(row.other_takes_more_w))?
            .set("other_takes_more_high_w", high(row.other_takes_more_w))?
            .set("saving_low", low(row.saving))?
            .set("saving_high", high(row.saving))?
            .set("run_id", run_id)?;
    }
    insert.execute(c).await.map(|_| ())
}

async fn put_spreads(
    c: &mut SqliteConnection,
    run_id: i64,
    grid: &StoredGrid,
    rows: &[MonthSpread],
) -> Result<(), StoreError> {
    let mut insert = Insert::into("month_spread");
    for (n, row) in rows.iter().enumerate() {
        insert = if n == 0 { insert } else { insert.another() };
        let [design, window] = row.point;
        insert = insert
            .of_point(&grid.designs[design].name, grid.windows[window])?
            .set("month", row.month)?
            .set("sample_count", row.samples.cast_signed())?
            .set("day_count", row.days.cast_signed())?
            .set("standard_error_w", row.standard_error_w)?
            .set("effective_sample_count", row.effective_samples)?
            .set("run_id", run_id)?;
    }
    insert.execute(c).await.map(|_| ())
}

async fn put_left_out(
    c: &mut SqliteConnection,
    run_id: i64,
    grid: &StoredGrid,
    rows: &[LeftOut],
) -> Result<(), StoreError> {
    let mut insert = Insert::into("left_out");
    for (n, row) in rows.iter().enumerate() {
        insert = if n == 0 { insert } else { insert.another() };
        let [design, window] = row.point;
        insert = insert
            .of_point(&grid.designs[design].name, grid.windows[window])?
            .set("kind", row.kind)?
            .set("name", row.name.clone())?
            .set("sample_count", row.samples.cast_signed())?
            .set("month_count", row.months.cast_signed())?
            .set("hvac_power_w", row.hvac_power_w)?
            .set("relative_change", row.change)?
            .set("reduction_vs_ptc", row.reduction_vs_ptc)?
            .set("run_id", run_id)?;
    }
    insert.execute(c).await.map(|_| ())
}
