//! What reports, `status` and `show` read: the views of the schema as plain rows.

use cabin::ComfortWindow;
use sqlx::sqlite::SqliteRow;
use sqlx::{AssertSqlSafe, Row};

use crate::row::{count, window};
use crate::{Store, StoreError};

/// A row of `annual_average`.
#[derive(Debug, Clone, PartialEq)]
pub struct AnnualRow {
    /// Design.
    pub design: String,
    /// Comfort window.
    pub window: ComfortWindow,
    /// Annual mean power in W; `None` while nothing is solved.
    pub hvac_power_w: Option<f64>,
    /// Share of it while the air unit heats or rests, in W.
    pub heating_power_w: Option<f64>,
    /// Share of it while the air unit cools, in W.
    pub cooling_power_w: Option<f64>,
    /// Samples.
    pub sample_count: u64,
    /// Samples without an optimum.
    pub unsolved_count: u64,
    /// Their weight.
    pub unsolved_weight: f64,
    /// Fraction saved against the design `ptc` in the same window.
    pub reduction_vs_ptc: Option<f64>,
}

/// A row of `monthly_average`.
#[derive(Debug, Clone, PartialEq)]
pub struct MonthlyRow {
    /// Design.
    pub design: String,
    /// Comfort window.
    pub window: ComfortWindow,
    /// Local month, 1 … 12.
    pub month: u8,
    /// Mean power in W; `None` while nothing is solved.
    pub hvac_power_w: Option<f64>,
    /// Samples.
    pub sample_count: u64,
}

/// A month that has samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MonthRow {
    /// Local month, 1 … 12.
    pub month: u8,
    /// Samples.
    pub sample_count: u64,
    /// Weight of one of its samples.
    pub sample_weight: f64,
}

/// In how many samples of a design and window a limit of comfort binds, and what the air unit does.
#[derive(Debug, Clone, PartialEq)]
pub struct LimitShare {
    /// Design.
    pub design: String,
    /// Comfort window.
    pub window: ComfortWindow,
    /// Solved samples.
    pub solved_count: u64,
    /// Samples at the lower limit.
    pub lower_count: u64,
    /// Samples at the upper limit.
    pub upper_count: u64,
    /// Samples that heat by the air unit.
    pub heating_count: u64,
    /// Samples that cool.
    pub cooling_count: u64,
    /// Weight of the samples at the lower limit, of all solved ones.
    pub lower_weight: f64,
    /// Weight of the samples that cool, of all solved ones.
    pub cooling_weight: f64,
    /// Samples whose state leaves the range of use of ISO 7730.
    pub outside_range_count: u64,
}

/// A row of `annual_energy`.
#[derive(Debug, Clone, PartialEq)]
pub struct EnergyRow {
    /// Design.
    pub design: String,
    /// Comfort window.
    pub window: ComfortWindow,
    /// HVAC energy in kWh for a kilometre; `None` where the telemetry has no distances.
    pub kwh_per_km: Option<f64>,
    /// Hours in operation of a bus in a year.
    pub operating_hours_per_bus_year: Option<f64>,
}

/// How many segments gave no sample for one reason.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExclusionCount {
    /// The reason.
    pub reason: String,
    /// How many.
    pub count: u64,
}

/// A stored optimum, as far as `show` compares it.
#[derive(Debug, Clone, PartialEq)]
pub struct OptimumRow {
    /// Status.
    pub status: String,
    /// Total power in W.
    pub hvac_power_w: Option<f64>,
    /// By how much the next choice of heaters and curtain is more expensive, in W.
    pub runner_up_excess_w: Option<f64>,
}

