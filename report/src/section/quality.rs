//! What was noticed in the input files, and which segments gave no sample.

use ingest::{FileRecord, Finding};

use crate::StudyReport;
use crate::document::{Block, Column, DataTable, Section, Span, Table};
use crate::numbers::text;

/// Findings that the report lists one by one; all of them are in data_quality.csv.
const LISTED: usize = 40;

pub(super) fn section(study: &StudyReport) -> Section {
    let all: Vec<(&FileRecord, &Finding)> =
        study.files.iter().flat_map(|f| f.findings.iter().map(move |finding| (f, finding))).collect();
    let mut section = Section { tables: vec![data(&all), excluded(study)], ..Section::new("Data quality") }
        .asking("What was noticed in the inputs, and which parts of missions gave no sample?");
    if all.is_empty() {
        section = section.with(Block::words("Nothing was noticed in the input files."));
    } else {
        section = section.with(Block::Table(findings(&all)));
        let more = all.len().saturating_sub(LISTED);
        let line = Block::Paragraph(vec![Span::Value(format!("{more} more in data_quality.csv."))]);
        section = section.with((more > 0).then_some(line));
    }
    if study.exclusions.is_empty() {
        return section.with(Block::words("Every segment gave a sample."));
    }
    let rows = study.exclusions.iter().map(|e| vec![e.reason.clone(), e.count.to_string()]);
    section.with(Block::Table(Table::new("excluded.csv", &["segments without a sample"], &["count"], rows.collect())))
}

fn findings(all: &[(&FileRecord, &Finding)]) -> Table {
    let rows = all.iter().take(LISTED).map(|(file, finding)| {
        let line = finding.line.map(|line| format!(", line {line}")).unwrap_or_default();
        let column = finding.column.as_ref().map(|c| format!(", column {c}")).unwrap_or_default();
        let place = format!("{}{line}{column}", file.path);
        vec![place, finding.kind.name().to_owned(), finding.count.to_string(), finding.message.clone()]
    });
    let mut table = Table::new("data_quality.csv", &["file", "finding"], &["count"], rows.collect());
    table.columns.push(Column::Words("what it is".to_owned()));
    table
}

fn data(all: &[(&FileRecord, &Finding)]) -> DataTable {
    DataTable::of(
        "data_quality.csv",
        all,
        &[
            ("path", &|(f, _)| text(&f.path)),
            ("file_kind", &|(f, _)| f.kind.name().to_owned()),
            ("finding", &|(_, q)| q.kind.name().to_owned()),
            ("count", &|(_, q)| q.count.to_string()),
            ("line", &|(_, q)| q.line.map(|l| l.to_string()).unwrap_or_default()),
            ("column", &|(_, q)| text(q.column.as_deref().unwrap_or_default())),
            ("message", &|(_, q)| text(&q.message)),
        ],
    )
}

fn excluded(study: &StudyReport) -> DataTable {
    DataTable::of(
        "excluded.csv",
        &study.exclusions,
        &[("reason", &|e| text(&e.reason)), ("segment_count", &|e| e.count.to_string())],
    )
}
