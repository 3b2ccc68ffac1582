//! Optima: which are missing, reading them, and writing them in bulk.

mod row;
mod write;

use cabin::{Operation, Optimum, Outcome};
use solve::nlp::Effort;
use sqlx::Row;
use sqlx::sqlite::SqliteRow;
use std::collections::{BTreeMap, BTreeSet};

use self::row::{NOT_CONVERGED, read};
use crate::checks::{Damage, RowHash};
use crate::connection::ROWS_AHEAD;
use crate::row::count;
use crate::{Store, StoreError, StoredGrid};

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

    /// The stored optima of samples between which no other one lies, by their ids in rising order; in the order of samples, designs
    /// and windows.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn optima(&mut self, grid: &StoredGrid, samples: &[i64]) -> Result<Vec<StoredOptimum>, StoreError> {
        let points = grid.designs.len() * grid.windows.len();
        let at_once = (ROWS_AHEAD / points.max(1)).max(1);
        self.drive_checked(async |c, damage| {
            let mut optima = Vec::with_capacity(samples.len() * points);
            let mut rows = Vec::new();
            for part in samples.chunks(at_once) {
                let sql = "SELECT * FROM optimum_point WHERE sample_id BETWEEN ? AND ?
                    ORDER BY sample_id, design_id, window_id";
                let next = sqlx::query(sql).bind(part[0]).bind(part[part.len() - 1]).fetch_all(&mut *c);
                // SQLite works on a thread of its own: rows are looked at while it reads as many as it may without waiting.
                let (next, looked_at) = tokio::join!(next, async { take(&mut optima, damage, grid, &rows) });
                looked_at?;
                rows = next?;
            }
            take(&mut optima, damage, grid, &rows)?;
            Ok(optima)
        })
    }

    /// The stored optima of the samples from `first` to `last` in some designs and windows, by their places in the grid; in the
    /// same order.
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
            let mut optima = Vec::with_capacity(rows.len());
            take(&mut optima, damage, grid, &rows)?;
            Ok(optima)
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
            let written = write::write(c, grid, points).await;
            sqlx::query("PRAGMA foreign_keys = ON").execute(c).await?;
            written
        })
    }
}

/// Takes rows as optima; refuses one that is not as it was written.
fn take(
    optima: &mut Vec<StoredOptimum>,
    damage: Damage<'_>,
    grid: &StoredGrid,
    rows: &[SqliteRow],
) -> Result<(), StoreError> {
    let mut hash = RowHash::default();
    for r in rows {
        let row = read(damage, r, &mut hash)?;
        let [sample_id, design, window] = row.keys;
        let (design, window) = (grid.design(design)?, grid.window(window)?);
        optima.push(StoredOptimum { sample_id, design, window, outcome: row.outcome });
    }
    Ok(())
}

/// The operation of a row that ends with the columns of its optimum, where that is solved; refuses one that is not as it was
/// written.
pub(crate) fn operation(damage: Damage<'_>, r: &SqliteRow) -> Result<Option<Operation>, StoreError> {
    let row = read(damage, r, &mut RowHash::default())?;
    Ok(row.outcome.and_then(|o| o.operation().copied()))
}