impl Store {
    /// The table `annual_average`, in the order of the study.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn annual(&mut self) -> Result<Vec<AnnualRow>, StoreError> {
        self.in_study_order("annual_average", "", |r| {
            Ok(AnnualRow {
                design: r.try_get("design")?,
                window: window(r)?,
                hvac_power_w: r.try_get("hvac_power_w")?,
                heating_power_w: r.try_get("heating_power_w")?,
                cooling_power_w: r.try_get("cooling_power_w")?,
                sample_count: count(r, "sample_count")?,
                unsolved_count: count(r, "unsolved_count")?,
                unsolved_weight: r.try_get("unsolved_weight")?,
                reduction_vs_ptc: r.try_get("reduction_vs_ptc")?,
            })
        })
    }

    /// The table `monthly_average`, in the order of the study and the year.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn monthly(&mut self) -> Result<Vec<MonthlyRow>, StoreError> {
        self.in_study_order("monthly_average", ", t.month", |r| {
            Ok(MonthlyRow {
                design: r.try_get("design")?,
                window: window(r)?,
                month: r.try_get("month")?,
                hvac_power_w: r.try_get("hvac_power_w")?,
                sample_count: count(r, "sample_count")?,
            })
        })
    }

    /// The months that have samples, in the order of the year.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn months(&mut self) -> Result<Vec<MonthRow>, StoreError> {
        self.select("SELECT month, sample_count, sample_weight FROM month_weight ORDER BY month", |r| {
            Ok(MonthRow {
                month: r.try_get("month")?,
                sample_count: count(r, "sample_count")?,
                sample_weight: r.try_get("sample_weight")?,
            })
        })
    }

    /// The table `annual_energy`, in the order of the study.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn energies(&mut self) -> Result<Vec<EnergyRow>, StoreError> {
        self.in_study_order("annual_energy", "", |r| {
            Ok(EnergyRow {
                design: r.try_get("design")?,
                window: window(r)?,
                kwh_per_km: r.try_get("kwh_per_km")?,
                operating_hours_per_bus_year: r.try_get("operating_hours_per_bus_year")?,
            })
        })
    }

    /// The table `limit_share`, in the order of the study.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn limit_shares(&mut self) -> Result<Vec<LimitShare>, StoreError> {
        self.in_study_order("limit_share", "", |r| {
            Ok(LimitShare {
                design: r.try_get("design")?,
                window: window(r)?,
                solved_count: count(r, "solved_count")?,
                lower_count: count(r, "lower_count")?,
                upper_count: count(r, "upper_count")?,
                heating_count: count(r, "heating_count")?,
                cooling_count: count(r, "cooling_count")?,
                lower_weight: r.try_get("lower_weight")?,
                cooling_weight: r.try_get("cooling_weight")?,
                outside_range_count: count(r, "outside_range_count")?,
            })
        })
    }

    /// Segments without a sample, counted by reason.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn exclusion_counts(&mut self) -> Result<Vec<ExclusionCount>, StoreError> {
        let sql = "SELECT reason, count(*) AS segment_count FROM excluded_segment
            GROUP BY reason ORDER BY segment_count DESC, reason";
        self.select(sql, |r| Ok(ExclusionCount { reason: r.try_get("reason")?, count: count(r, "segment_count")? }))
    }

    /// Weight of a sample in the annual average; `None` where there is no such sample.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn sample_weight(&mut self, sample_id: i64) -> Result<Option<f64>, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT weight FROM sample WHERE sample_id = ?";
            Ok(sqlx::query(sql).bind(sample_id).fetch_optional(c).await?.map(|r| r.try_get("weight")).transpose()?)
        })
    }

    /// The stored optimum of a sample, design and window.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn optimum(
        &mut self,
        sample_id: i64,
        design: &str,
        window: ComfortWindow,
    ) -> Result<Option<OptimumRow>, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT status, hvac_power_w, runner_up_excess_w FROM optimum
                WHERE sample_id = ? AND design = ? AND pmv_min = ? AND pmv_max = ?";
            let query = sqlx::query(sql).bind(sample_id).bind(design).bind(window.pmv_min()).bind(window.pmv_max());
            let Some(r) = query.fetch_optional(c).await? else { return Ok(None) };
            Ok(Some(OptimumRow {
                status: r.try_get("status")?,
                hvac_power_w: r.try_get("hvac_power_w")?,
                runner_up_excess_w: r.try_get("runner_up_excess_w")?,
            }))
        })
    }

    /// The rows of any query as text, for tests that compare the contract's views: NULL is empty.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`], also where the query is not valid.
    pub fn query_text(&mut self, sql: &str) -> Result<Vec<Vec<String>>, StoreError> {
        let sql = sql.to_owned();
        self.drive(async |c| {
            let rows = sqlx::query(AssertSqlSafe(sql)).fetch_all(c).await?;
            rows.iter()
                .map(|r| {
                    (0..r.len())
                        .map(|i| {
                            let text: Option<String> = r.try_get_unchecked(i)?;
                            Ok(text.unwrap_or_default())
                        })
                        .collect()
                })
                .collect()
        })
    }

    /// The rows of a table or view that has design and window, in the order of the study; `then` orders those of the same point:
    /// nothing, or columns of `t` with a comma before each.
    pub(crate) fn in_study_order<T>(
        &mut self,
        table: &'static str,
        then: &'static str,
        row: impl Fn(&SqliteRow) -> Result<T, sqlx::Error>,
    ) -> Result<Vec<T>, StoreError> {
        let sql = format!(
            "SELECT t.* FROM {table} AS t
            JOIN hvac_design AS d ON d.name = t.design
            JOIN comfort_window AS w ON w.pmv_min = t.pmv_min AND w.pmv_max = t.pmv_max
            ORDER BY d.position, w.position{then}"
        );
        self.drive(async |c| {
            // The text is built from constants alone.
            let rows = sqlx::query(AssertSqlSafe(sql)).fetch_all(c).await?;
            Ok(rows.iter().map(row).collect::<Result<_, _>>()?)
        })
    }

    pub(crate) fn select<T>(
        &mut self,
        sql: &'static str,
        row: impl Fn(&SqliteRow) -> Result<T, sqlx::Error>,
    ) -> Result<Vec<T>, StoreError> {
        self.drive(async |c| {
            let rows = sqlx::query(sql).fetch_all(c).await?;
            Ok(rows.iter().map(row).collect::<Result<_, _>>()?)
        })
    }
}
