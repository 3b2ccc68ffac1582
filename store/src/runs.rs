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
    /// BLAKE3 of the study with all defaults.
    pub study_hash: String,
    /// Points.
    pub counts: Option<Counts>,
    /// Why it failed.
    pub reason: Option<String>,
}

/// What a stage of a run did.
#[derive(Debug, Clone, PartialEq)]
pub struct RunStage {
    /// Name of the stage.
    pub stage: String,
    /// What was done now: missions read, samples new or changed, points, simulations, files.
    pub computed: u64,
    /// What is no longer valid.
    pub withdrawn: u64,
    /// All that the stage keeps.
    pub total: u64,
    /// How long it took in s.
    pub duration_s: f64,
}

impl Store {
    /// Records the start of a run; a run that was still marked as running was interrupted. Returns its number.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
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
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn end_run(
        &mut self,
        run_id: i64,
        finished: DateTime<Utc>,
        end: RunEnd,
        input_hash: Option<&str>,
        counts: Counts,
        reason: Option<&str>,
    ) -> Result<(), StoreError> {
        let status = match end {
            RunEnd::Done => "done",
            RunEnd::DoneWithLosses => "done with losses",
            RunEnd::Interrupted => "interrupted",
            RunEnd::Failed => "failed",
        };
        self.drive(async |c| {
            let sql = "UPDATE run SET finished_utc = ?, status = ?, input_hash = ?, point_count = ?, solved_count = ?,
                failed_count = ?, reason = ? WHERE run_id = ?";
            sqlx::query(sql)
                .bind(time_text(finished))
                .bind(status)
                .bind(input_hash)
                .bind(counts.points.cast_signed())
                .bind(counts.solved.cast_signed())
                .bind(counts.failed.cast_signed())
                .bind(reason)
                .bind(run_id)
                .execute(c)
                .await?;
            Ok(())
        })
    }

    /// The latest run.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn last_run(&mut self) -> Result<Option<RunRow>, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT run_id, started_utc, finished_utc, status, program_version, study_hash, point_count, solved_count,
                failed_count, reason FROM run ORDER BY run_id DESC LIMIT 1";
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
                study_hash: r.try_get("study_hash")?,
                counts,
                reason: r.try_get("reason")?,
            }))
        })
    }

    /// Records what a stage of a run did, after those before it.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn put_run_stage(&mut self, run_id: i64, stage: &RunStage) -> Result<(), StoreError> {
        self.drive(async |c| {
            let sql = "INSERT INTO run_stage
                SELECT ?1, count(*), ?2, ?3, ?4, ?5, ?6 FROM run_stage WHERE run_id = ?1";
            sqlx::query(sql)
                .bind(run_id)
                .bind(&stage.stage)
                .bind(stage.computed.cast_signed())
                .bind(stage.withdrawn.cast_signed())
                .bind(stage.total.cast_signed())
                .bind(stage.duration_s)
                .execute(c)
                .await?;
            Ok(())
        })
    }

    /// The stages of the latest run that had any.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn last_run_stages(&mut self) -> Result<Vec<RunStage>, StoreError> {
        let sql = "SELECT stage, computed_count, withdrawn_count, total_count, duration_s FROM run_stage
            WHERE run_id = (SELECT max(run_id) FROM run_stage) ORDER BY position";
        self.select(sql, |r| {
            Ok(RunStage {
                stage: r.try_get("stage")?,
                computed: count(r, "computed_count")?,
                withdrawn: count(r, "withdrawn_count")?,
                total: count(r, "total_count")?,
                duration_s: r.try_get("duration_s")?,
            })
        })
    }

    /// When a run last finished its work, with losses or without.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn last_success(&mut self) -> Result<Option<DateTime<Utc>>, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT max(finished_utc) AS finished_utc FROM run WHERE status IN ('done', 'done with losses')";
            Ok(optional_time(&sqlx::query(sql).fetch_one(c).await?, "finished_utc")?)
        })
    }

    /// Pace of a stage: the seconds of one thing computed, from the latest run that computed any; `None` before.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn pace_s(&mut self, stage: &str) -> Result<Option<f64>, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT duration_s / computed_count AS pace_s FROM run_stage
                WHERE stage = ? AND computed_count > 0 ORDER BY run_id DESC LIMIT 1";
            Ok(sqlx::query(sql).bind(stage).fetch_optional(c).await?.map(|r| r.try_get("pace_s")).transpose()?)
        })
    }
}
