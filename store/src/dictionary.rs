//! What every table, view and column is, in words: `dictionary.toml` beside the schema itself.
//!
//! Names, order and types of columns are those of the schema; the text says what they mean. It goes into the `CREATE` statements
//! that a database keeps, so that whoever has only the file can read it there.

use serde::Deserialize;
use sqlx::sqlite::SqliteConnection;
use sqlx::{AssertSqlSafe, Row};
use std::collections::BTreeMap;

use crate::row::begin;
use crate::{Store, StoreError};

const TEXT: &str = include_str!("../dictionary.toml");
/// How a line that comes from the dictionary begins.
const MARK: &str = "-- | ";

/// A table or view.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Relation {
    /// Name.
    pub name: String,
    /// Whether it is a view.
    pub is_view: bool,
    /// Whether it is the program's own and may change with any version.
    pub internal: bool,
    /// What it is, in a few words.
    pub title: String,
    /// What it is, in a sentence or two.
    pub text: String,
    /// Where its definition comes from; empty where that is this project.
    pub source: String,
    /// In the order of the schema.
    pub columns: Vec<Column>,
}

impl Relation {
    /// Title and text as one line.
    #[must_use]
    pub fn about(&self) -> String {
        format!("{}. {}", self.title, self.text).trim_end().to_owned()
    }
}

/// A column.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    /// Name.
    pub name: String,
    /// What its values are.
    pub kind: ColumnKind,
    /// What it means.
    pub text: String,
    /// Unit; empty for a number without one and for a text.
    pub unit: String,
    /// Where its definition comes from; empty where that is this project.
    pub source: String,
}

impl Column {
    /// The unit as it stands beside a name or a text: ` [W]`, or nothing.
    #[must_use]
    pub fn bracketed_unit(&self) -> String {
        if self.unit.is_empty() { String::new() } else { format!(" [{}]", self.unit) }
    }
}

/// What the values of a column are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColumnKind {
    /// Whole numbers of 64 bits.
    Integer,
    /// Floating ones of 64 bits.
    Real,
    /// Text.
    Text,
    /// Bytes.
    Bytes,
}

