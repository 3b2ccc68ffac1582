//! Optima: which are missing, and writing them in bulk.

use cabin::{Devices, Infeasible, OperatingMode, Operation, Optimum, Outcome, StandardRange, Temperatures};
use solve::nlp::Effort;
use sqlx::error::BoxDynError;
use sqlx::sqlite::{SqliteArguments, SqliteConnection, SqliteRow};
use sqlx::{Arguments, AssertSqlSafe, Row};
use std::collections::{BTreeMap, BTreeSet};

use crate::checks::{RowHash, commit, whole};
use crate::row::{begin, count, insert_sql};
use crate::{Store, StoreError, StoredGrid};

/// The columns, in the order in which [`add_row`] gives their values.
const COLUMNS: [&str; 25] = [
    "sample_id",
    "design_id",
    "window_id",
    "status",
    "operating_mode",
    "air_curtain_on",
    "radiant_heaters_on",
    "outside_standard_range",
    "air_unit_power_w",
    "radiant_heater_power_w",
    "air_curtain_power_w",
    "air_unit_heat_w",
    "cabin_k",
    "interior_k",
    "shell_inside_k",
    "shell_outside_k",
    "radiant_heater_k",
    "mean_radiant_k",
    "pmv",
    "runner_up_excess_w",
    "kkt_residual",
    "subproblem_count",
    "backup_heater_power_w",
    "unmet_heat_w",
    "row_check",
];
/// Values of an operation: columns but for keys and status before it and six after it.
const OPERATION_VALUES: usize = COLUMNS.len() - 10;
/// Rows of one INSERT: from here on a statement does not get cheaper by the row.
const ROWS: usize = 400;

/// How outcomes are kept in `status`.
const STATUSES: [(i64, Outcome); 3] = [
    (1, Outcome::Infeasible(Infeasible::TooWarm)),
    (2, Outcome::Infeasible(Infeasible::TooCold)),
    (NOT_CONVERGED, Outcome::NotConverged),
];
const SOLVED: i64 = 0;
const NOT_CONVERGED: i64 = 3;

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

/// An optimum as it is stored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StoredOptimum {
    /// Sample.
    pub sample_id: i64,
    /// Place of the design in the stored grid.
    pub design: usize,
    /// Place of the window in the stored grid.
    pub window: usize,
    /// How it ended; `None` where the row lacks a value that its status asks for.
    pub outcome: Option<Outcome>,
}

/// Samples that lack the same optima.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MissingOptima {
    /// Design and window by their places in the stored grid, in rising order.
    pub points: Vec<(usize, usize)>,
    /// The samples' ids in rising order.
    pub samples: Vec<i64>,
}

/// An optimum that is to be stored, of a point that has none.
#[derive(Debug, Clone, Copy)]
pub struct NewOptimum<'a> {
    /// Sample.
    pub sample_id: i64,
    /// Place of the design in the stored grid.
    pub design: usize,
    /// Place of the window in the stored grid.
    pub window: usize,
    /// How it ended.
    pub outcome: &'a Outcome,
    /// What it has cost, of methods that iterate.
    pub effort: Option<Effort>,
}

impl<'a> NewOptimum<'a> {
    /// An optimum of a grid that is the stored one.
    #[must_use]
    pub fn of(sample_id: i64, optimum: &'a Optimum) -> Self {
        let Optimum { design, window, outcome } = optimum;
        Self { sample_id, design: *design, window: *window, outcome, effort: None }
    }
}

