//! Optima into the database, many rows at a time.

use cabin::Operation;
use sqlx::sqlite::{SqliteArguments, SqliteConnection};
use sqlx::{Arguments, AssertSqlSafe, Row};
use std::fmt::Write;
use std::iter::Peekable;

use super::NewOptimum;
use super::row::{COLUMNS, RowValues, add_row};
use crate::checks::{RowHash, commit};
use crate::row::begin;
use crate::{StoreError, StoredGrid};

/// The values behind the keys in a statement.
const VALUES: &str = "?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?";
/// The same where every row is usual.
const USUAL_VALUES: &str = "0,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,NULL,NULL,0.0,0.0,?";
/// Most rows of one statement: of 170 to 1,020 the fastest.
const ROWS: usize = 256;

/// Whether a row has the values of [`USUAL_VALUES`]: solved, no iterations, no limit that binds, no back-up heater in use.
fn is_usual(point: &NewOptimum<'_>) -> bool {
    let unlimited = |o: &Operation| o.backup_heater_power_w == 0.0 && o.unmet_heat_w == 0.0;
    point.effort.is_none() && point.outcome.operation().is_some_and(unlimited)
}

/// Writes missing optima in one transaction.
pub(super) async fn write<'a>(
    c: &mut SqliteConnection,
    grid: &StoredGrid,
    points: impl Iterator<Item = NewOptimum<'a>>,
) -> Result<(), StoreError> {
    let mut tx = begin(c).await?;
    let mut samples = Vec::new();
    let mut points = points
        .inspect(|point| {
            if samples.last() != Some(&point.sample_id) {
                samples.push(point.sample_id);
            }
        })
        .peekable();
    let mut chunk = encode(grid, &mut points)?;
    while let Some(full) = chunk {
        // SQLite works on a thread of its own: the next rows are put together meanwhile.
        let (written, next) = tokio::join!(execute(&mut tx, full), async { encode(grid, &mut points) });
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

/// Rows of one statement. Its text says what is the same in the next one, which takes SQLite less time than a value: the keys of
/// designs and windows, and the usual of optima without limits.
struct Chunk {
    sql: String,
    arguments: SqliteArguments,
}

/// Points of one statement: whole samples where they fit, so that its text is the same again and again.
fn next_chunk<'a>(points: &mut Peekable<impl Iterator<Item = NewOptimum<'a>>>) -> Vec<NewOptimum<'a>> {
    let mut chunk: Vec<NewOptimum<'a>> = Vec::with_capacity(ROWS);
    let mut of_first = None;
    while let Some(point) = points.next_if(|next| match chunk.last() {
        Some(last) if last.sample_id != next.sample_id => chunk.len() + *of_first.get_or_insert(chunk.len()) <= ROWS,
        _ => chunk.len() < ROWS,
    }) {
        chunk.push(point);
    }
    chunk
}

fn encode<'a>(
    grid: &StoredGrid,
    points: &mut Peekable<impl Iterator<Item = NewOptimum<'a>>>,
) -> Result<Option<Chunk>, StoreError> {
    let points = next_chunk(points);
    if points.is_empty() {
        return Ok(None);
    }
    let usual = points.iter().all(is_usual);
    let rest = if usual { USUAL_VALUES } else { VALUES };
    let mut sql = format!("INSERT INTO optimum_point ({}) VALUES ", COLUMNS.join(","));
    let mut arguments = SqliteArguments::default();
    arguments.reserve(points.len() * COLUMNS.len(), 0);
    let mut hash = RowHash::default();
    for point in &points {
        let (design, window) = (grid.design_ids[point.design], grid.window_ids[point.window]);
        // Text grows without errors.
        let _ = write!(sql, "(?,{design},{window},{rest}),");
        hash.integer(Some(point.sample_id));
        hash.integer(Some(design));
        hash.integer(Some(window));
        arguments.add(point.sample_id).map_err(sqlx::Error::Encode)?;
        let mut values = RowValues { arguments: &mut arguments, hash: &mut hash, usual };
        add_row(&mut values, point.outcome, point.effort).map_err(sqlx::Error::Encode)?;
    }
    sql.pop();
    Ok(Some(Chunk { sql, arguments }))
}

async fn execute(c: &mut SqliteConnection, chunk: Chunk) -> Result<(), StoreError> {
    // The text is built from constants and numbers alone.
    sqlx::query_with(AssertSqlSafe(chunk.sql), chunk.arguments).execute(c).await?;
    Ok(())
}
