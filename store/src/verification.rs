//! The record of verifications.

use sqlx::{Connection, Row};

use crate::{Store, StoreError};

/// A verification of stored points.
#[derive(Debug, Clone, PartialEq)]
pub struct VerificationRow {
    /// End, RFC 3339.
    pub finished_utc: String,
    /// Version of the program.
    pub program_version: String,
    /// Hash of the study.
    pub study_hash: String,
    /// Share of the points that was asked for.
    pub fraction: f64,
    /// Seed of their choice.
    pub seed: u64,
    /// Points that were solved again.
    pub points: u64,
    /// What was checked.
    pub checks: Vec<CheckRow>,
}

/// One kind of check.
#[derive(Debug, Clone, PartialEq)]
pub struct CheckRow {
    /// What is checked.
    pub name: String,
    /// How often.
    pub checked: u64,
    /// How often it failed.
    pub violations: u64,
    /// Largest deviation.
    pub largest: f64,
    /// Unit of the deviation.
    pub unit: String,
    /// What is allowed.
    pub tolerance: String,
    /// Where it failed first, and how.
    pub first_violation: Option<String>,
}

impl Store {
    /// Records a verification.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn put_verification(&mut self, verification: &VerificationRow) -> Result<(), StoreError> {
        let violations: u64 = verification.checks.iter().map(|c| c.violations).sum();
        self.drive(async |c| {
            let mut tx = c.begin().await?;
            let sql = "INSERT INTO verification
                    (finished_utc, program_version, study_hash, fraction, seed, point_count, violation_count)
                VALUES (?, ?, ?, ?, ?, ?, ?) RETURNING verification_id";
            let row = sqlx::query(sql)
                .bind(&verification.finished_utc)
                .bind(&verification.program_version)
                .bind(&verification.study_hash)
                .bind(verification.fraction)
                .bind(verification.seed.cast_signed())
                .bind(verification.points.cast_signed())
                .bind(violations.cast_signed())
                .fetch_one(&mut *tx)
                .await?;
            let id: i64 = row.try_get(0)?;
            for (position, check) in verification.checks.iter().enumerate() {
                sqlx::query("INSERT INTO verification_check VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)")
                    .bind(id)
                    .bind(position as i64)
                    .bind(&check.name)
                    .bind(check.checked.cast_signed())
                    .bind(check.violations.cast_signed())
                    .bind(check.largest)
                    .bind(&check.unit)
                    .bind(&check.tolerance)
                    .bind(&check.first_violation)
                    .execute(&mut *tx)
                    .await?;
            }
            tx.commit().await?;
            Ok(())
        })
    }
}
