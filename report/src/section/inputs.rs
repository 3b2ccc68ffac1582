//! What was read.

use ingest::FileKind;

use crate::StudyReport;
use crate::document::{Block, Column, DataTable, Section, Span, Table};
use crate::numbers::{text, time};

pub(super) fn section(study: &StudyReport) -> Section {
    let row = |kind: FileKind| {
        let of = || study.files.iter().filter(move |f| f.kind == kind);
        let used = || of().filter(|f| f.accepted);
        let or_dash = |t: Option<_>| t.map_or_else(|| "–".to_owned(), time);
        vec![
            kind.name().to_owned(),
            used().count().to_string(),
            of().filter(|f| !f.accepted).count().to_string(),
            used().map(|f| f.rows).sum::<u64>().to_string(),
            used().map(|f| f.bytes).sum::<u64>().to_string(),
            or_dash(used().filter_map(|f| f.first).min()),
            or_dash(used().filter_map(|f| f.last).max()),
        ]
    };
    let rows = [FileKind::Mission, FileKind::Weather, FileKind::Shadow].map(row).to_vec();
    let mut table = Table::new("sources.csv", &["kind"], &["used", "refused", "rows", "bytes"], rows);
    table.columns.extend(["first", "last"].map(|c| Column::Words(c.to_owned())));
    let section = Section { tables: vec![data(study)], ..Section::new("Inputs") }
        .asking("What was read?")
        .with(Block::words("Every file with its hash is in sources.csv."))
        .with(Block::Table(table));
    let missing: Vec<&str> = study.files.iter().filter(|f| f.is_missing()).map(|f| f.path.as_str()).collect();
    match missing.first() {
        None => section,
        Some(first) => section.with(Block::Paragraph(vec![
            Span::Value(missing.len().to_string()),
            Span::Text(" missions were not there when they were last looked for, the first: "),
            Span::Value((*first).to_owned()),
            Span::Text(". What came from them is kept,\nand is part of all numbers here."),
        ])),
    }
}

fn data(study: &StudyReport) -> DataTable {
    DataTable::of(
        "sources.csv",
        &study.files,
        &[
            ("path", &|f| text(&f.path)),
            ("kind", &|f| f.kind.name().to_owned()),
            ("blake3", &|f| f.blake3.clone()),
            ("bytes", &|f| f.bytes.to_string()),
            ("rows", &|f| f.rows.to_string()),
            ("first_utc", &|f| f.first.map(time).unwrap_or_default()),
            ("last_utc", &|f| f.last.map(time).unwrap_or_default()),
            ("outcome", &|f| if f.accepted { "accepted" } else { "refused" }.to_owned()),
        ],
    )
}
