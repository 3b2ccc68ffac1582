//! The dictionary and the questions as documents and as metadata of other tools.

use serde_json::{Map, Value, json};
use std::fmt::Write;
use store::{Column, Question, Relation};

/// Columns of a line of prose.
const WIDTH: usize = 120;

/// The reference of all tables, views and columns: what others build on, then the program's own.
#[must_use]
pub fn markdown(relations: &[Relation]) -> String {
    let mut text = String::new();
    for relation in relations.iter().filter(|r| !r.internal) {
        let kind = if relation.is_view { "view" } else { "table" };
        let _ = writeln!(text, "## {} ({kind})\n", relation.name);
        let source = if relation.source.is_empty() { String::new() } else { format!(" Source: {}.", relation.source) };
        let _ = writeln!(text, "{}", wrapped(&format!("{}{source}", relation.about())));
        let _ = writeln!(text, "\n| column | type | unit | what it is |\n|---|---|---|---|");
        for c in &relation.columns {
            let source = if c.source.is_empty() { String::new() } else { format!(" ({})", c.source) };
            let _ = writeln!(text, "| {} | {} | {} | {}{source} |", c.name, c.kind.name(), c.unit, cell(&c.text));
        }
        text.push('\n');
    }
    text.push_str("## Internal tables\n\n");
    let own = "What the views and the tables above are made from. They are the program's own and may change with any version.";
    let _ = writeln!(text, "{}\n\n| table | a row is of |\n|---|---|", wrapped(own));
    for relation in relations.iter().filter(|r| r.internal) {
        let columns: Vec<&str> = relation.columns.iter().map(|c| c.name.as_str()).collect();
        let _ = writeln!(text, "| {} | {}: {} |", relation.name, relation.title, columns.join(", "));
    }
    text
}

/// The questions with their queries.
#[must_use]
pub fn questions_markdown(questions: &[Question]) -> String {
    let mut text = String::new();
    let mut who = "";
    for question in questions {
        if question.who != who {
            who = &question.who;
            let _ = writeln!(text, "## From {who}\n");
        }
        let _ = writeln!(
            text,
            "### {}\n\n{}\n\n```sql\n{}\n```\n",
            question.name,
            wrapped(&question.asks),
            question.sql.trim()
        );
    }
    text.truncate(text.trim_end().len());
    text.push('\n');
    text
}

/// Both as JSON: `relations` with their columns, `questions` with their queries.
#[must_use]
pub fn json(relations: &[Relation], questions: &[Question]) -> Value {
    let relation = |r: &Relation| {
        json!({
            "name": r.name, "kind": if r.is_view { "view" } else { "table" }, "internal": r.internal, "title": r.title,
            "description": r.text, "source": r.source, "columns": r.columns.iter().map(field).collect::<Vec<_>>(),
        })
    };
    let question = |q: &Question| json!({ "name": q.name, "who": q.who, "question": q.asks, "sql": q.sql.trim() });
    json!({
        "relations": relations.iter().map(relation).collect::<Vec<_>>(),
        "questions": questions.iter().map(question).collect::<Vec<_>>(),
    })
}

/// A column in a document that machines read.
pub(crate) fn field(c: &Column) -> Value {
    json!({ "name": c.name, "type": c.kind.name(), "unit": c.unit, "description": c.text, "source": c.source })
}

/// Metadata for Datasette, which knows the database by the name of its file: titles, descriptions with units, the questions as
/// queries; internal tables are hidden.
#[must_use]
pub fn datasette(relations: &[Relation], questions: &[Question], database: &str) -> Value {
    let table = |r: &Relation| {
        let column = |c: &Column| (c.name.clone(), Value::from(format!("{}{}", c.text, c.bracketed_unit())));
        let columns: Map<String, Value> = r.columns.iter().map(column).collect();
        let mut about = json!({ "description": r.about(), "columns": columns });
        if r.internal {
            about["hidden"] = Value::from(true);
        }
        (r.name.clone(), about)
    };
    let query = |q: &Question| {
        let about = json!({ "title": q.asks, "description": format!("Asked in {}.", q.who), "sql": q.sql.trim() });
        (q.name.clone(), about)
    };
    let mut tables: Map<String, Value> = relations.iter().map(table).collect();
    // The record of schema versions, which the database's driver keeps.
    tables.insert("_sqlx_migrations".to_owned(), json!({ "hidden": true }));
    let queries: Map<String, Value> = questions.iter().map(query).collect();
    json!({
        "title": "What thermal comfort in an electric city bus costs over a year",
        "description": "A busclimate study: optimal HVAC operation of every hour, design and comfort window.",
        "license": "CC BY 4.0 where it is made from ZTBus and MeteoSwiss data",
        "license_url": "https://creativecommons.org/licenses/by/4.0/",
        "source": "ZTBus, Widmer et al., Sci. Data 10:687 (2023); weather as the study names it",
        "source_url": "https://doi.org/10.3929/ethz-b-000626723",
        "databases": { database: { "tables": tables, "queries": queries } },
    })
}

/// A bar would end the cell of a table.
fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}

/// Prose in lines.
fn wrapped(text: &str) -> String {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let last = lines.len() - 1;
        let width = lines[last].chars().count();
        if width > 0 && width + 1 + word.chars().count() > WIDTH {
            lines.push(word.to_owned());
        } else {
            let line = &mut lines[last];
            if width > 0 {
                line.push(' ');
            }
            line.push_str(word);
        }
    }
    lines.join("\n")
}
