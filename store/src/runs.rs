//! The record of runs.

use chrono::{DateTime, Utc};
use sqlx::Row;

use crate::row::{count, optional_time, time, time_text};
use crate::{Store, StoreError};

/// How a run ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RunEnd {
    /// All points solved, all inputs used.
    Done,
    /// Finished, but points stayed unsolved or inputs were refused.
    DoneWithLosses,
    /// Stopped before the end; the next run goes on.
    Interrupted,
    /// Ended by an error.
    Failed,
}

/// Points of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counts {
    /// Points of the study.
    pub points: u64,
    /// Points with an optimum.
    pub solved: u64,
    /// Points without: infeasible or not converged.
    pub failed: u64,
}

/// A run as stored.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RunRow {
    /// Number of the run.
    pub run_id: i64,
    /// Start.
    pub started: DateTime<Utc>,
    /// End, once the run is over.
    pub finished: Option<DateTime<Utc>>,
    /// How it ended, or `running`.
    pub status: String,
    /// Version of the program.
    pub program_version: String,
    /// Points.
    pub counts: Option<Counts>,
}

impl Store {
    /// Records the start of a run; a run that was still marked as running was interrupted. Returns its number.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn start_run(&mut self, started: DateTime<Utc>, version: &str, study_hash: &str) -> Result<i64, StoreError> {
        self.drive(async |c| {
            sqlx::query("UPDATE run SET status = 'interrupted' WHERE status = 'running'").execute(&mut *c).await?;
            let sql = "INSERT INTO run (started_utc, status, program_version, study_hash)
                VALUES (?, 'running', ?, ?) RETURNING run_id";
            let row = sqlx::query(sql).bind(time_text(started)).bind(version).bind(study_hash).fetch_one(c).await?;
            Ok(row.try_get(0)?)
        })
    }

    /// Records the end of a run.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn end_run(
        &mut self,
        run_id: i64,
        finished: DateTime<Utc>,
        end: RunEnd,
        input_hash: Option<&str>,
        counts: Counts,
    ) -> Result<(), StoreError> {
        let status = match end {
            RunEnd::Done => "done",
            RunEnd::DoneWithLosses => "done with losses",
            RunEnd::Interrupted => "interrupted",
            RunEnd::Failed => "failed",
        };
        self.drive(async |c| {
            let sql = "UPDATE run SET finished_utc = ?, status = ?, input_hash = ?, point_count = ?, solved_count = ?,
                failed_count = ? WHERE run_id = ?";
            sqlx::query(sql)
                .bind(time_text(finished))
                .bind(status)
                .bind(input_hash)
                .bind(counts.points.cast_signed())
                .bind(counts.solved.cast_signed())
                .bind(counts.failed.cast_signed())
                .bind(run_id)
                .execute(c)
                .await?;
            Ok(())
        })
    }

    /// The latest run.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn last_run(&mut self) -> Result<Option<RunRow>, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT run_id, started_utc, finished_utc, status, program_version, point_count, solved_count,
                failed_count FROM run ORDER BY run_id DESC LIMIT 1";
            let Some(r) = sqlx::query(sql).fetch_optional(c).await? else { return Ok(None) };
            let points: Option<i64> = r.try_get("point_count")?;
            let counts = match points {
                None => None,
                Some(points) => Some(Counts {
                    points: points.cast_unsigned(),
                    solved: count(&r, "solved_count")?,
                    failed: count(&r, "failed_count")?,
                }),
            };
            Ok(Some(RunRow {
                run_id: r.try_get("run_id")?,
                started: time(&r, "started_utc")?,
                finished: optional_time(&r, "finished_utc")?,
                status: r.try_get("status")?,
                program_version: r.try_get("program_version")?,
                counts,
            }))
        })
    }
}