impl Store {
    /// The optima that are missing of a grid that is the stored one, the samples that lack the same ones together.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn missing_optima(&mut self, grid: &StoredGrid) -> Result<Vec<MissingOptima>, StoreError> {
        self.drive(async |c| {
            // Counting is all that complete samples cost.
            let sql = "WITH incomplete AS MATERIALIZED (
                    SELECT sample_id FROM hourly_sample
                    WHERE (SELECT count(*) FROM optimum_point AS p WHERE p.sample_id = hourly_sample.sample_id) < ?)
                SELECT s.sample_id, coalesce(group_concat(p.design_id || ' ' || p.window_id), '') AS present
                FROM incomplete AS s LEFT JOIN optimum_point AS p USING (sample_id)
                GROUP BY s.sample_id ORDER BY s.sample_id";
            let points = grid.designs.len() * grid.windows.len();
            let mut by_present: BTreeMap<String, Vec<i64>> = BTreeMap::new();
            for r in sqlx::query(sql).bind(points as i64).fetch_all(c).await? {
                by_present.entry(r.try_get("present")?).or_default().push(r.try_get("sample_id")?);
            }
            let mut missing: BTreeMap<Vec<(usize, usize)>, Vec<i64>> = BTreeMap::new();
            for (present, mut samples) in by_present {
                let present: BTreeSet<&str> = present.split(',').collect();
                let is_missing = |(design, window): &(usize, usize)| {
                    let ids = format!("{} {}", grid.design_ids[*design], grid.window_ids[*window]);
                    !present.contains(ids.as_str())
                };
                let all = (0..grid.designs.len()).flat_map(|d| (0..grid.windows.len()).map(move |w| (d, w)));
                missing.entry(all.filter(is_missing).collect()).or_default().append(&mut samples);
            }
            let gap = |(points, mut samples): (_, Vec<i64>)| {
                samples.sort_unstable();
                MissingOptima { points, samples }
            };
            Ok(missing.into_iter().map(gap).collect())
        })
    }

    /// The stored optima of the samples from `first` to `last`, in the order of samples, designs and windows.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn optima(&mut self, grid: &StoredGrid, first: i64, last: i64) -> Result<Vec<StoredOptimum>, StoreError> {
        let all = |places: usize| (0..places).collect::<Vec<_>>();
        self.optima_of(grid, [first, last], &all(grid.designs.len()), &all(grid.windows.len()))
    }

    /// As [`Store::optima`], of some designs and windows alone, by their places in the grid.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn optima_of(
        &mut self,
        grid: &StoredGrid,
        [first, last]: [i64; 2],
        designs: &[usize],
        windows: &[usize],
    ) -> Result<Vec<StoredOptimum>, StoreError> {
        let ids = |ids: &[i64], places: &[usize]| {
            serde_json::json!(places.iter().map(|&place| ids[place]).collect::<Vec<_>>()).to_string()
        };
        let (designs, windows) = (ids(&grid.design_ids, designs), ids(&grid.window_ids, windows));
        self.drive_checked(async |c, damage| {
            let sql = "SELECT * FROM optimum_point WHERE sample_id BETWEEN ? AND ?
                AND design_id IN (SELECT value FROM json_each(?)) AND window_id IN (SELECT value FROM json_each(?))
                ORDER BY sample_id, design_id, window_id";
            let query = sqlx::query(sql).bind(first).bind(last).bind(designs).bind(windows);
            let rows = query.fetch_all(c).await?;
            whole(damage, "optimum_point", &rows)?;
            rows.iter()
                .map(|r| {
                    Ok(StoredOptimum {
                        sample_id: r.try_get("sample_id")?,
                        design: grid.design(r.try_get("design_id")?)?,
                        window: grid.window(r.try_get("window_id")?)?,
                        outcome: outcome(r)?,
                    })
                })
                .collect()
        })
    }

    /// How many stored points ended in which way.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn status_counts(&mut self) -> Result<StatusCounts, StoreError> {
        self.drive(async |c| {
            let all = sqlx::query("SELECT count(*) AS points FROM optimum_point").fetch_one(&mut *c).await?;
            let mut counts = StatusCounts { solved: count(&all, "points")?, ..StatusCounts::default() };
            let sql = "SELECT status, count(*) AS points FROM optimum_point WHERE status <> 0 GROUP BY status";
            for row in sqlx::query(sql).fetch_all(c).await? {
                let points = count(&row, "points")?;
                counts.solved -= points;
                match row.try_get("status")? {
                    NOT_CONVERGED => counts.not_converged += points,
                    _ => counts.infeasible += points,
                }
            }
            Ok(counts)
        })
    }

    /// Writes missing optima of a grid in one transaction. Samples in the order of their ids, and within one designs and
    /// windows in the order of the grid, append to the table and are fastest.
    ///
    /// # Errors
    /// [`StoreError::UnknownPoint`], [`StoreError::Refused`], [`StoreError::Damaged`], also where a point has its optimum
    /// already.
    pub fn put_optima<'a>(
        &mut self,
        grid: &StoredGrid,
        points: impl Iterator<Item = NewOptimum<'a>>,
    ) -> Result<(), StoreError> {
        self.drive(async |c| {
            // Three lookups a row cost a fifth of the time; that rows have what they refer to is seen once for all of them.
            sqlx::query("PRAGMA foreign_keys = OFF").execute(&mut *c).await?;
            let written = write(c, grid, points).await;
            sqlx::query("PRAGMA foreign_keys = ON").execute(c).await?;
            written
        })
    }
}

