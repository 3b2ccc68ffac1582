//! The shade of the year, as reports draw it.

use sqlx::Row;

use crate::checks::{Damage, commit, whole};
use crate::row::{Insert, begin, pack, unpack};
use crate::{Store, StoreError};

impl Store {
    /// Keeps the shadow fractions at the full hours of a year of 365 days from 1 January 00:00 UTC.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn put_shadow_year(&mut self, hourly: &[f64]) -> Result<(), StoreError> {
        self.drive(async |c| {
            let mut tx = begin(c).await?;
            let hourly = pack(hourly.iter().copied());
            Insert::replacing("shadow_year").set("one", 1)?.set("hourly", hourly)?.execute(&mut tx).await?;
            commit(tx).await
        })
    }

    /// Those shadow fractions; none before samples were made.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn shadow_year(&mut self) -> Result<Vec<f64>, StoreError> {
        let path = self.path().to_owned();
        self.drive(async |c| {
            let rows = sqlx::query("SELECT * FROM shadow_year").fetch_all(c).await?;
            whole(Damage::Refused(&path), "shadow_year", &rows)?;
            let Some(row) = rows.first() else { return Ok(Vec::new()) };
            Ok(unpack::<1>(row.try_get("hourly")?).into_iter().flatten().collect())
        })
    }
}
