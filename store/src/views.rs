//! What reports, `status` and `show` read: the views of the schema as plain rows.

use sqlx::sqlite::SqliteRow;
use sqlx::{AssertSqlSafe, Row};

use crate::{FindingRow, Store, StoreError, StoredExclusion, StoredFinding};

/// A row of `annual_average`.
#[derive(Debug, Clone, PartialEq)]
pub struct AnnualRow {
    /// Design.
    pub design: String,
    /// Lower limit of the window.
    pub pmv_min: f64,
    /// Upper limit of the window.
    pub pmv_max: f64,
    /// The larger distance from neutral.
    pub pmv_limit: f64,
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
    /// Lower limit of the window.
    pub pmv_min: f64,
    /// Upper limit of the window.
    pub pmv_max: f64,
    /// The larger distance from neutral.
    pub pmv_limit: f64,
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
    /// Lower limit of the window.
    pub pmv_min: f64,
    /// Upper limit of the window.
    pub pmv_max: f64,
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

/// How many points have which status.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct StatusCounts {
    /// With an optimum.
    pub solved: u64,
    /// Without an operation that meets the window.
    pub infeasible: u64,
    /// Not settled.
    pub not_converged: u64,
}

/// How many segments gave no sample for one reason.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExclusionCount {
    /// The reason.
    pub reason: String,
    /// How many.
    pub count: u64,
}

/// A row of `source_file`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StoredFile {
    /// Path as the study names it.
    pub path: String,
    /// `mission`, `weather` or `shadow`.
    pub kind: String,
    /// BLAKE3 of the content.
    pub blake3: String,
    /// Size in bytes.
    pub bytes: u64,
    /// Data rows.
    pub rows: u64,
    /// First time in the file.
    pub first_utc: Option<String>,
    /// Last time in the file.
    pub last_utc: Option<String>,
    /// Whether it is used.
    pub accepted: bool,
}

