//! Optima: which are missing, and writing them in bulk.

use cabin::{StandardRange, Temperatures};
use solve::nlp::Effort;
use solve::{Infeasible, OperatingMode, Operation, Optimum, Outcome};
use sqlx::sqlite::{SqliteArguments, SqliteConnection, SqliteRow};
use sqlx::{Arguments, AssertSqlSafe, Connection, Row};
use std::collections::BTreeSet;

use crate::{Store, StoreError};

const COLUMNS: usize = 22;
/// Rows of one INSERT: from here on a statement does not get cheaper by the row.
const ROWS: usize = 400;

/// The key of an optimum.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct PointId {
    /// Sample.
    pub sample_id: i64,
    /// Design.
    pub design_id: i64,
    /// Window.
    pub window_id: i64,
}

/// An optimum as it is stored.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StoredOptimum {
    /// Its key.
    pub id: PointId,
    /// How it ended; `None` where the row lacks a value that its status asks for.
    pub outcome: Option<Outcome>,
}

impl Store {
    /// The samples that have all their `points` optima.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn complete_samples(&mut self, points: usize) -> Result<BTreeSet<i64>, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT sample_id FROM optimum_point GROUP BY sample_id HAVING count(*) = ?";
            let rows = sqlx::query(sql).bind(points as i64).fetch_all(c).await?;
            rows.iter().map(|r| Ok(r.try_get(0)?)).collect()
        })
    }

    /// The stored optima of the samples from `first` to `last`, in the order of their keys.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn optima(&mut self, first: i64, last: i64) -> Result<Vec<StoredOptimum>, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT * FROM optimum_point WHERE sample_id BETWEEN ? AND ?
                ORDER BY sample_id, design_id, window_id";
            let rows = sqlx::query(sql).bind(first).bind(last).fetch_all(c).await?;
            rows.iter()
                .map(|r| {
                    let id = PointId {
                        sample_id: r.try_get("sample_id")?,
                        design_id: r.try_get("design_id")?,
                        window_id: r.try_get("window_id")?,
                    };
                    Ok(StoredOptimum { id, outcome: outcome(r)? })
                })
                .collect()
        })
    }

    /// Writes optima in one transaction; whatever `samples` had of them is replaced. Rows in the order of their key append
    /// to the table and are fastest. Methods that iterate say what a point has cost.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn put_optima<'a>(
        &mut self,
        samples: &[i64],
        mut points: impl Iterator<Item = (PointId, &'a Optimum, Option<Effort>)>,
    ) -> Result<(), StoreError> {
        self.drive(async |c| {
            let mut tx = c.begin().await?;
            // Deleting first leaves plain inserts, which cost less than replacing ones.
            let ids = samples.iter().map(i64::to_string).collect::<Vec<_>>().join(",");
            sqlx::query("DELETE FROM optimum_point WHERE sample_id IN (SELECT value FROM json_each(?))")
                .bind(format!("[{ids}]"))
                .execute(&mut *tx)
                .await?;
            let full = insert_statement(ROWS);
            let mut chunk = encode(&mut points)?;
            while chunk.rows > 0 {
                let sql = if chunk.rows == ROWS { full.clone() } else { insert_statement(chunk.rows) };
                // SQLite works on a thread of its own: the next rows are put together meanwhile.
                let (written, next) =
                    tokio::join!(execute(&mut tx, sql, chunk.arguments), async { encode(&mut points) });
                written?;
                chunk = next?;
            }
            Ok(tx.commit().await?)
        })
    }
}

/// The values of up to [`ROWS`] rows.
#[derive(Default)]
struct Chunk {
    arguments: SqliteArguments,
    rows: usize,
}

