//! The record of verifications.

use chrono::{DateTime, Utc};

use crate::checks::commit;
use crate::row::{Insert, begin, time_text};
use crate::{Store, StoreError};

/// A verification of stored points.
#[derive(Debug, Clone, PartialEq)]
pub struct VerificationRow {
    /// End.
    pub finished: DateTime<Utc>,
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
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn put_verification(&mut self, verification: &VerificationRow) -> Result<(), StoreError> {
        let violations: u64 = verification.checks.iter().map(|c| c.violations).sum();
        self.drive(async |c| {
            let mut tx = begin(c).await?;
            let id = Insert::into("verification")
                .set("finished_utc", time_text(verification.finished))?
                .set("program_version", verification.program_version.as_str())?
                .set("study_hash", verification.study_hash.as_str())?
                .set("fraction", verification.fraction)?
                .set("seed", verification.seed.cast_signed())?
                .set("point_count", verification.points.cast_signed())?
                .set("violation_count", violations.cast_signed())?
                .execute(&mut tx)
                .await?;
            for (position, check) in verification.checks.iter().enumerate() {
                Insert::into("verification_check")
                    .set("verification_id", id)?
                    .set("position", position as i64)?
                    .set("name", check.name.as_str())?
                    .set("checked_count", check.checked.cast_signed())?
                    .set("violation_count", check.violations.cast_signed())?
                    .set("largest", check.largest)?
                    .set("unit", check.unit.as_str())?
                    .set("tolerance", check.tolerance.as_str())?
                    .set("first_violation", check.first_violation.as_deref())?
                    .execute(&mut tx)
                    .await?;
            }
            commit(tx).await?;
            Ok(())
        })
    }
}