/// A row of `sample` with what is needed to show it.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredSample {
    /// Weight in the annual average.
    pub weight: f64,
    /// Path of the mission file.
    pub source_path: String,
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
    /// The view `annual_average`, in the order of the study.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn annual(&mut self) -> Result<Vec<AnnualRow>, StoreError> {
        let sql = "SELECT a.design, a.pmv_min, a.pmv_max, a.pmv_limit, a.hvac_power_w, a.heating_power_w,
                a.cooling_power_w, a.sample_count, a.unsolved_count, a.unsolved_weight, a.reduction_vs_ptc
            FROM annual_average AS a
            JOIN hvac_design AS d ON d.name = a.design
            JOIN comfort_window AS w ON w.pmv_min = a.pmv_min AND w.pmv_max = a.pmv_max
            ORDER BY d.position, w.position";
        self.select(sql, |r| {
            Ok(AnnualRow {
                design: r.try_get(0)?,
                pmv_min: r.try_get(1)?,
                pmv_max: r.try_get(2)?,
                pmv_limit: r.try_get(3)?,
                hvac_power_w: r.try_get(4)?,
                heating_power_w: r.try_get(5)?,
                cooling_power_w: r.try_get(6)?,
                sample_count: count(r, 7)?,
                unsolved_count: count(r, 8)?,
                unsolved_weight: r.try_get(9)?,
                reduction_vs_ptc: r.try_get(10)?,
            })
        })
    }

    /// The view `monthly_average`, in the order of the study and the year.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn monthly(&mut self) -> Result<Vec<MonthlyRow>, StoreError> {
        let sql = "SELECT m.design, m.pmv_min, m.pmv_max, m.pmv_limit, m.month, m.hvac_power_w, m.sample_count
            FROM monthly_average AS m
            JOIN hvac_design AS d USING (design_id) JOIN comfort_window AS w USING (window_id)
            ORDER BY d.position, w.position, m.month";
        self.select(sql, |r| {
            Ok(MonthlyRow {
                design: r.try_get(0)?,
                pmv_min: r.try_get(1)?,
                pmv_max: r.try_get(2)?,
                pmv_limit: r.try_get(3)?,
                month: r.try_get(4)?,
                hvac_power_w: r.try_get(5)?,
                sample_count: count(r, 6)?,
            })
        })
    }

    /// The months that have samples, in the order of the year.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn months(&mut self) -> Result<Vec<MonthRow>, StoreError> {
        self.select("SELECT month, sample_count, sample_weight FROM month_weight ORDER BY month", |r| {
            Ok(MonthRow { month: r.try_get(0)?, sample_count: count(r, 1)?, sample_weight: r.try_get(2)? })
        })
    }

    /// In how many samples the limits of comfort bind, for every design and window in the order of the study.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn limit_shares(&mut self) -> Result<Vec<LimitShare>, StoreError> {
        // A binding limit is met to rounding; the next state inside is many orders of magnitude away.
        let sql = "SELECT d.name, w.pmv_min, w.pmv_max, count(*),
                sum(p.pmv < w.pmv_min + 1e-6), sum(p.pmv > w.pmv_max - 1e-6),
                sum(p.operating_mode = 1), sum(p.operating_mode = -1),
                sum((p.pmv < w.pmv_min + 1e-6) * m.sample_weight) / sum(m.sample_weight),
                sum((p.operating_mode = -1) * m.sample_weight) / sum(m.sample_weight),
                sum(p.outside_standard_range)
            FROM optimum_point AS p
            JOIN hourly_sample AS s USING (sample_id)
            JOIN month_weight AS m USING (month)
            JOIN hvac_design AS d USING (design_id) JOIN comfort_window AS w USING (window_id)
            WHERE p.status = 0
            GROUP BY p.design_id, p.window_id ORDER BY d.position, w.position";
        self.select(sql, |r| {
            Ok(LimitShare {
                design: r.try_get(0)?,
                pmv_min: r.try_get(1)?,
                pmv_max: r.try_get(2)?,
                solved_count: count(r, 3)?,
                lower_count: count(r, 4)?,
                upper_count: count(r, 5)?,
                heating_count: count(r, 6)?,
                cooling_count: count(r, 7)?,
                lower_weight: r.try_get(8)?,
                cooling_weight: r.try_get(9)?,
                outside_range_count: count(r, 10)?,
            })
        })
    }

    /// How many stored points have which status.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn status_counts(&mut self) -> Result<StatusCounts, StoreError> {
        let sql = "SELECT coalesce(sum(status = 0), 0), coalesce(sum(status IN (1, 2)), 0),
            coalesce(sum(status = 3), 0) FROM optimum_point";
        let rows = self.select(sql, |r| {
            Ok(StatusCounts { solved: count(r, 0)?, infeasible: count(r, 1)?, not_converged: count(r, 2)? })
        })?;
        Ok(rows.first().copied().unwrap_or_default())
    }

    /// The input files by kind and path.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn files(&mut self) -> Result<Vec<StoredFile>, StoreError> {
        let sql = "SELECT path, kind, blake3, bytes, rows, first_utc, last_utc, outcome = 'accepted'
            FROM source_file ORDER BY kind, path";
        self.select(sql, |r| {
            Ok(StoredFile {
                path: r.try_get(0)?,
                kind: r.try_get(1)?,
                blake3: r.try_get(2)?,
                bytes: count(r, 3)?,
                rows: count(r, 4)?,
                first_utc: r.try_get(5)?,
                last_utc: r.try_get(6)?,
                accepted: r.try_get(7)?,
            })
        })
    }

    /// What was noticed in the input files, by kind and path.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn findings(&mut self) -> Result<Vec<StoredFinding>, StoreError> {
        let sql = "SELECT f.path, f.kind, q.kind, q.count, q.line, q.column_name, q.message
            FROM data_quality AS q JOIN source_file AS f USING (source_file_id) ORDER BY f.kind, f.path, q.position";
        self.select(sql, |r| {
            let line: Option<i64> = r.try_get(4)?;
            let finding = FindingRow {
                kind: r.try_get(2)?,
                count: count(r, 3)?,
                line: line.map(i64::cast_unsigned),
                column: r.try_get(5)?,
                message: r.try_get(6)?,
            };
            Ok(StoredFinding { path: r.try_get(0)?, file_kind: r.try_get(1)?, finding })
        })
    }

    /// Segments without a sample, by mission and number.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn exclusions(&mut self) -> Result<Vec<StoredExclusion>, StoreError> {
        let sql = "SELECT mission, segment, start_utc, reason FROM excluded_segment ORDER BY mission, segment";
        self.select(sql, |r| {
            Ok(StoredExclusion {
                mission: r.try_get(0)?,
                segment: r.try_get(1)?,
                start_utc: r.try_get(2)?,
                reason: r.try_get(3)?,
            })
        })
    }

    /// Segments without a sample, counted by reason.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn exclusion_counts(&mut self) -> Result<Vec<ExclusionCount>, StoreError> {
        let sql = "SELECT reason, count(*) FROM excluded_segment GROUP BY reason ORDER BY count(*) DESC, reason";
        self.select(sql, |r| Ok(ExclusionCount { reason: r.try_get(0)?, count: count(r, 1)? }))
    }

    /// Weight and source of a sample.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn sample_source(&mut self, sample_id: i64) -> Result<Option<StoredSample>, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT weight, source_path FROM sample WHERE sample_id = ?";
            let Some(r) = sqlx::query(sql).bind(sample_id).fetch_optional(c).await? else { return Ok(None) };
            Ok(Some(StoredSample { weight: r.try_get(0)?, source_path: r.try_get(1)? }))
        })
    }

    /// The stored optimum of a sample, design and window.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn optimum(
        &mut self,
        sample_id: i64,
        design: &str,
        pmv_min: f64,
        pmv_max: f64,
    ) -> Result<Option<OptimumRow>, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT status, hvac_power_w, runner_up_excess_w FROM optimum
                WHERE sample_id = ? AND design = ? AND pmv_min = ? AND pmv_max = ?";
            let query = sqlx::query(sql).bind(sample_id).bind(design).bind(pmv_min).bind(pmv_max);
            let Some(r) = query.fetch_optional(c).await? else { return Ok(None) };
            Ok(Some(OptimumRow {
                status: r.try_get(0)?,
                hvac_power_w: r.try_get(1)?,
                runner_up_excess_w: r.try_get(2)?,
            }))
        })
    }

    /// The rows of any query as text, for tests that compare the contract's views: NULL is empty.
    ///
    /// # Errors
    /// [`StoreError::Statement`], also where the query is not valid.
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

    fn select<T>(
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

fn count(row: &SqliteRow, column: usize) -> Result<u64, sqlx::Error> {
    Ok(row.try_get::<i64, _>(column)?.cast_unsigned())
}