fn encode<'a>(points: &mut impl Iterator<Item = (PointId, &'a Optimum, Option<Effort>)>) -> Result<Chunk, StoreError> {
    let mut chunk = Chunk::default();
    chunk.arguments.reserve(ROWS * COLUMNS, 0);
    for (id, optimum, effort) in points.take(ROWS) {
        add_row(&mut chunk.arguments, id, optimum, effort).map_err(sqlx::Error::Encode)?;
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
    let row = format!("({})", vec!["?"; COLUMNS].join(","));
    format!("INSERT INTO optimum_point VALUES {}", vec![row; rows].join(","))
}

fn add_row(
    a: &mut SqliteArguments,
    id: PointId,
    optimum: &Optimum,
    effort: Option<Effort>,
) -> Result<(), sqlx::error::BoxDynError> {
    let status = match optimum.outcome {
        Outcome::Solved(..) => 0_i64,
        Outcome::Infeasible(Infeasible::TooWarm) => 1,
        Outcome::Infeasible(Infeasible::TooCold) => 2,
        Outcome::NotConverged => 3,
    };
    for key in [id.sample_id, id.design_id, id.window_id, status] {
        a.add(key)?;
    }
    let Outcome::Solved(o, runner_up_excess_w) = optimum.outcome else {
        for _ in 4..COLUMNS - 2 {
            a.add(None::<f64>)?;
        }
        return add_effort(a, effort);
    };
    let outside = o.standard_range == cabin::StandardRange::Outside;
    for choice in
        [i64::from(o.mode.number()), i64::from(o.air_curtain_on), i64::from(o.radiant_heaters_on), i64::from(outside)]
    {
        a.add(choice)?;
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
        a.add(value)?;
    }
    a.add(runner_up_excess_w)?;
    add_effort(a, effort)
}

fn add_effort(a: &mut SqliteArguments, effort: Option<Effort>) -> Result<(), sqlx::error::BoxDynError> {
    a.add(effort.map(|e| e.kkt_residual))?;
    a.add(effort.map(|e| i64::from(e.subproblems)))
}

/// A row of the optima as it is stored; `None` where a value that its status asks for is missing.
fn outcome(r: &SqliteRow) -> Result<Option<Outcome>, sqlx::Error> {
    let status: i64 = r.try_get("status")?;
    match status {
        0 => {}
        1 => return Ok(Some(Outcome::Infeasible(Infeasible::TooWarm))),
        2 => return Ok(Some(Outcome::Infeasible(Infeasible::TooCold))),
        _ => return Ok(Some(Outcome::NotConverged)),
    }
    let whole = |name: &str| r.try_get::<Option<i64>, _>(name);
    let real = |name: &str| r.try_get::<Option<f64>, _>(name);
    let mode = match whole("operating_mode")? {
        Some(-1) => OperatingMode::Cooling,
        Some(0) => OperatingMode::Passive,
        Some(1) => OperatingMode::Heating,
        _ => return Ok(None),
    };
    let (Some(curtain), Some(heaters), Some(outside)) =
        (whole("air_curtain_on")?, whole("radiant_heaters_on")?, whole("outside_standard_range")?)
    else {
        return Ok(None);
    };
    let names = [
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
    ];
    let mut values = [0.0; 11];
    for (value, name) in values.iter_mut().zip(names) {
        let Some(stored) = real(name)? else { return Ok(None) };
        *value = stored;
    }
    let [air_unit_w, heaters_w, curtain_w, heat_w, cabin_k, interior_k, inside_k, outside_k, heater_k, radiant_k, pmv] =
        values;
    let operation = Operation {
        mode,
        air_curtain_on: curtain == 1,
        radiant_heaters_on: heaters == 1,
        air_unit_power_w: air_unit_w,
        radiant_heater_power_w: heaters_w,
        air_curtain_power_w: curtain_w,
        air_unit_heat_w: heat_w,
        temperatures: Temperatures {
            cabin_k,
            interior_k,
            shell_inside_k: inside_k,
            shell_outside_k: outside_k,
            radiant_heater_k: heater_k,
        },
        mean_radiant_temperature_k: radiant_k,
        pmv,
        standard_range: if outside == 1 { StandardRange::Outside } else { StandardRange::Inside },
    };
    Ok(Some(Outcome::Solved(operation, real("runner_up_excess_w")?)))
}
