//! For which inputs each stage was last completed.

use sqlx::Row;
use sqlx::sqlite::{SqliteConnection, SqliteRow};
use std::collections::BTreeMap;

use crate::checks::{RowHash, commit, is_whole};
use crate::row::{Insert, begin, count};
use crate::{Store, StoreError};

/// A stage that is left out of a run while what it was completed for is as it was.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RecordedStage {
    /// The optima of all samples.
    Solve,
    /// The simulations of all missions.
    Simulate,
    /// All missions under causal controllers.
    Control,
    /// What the year depends on.
    Sensitivity,
    /// The files of the report.
    Report,
}

impl RecordedStage {
    /// Its name in the database, which is that of the command.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Solve => "solve",
            Self::Simulate => "simulate",
            Self::Control => "control",
            Self::Sensitivity => "sensitivity",
            Self::Report => "report",
        }
    }
}

/// A stage as it was last completed, nothing of which has been withdrawn since.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StageRecord {
    /// Key of its inputs.
    pub key: String,
    /// What it came to, in the stage's own JSON.
    pub result: String,
}

/// A value of the study file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SettingRow {
    /// Place by section and key.
    pub position: usize,
    /// Section, a dot, key.
    pub name: String,
    /// Its value.
    pub value: String,
    /// Its unit; empty for what has none.
    pub unit: String,
    /// What it is where the study file does not say it.
    pub default_value: Option<String>,
    /// Where the value comes from.
    pub source: String,
    /// Whether it is not the default.
    pub differs_from_default: bool,
}

impl Store {
    /// The record of a stage; `None` where it is not complete.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn stage(&mut self, stage: RecordedStage) -> Result<Option<StageRecord>, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT * FROM stage_record WHERE stage = ?";
            let row = sqlx::query(sql).bind(stage.name()).fetch_optional(c).await?;
            // A damaged one vouches for nothing.
            let row = row.map(|r| Ok::<_, sqlx::Error>((is_whole(&r, &mut RowHash::default())?, r))).transpose()?;
            let row = row.filter(|(is_whole, _)| *is_whole).map(|(_, r)| r);
            let record = row.map(|r| Ok(StageRecord { key: r.try_get("stage_key")?, result: r.try_get("result")? }));
            Ok(record.transpose().map_err(|e: sqlx::Error| e)?)
        })
    }

    /// Records that a stage is complete for the inputs of a key.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn complete_stage(&mut self, stage: RecordedStage, record: &StageRecord) -> Result<(), StoreError> {
        self.drive(async |c| {
            let mut tx = begin(c).await?;
            record_stage(&mut tx, stage, record).await?;
            commit(tx).await
        })
    }

    /// Forgets that a stage is complete.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn reopen_stage(&mut self, stage: RecordedStage) -> Result<(), StoreError> {
        self.drive(async |c| {
            sqlx::query("DELETE FROM stage_record WHERE stage = ?").bind(stage.name()).execute(c).await?;
            Ok(())
        })
    }

    /// What the study said when a stage was last done, by name; nothing where it never was.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn settings(&mut self, stage: &str) -> Result<BTreeMap<String, String>, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT name, value FROM stage_setting WHERE stage = ? ORDER BY name";
            let rows = sqlx::query(sql).bind(stage).fetch_all(c).await?;
            rows.iter().map(|r| Ok((r.try_get("name")?, r.try_get("value")?))).collect()
        })
    }

    /// Records what the study said when a stage was done.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn put_settings(&mut self, stage: &str, settings: &BTreeMap<String, String>) -> Result<(), StoreError> {
        if self.settings(stage)? == *settings {
            return Ok(());
        }
        self.drive(async |c| {
            let mut tx = begin(c).await?;
            sqlx::query("DELETE FROM stage_setting WHERE stage = ?").bind(stage).execute(&mut *tx).await?;
            for (name, value) in settings {
                let row = Insert::into("stage_setting").set("stage", stage)?.set("name", name.as_str())?;
                row.set("value", value.as_str())?.execute(&mut tx).await?;
            }
            commit(tx).await
        })
    }

    /// Records the values of the study file that a stage is the first to use, in their order.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn put_study_settings(&mut self, stage: &str, rows: &[SettingRow]) -> Result<(), StoreError> {
        if self.study_settings(stage)? == rows {
            return Ok(());
        }
        self.drive(async |c| {
            let mut tx = begin(c).await?;
            sqlx::query("DELETE FROM study_setting WHERE stage = ?").bind(stage).execute(&mut *tx).await?;
            for row in rows {
                let insert = Insert::into("study_setting")
                    .set("stage", stage)?
                    .set("position", row.position as i64)?
                    .set("name", row.name.as_str())?
                    .set("value", row.value.as_str())?
                    .set("unit", row.unit.as_str())?
                    .set("default_value", row.default_value.as_deref())?
                    .set("source", row.source.as_str())?
                    .set("differs_from_default", row.differs_from_default)?;
                insert.execute(&mut tx).await?;
            }
            commit(tx).await
        })
    }

    /// The values of the study file that a stage was the first to use.
    fn study_settings(&mut self, stage: &str) -> Result<Vec<SettingRow>, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT * FROM study_setting WHERE stage = ? ORDER BY position";
            let rows = sqlx::query(sql).bind(stage).fetch_all(c).await?;
            let row = |r: &SqliteRow| {
                Ok(SettingRow {
                    position: usize::try_from(count(r, "position")?).unwrap_or(usize::MAX),
                    name: r.try_get("name")?,
                    value: r.try_get("value")?,
                    unit: r.try_get("unit")?,
                    default_value: r.try_get("default_value")?,
                    source: r.try_get("source")?,
                    differs_from_default: r.try_get("differs_from_default")?,
                })
            };
            rows.iter().map(row).collect()
        })
    }

    /// Records the text of a study file.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn put_study_text(&mut self, hash: &str, text: &str) -> Result<(), StoreError> {
        self.drive(async |c| {
            let mut tx = begin(c).await?;
            let sql = "INSERT INTO study_text VALUES (?, ?)
                ON CONFLICT DO UPDATE SET text = excluded.text WHERE text <> excluded.text";
            sqlx::query(sql).bind(hash).bind(text).execute(&mut *tx).await?;
            commit(tx).await
        })
    }

    /// The samples with what each was made from, by id.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn sample_keys(&mut self) -> Result<Vec<(i64, String)>, StoreError> {
        let sql = "SELECT sample_id, sample_key FROM hourly_sample ORDER BY sample_id";
        self.select(sql, |r| Ok((r.try_get("sample_id")?, r.try_get("sample_key")?)))
    }
}

pub(crate) async fn record_stage(
    c: &mut SqliteConnection,
    stage: RecordedStage,
    record: &StageRecord,
) -> Result<(), StoreError> {
    let row = Insert::replacing("stage_record").set("stage", stage.name())?.set("stage_key", record.key.as_str())?;
    row.set("result", record.result.as_str())?.execute(c).await?;
    Ok(())
}
