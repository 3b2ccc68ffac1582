//! Columns by name: in inserts beside their values, in reads beside their fields.

use cabin::ComfortWindow;
use chrono::{DateTime, SecondsFormat, Utc};
use sqlx::sqlite::{SqliteArguments, SqliteConnection, SqliteRow};
use sqlx::{Arguments, AssertSqlSafe, Connection, Encode, Row, Sqlite, Transaction, Type};

use crate::{Ends, StoreError};

/// A transaction that writes from its beginning: one that only reads at first could not wait for another writer.
pub(crate) async fn begin(c: &mut SqliteConnection) -> Result<Transaction<'_, Sqlite>, StoreError> {
    Ok(c.begin_with("BEGIN IMMEDIATE").await?)
}

/// A row on its way into a table, or several.
pub(crate) struct Insert {
    verb: &'static str,
    table: &'static str,
    columns: Vec<&'static str>,
    rows: usize,
    arguments: SqliteArguments,
}

impl Insert {
    /// A row that is not there yet.
    pub fn into(table: &'static str) -> Self {
        Self { verb: "INSERT", table, columns: Vec::new(), rows: 1, arguments: SqliteArguments::default() }
    }

    /// A row that takes the place of one with the same key.
    pub fn replacing(table: &'static str) -> Self {
        Self { verb: "INSERT OR REPLACE", ..Self::into(table) }
    }

    /// A column with its value.
    pub fn set<'q>(
        mut self,
        column: &'static str,
        value: impl Encode<'q, Sqlite> + Type<Sqlite>,
    ) -> Result<Self, StoreError> {
        if self.rows == 1 {
            self.columns.push(column);
        }
        self.arguments.add(value).map_err(sqlx::Error::Encode)?;
        Ok(self)
    }

    /// The columns by which analysts know a design and a comfort window.
    pub fn of_point(self, design: &str, window: ComfortWindow) -> Result<Self, StoreError> {
        self.set("design", design)?
            .set("pmv_limit", window.pmv_limit())?
            .set("pmv_min", window.pmv_min())?
            .set("pmv_max", window.pmv_max())
    }

    /// Begins another row; its columns come in the same order.
    pub fn another(mut self) -> Self {
        self.rows += 1;
        self
    }

    /// Writes the row; gives its id, or that of the last of several, where the table has one.
    pub async fn execute(self, c: &mut SqliteConnection) -> Result<i64, StoreError> {
        let sql = insert_sql(self.verb, self.table, &self.columns, self.rows);
        // The text is built from constants alone.
        Ok(sqlx::query_with(AssertSqlSafe(sql), self.arguments).execute(c).await?.last_insert_rowid())
    }
}

/// An INSERT of so many rows.
pub(crate) fn insert_sql(verb: &str, table: &str, columns: &[&str], rows: usize) -> String {
    let row = format!("({})", vec!["?"; columns.len()].join(","));
    format!("{verb} INTO {table} ({}) VALUES {}", columns.join(","), vec![row; rows].join(","))
}

/// Numbers as bytes, little endian.
pub(crate) fn pack(values: impl Iterator<Item = f64>) -> Vec<u8> {
    values.flat_map(f64::to_le_bytes).collect()
}

/// The numbers of [`pack`], so many at a time.
pub(crate) fn unpack<const N: usize>(bytes: &[u8]) -> Vec<[f64; N]> {
    let (values, _) = bytes.as_chunks::<8>();
    let values: Vec<f64> = values.iter().map(|b| f64::from_le_bytes(*b)).collect();
    values.as_chunks::<N>().0.to_vec()
}

/// Rows of one INSERT.
const ROWS: usize = 256;

/// Writes rows, many of them in one statement; `columns` sets those of a row, always in the same order.
pub(crate) async fn put_all<T>(
    c: &mut SqliteConnection,
    table: &'static str,
    rows: &[T],
    columns: impl Fn(Insert, &T) -> Result<Insert, StoreError>,
) -> Result<(), StoreError> {
    for rows in rows.chunks(ROWS) {
        let mut insert = Insert::into(table);
        for (n, row) in rows.iter().enumerate() {
            insert = columns(if n == 0 { insert } else { insert.another() }, row)?;
        }
        insert.execute(&mut *c).await?;
    }
    Ok(())
}

/// Lower end of an interval.
pub(crate) fn low(ends: Ends) -> Option<f64> {
    ends.map(|[low, _]| low)
}

/// Upper end.
pub(crate) fn high(ends: Ends) -> Option<f64> {
    ends.map(|[_, high]| high)
}

/// Both ends of an interval, where it is known.
pub(crate) fn ends(r: &SqliteRow, low: &str, high: &str) -> Result<Ends, sqlx::Error> {
    let (low, high): (Option<f64>, Option<f64>) = (r.try_get(low)?, r.try_get(high)?);
    Ok(low.zip(high).map(|(low, high)| [low, high]))
}

/// A count, which SQLite keeps as a signed number.
pub(crate) fn count(row: &SqliteRow, column: &str) -> Result<u64, sqlx::Error> {
    Ok(row.try_get::<i64, _>(column)?.cast_unsigned())
}

/// A time as it is kept: RFC 3339 in UTC, to the second.
pub(crate) fn time_text(time: DateTime<Utc>) -> String {
    time.to_rfc3339_opts(SecondsFormat::Secs, true)
}

/// A time.
pub(crate) fn time(row: &SqliteRow, column: &str) -> Result<DateTime<Utc>, sqlx::Error> {
    optional_time(row, column)?.ok_or_else(|| invalid(column, "no time"))
}

/// A time, or none.
pub(crate) fn optional_time(row: &SqliteRow, column: &str) -> Result<Option<DateTime<Utc>>, sqlx::Error> {
    let text: Option<String> = row.try_get(column)?;
    let parse = |text: String| {
        DateTime::parse_from_rfc3339(&text).map(|t| t.to_utc()).map_err(|e| invalid(column, &format!("{text:?}: {e}")))
    };
    text.map(parse).transpose()
}

/// The comfort window of a row: the columns `pmv_min` and `pmv_max`.
pub(crate) fn window(row: &SqliteRow) -> Result<ComfortWindow, sqlx::Error> {
    let (pmv_min, pmv_max) = (row.try_get("pmv_min")?, row.try_get("pmv_max")?);
    ComfortWindow::new(pmv_min, pmv_max).map_err(|e| invalid("pmv_min", &e.to_string()))
}

/// What a word of the database stands for.
pub(crate) fn word<T>(row: &SqliteRow, column: &str, meaning: impl Fn(&str) -> Option<T>) -> Result<T, sqlx::Error> {
    let text: String = row.try_get(column)?;
    meaning(&text).ok_or_else(|| invalid(column, &format!("{text:?} has no meaning")))
}

fn invalid(column: &str, what: &str) -> sqlx::Error {
    sqlx::Error::ColumnDecode { index: column.to_owned(), source: what.to_owned().into() }
}
