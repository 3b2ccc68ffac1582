//! Sections as Markdown.

use std::fmt::Write as _;

use super::figures::data_file;
use crate::document::{Block, Column, Prose, Section, Span, Table};

/// The sections one after the other, blocks parted by blank lines.
pub(crate) fn markdown(sections: &[Section]) -> String {
    let mut parts = Vec::new();
    for section in sections {
        if section.level > 0 {
            parts.push(format!("{} {}\n", "#".repeat(section.level), escaped(&section.title)));
        }
        if !section.question.is_empty() {
            parts.push(format!("*{}*\n", prose(&section.question)));
        }
        parts.extend(section.blocks.iter().map(block));
    }
    parts.join("\n")
}

fn block(block: &Block) -> String {
    match block {
        Block::Paragraph(text) => format!("{}\n", prose(text)),
        Block::Note(text) => format!("*{}*\n", prose(text)),
        Block::Quote(text) => format!("> {}\n", prose(text)),
        Block::List(items) => items.iter().map(|item| format!("- {}\n", prose(item))).collect(),
        Block::Table(rows) => table(rows),
        Block::Figure(figure) => {
            let (file, data) = (figure.file, data_file(figure));
            format!("![{}]({file}.svg)\n\nThe values in it: [{data}]({data})\n", escaped(&figure.caption))
        }
        Block::Means(text) => format!("**What it means.** {}\n", prose(text)),
        Block::Limits(text) => format!("**Its limits.** {}\n", prose(text)),
        Block::Choice(choice) => match choice.options.get(choice.shown) {
            Some((_, blocks)) => blocks.iter().map(self::block).collect::<Vec<_>>().join("\n"),
            None => String::new(),
        },
    }
}

fn table(table: &Table) -> String {
    let mut text = "|".to_owned();
    for column in &table.columns {
        let title = column.title();
        text += &if title.is_empty() { " |".to_owned() } else { format!(" {} |", escaped(title)) };
    }
    text += "\n|";
    for column in &table.columns {
        text += match column {
            Column::Words(_) => "---|",
            Column::Numbers(_) => "---:|",
        };
    }
    for row in &table.rows {
        text += "\n|";
        for cell in row {
            let _ = write!(text, " {} |", escaped(cell));
        }
    }
    format!("{text}\n\nEvery digit: [{0}]({0})\n", table.file)
}

fn prose(spans: &Prose) -> String {
    let span = |span: &Span| match span {
        Span::Text(text) => (*text).to_owned(),
        Span::Value(text) => escaped(text),
        Span::Strong(text) => format!("**{}**", escaped(text)),
        Span::Code(text) => format!("`{text}`"),
    };
    spans.iter().map(span).collect()
}

/// Text from outside must not break a table or the page.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '|' | '*' | '`' | '[' | ']' | '\\' | '~' => escaped.extend(['\\', c]),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '&' => escaped.push_str("&amp;"),
            c if c.is_control() => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}
