//! The designs and comfort windows of the study.

use sqlx::{Connection, Row};

use crate::{DesignRow, Store, StoreError, WindowRow};

/// What a study has changed in the database.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct StudyChange {
    /// Ids of the designs, in the order given.
    pub design_ids: Vec<i64>,
    /// Ids of the windows, in the order given.
    pub window_ids: Vec<i64>,
    /// Designs that are new or whose key has changed: their optima are to be computed.
    pub changed_designs: Vec<String>,
    /// Designs and windows that the study no longer has.
    pub removed: u64,
}

/// The designs and windows that the database has.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct StoredStudy {
    /// Id, name, key and method of each design.
    pub designs: Vec<(i64, String, String, String)>,
    /// Id of each window, with the bits of its limits.
    pub windows: Vec<(i64, [u64; 2])>,
}

impl Store {
    /// The designs and windows that the optima belong to, in the order of the study.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn stored_study(&mut self) -> Result<StoredStudy, StoreError> {
        self.drive(async |c| {
            let sql = "SELECT design_id, name, design_key, method FROM hvac_design ORDER BY position";
            let designs = sqlx::query(sql).fetch_all(&mut *c).await?;
            let sql = "SELECT window_id, pmv_min, pmv_max FROM comfort_window ORDER BY position";
            let windows = sqlx::query(sql).fetch_all(c).await?;
            let design = |r: &sqlx::sqlite::SqliteRow| Ok((r.try_get(0)?, r.try_get(1)?, r.try_get(2)?, r.try_get(3)?));
            let window = |r: &sqlx::sqlite::SqliteRow| {
                let limits = [r.try_get::<f64, _>(1)?.to_bits(), r.try_get::<f64, _>(2)?.to_bits()];
                Ok((r.try_get(0)?, limits))
            };
            Ok(StoredStudy {
                designs: designs.iter().map(design).collect::<Result<_, sqlx::Error>>()?,
                windows: windows.iter().map(window).collect::<Result<_, sqlx::Error>>()?,
            })
        })
    }

    /// Makes the designs and windows of the database exactly these. The optima of a design whose key has changed, and
    /// of what the study no longer has, go.
    ///
    /// # Errors
    /// [`StoreError::Statement`].
    pub fn put_study(&mut self, designs: &[DesignRow], windows: &[WindowRow]) -> Result<StudyChange, StoreError> {
        self.drive(async |c| {
            let mut change = StudyChange::default();
            let mut tx = c.begin().await?;
            for row in sqlx::query("SELECT name FROM hvac_design").fetch_all(&mut *tx).await? {
                let name: String = row.try_get(0)?;
                if !designs.iter().any(|d| d.name == name) {
                    sqlx::query("DELETE FROM hvac_design WHERE name = ?").bind(&name).execute(&mut *tx).await?;
                    change.removed += 1;
                }
            }
            for row in sqlx::query("SELECT window_id, pmv_min, pmv_max FROM comfort_window").fetch_all(&mut *tx).await?
            {
                let (id, pmv_min, pmv_max): (i64, f64, f64) = (row.try_get(0)?, row.try_get(1)?, row.try_get(2)?);
                if !windows.iter().any(|w| w.pmv_min == pmv_min && w.pmv_max == pmv_max) {
                    sqlx::query("DELETE FROM comfort_window WHERE window_id = ?").bind(id).execute(&mut *tx).await?;
                    change.removed += 1;
                }
            }
            for (position, design) in designs.iter().enumerate() {
                let stored = sqlx::query("SELECT design_id FROM hvac_design WHERE name = ? AND design_key = ?")
                    .bind(&design.name)
                    .bind(&design.design_key)
                    .fetch_optional(&mut *tx)
                    .await?;
                if let Some(row) = stored {
                    let id: i64 = row.try_get(0)?;
                    sqlx::query("UPDATE hvac_design SET position = ? WHERE design_id = ?")
                        .bind(position as i64)
                        .bind(id)
                        .execute(&mut *tx)
                        .await?;
                    change.design_ids.push(id);
                    continue;
                }
                sqlx::query("DELETE FROM hvac_design WHERE name = ?").bind(&design.name).execute(&mut *tx).await?;
                let sql = "INSERT INTO hvac_design
                        (name, position, heating, heating_cop, cooling_cop, radiant_heaters, air_curtain, method,
                         design_key)
                    VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?) RETURNING design_id";
                let row = sqlx::query(sql)
                    .bind(&design.name)
                    .bind(position as i64)
                    .bind(&design.heating)
                    .bind(&design.heating_cop)
                    .bind(&design.cooling_cop)
                    .bind(design.radiant_heaters)
                    .bind(design.air_curtain)
                    .bind(&design.method)
                    .bind(&design.design_key)
                    .fetch_one(&mut *tx)
                    .await?;
                change.design_ids.push(row.try_get(0)?);
                change.changed_designs.push(design.name.clone());
            }
            for (position, window) in windows.iter().enumerate() {
                let sql = "INSERT INTO comfort_window (position, pmv_min, pmv_max, pmv_limit) VALUES (?, ?, ?, ?)
                    ON CONFLICT (pmv_min, pmv_max) DO UPDATE SET position = excluded.position RETURNING window_id";
                let row = sqlx::query(sql)
                    .bind(position as i64)
                    .bind(window.pmv_min)
                    .bind(window.pmv_max)
                    .bind(window.pmv_limit)
                    .fetch_one(&mut *tx)
                    .await?;
                change.window_ids.push(row.try_get(0)?);
            }
            tx.commit().await?;
            Ok(change)
        })
    }
}