async fn write<'a>(
    c: &mut SqliteConnection,
    grid: &StoredGrid,
    points: impl Iterator<Item = NewOptimum<'a>>,
) -> Result<(), StoreError> {
    let mut tx = begin(c).await?;
    let mut samples = Vec::new();
    let mut points = points.inspect(|point| {
        if samples.last() != Some(&point.sample_id) {
            samples.push(point.sample_id);
        }
    });
    let full = insert_statement(ROWS);
    let mut chunk = encode(grid, &mut points)?;
    while chunk.rows > 0 {
        let sql = if chunk.rows == ROWS { full.clone() } else { insert_statement(chunk.rows) };
        // SQLite works on a thread of its own: the next rows are put together meanwhile.
        let (written, next) = tokio::join!(execute(&mut tx, sql, chunk.arguments), async { encode(grid, &mut points) });
        written?;
        chunk = next?;
    }
    drop(points);
    for (table, id, ids) in [
        ("hourly_sample", "sample_id", &samples),
        ("hvac_design", "design_id", &grid.design_ids),
        ("comfort_window", "window_id", &grid.window_ids),
    ] {
        let sql = format!("SELECT value FROM json_each(?) WHERE value NOT IN (SELECT {id} FROM {table}) LIMIT 1");
        // The text is built from constants alone.
        let unknown =
            sqlx::query(AssertSqlSafe(sql)).bind(serde_json::json!(ids).to_string()).fetch_optional(&mut *tx).await?;
        if let Some(row) = unknown {
            return Err(StoreError::UnknownPoint { table, id: row.try_get("value")? });
        }
    }
    commit(tx).await
}

/// The values of up to [`ROWS`] rows.
#[derive(Default)]
struct Chunk {
    arguments: SqliteArguments,
    rows: usize,
}

fn encode<'a>(grid: &StoredGrid, points: &mut impl Iterator<Item = NewOptimum<'a>>) -> Result<Chunk, StoreError> {
    let mut chunk = Chunk::default();
    let mut hash = RowHash::default();
    chunk.arguments.reserve(ROWS * COLUMNS.len(), 0);
    for point in points.take(ROWS) {
        let keys = [point.sample_id, grid.design_ids[point.design], grid.window_ids[point.window]];
        add_row(&mut chunk.arguments, &mut hash, keys, point.outcome, point.effort).map_err(sqlx::Error::Encode)?;
        chunk.rows += 1;
    }
    Ok(chunk)
}

async fn execute(c: &mut SqliteConnection, sql: String, arguments: SqliteArguments) -> Result<(), StoreError> {
    // The text is built from constants alone.
    sqlx::query_with(AssertSqlSafe(sql), arguments).execute(c).await?;
    Ok(())
}

fn insert_statement(rows: usize) -> String {
    insert_sql("INSERT", "optimum_point", &COLUMNS, rows)
}

/// Values of a row, in the order of [`COLUMNS`], on their way into a statement and into the row's check.
struct RowValues<'a> {
    arguments: &'a mut SqliteArguments,
    hash: &'a mut RowHash,
}

impl RowValues<'_> {
    fn integer(&mut self, value: Option<i64>) -> Result<(), BoxDynError> {
        self.hash.integer(value);
        self.arguments.add(value)
    }

    fn real(&mut self, value: Option<f64>) -> Result<(), BoxDynError> {
        self.hash.real(value);
        self.arguments.add(value)
    }
}

