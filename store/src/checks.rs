//! Checks of what is stored, against storage that changes a bit without saying so.
//!
//! A row has a check over its other columns (`row_check`, its last column), a table of averages one over all its rows. Reads
//! that something is built on look at them; [`Store::check_all`] looks at everything.

use futures_util::{StreamExt, TryStreamExt};
use sqlx::sqlite::{SqliteConnection, SqliteRow};
use sqlx::{AssertSqlSafe, Column, Row, Sqlite, Transaction, TypeInfo, ValueRef};
use std::collections::BTreeMap;

use crate::connection::ROWS_AHEAD;
use crate::dictionary::without_words;
use crate::{Store, StoreError};

/// A table and the columns of its key.
type Table = (&'static str, &'static [&'static str]);

/// Tables whose rows get their check when the transaction that wrote them ends. Optima get theirs
/// while they are inserted.
const SEALED: [Table; 18] = [
    ("source_file", &["source_file_id"]),
    ("data_quality", &["source_file_id", "position"]),
    ("excluded_segment", &["mission", "segment"]),
    ("stage_record", &["stage"]),
    ("mission_segment", &["source_file_id", "segment"]),
    ("mission_load", &["source_file_id"]),
    ("hourly_sample", &["sample_id"]),
    ("sample_clock", &["sample_id"]),
    ("shadow_year", &["one"]),
    ("hvac_design", &["design_id"]),
    ("comfort_window", &["window_id"]),
    SIMULATED,
    ("unsimulated_mission", &["source_file_id", "design_id", "window_id"]),
    ("controlled_mission_key", &["source_file_id", "design_id"]),
    CONTROLLED,
    ("controlled_outside", &["source_file_id", "design_id", "profile_id", "window_id"]),
    ("mission_trace", &["trace_id"]),
    ("trace_minute", &["trace_id", "minute"]),
];
const SIMULATED: Table = ("simulated_mission", &["source_file_id", "design_id", "window_id", "controller"]);
const CONTROLLED: Table = ("controlled_mission", &["source_file_id", "design_id", "window_id", "controller"]);
const OPTIMA: Table = ("optimum_point", &["sample_id", "design_id", "window_id"]);
/// Tables of averages, with their keys.
const AVERAGES: [(&str, &str); 39] = [
    ("simulation_month", "design_id, window_id, controller, month"),
    ("simulation_class_month", "design_id, window_id, class_order, month"),
    ("monthly_average", "design, pmv_min, pmv_max, month"),
    ("annual_average", "design, pmv_min, pmv_max"),
    ("limit_share", "design, pmv_min, pmv_max"),
    ("heat_transfer", "one"),
    ("power_limit", "design_id"),
    ("class_month", "month"),
    ("class_sum", "month, design_id, window_id"),
    ("heat_flow_monthly", "design, pmv_min, pmv_max, month"),
    ("unmet_demand", "design, pmv_min, pmv_max"),
    ("energy_class", "design, pmv_min, pmv_max, sorted_by, class"),
    ("annual_energy", "design, pmv_min, pmv_max"),
    ("disturbance_histogram", "quantity, bin_from"),
    ("day_month", "month"),
    ("day_sum", "month, design_id, window_id"),
    ("annual_interval", "design, pmv_min, pmv_max"),
    ("design_interval", "design, other_design, pmv_min, pmv_max"),
    ("month_spread", "design, pmv_min, pmv_max, month"),
    ("left_out", "design, pmv_min, pmv_max, kind, name"),
    ("simulation_interval", "design, pmv_min, pmv_max, controller"),
    ("control_interval", "design, pmv_min, pmv_max, controller"),
    ("simulation_annual", "design, pmv_min, pmv_max, controller"),
    ("simulation_class", "design, pmv_min, pmv_max, class_order"),
    ("setpoint_profile", "design, pmv_min, pmv_max, mode"),
    ("curtain_threshold", "design, pmv_min, pmv_max, mode"),
    ("heater_threshold", "design, pmv_min, pmv_max"),
    ("control_annual", "design, pmv_min, pmv_max, controller"),
    ("control_class", "design, pmv_min, pmv_max, controller, class_order"),
    ("control_outside", "design, controller, profile_pmv_min, profile_pmv_max, pmv_min, pmv_max"),
    ("control_trace", "design, pmv_min, pmv_max, controller, minute"),
    ("variant_setting", "variant, name"),
    ("variant_annual", "variant, design, pmv_min, pmv_max"),
    ("sensitivity_result", "design, pmv_min, pmv_max, quantity"),
    ("sensitivity_swing", "design, pmv_min, pmv_max, quantity, input"),
    ("sensitivity_index", "design, pmv_min, pmv_max, quantity, input"),
    ("limited_annual", "design, pmv_min, pmv_max"),
    ("economic_input", "design"),
    ("economics", "design, pmv_min, pmv_max"),
];
/// Rows that get their checks in one statement.
const SEALED_AT_ONCE: usize = 256;

/// What a look at all checks has found.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Checked {
    /// Rows and tables that were looked at.
    pub count: u64,
    /// What is not as it was written.
    pub damaged: Vec<String>,
}

/// The values of a row on their way into a hash.
#[derive(Debug, Default)]
pub(crate) struct RowHash(Vec<u8>);

impl RowHash {
    pub fn integer(&mut self, value: Option<i64>) {
        self.value(b'i', value.map(i64::to_le_bytes));
    }

    /// SQLite keeps no negative zero.
    pub fn real(&mut self, value: Option<f64>) {
        self.value(b'r', value.map(|value| (value + 0.0).to_le_bytes()));
    }

    fn bytes(&mut self, value: &[u8]) {
        self.value(b'b', Some((value.len() as u64).to_le_bytes()));
        self.0.extend_from_slice(value);
    }

    fn value(&mut self, kind: u8, bytes: Option<[u8; 8]>) {
        match bytes {
            Some(bytes) => {
                self.0.push(kind);
                self.0.extend_from_slice(&bytes);
            }
            None => self.0.push(b'n'),
        }
    }

    /// All columns of a row up to its check, which is the last of its table; what a query has besides stands behind it.
    fn row(&mut self, row: &SqliteRow) -> Result<Option<i64>, sqlx::Error> {
        for (i, column) in row.columns().iter().enumerate() {
            if column.name() == "row_check" {
                return row.try_get(i);
            }
            let value = row.try_get_raw(i)?;
            if value.is_null() {
                self.value(b'n', None);
                continue;
            }
            match value.type_info().name() {
                "INTEGER" => self.integer(Some(row.try_get_unchecked(i)?)),
                "REAL" => self.real(Some(row.try_get_unchecked(i)?)),
                _ => self.bytes(row.try_get_unchecked(i)?),
            }
        }
        Ok(None)
    }

    /// The check of the values so far; starts anew.
    pub fn finish(&mut self) -> i64 {
        let hash = blake3::hash(&self.0);
        self.0.clear();
        let bytes: [u8; 8] = std::array::from_fn(|i| hash.as_bytes()[i]);
        i64::from_le_bytes(bytes) & i64::MAX
    }
}

/// Whether a row is as it was written, as far as it says.
pub(crate) fn is_whole(row: &SqliteRow, hash: &mut RowHash) -> Result<bool, sqlx::Error> {
    let check = hash.row(row)?;
    let now = hash.finish();
    Ok(check.is_none_or(|then| then == now))
}

/// The rows of a query on a table, `table.*` first, each of them looked at where damage is refused.
pub(crate) fn whole(damage: Damage<'_>, table: &'static str, rows: &[SqliteRow]) -> Result<(), StoreError> {
    let mut hash = RowHash::default();
    for row in rows {
        if matches!(damage, Damage::Refused(_)) && !is_whole(row, &mut hash)? {
            damage.of(table, row)?;
        }
    }
    Ok(())
}

/// What is done about a damaged row.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Damage<'p> {
    /// It is an error that names the database.
    Refused(&'p std::path::Path),
    /// Somebody looks at all checks anyhow.
    Reported,
}

impl Damage<'_> {
    /// A row of a table is damaged.
    pub fn of(self, table: &'static str, row: &SqliteRow) -> Result<(), StoreError> {
        let Self::Refused(path) = self else { return Ok(()) };
        let key = SEALED.iter().chain([&OPTIMA]).find(|t| t.0 == table).map_or(&[][..], |t| t.1);
        Err(StoreError::Damaged { path: path.to_owned(), what: place((table, key), row) })
    }
}

