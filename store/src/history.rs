//! What earlier runs came to, and what had changed: small rows, by which a number's way can be followed.

use cabin::ComfortWindow;
use sqlx::Row;
use std::collections::BTreeMap;

use crate::checks::commit;
use crate::row::{Insert, begin, count, window, word};
use crate::{Store, StoreError};

/// An annual average as a run left it.
#[derive(Debug, Clone, PartialEq)]
pub struct PastAverage {
    /// The run that computed it.
    pub run_id: i64,
    /// Design.
    pub design: String,
    /// Comfort window.
    pub window: ComfortWindow,
    /// Annual mean power in W; `None` while nothing was solved.
    pub hvac_power_w: Option<f64>,
    /// Samples.
    pub sample_count: u64,
    /// Samples without an optimum.
    pub unsolved_count: u64,
}

/// What kind of thing changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ChangeKind {
    /// A value of the study file, or the program's version.
    Setting,
    /// An input file, by its content.
    Input,
    /// How many samples there are.
    Samples,
}

impl ChangeKind {
    const ALL: [Self; 3] = [Self::Setting, Self::Input, Self::Samples];

    /// The word in the database.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Setting => "setting",
            Self::Input => "input",
            Self::Samples => "samples",
        }
    }

    fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }
}

/// Something that is other than before.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Change {
    /// What kind of thing.
    pub kind: ChangeKind,
    /// Its name.
    pub name: String,
    /// What it was; `None` where it was not there.
    pub before: Option<String>,
    /// What it is; `None` where it is gone.
    pub after: Option<String>,
}

/// All that results rest on, by kind and name.
pub type Basis = BTreeMap<(ChangeKind, String), String>;

impl Change {
    /// What differs between two bases, by kind and name.
    #[must_use]
    pub fn between(before: &Basis, after: &Basis) -> Vec<Self> {
        let mut keys: Vec<&(ChangeKind, String)> = before.keys().chain(after.keys()).collect();
        keys.sort_unstable();
        keys.dedup();
        let differs = |key: &&&(ChangeKind, String)| before.get(**key) != after.get(**key);
        let change = |key: &(ChangeKind, String)| Self {
            kind: key.0,
            name: key.1.clone(),
            before: before.get(key).cloned(),
            after: after.get(key).cloned(),
        };
        keys.iter().filter(differs).map(|key| change(key)).collect()
    }
}

impl Store {
    /// What the stored results rest on: settings as their stages last used them, inputs by their content, the number of samples.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn basis(&mut self) -> Result<Basis, StoreError> {
        let sql = "SELECT 'setting' AS kind, name, value FROM setting
            UNION ALL
            SELECT 'input', path, CASE outcome WHEN 'accepted' THEN blake3 ELSE blake3 || ', refused' END FROM source_file
            UNION ALL
            SELECT 'samples', 'samples', CAST(count(*) AS TEXT) FROM hourly_sample";
        let rows = self.select(sql, |r| {
            let kind = word(r, "kind", ChangeKind::from_name)?;
            Ok(((kind, r.try_get("name")?), r.try_get("value")?))
        })?;
        Ok(rows.into_iter().collect())
    }

    /// Records what a run found changed.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn put_changes(&mut self, run_id: i64, changes: &[Change]) -> Result<(), StoreError> {
        self.drive(async |c| {
            let mut tx = begin(c).await?;
            for (position, change) in changes.iter().enumerate() {
                let row = Insert::into("run_change")
                    .set("run_id", run_id)?
                    .set("position", position as i64)?
                    .set("kind", change.kind.name())?
                    .set("name", change.name.as_str())?
                    .set("before_value", change.before.as_deref())?
                    .set("after_value", change.after.as_deref())?;
                row.execute(&mut tx).await?;
            }
            commit(tx).await
        })
    }

    /// What runs after the first and up to the last of two found changed, in their order.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn changes(&mut self, after_run: i64, to_run: i64) -> Result<Vec<(i64, Change)>, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT * FROM run_change WHERE run_id > ? AND run_id <= ? ORDER BY run_id, position";
            let rows = sqlx::query(sql).bind(after_run).bind(to_run).fetch_all(c).await?;
            let change = |r: &sqlx::sqlite::SqliteRow| {
                let change = Change {
                    kind: word(r, "kind", ChangeKind::from_name)?,
                    name: r.try_get("name")?,
                    before: r.try_get("before_value")?,
                    after: r.try_get("after_value")?,
                };
                Ok((r.try_get("run_id")?, change))
            };
            rows.iter().map(change).collect()
        })
    }

    /// The annual averages as they stood after a run, by design and window.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn averages_after(&mut self, run_id: i64) -> Result<Vec<PastAverage>, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT * FROM annual_history
                WHERE run_id = (SELECT max(run_id) FROM annual_history WHERE run_id <= ?)
                ORDER BY design, pmv_min, pmv_max";
            let rows = sqlx::query(sql).bind(run_id).fetch_all(c).await?;
            let row = |r: &sqlx::sqlite::SqliteRow| {
                Ok(PastAverage {
                    run_id: r.try_get("run_id")?,
                    design: r.try_get("design")?,
                    window: window(r)?,
                    hvac_power_w: r.try_get("hvac_power_w")?,
                    sample_count: count(r, "sample_count")?,
                    unsolved_count: count(r, "unsolved_count")?,
                })
            };
            rows.iter().map(row).collect()
        })
    }
}
