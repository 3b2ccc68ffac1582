//! Sections as one page that needs nothing else: figures, values, style and script are in it, and nothing else may run or load.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use minijinja::{AutoEscape, Environment, Value, context};
use sha2::{Digest, Sha256};

use super::figures::{data_file, svg, tables};
use crate::ReportError;
use crate::document::{Block, Choice, Column, Figure, Prose, Section, Span, Table};
use crate::figure::{Form, ValueTable, coordinate};

const PAGE: &str = include_str!("../../templates/page.html");
const STYLE: &str = include_str!("../../templates/page.css");
const SCRIPT: &str = include_str!("../../templates/page.js");

/// The page.
pub(crate) fn html(sections: &[Section]) -> Result<String, ReportError> {
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    environment.add_template("page.html", PAGE)?;
    let mut places = 0..;
    let sections: Vec<Value> = sections
        .iter()
        .map(|s| {
            let blocks = blocks(&s.blocks)?;
            let id = format!("section-{}", places.next().unwrap_or_default());
            Ok(context! { level => s.level, title => &s.title, id, question => prose(&s.question), blocks })
        })
        .collect::<Result<_, ReportError>>()?;
    let hash = |text: &str| format!("'sha256-{}'", STANDARD.encode(Sha256::digest(text)));
    let content = context! {
        sections,
        style => Value::from_safe_string(STYLE.to_owned()),
        script => Value::from_safe_string(SCRIPT.to_owned()),
        style_hash => Value::from_safe_string(hash(STYLE)),
        script_hash => Value::from_safe_string(hash(SCRIPT)),
    };
    Ok(environment.get_template("page.html")?.render(content)?)
}

fn blocks(blocks: &[Block]) -> Result<Vec<Value>, ReportError> {
    blocks.iter().map(block).collect()
}

fn block(block: &Block) -> Result<Value, ReportError> {
    let words = |kind: &str, text: &Prose| context! { kind, text => prose(text) };
    Ok(match block {
        Block::Paragraph(text) => words("paragraph", text),
        Block::Note(text) => words("note", text),
        Block::Quote(text) => words("quote", text),
        Block::Means(text) => words("means", text),
        Block::Limits(text) => words("limits", text),
        Block::List(items) => context! { kind => "list", items => items.iter().map(prose).collect::<Vec<_>>() },
        Block::Table(rows) => table(rows),
        Block::Figure(picture) => figure(picture)?,
        Block::Choice(Choice { of, options, shown }) => {
            let option = |(i, (name, of)): (usize, &(String, Vec<Block>))| -> Result<Value, ReportError> {
                Ok(context! { name, shown => i == *shown, blocks => blocks(of)? })
            };
            let options: Vec<Value> = options.iter().enumerate().map(option).collect::<Result<_, _>>()?;
            context! { kind => "choice", of => *of, options }
        }
    })
}

fn prose(spans: &Prose) -> Vec<Value> {
    let span = |span: &Span| match span {
        Span::Text(text) => context! { kind => "text", text => *text },
        Span::Value(text) => context! { kind => "text", text },
        Span::Strong(text) => context! { kind => "strong", text },
        Span::Code(text) => context! { kind => "code", text => *text },
    };
    spans.iter().map(span).collect()
}

fn table(table: &Table) -> Value {
    let column = |c: &Column| context! { title => c.title(), number => matches!(c, Column::Numbers(_)) };
    let columns: Vec<Value> = table.columns.iter().map(column).collect();
    context! { kind => "table", columns, rows => &table.rows, file => table.file }
}

fn figure(figure: &Figure) -> Result<Value, ReportError> {
    let values = |t: ValueTable| {
        let rows: Vec<Value> =
            t.rows.into_iter().map(|(x, at, cells)| context! { x => coordinate(x), at, cells }).collect();
        let panel = t.panel.map_or_else(String::new, |ends| ends.map(coordinate).join(" "));
        context! { caption => t.caption, at => t.at, columns => t.columns, rows, panel }
    };
    Ok(context! {
        kind => "figure",
        caption => &figure.caption,
        file => figure.file,
        data => data_file(figure),
        svg => Value::from_safe_string(svg(figure, Form::Inline)?),
        tables => tables(figure).into_iter().map(values).collect::<Vec<_>>(),
    })
}