/// Gives rows their checks and commits.
pub(crate) async fn commit(mut tx: Transaction<'_, Sqlite>) -> Result<(), StoreError> {
    let mut hash = RowHash::default();
    for (table, key) in SEALED {
        let rows = select(&mut tx, format!("SELECT * FROM {table} WHERE row_check IS NULL")).await?;
        let same = |(n, column): (usize, &&str)| format!("{table}.{column} = v.column{}", n + 2);
        let places = key.iter().enumerate().map(same).collect::<Vec<_>>().join(" AND ");
        // Statement by statement, a row would take longer than to be computed.
        for rows in rows.chunks(SEALED_AT_ONCE) {
            let values = vec![format!("(?{})", ",?".repeat(key.len())); rows.len()].join(",");
            // The text is built from constants alone.
            let sql = format!("UPDATE {table} SET row_check = v.column1 FROM (VALUES {values}) AS v WHERE {places}");
            let mut update = sqlx::query(AssertSqlSafe(sql));
            for row in rows {
                hash.row(row)?;
                update = update.bind(hash.finish());
                for column in key {
                    update = match *column {
                        "controller" | "mission" | "stage" => update.bind(row.try_get::<String, _>(*column)?),
                        _ => update.bind(row.try_get::<i64, _>(*column)?),
                    };
                }
            }
            update.execute(&mut *tx).await?;
        }
    }
    Ok(tx.commit().await?)
}

