//! The designs and comfort windows of the study. Their ids stay inside this room: outside, a design is known by its place in
//! the study or its name, a window by its place or its limits.

use cabin::{ComfortWindow, Devices, Heating};
use solve::Method;
use sqlx::Row;
use sqlx::sqlite::{SqliteConnection, SqliteRow};

use crate::checks::{commit, seal_averages, whole};
use crate::row::{Insert, begin, window, word};
use crate::{Store, StoreError};

/// A design of the study.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DesignRow {
    /// Name, unique.
    pub name: String,
    /// How the air is heated.
    pub heating: Heating,
    /// Name or table of the heating COP.
    pub heating_cop: String,
    /// Name or table of the cooling COP.
    pub cooling_cop: String,
    /// The devices on board.
    pub devices: Devices,
    /// How its optima are found.
    pub method: Method,
    /// BLAKE3 of design, vehicle constants and version of the method.
    pub design_key: String,
}

impl DesignRow {
    /// Whether it is resistive heating and nothing else, which others are compared with.
    #[must_use]
    pub fn is_plain_resistive(&self) -> bool {
        self.heating == Heating::Ptc && self.devices == Devices::NONE
    }
}

/// The designs and windows that the database has, in the order of the study.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StoredGrid {
    /// Designs.
    pub designs: Vec<DesignRow>,
    /// Windows.
    pub windows: Vec<ComfortWindow>,
    pub(crate) design_ids: Vec<i64>,
    pub(crate) window_ids: Vec<i64>,
}

/// What a study has changed in the database.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct GridChange {
    /// What the database has now.
    pub grid: StoredGrid,
    /// Designs that are new or whose key has changed: their optima are to be computed.
    pub changed_designs: Vec<String>,
    /// Designs and windows that the study no longer has.
    pub removed: u64,
}

impl StoredGrid {
    /// For each of a study's designs the place of the stored one that is the same but for its name.
    #[must_use]
    pub fn same_designs(&self, wanted: &[DesignRow]) -> Vec<Option<usize>> {
        same_designs(&self.designs, wanted)
    }

    /// Place of the design with an id of the database.
    pub(crate) fn design(&self, id: i64) -> Result<usize, sqlx::Error> {
        self.design_ids.iter().position(|i| *i == id).ok_or(sqlx::Error::RowNotFound)
    }

    /// Place of the window with an id of the database.
    pub(crate) fn window(&self, id: i64) -> Result<usize, sqlx::Error> {
        self.window_ids.iter().position(|i| *i == id).ok_or(sqlx::Error::RowNotFound)
    }
}

impl Store {
    /// The designs and windows that the optima belong to.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn grid(&mut self) -> Result<StoredGrid, StoreError> {
        self.drive_checked(async |c, damage| {
            let mut grid = StoredGrid::default();
            let rows = sqlx::query("SELECT * FROM hvac_design ORDER BY position").fetch_all(&mut *c).await?;
            whole(damage, "hvac_design", &rows)?;
            for r in &rows {
                grid.design_ids.push(r.try_get("design_id")?);
                grid.designs.push(design(r)?);
            }
            let rows = sqlx::query("SELECT * FROM comfort_window ORDER BY position").fetch_all(c).await?;
            whole(damage, "comfort_window", &rows)?;
            for r in &rows {
                grid.window_ids.push(r.try_get("window_id")?);
                grid.windows.push(window(r)?);
            }
            Ok(grid)
        })
    }

    /// Makes the designs and windows of the database exactly these. The optima of a design whose key has changed, and
    /// of what the study no longer has, go; a design under a new name keeps them.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn put_grid(&mut self, designs: &[DesignRow], windows: &[ComfortWindow]) -> Result<GridChange, StoreError> {
        let stored = self.grid()?;
        self.drive(async |c| {
            let mut change = GridChange::default();
            let mut tx = begin(c).await?;
            let same = same_designs(&stored.designs, designs);
            for (i, (row, id)) in stored.designs.iter().zip(&stored.design_ids).enumerate() {
                if !same.contains(&Some(i)) {
                    sqlx::query("DELETE FROM hvac_design WHERE design_id = ?").bind(id).execute(&mut *tx).await?;
                    change.removed += u64::from(!designs.iter().any(|d| d.name == row.name));
                }
            }
            rename_designs(&mut tx, &stored, designs, &same).await?;
            for (window, id) in stored.windows.iter().zip(&stored.window_ids) {
                if !windows.contains(window) {
                    sqlx::query("DELETE FROM comfort_window WHERE window_id = ?").bind(id).execute(&mut *tx).await?;
                    change.removed += 1;
                }
            }
            for (position, design) in designs.iter().enumerate() {
                let id = match same[position] {
                    Some(i) => {
                        let sql = "UPDATE hvac_design SET position = ? WHERE design_id = ?";
                        let id = stored.design_ids[i];
                        sqlx::query(sql).bind(position as i64).bind(id).execute(&mut *tx).await?;
                        id
                    }
                    None => {
                        change.changed_designs.push(design.name.clone());
                        insert_design(&mut tx, position, design).await?
                    }
                };
                change.grid.design_ids.push(id);
            }
            for (position, window) in windows.iter().enumerate() {
                let sql = "INSERT INTO comfort_window (position, pmv_min, pmv_max, pmv_limit) VALUES (?, ?, ?, ?)
                    ON CONFLICT (pmv_min, pmv_max) DO UPDATE SET position = excluded.position RETURNING window_id";
                let row = sqlx::query(sql)
                    .bind(position as i64)
                    .bind(window.pmv_min())
                    .bind(window.pmv_max())
                    .bind(window.pmv_limit())
                    .fetch_one(&mut *tx)
                    .await?;
                change.grid.window_ids.push(row.try_get("window_id")?);
            }
            // What a design or window had in tables of sums has gone with it.
            seal_averages(&mut tx).await?;
            commit(tx).await?;
            (change.grid.designs, change.grid.windows) = (designs.to_vec(), windows.to_vec());
            Ok(change)
        })
    }
}

