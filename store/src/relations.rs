//! Whole tables and views, a portion at a time and typed as the dictionary says.

use futures_util::TryStreamExt;
use sqlx::sqlite::SqliteRow;
use sqlx::{AssertSqlSafe, Row};
use std::ops::ControlFlow;

use crate::dictionary::{Column, ColumnKind, Relation};
use crate::{Store, StoreError};

/// Values of a column, of some rows.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Whole numbers.
    Integer(Vec<Option<i64>>),
    /// Floating ones.
    Real(Vec<Option<f64>>),
    /// Texts; bytes are not given.
    Text(Vec<Option<String>>),
}

impl Values {
    fn of(column: &Column) -> Self {
        match column.kind {
            ColumnKind::Integer => Self::Integer(Vec::new()),
            ColumnKind::Real => Self::Real(Vec::new()),
            ColumnKind::Text | ColumnKind::Bytes => Self::Text(Vec::new()),
        }
    }

    fn push(&mut self, row: &SqliteRow, place: usize) -> Result<(), sqlx::Error> {
        match self {
            Self::Integer(values) => values.push(row.try_get(place)?),
            Self::Real(values) => values.push(row.try_get(place)?),
            Self::Text(values) => values.push(row.try_get(place)?),
        }
        Ok(())
    }
}

impl Store {
    /// Gives the rows of a relation, of one design where the relation has them by design, at most `portion` at a time and at least
    /// once, in the order of their values; ends early where `each` says so. Columns are those of the relation.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`].
    pub fn portions(
        &mut self,
        relation: &Relation,
        design: Option<&str>,
        portion: usize,
        each: &mut dyn FnMut(&[Values]) -> ControlFlow<()>,
    ) -> Result<(), StoreError> {
        self.drive(async |c| {
            let empty = || relation.columns.iter().map(Values::of).collect::<Vec<Values>>();
            let names: Vec<&str> = relation.columns.iter().map(|c| c.name.as_str()).collect();
            let wanted = if design.is_some() { " WHERE design = ?" } else { "" };
            let columns = names.join(", ");
            let sql = format!("SELECT {columns} FROM {}{wanted} ORDER BY {columns}", relation.name);
            // The text is built from names of the schema.
            let mut query = sqlx::query(AssertSqlSafe(sql));
            if let Some(design) = design {
                query = query.bind(design);
            }
            let (mut values, mut rows, mut given) = (empty(), 0, false);
            let mut stream = query.fetch(c);
            while let Some(row) = stream.try_next().await? {
                for (place, column) in values.iter_mut().enumerate() {
                    column.push(&row, place)?;
                }
                rows += 1;
                if rows == portion {
                    if each(&values).is_break() {
                        return Ok(());
                    }
                    (values, rows, given) = (empty(), 0, true);
                }
            }
            if rows > 0 || !given {
                let _ = each(&values);
            }
            Ok(())
        })
    }
}