/// Records the checks of tables of averages, in the transaction that writes them.
pub(crate) async fn seal_averages(c: &mut SqliteConnection) -> Result<(), StoreError> {
    for (table, key) in AVERAGES {
        let hash = table_hash(c, table, key).await?;
        let sql = "INSERT OR REPLACE INTO table_check VALUES (?, ?)";
        sqlx::query(sql).bind(table).bind(hash).execute(&mut *c).await?;
    }
    Ok(())
}

async fn table_hash(c: &mut SqliteConnection, table: &str, key: &str) -> Result<String, StoreError> {
    let mut hash = RowHash::default();
    for row in select(c, format!("SELECT * FROM {table} ORDER BY {key}")).await? {
        hash.row(&row)?;
    }
    Ok(blake3::hash(&hash.0).to_hex().to_string())
}

/// Runs a query whose text is built from constants alone.
async fn select(c: &mut SqliteConnection, sql: String) -> Result<Vec<SqliteRow>, StoreError> {
    Ok(sqlx::query(AssertSqlSafe(sql)).fetch_all(c).await?)
}

impl Store {
    /// The error that says what is damaged.
    #[must_use]
    pub fn damaged(&self, what: String) -> StoreError {
        StoreError::Damaged { path: self.path().to_owned(), what }
    }

    /// Tables, views and triggers that are not as this program makes them. Others may stand beside them.
    fn damaged_schema(&mut self) -> Result<Vec<String>, StoreError> {
        let schema = async |c: &mut SqliteConnection| {
            let sql = "SELECT type || ' ' || name AS object, coalesce(sql, '') AS text FROM sqlite_schema";
            let rows = select(c, sql.to_owned()).await?;
            // Words may be those of another version of the program.
            let pair = |r: &SqliteRow| Ok((r.try_get("object")?, without_words(r.try_get("text")?)));
            rows.iter().map(pair).collect::<Result<BTreeMap<String, String>, StoreError>>()
        };
        let mut new = Self::in_memory()?;
        let (stored, made) = (self.drive(schema)?, new.drive(schema)?);
        new.close()?;
        Ok(made
            .into_iter()
            .filter(|(object, text)| stored.get(object) != Some(text))
            .map(|(object, _)| object)
            .collect())
    }

    /// Refuses averages and a schema that are not as they were written.
    ///
    /// # Errors
    /// [`StoreError::Damaged`], [`StoreError::Refused`].
    pub fn check_averages(&mut self) -> Result<(), StoreError> {
        let mut damaged = self.damaged_schema()?;
        damaged.extend(self.drive(async |c| damaged_averages(c).await)?);
        damaged.into_iter().next().map_or(Ok(()), |what| Err(self.damaged(what)))
    }