/// For each wanted design the place of the stored one that is the same but for its name: of several, that of its name.
fn same_designs(stored: &[DesignRow], wanted: &[DesignRow]) -> Vec<Option<usize>> {
    let key = |i: &usize, design: &DesignRow| stored[*i].design_key == design.design_key;
    let named = |design: &DesignRow| (0..stored.len()).find(|i| stored[*i].name == design.name && key(i, design));
    let mut same: Vec<Option<usize>> = wanted.iter().map(named).collect();
    for (place, design) in wanted.iter().enumerate() {
        if same[place].is_none() {
            same[place] = (0..stored.len()).find(|i| key(i, design) && !same.contains(&Some(*i)));
        }
    }
    same
}

/// Gives stored designs the names of the study; averages go by names, so that all of them are to be renewed.
async fn rename_designs(
    c: &mut SqliteConnection,
    stored: &StoredGrid,
    wanted: &[DesignRow],
    same: &[Option<usize>],
) -> Result<(), StoreError> {
    let pairs = wanted.iter().zip(same).filter_map(|(design, same)| Some((design, (*same)?)));
    let renamed: Vec<(i64, &str)> = pairs
        .filter(|(design, i)| stored.designs[*i].name != design.name)
        .map(|(design, i)| (stored.design_ids[i], design.name.as_str()))
        .collect();
    // First to names that no design has, so that two may exchange theirs.
    for (id, _) in &renamed {
        let sql = "UPDATE hvac_design SET name = char(1) || design_id WHERE design_id = ?";
        sqlx::query(sql).bind(id).execute(&mut *c).await?;
    }
    for (id, name) in &renamed {
        let sql = "UPDATE hvac_design SET name = ? WHERE design_id = ?";
        sqlx::query(sql).bind(*name).bind(id).execute(&mut *c).await?;
    }
    if !renamed.is_empty() {
        let sql = "INSERT OR IGNORE INTO stale_month
            VALUES (1), (2), (3), (4), (5), (6), (7), (8), (9), (10), (11), (12)";
        sqlx::query(sql).execute(&mut *c).await?;
    }
    Ok(())
}

async fn insert_design(c: &mut SqliteConnection, position: usize, design: &DesignRow) -> Result<i64, StoreError> {
    Insert::into("hvac_design")
        .set("name", design.name.as_str())?
        .set("position", position as i64)?
        .set("heating", design.heating.name())?
        .set("heating_cop", design.heating_cop.as_str())?
        .set("cooling_cop", design.cooling_cop.as_str())?
        .set("radiant_heaters", design.devices.radiant_heaters)?
        .set("air_curtain", design.devices.air_curtain)?
        .set("method", design.method.name())?
        .set("design_key", design.design_key.as_str())?
        .execute(c)
        .await
}

fn design(r: &SqliteRow) -> Result<DesignRow, sqlx::Error> {
    Ok(DesignRow {
        name: r.try_get("name")?,
        heating: word(r, "heating", Heating::from_name)?,
        heating_cop: r.try_get("heating_cop")?,
        cooling_cop: r.try_get("cooling_cop")?,
        devices: Devices { radiant_heaters: r.try_get("radiant_heaters")?, air_curtain: r.try_get("air_curtain")? },
        method: word(r, "method", Method::from_name)?,
        design_key: r.try_get("design_key")?,
    })
}