impl ColumnKind {
    /// The word for it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Integer => "integer",
            Self::Real => "real",
            Self::Text => "text",
            Self::Bytes => "bytes",
        }
    }

    fn of(declared: &str) -> Self {
        match declared {
            "INTEGER" | "INT" | "BIGINT" => Self::Integer,
            "REAL" | "DOUBLE" => Self::Real,
            "BLOB" => Self::Bytes,
            _ => Self::Text,
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Dictionary {
    columns: BTreeMap<String, Vec<String>>,
    object: toml::Table,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    title: String,
    #[serde(default)]
    text: String,
    #[serde(default)]
    source: String,
    #[serde(default)]
    internal: bool,
    #[serde(default)]
    columns: BTreeMap<String, Vec<String>>,
}

/// Units by what a name ends with, the longest first.
const UNITS: [(&str, &str); 12] = [
    ("_w_m2", "W/m²"),
    ("_w_k4", "W/K⁴"),
    ("_w_k", "W/K"),
    ("_deg", "°"),
    ("_rad", "rad"),
    ("_utc", ""),
    ("_w", "W"),
    ("_c", "°C"),
    ("_k", "K"),
    ("_s", "s"),
    ("_m", "m"),
    ("_h", "h"),
];

/// Tables and views that others build on, then the program's own; each in the order of the text.
///
/// # Errors
/// [`StoreError`].
pub fn dictionary() -> Result<Vec<Relation>, StoreError> {
    let mut store = Store::in_memory()?;
    let relations = store.drive(async |c| relations(c).await);
    store.close()?;
    relations
}

async fn relations(c: &mut SqliteConnection) -> Result<Vec<Relation>, StoreError> {
    let text: Dictionary = toml::from_str(TEXT).map_err(|e| sqlx::Error::Decode(e.into()))?;
    let sql = "SELECT s.name AS relation, s.type AS kind, c.name AS column_name, c.type AS declared
        FROM sqlite_schema AS s, pragma_table_info(s.name) AS c WHERE s.type IN ('table', 'view') ORDER BY s.name, c.cid";
    let mut schema: BTreeMap<String, (bool, Vec<(String, ColumnKind)>)> = BTreeMap::new();
    for r in sqlx::query(sql).fetch_all(c).await? {
        let (is_view, columns) = schema.entry(r.try_get("relation")?).or_default();
        *is_view = r.try_get::<String, _>("kind")? == "view";
        columns.push((r.try_get("column_name")?, ColumnKind::of(r.try_get("declared")?)));
    }
    let mut relations = Vec::new();
    for (name, entry) in text.object {
        let entry: Entry = entry.try_into().map_err(|e| sqlx::Error::Decode(Box::from(e)))?;
        let (is_view, columns) = schema.remove(&name).unwrap_or_default();
        let column = |(name, kind): (String, ColumnKind)| {
            let said = entry.columns.get(&name).or_else(|| text.columns.get(&name));
            let word = |n: usize| said.and_then(|said| said.get(n)).cloned();
            let by_suffix = || UNITS.iter().find(|(suffix, _)| name.ends_with(suffix)).map_or("", |u| u.1).to_owned();
            Column {
                kind,
                text: word(0).unwrap_or_default(),
                unit: word(1).unwrap_or_else(by_suffix),
                source: word(2).unwrap_or_default(),
                name,
            }
        };
        relations.push(Relation {
            columns: columns.into_iter().map(column).collect(),
            name,
            is_view,
            internal: entry.internal,
            title: entry.title,
            text: entry.text,
            source: entry.source,
        });
    }
    Ok(relations)
}

/// Writes the words into the `CREATE` statements that the database keeps; does nothing where they stand there already. Comments
/// change nothing of what is stored, which is why the statements may be rewritten in their place
/// (<https://www.sqlite.org/lang_altertable.html>, section 7).
pub(crate) async fn describe(c: &mut SqliteConnection) -> Result<(), StoreError> {
    let relations = relations(c).await?;
    let mut renewed = Vec::new();
    for r in
        sqlx::query("SELECT name, sql FROM sqlite_schema WHERE type IN ('table', 'view')").fetch_all(&mut *c).await?
    {
        let (name, stored): (String, String) = (r.try_get("name")?, r.try_get("sql")?);
        if let Some(relation) = relations.iter().find(|r| !r.internal && r.name == name) {
            let described = described(&stored, relation);
            if described != stored {
                renewed.push((name, described));
            }
        }
    }
    if renewed.is_empty() {
        return Ok(());
    }
    let mut tx = begin(c).await?;
    sqlx::query("PRAGMA writable_schema = ON").execute(&mut *tx).await?;
    for (name, sql) in &renewed {
        let update = "UPDATE sqlite_schema SET sql = ? WHERE name = ? AND type IN ('table', 'view')";
        sqlx::query(update).bind(sql).bind(name).execute(&mut *tx).await?;
    }
    // Whoever has the database open reads the statements again.
    let version: i64 = sqlx::query("PRAGMA schema_version").fetch_one(&mut *tx).await?.try_get(0)?;
    // The text is built from a number.
    sqlx::query(AssertSqlSafe(format!("PRAGMA schema_version = {}", version + 1))).execute(&mut *tx).await?;
    sqlx::query("PRAGMA writable_schema = RESET").execute(&mut *tx).await?;
    Ok(tx.commit().await?)
}

/// A statement as it is without the words of any version.
pub(crate) fn without_words(statement: &str) -> String {
    statement.lines().filter(|line| !line.starts_with(MARK)).collect::<Vec<_>>().join("\n")
}

/// A statement with the words after its first line, in place of those that stand there.
fn described(statement: &str, relation: &Relation) -> String {
    let bare = without_words(statement);
    let (first, rest) = bare.split_once('\n').unwrap_or((&bare, ""));
    let mut text = format!("{first}\n{MARK}{}\n", relation.about());
    for column in &relation.columns {
        text += &format!("{MARK}{}{}: {}\n", column.name, column.bracketed_unit(), column.text);
    }
    text + rest
}

#[cfg(test)]
mod tests {
    use super::{UNITS, dictionary};
    use crate::Store;
    use std::collections::BTreeSet;

    #[test]
    fn prop_every_table_view_and_column_has_words() {
        let relations = dictionary().unwrap();
        let named: BTreeSet<&str> = relations.iter().map(|r| r.name.as_str()).collect();
        let mut store = Store::in_memory().unwrap();
        let sql = "SELECT name FROM sqlite_schema WHERE type IN ('table', 'view') AND name NOT LIKE 'sqlite%'
            AND name <> '_sqlx_migrations'";
        let there = store.query_text(sql).unwrap().concat();
        assert_eq!(named, there.iter().map(String::as_str).collect());
        for r in &relations {
            assert!(!r.title.is_empty() && (r.internal || !r.text.is_empty()), "{}", r.name);
            for column in &r.columns {
                assert!(!column.text.is_empty(), "{}.{}", r.name, column.name);
                let suffix = UNITS.iter().find(|(suffix, _)| column.name.ends_with(suffix));
                let said = suffix.is_none_or(|(_, unit)| column.unit == *unit || column.unit.is_empty());
                assert!(said, "{}.{} in {}", r.name, column.name, column.unit);
            }
        }
        let internal = relations.iter().position(|r| r.internal).unwrap();
        assert!(relations[internal..].iter().all(|r| r.internal), "what is internal comes last");
        // No word for what is not there.
        let text: super::Dictionary = toml::from_str(super::TEXT).unwrap();
        for (name, entry) in &text.object {
            let entry: super::Entry = entry.clone().try_into().unwrap();
            let r = relations.iter().find(|r| r.name == *name).unwrap();
            assert!(entry.columns.keys().all(|said| r.columns.iter().any(|c| c.name == *said)), "{name}");
        }
        let used = |said: &&String| !relations.iter().any(|r| r.columns.iter().any(|c| c.name == **said));
        assert_eq!(text.columns.keys().filter(used).collect::<Vec<_>>(), Vec::<&String>::new());
    }

    #[test]
    fn prop_a_database_keeps_the_words() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("study.db");
        for _ in 0..2 {
            let mut store = Store::open(&path).unwrap();
            for name in ["sample", "annual_average"] {
                let sql = format!("SELECT sql FROM sqlite_schema WHERE name = '{name}'");
                let text = store.query_text(&sql).unwrap().concat().concat();
                let words = text.matches("\n-- | pmv_limit [PMV]: larger distance").count();
                assert_eq!(words, usize::from(name != "sample"), "{text}");
                assert_eq!(text.matches("\n-- | ").count(), if name == "sample" { 26 } else { 13 }, "{text}");
            }
            assert_eq!(store.query_text("PRAGMA integrity_check").unwrap(), [["ok"]]);
            store.check_averages().unwrap();
            store.close().unwrap();
        }
    }
    #[test]
    fn prop_words_of_another_version_are_no_damage_and_are_renewed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("study.db");
        Store::open(&path).unwrap().close().unwrap();
        let other = async |c: &mut sqlx::sqlite::SqliteConnection| {
            let sql = "PRAGMA writable_schema = ON;
                UPDATE sqlite_schema SET sql = replace(sql, '-- | weight: share', '-- | weight: part') WHERE name = 'sample';
                PRAGMA writable_schema = RESET";
            sqlx::raw_sql(sql).execute(c).await?;
            Ok(())
        };
        let mut store = Store::open(&path).unwrap();
        store.drive(other).unwrap();
        store.close().unwrap();
        let words = |store: &mut Store| {
            store.query_text("SELECT sql FROM sqlite_schema WHERE name = 'sample'").unwrap().concat()
        };
        let mut reader = Store::open_read_only(&path).unwrap();
        assert!(words(&mut reader)[0].contains("-- | weight: part in the year"));
        reader.check_averages().unwrap();
        reader.close().unwrap();
        let mut store = Store::open(&path).unwrap();
        assert!(words(&mut store)[0].contains("-- | weight: share in the year"));
        store.close().unwrap();
    }
}