fn add_row(
    arguments: &mut SqliteArguments,
    hash: &mut RowHash,
    keys: [i64; 3],
    outcome: &Outcome,
    effort: Option<Effort>,
) -> Result<(), BoxDynError> {
    let mut values = RowValues { arguments, hash };
    let status = STATUSES.iter().find(|(_, other)| other == outcome).map_or(SOLVED, |s| s.0);
    for key in keys.into_iter().chain([status]) {
        values.integer(Some(key))?;
    }
    let solved = match outcome {
        Outcome::Solved(operation, runner_up_excess_w) => Some((operation, *runner_up_excess_w)),
        _ => None,
    };
    match solved {
        Some((operation, _)) => add_operation(&mut values, operation)?,
        None => {
            for _ in 0..OPERATION_VALUES {
                values.real(None)?;
            }
        }
    }
    values.real(solved.and_then(|(_, runner_up_excess_w)| runner_up_excess_w))?;
    values.real(effort.map(|e| e.kkt_residual))?;
    values.integer(effort.map(|e| i64::from(e.subproblems)))?;
    values.real(solved.map(|(operation, _)| operation.backup_heater_power_w))?;
    values.real(solved.map(|(operation, _)| operation.unmet_heat_w))?;
    let check = hash.finish();
    arguments.add(check)
}

fn add_operation(values: &mut RowValues<'_>, o: &Operation) -> Result<(), BoxDynError> {
    let outside = o.standard_range == StandardRange::Outside;
    let (curtain, heaters) = (o.devices.air_curtain, o.devices.radiant_heaters);
    for choice in [i64::from(o.mode.number()), i64::from(curtain), i64::from(heaters), i64::from(outside)] {
        values.integer(Some(choice))?;
    }
    let t = o.temperatures;
    for value in [
        o.air_unit_power_w,
        o.radiant_heater_power_w,
        o.air_curtain_power_w,
        o.air_unit_heat_w,
        t.cabin_k,
        t.interior_k,
        t.shell_inside_k,
        t.shell_outside_k,
        t.radiant_heater_k,
        o.mean_radiant_temperature_k,
        o.pmv,
    ] {
        values.real(Some(value))?;
    }
    Ok(())
}

/// The outcome of a row; `None` where a value that its status asks for is missing.
fn outcome(r: &SqliteRow) -> Result<Option<Outcome>, sqlx::Error> {
    let status: i64 = r.try_get("status")?;
    if status == SOLVED { solved(r) } else { Ok(STATUSES.iter().find(|(code, _)| *code == status).map(|s| s.1)) }
}

fn solved(r: &SqliteRow) -> Result<Option<Outcome>, sqlx::Error> {
    let whole = |name: &str| r.try_get::<Option<i64>, _>(name);
    let real = |name: &str| r.try_get::<Option<f64>, _>(name);
    let (Some(mode), Some(curtain), Some(heaters), Some(outside)) = (
        whole("operating_mode")?.and_then(OperatingMode::from_number),
        whole("air_curtain_on")?,
        whole("radiant_heaters_on")?,
        whole("outside_standard_range")?,
    ) else {
        return Ok(None);
    };
    let mut complete = true;
    let mut value = |name: &str| -> Result<f64, sqlx::Error> {
        let stored = real(name)?;
        complete &= stored.is_some();
        Ok(stored.unwrap_or(f64::NAN))
    };
    let operation = Operation {
        mode,
        devices: Devices { radiant_heaters: heaters == 1, air_curtain: curtain == 1 },
        air_unit_power_w: value("air_unit_power_w")?,
        radiant_heater_power_w: value("radiant_heater_power_w")?,
        air_curtain_power_w: value("air_curtain_power_w")?,
        backup_heater_power_w: value("backup_heater_power_w")?,
        air_unit_heat_w: value("air_unit_heat_w")?,
        unmet_heat_w: value("unmet_heat_w")?,
        temperatures: Temperatures {
            cabin_k: value("cabin_k")?,
            interior_k: value("interior_k")?,
            shell_inside_k: value("shell_inside_k")?,
            shell_outside_k: value("shell_outside_k")?,
            radiant_heater_k: value("radiant_heater_k")?,
        },
        mean_radiant_temperature_k: value("mean_radiant_k")?,
        pmv: value("pmv")?,
        standard_range: if outside == 1 { StandardRange::Outside } else { StandardRange::Inside },
    };
    Ok(if complete { Some(Outcome::Solved(operation, real("runner_up_excess_w")?)) } else { None })
}

/// The operation of a row that is solved and whole.
pub(crate) fn operation(r: &SqliteRow) -> Result<Option<Operation>, sqlx::Error> {
    Ok(outcome(r)?.and_then(|o| o.operation().copied()))
}