    /// Refuses simulated missions of the months that are to be averaged anew where one is not as it was written; ends early
    /// where `stop` says so.
    ///
    /// # Errors
    /// [`StoreError::Damaged`], [`StoreError::Refused`].
    pub fn check_simulations(&mut self, stop: &dyn Fn() -> bool) -> Result<(), StoreError> {
        let of_stale_months = "SELECT * FROM simulated_mission
            WHERE month IN (SELECT month FROM stale_simulation_month)";
        self.refuse_damaged(SIMULATED, of_stale_months, stop)
    }

    /// Refuses missions under controllers where one is not as it was written; ends early where `stop` says so.
    ///
    /// # Errors
    /// [`StoreError::Damaged`], [`StoreError::Refused`].
    pub fn check_controls(&mut self, stop: &dyn Fn() -> bool) -> Result<(), StoreError> {
        self.refuse_damaged(CONTROLLED, "SELECT * FROM controlled_mission", stop)
    }

    fn refuse_damaged(&mut self, table: Table, sql: &str, stop: &dyn Fn() -> bool) -> Result<(), StoreError> {
        let mut checked = Checked::default();
        self.drive(async |c| check_rows(c, table, sql, &mut checked, stop).await)?;
        checked.damaged.into_iter().next().map_or(Ok(()), |what| Err(self.damaged(what)))
    }

    /// Looks at every check, and at the structure of the database (`PRAGMA integrity_check`); ends early, with what it has seen,
    /// where `stop` says so.
    ///
    /// # Errors
    /// [`StoreError::Refused`], [`StoreError::Damaged`] where the database cannot even be read.
    pub fn check_all(&mut self, stop: &dyn Fn() -> bool) -> Result<Checked, StoreError> {
        let damaged = self.damaged_schema()?;
        self.drive(async |c| {
            let mut checked = Checked { count: 1, damaged };
            for row in select(c, "PRAGMA integrity_check".to_owned()).await? {
                let said: String = row.try_get(0)?;
                checked.count += 1;
                if said != "ok" {
                    checked.damaged.push(said);
                }
            }
            for table in SEALED.into_iter().chain([OPTIMA]) {
                check_rows(c, table, &format!("SELECT * FROM {}", table.0), &mut checked, stop).await?;
            }
            checked.count += AVERAGES.len() as u64;
            checked.damaged.extend(damaged_averages(c).await?);
            Ok(checked)
        })
    }
}

/// Which row of a table.
fn place((table, key): (&str, &[&str]), row: &SqliteRow) -> String {
    let text = |column: &&str| {
        let value = row.try_get_unchecked::<String, _>(*column).unwrap_or_default();
        format!(", {column} {value}")
    };
    format!("{table}{}", key.iter().map(text).collect::<String>())
}

/// Looks at the rows of a query on a table, at some while SQLite reads the next ones.
async fn check_rows(
    c: &mut SqliteConnection,
    table: Table,
    sql: &str,
    checked: &mut Checked,
    stop: &dyn Fn() -> bool,
) -> Result<(), StoreError> {
    // The text is built from constants alone.
    let mut rows = sqlx::query(AssertSqlSafe(sql.to_owned())).fetch(c).fuse();
    let mut read: Vec<SqliteRow> = Vec::new();
    loop {
        let next = (&mut rows).take(ROWS_AHEAD).try_collect();
        let (next, looked_at) = tokio::join!(next, async { look_at(table, &read, checked) });
        looked_at?;
        read = next?;
        if read.is_empty() || stop() {
            return Ok(());
        }
    }
}

fn look_at(table: Table, rows: &[SqliteRow], checked: &mut Checked) -> Result<(), StoreError> {
    let mut hash = RowHash::default();
    for row in rows {
        checked.count += 1;
        if !is_whole(row, &mut hash)? {
            checked.damaged.push(place(table, row));
        }
    }
    Ok(())
}

async fn damaged_averages(c: &mut SqliteConnection) -> Result<Vec<String>, StoreError> {
    let mut damaged = Vec::new();
    for (table, key) in AVERAGES {
        let sql = "SELECT blake3 FROM table_check WHERE table_name = ?";
        let Some(then) = sqlx::query(sql).bind(table).fetch_optional(&mut *c).await? else { continue };
        if then.try_get::<String, _>("blake3")? != table_hash(c, table, key).await? {
            damaged.push(table.to_owned());
        }
    }
    Ok(damaged)
}
